#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

namespace collarmesh {

/// Costs of all that runs between and inside of parallel parts, for developers: what more threads would gain
/// can be told on a machine that has few. With COLLARMESH_RECORD_COSTS=FILE in the environment all runs on
/// one thread, but is divided for as many as `--threads` says (COLLARMESH_CORES allows more than there are);
/// at the end of the program FILE gets a table (bench/schedule.py), seconds of the processor by stage and
/// place.
namespace recorded_costs {

/// Are they recorded?
extern const bool on;

/// A place in the code.
struct Place {
  const char* file;
  int line;
};

/// Calls `work(i)` for all i below `count`, in order, and notes what each call costs.
void run(std::size_t count, const std::function<void(std::size_t)>& work, const Place& place);

/// What follows belongs to this stage.
void begin_stage(std::string_view stage);

/// Writes the table, which also happens at the end of the program, unless that is a process that ends at
/// once.
void write();

}  // namespace recorded_costs

}  // namespace collarmesh
