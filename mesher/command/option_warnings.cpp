#include "command/option_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "io/file_format.h"
#include "report/conversion_report.h"

namespace collarmesh::command {

namespace {

// The lowest bound on the radius-edge ratio for which termination is proved in the plane (doc/theory.md). On
// test shapes refinement also ended with lower bounds, down to 1.1, but never with 1 (doc/limits.md).
constexpr double proved_radius_edge = std::numbers::sqrt2;
// The lowest bounds on collar angles, in degrees, that meshes of test shapes kept: without coarsening
// (doc/architecture/collars.md), and after it (doc/architecture/coarsening.md).
constexpr double reached_collar_angle = 130, reached_coarsened = 120;
// Distances below or tolerances above these, relative to the diagonal, get a warning.
constexpr double small_distance = 1e-5, large_planar_tolerance = 1e-3;

bool is_smooth_anywhere(const Plc& plc) {
  return std::any_of(plc.patches.begin(), plc.patches.end(),
                     [](const auto& patch) { return !patch.planar; }) ||
         std::any_of(plc.curves.begin(), plc.curves.end(), [](const auto& curve) { return !curve.straight; });
}

}  // namespace

std::vector<std::string> option_warnings(const MeshArguments& a, const Plc& plc) {
  std::vector<std::string> warnings = sizes_without_effect(plc, a.mesh);
  const double diagonal = plc.bounds.diagonal();
  if (a.mesh.bounds.radius_edge < proved_radius_edge)
    warnings.push_back(
        fmt::format("--radius-edge {}: below sqrt 2 = 1.414 refinement may not terminate; set a budget with "
                    "--max-vertices or --time-limit.",
                    a.mesh.bounds.radius_edge));
  if (a.improve == 0 && a.min_dihedral > 0)
    warnings.push_back(fmt::format(
        "--min-dihedral {}: no effect, because --improve 0 improves nothing; leave --improve 0 out.",
        a.min_dihedral));
  if (a.mesh.bounds.collar_angle < (a.coarsen ? reached_coarsened : reached_collar_angle) &&
      !find_creases(plc, a.mesh.bounds.crease_angle).empty())
    warnings.push_back(
        a.coarsen ? fmt::format("--collar-angle {}: collars may miss bounds below 120 degrees; the "
                                "certificate then names the tetrahedra, and the exit code is 7.",
                                a.mesh.bounds.collar_angle)
                  : fmt::format(
                        "--collar-angle {}: with --coarsen off, collars may miss bounds below 130 degrees, "
                        "and refinement may not terminate; set a budget with --max-vertices or --time-limit.",
                        a.mesh.bounds.collar_angle));
  if (a.coarsen && a.mesh.vertex_ratio > 0)
    warnings.push_back(
        fmt::format("--vertex-ratio {}: a coarsened mesh may exceed this bound; with --coarsen off "
                    "only improvement may exceed it.",
                    a.mesh.vertex_ratio));
  if (a.mesh.bounds.distance > 0 && a.mesh.bounds.distance < small_distance * diagonal &&
      is_smooth_anywhere(plc))
    warnings.push_back(
        fmt::format("--distance {:.6g} is {:.2g} of the diagonal: so small a distance takes many elements "
                    "on smooth faces and curves; choose a larger one, or --feature-angle 0, which keeps "
                    "the facets as they are.",
                    a.mesh.bounds.distance, a.mesh.bounds.distance / diagonal));
  if (a.complex.planar_tolerance > large_planar_tolerance)
    warnings.push_back(fmt::format(
        "--planar-tolerance {}: facets were merged into planar patches up to {:.6g} away from them, and the "
        "mesh follows these patches; without this option, curved faces stay curved.",
        a.complex.planar_tolerance, plc.largest_deviation));
  if (!(a.names.empty() && a.given_names.empty()) &&
      !report::keeps_names(io::format_of(a.output, a.output_format)))
    warnings.push_back(fmt::format("{}: {} has no place for names; numbers are kept.",
                                   a.names.empty() ? "--name" : "--names",
                                   io::format_of(a.output, a.output_format)));
  return warnings;
}

}  // namespace collarmesh::command
