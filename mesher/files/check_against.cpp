#include "files/check_against.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "check/periodic.h"
#include "collarmesh/error.h"
#include "collarmesh/shells.h"

namespace collarmesh::files {

namespace {

/// Returns a note if a mesh is much larger or smaller than the input that it is checked against.
std::string note_on_scale(const TetMesh& mesh, const Plc& plc, double scale) {
  Box box;
  for (const Point& p : mesh.points) box.add(p);
  const double ratio = box.diagonal() / plc.bounds.diagonal();
  if (!(ratio > 0) || (ratio > 0.5 && ratio < 2)) return {};
  return fmt::format(
      "the mesh is {:.3g} times as large as the input; if it was written in another unit, give check the "
      "--scale of that run, probably {:.3g}",
      ratio, scale * ratio);
}

/// Builds the complex of the input that `mesh_shells` would mesh.
Plc build_surfaces(ComplexInput& input, const RunOptions& o, const RepairOptions& repair) {
  PlcOptions any = o.complex;
  any.require_solid = false;
  return build_shell_complex(
             [&](const RepairOptions& each) {
               return RepairedPlc{input.build(any, each), input.repaired(), {}};
             },
             repair)
      .plc;
}

CheckReport check_as_built(const TetMesh& mesh, ComplexInput& input, const RunOptions& o,
                           const RepairOptions& repair, const Execution& execution) {
  const bool solid = !mesh.is_surface() && !mesh.is_curves();
  if (!o.faces.empty() && !mesh.is_surface())
    throw OptionError("faces are for meshes of triangles alone; leave them out");
  const Plc plc = solid ? input.build(o.complex, repair) : build_surfaces(input, o, repair);
  const CheckOptions options{.bounds = o.mesh.bounds,
                             .exact = input.exact_measures(plc),
                             .findings_per_guarantee = o.findings,
                             .threads = o.mesh.threads};
  CheckReport report = solid              ? check(mesh, plc, options, execution)
                       : mesh.is_curves() ? check_lines(mesh, plc, options)
                       : o.faces.empty()  ? check_shells(mesh, plc, options, execution)
                                          : check_faces(mesh, plc, o.faces, options, execution);
  checks::check_periodic(mesh, report);
  if (const std::string note = note_on_scale(mesh, plc, o.scale); !report.passed() && !note.empty())
    report.notes.push_back(note);
  return report;
}

/// Checks the mesh against complexes that stronger repairs of the input make. Replaces `report` and `repair`
/// by those of the first complex against which the mesh passes; leaves them as they are if there is none.
void check_against_further(const TetMesh& mesh, ComplexInput& input, const RunOptions& options,
                           const Execution& execution, CheckReport& report, RepairReport& repair) {
  std::vector<RepairOptions> all = further_repairs(options.repair, repair);
  all.insert(all.begin(), options.repair);
  constexpr double size = 1, diagonal = 20;  // any lengths in the ratio of the default size to the diagonal
  for (const RepairOptions& coarser : coarser_repairs(options.repair, size, diagonal)) all.push_back(coarser);
  for (RepairOptions& each : all)
    if (!each.wrap_at_once) each.target_size = options.mesh.size;  // collapses features, as `mesh` does
  for (const RepairOptions& further : all) {
    try {
      CheckReport other = check_as_built(mesh, input, options, further, execution);
      if (other.cancelled || !other.passed()) continue;
      report = std::move(other);
    } catch (const PlcError&) {
      continue;
    } catch (const OptionError&) {  // a surface around everything may lack named features
      continue;
    }
    repair = input.repaired();
    report.notes.push_back(
        !repair.small_features.empty() && further.tolerance == options.repair.tolerance
            ? "features smaller than the feature size are collapsed in the mesh"
        : repair.wrapped ? "the mesh was made from a wrap (a closed surface around the input)"
                         : fmt::format("the mesh was made after a repair with --repair-tolerance {:.3g}",
                                       further.tolerance));
    return;
  }
}

}  // namespace

CheckReport check_against(const TetMesh& mesh, ComplexInput& input, const RunOptions& options,
                          const Execution& execution) {
  CheckReport report = check_as_built(mesh, input, options, options.repair, execution);
  RepairReport repair = input.repaired();
  if (!report.passed() && !report.cancelled)
    check_against_further(mesh, input, options, execution, report, repair);
  if (repair.repaired)
    report.notes.emplace_back(
        "the mesh was judged against the repaired complex, and the repaired complex against the input:");
  for (const std::string& line : describe(repair)) report.notes.push_back("the input was repaired: " + line);
  return report;
}

}  // namespace collarmesh::files
