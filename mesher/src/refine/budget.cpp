#include "refine/budget.h"

#include <fmt/format.h>

#include <algorithm>

namespace collarmesh {

namespace {

constexpr double seconds_between_reports = 0.1;

}  // namespace

bool Budget::spent(const Usage& now) {
  constexpr const char* more =
      "raise {} or size; if the mesh should need far less, look for faults of the input at this vertex, or "
      "wrap the input (repair wrap)";
  peak_bytes_ = std::max(peak_bytes_, now.bytes);
  if (execution_.cancelled() || !report_progress(now))
    stop(MeshStatus::cancelled, now, "the refinement was stopped", "start it again");
  else if (options_.max_vertices > 0 && now.vertices + now.planned_vertices > options_.max_vertices)
    stop(MeshStatus::budget_hit, now,
         fmt::format("the budget of {} vertices is spent", options_.max_vertices),
         fmt::format(more, "max-vertices"));
  else if (options_.max_memory > 0 && peak_bytes_ > options_.max_memory)
    stop(MeshStatus::budget_hit, now,
         fmt::format("the memory budget of {} bytes is spent", options_.max_memory),
         fmt::format(more, "max-memory"));
  else if (is_out_of_time())
    stop(MeshStatus::budget_hit, now, fmt::format("the time limit of {} s is reached", options_.time_limit),
         fmt::format(more, "time-limit"));
  return outcome_.stopped();
}

void Budget::stop(MeshStatus status, const Usage& now, const std::string& what, const std::string& next) {
  outcome_.stop(status, now.last_vertex,
                fmt::format("{} at {} vertices and {} cells, {:.1f} MB, after {:.2f} s; the last vertex is",
                            what, now.vertices, now.cells, static_cast<double>(peak_bytes_) / 1e6, elapsed()),
                next);
}

bool Budget::report_progress(const Usage& now) {
  if (!execution_.progress) return true;
  const double seconds = elapsed();
  if (seconds - reported_ < seconds_between_reports) return true;
  reported_ = seconds;
  const double share = static_cast<double>(now.cells) / now.expected_cells;
  fraction_ = std::max(fraction_, std::min(0.98, share));
  return execution_.progress({"refine", fraction_, now.vertices, now.cells});
}

}  // namespace collarmesh
