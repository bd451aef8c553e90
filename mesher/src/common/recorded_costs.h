#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

namespace collarmesh {

/// Records the costs of everything between and inside parallel parts, for developers: it shows on a machine
/// with few cores how much more threads would gain. With COLLARMESH_RECORD_COSTS=FILE in the environment the
/// program runs on one thread, but divides the work for as many as `--threads` says (COLLARMESH_CORES allows
/// more than there are). At the end of the program FILE gets a table (bench/schedule.py): CPU seconds by
/// stage and place.
namespace recorded_costs {

/// True if costs are recorded.
extern const bool on;

/// A place in the code.
struct Place {
  const char* file;
  int line;
};

/// Calls `work(i)` for all i below `count`, in order, and notes what each call costs.
void run(std::size_t count, const std::function<void(std::size_t)>& work, const Place& place);

/// Begins a stage: later costs belong to it.
void begin_stage(std::string_view stage);

/// Writes the table. The end of the program writes it, too, unless the process ends without cleaning up.
void write();

}  // namespace recorded_costs

}  // namespace collarmesh
