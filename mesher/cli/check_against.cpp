#include "check_against.h"

#include <fmt/format.h>

#include <utility>

namespace collarmesh::cli {

CheckReport check_against(const TetMesh& mesh, ComplexInput& input, ComplexArguments how,
                          const CheckOptions& options, const Execution& execution) {
  CheckReport report = check(mesh, input.build(how), options, execution);
  std::vector<std::string> repairs = describe(input.repaired());
  if (!report.passed()) {
    const std::optional<Plc> next = input.build_next(how);
    if (next) {
      CheckReport against_next = check(mesh, *next, options, execution);
      if (against_next.passed()) {
        report = std::move(against_next);
        repairs = describe(input.repaired());
        report.notes.push_back(input.repaired().wrapped
                                   ? "the mesh is one of a surface around everything"
                                   : fmt::format("the mesh is one of a repair with --repair-tolerance {:.3g}",
                                                 how.repair.tolerance));
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
