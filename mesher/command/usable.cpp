#include "command/usable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "check/guarantees.h"
#include "check/layer_cells.h"
#include "process/interrupt.h"

namespace collarmesh::command {

void require_usable(std::string_view missed, const std::string& message, const std::function<void()>& tell) {
  constexpr std::array<std::string_view, 7> needed{guarantee::valid_arrays,  guarantee::finite_points,
                                                   guarantee::layer_arrays,  guarantee::positive_volume,
                                                   guarantee::distinct_tets, guarantee::positive_jacobian,
                                                   guarantee::layer_jacobian};
  if (std::ranges::find(needed, missed) == needed.end()) return;
  tell();
  throw process::Stopped(
      process::ExitCode::guarantee_missed,
      fmt::format("{} Nothing was written; --keep-invalid writes the mesh all the same", message));
}

}  // namespace collarmesh::command
