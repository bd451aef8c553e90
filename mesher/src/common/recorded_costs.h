#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace collarmesh {

/// Records the costs of everything between and inside parallel parts, so that developers whose machine has
/// few cores can estimate the gain from more threads. With COLLARMESH_RECORD_COSTS=FILE in the environment
/// the program runs on one thread, but divides the work as for `--threads` threads (COLLARMESH_CORES allows
/// more than the machine has). At the end of the program FILE gets a table of CPU seconds by stage and place,
/// which bench/schedule.py reads.
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

/// Writes the table. The end of the program writes it as well, unless the process ends without cleaning up.
void write();

/// A part of a stage whose costs are recorded apart, as "STAGE: WORK".
class StagePart {
 public:
  explicit StagePart(std::string_view work);
  /// Ends the part; later costs belong to the stage again.
  ~StagePart();
  StagePart(const StagePart&) = delete;
  StagePart& operator=(const StagePart&) = delete;

 private:
  std::string stage_;
};

}  // namespace recorded_costs

}  // namespace collarmesh
