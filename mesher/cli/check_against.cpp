#include "check_against.h"

#include <fmt/format.h>

#include <utility>

namespace collarmesh::cli {

CheckReport check_against(const TetMesh& mesh, ComplexInput& input, ComplexArguments how,
                          const CheckOptions& options, const Execution& execution) {
  CheckReport report = check(mesh, input.build(how), options, execution);
  std::vector<std::string> repairs = describe(input.repaired());
  if (!report.passed()) {
    const std::optional<Plc> coarser = input.build_coarser(how);
    if (coarser) {
      CheckReport against_coarser = check(mesh, *coarser, options, execution);
      if (against_coarser.passed()) {
        report = std::move(against_coarser);
        repairs = describe(input.repaired());
        report.notes.push_back(
            fmt::format("the mesh is one of a repair with --repair-tolerance {:.3g}", how.repair.tolerance));
      }
    }
  }
  if (!repairs.empty())
    report.notes.emplace_back(
        "the mesh was judged against the repaired complex, and that against the input:");
  for (const std::string& repair : repairs) report.notes.push_back("the input was repaired: " + repair);
  return report;
}

}  // namespace collarmesh::cli
