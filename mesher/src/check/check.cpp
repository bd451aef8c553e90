// The certificate: each guarantee recomputed from the mesh and the complex alone.
#include "collarmesh/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "check/labelled.h"
#include "check/layer_cells.h"
#include "check/mesh_to_check.h"
#include "collarmesh/error.h"
#include "collarmesh/mesher.h"
#include "common/layer_tets.h"
#include "common/parallel_for.h"
#include "common/thread_limit.h"

namespace collarmesh {

namespace {

using namespace checks;

Box bounds_of(const Plc& plc) {
  if (!plc.bounds.empty()) return plc.bounds;
  Box box;
  for (const Point& p : plc.points) box.add(p);
  return box;
}

double largest_coordinate(const Box& box) {
  double largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::fabs(box.min[axis]), std::fabs(box.max[axis])});
  return largest;
}

}  // namespace

MeshToCheck checks::make_mesh_to_check(const TetMesh& mesh, const Plc& plc, const CheckOptions& options) {
  constexpr double epsilon = 0x1p-52;
  const Box box = bounds_of(plc);
  MeshToCheck to_check{mesh,
                       plc,
                       options,
                       tolerance_of_any_size(plc, options.bounds),
                       1e-12 * box.diagonal() + 8 * epsilon * largest_coordinate(box),
                       {},
                       {},
                       std::make_shared<RegionLocator>(plc),
                       {},
                       {},
                       false,
                       none};
  to_check.curve_allowance = curve_allowances(to_check);
  to_check.patch_allowance = patch_allowances(to_check);
  return to_check;
}

namespace {

void take_measures(CheckReport& report, CheckReport&& part) {
  report.collar_tets += part.collar_tets;
  report.thin_tets += part.thin_tets;
  report.forced_tets += part.forced_tets;
  report.min_forced_dihedral = std::min(report.min_forced_dihedral, part.min_forced_dihedral);
  report.max_thin_radius_edge = std::max(report.max_thin_radius_edge, part.max_thin_radius_edge);
  report.max_radius_edge = std::max(report.max_radius_edge, part.max_radius_edge);
  report.min_dihedral = std::min(report.min_dihedral, part.min_dihedral);
  report.max_dihedral = std::max(report.max_dihedral, part.max_dihedral);
  report.max_collar_dihedral = std::max(report.max_collar_dihedral, part.max_collar_dihedral);
  report.min_collar_dihedral = std::min(report.min_collar_dihedral, part.min_collar_dihedral);
  report.max_surface_distance = std::max(report.max_surface_distance, part.max_surface_distance);
  report.surface_tets += part.surface_tets;
  report.median_edge = std::max(report.median_edge, part.median_edge);
  report.warnings.insert(report.warnings.end(), part.warnings.begin(), part.warnings.end());
  if (part.region_volumes.empty()) return;
  report.region_volumes = std::move(part.region_volumes);
  report.of_input = std::move(part.of_input);
  report.of_mesh = std::move(part.of_mesh);
  report.measures = std::move(part.measures);
}

// Checks independent groups of guarantees in parallel, each with its own report.
void judge(MeshToCheck& to_check, CheckReport& report, Findings& findings, const Execution& execution) {
  report.faces = to_check.mesh.faces.size();
  report.edges = to_check.mesh.edges.size();
  to_check.match = match_features(to_check.mesh, to_check.plc, to_check.rounding);
  find_collar_cells(to_check, findings);
  using Group = void (*)(const MeshToCheck&, CheckReport&, Findings&);
  const std::array<Group, 8> groups{
      [](const MeshToCheck& s, CheckReport& r, Findings& f) {
        check_tets(s, r, f);
        check_interior_nodes(s, r, f);
        check_region_volumes(s, r, f);
        check_shape_kept(s, r, f);
      },
      check_conformity,
      [](const MeshToCheck& s, CheckReport& r, Findings& f) {
        warn_of_features_outside(s, r);
        check_watertight(s, f);
        check_vertices(s, f);
        check_listed_edges(s, f);
      },
      check_curves,
      check_thickness_kept,
      check_patches,
      [](const MeshToCheck& s, CheckReport&, Findings& f) { check_collars(s, f); },
      check_second_order};
  std::array<CheckReport, groups.size()> parts;
  parallel_for(groups.size(), [&](std::size_t i) {
    if (execution.cancelled()) return;
    Findings own(parts[i], to_check.options.findings_per_guarantee);
    groups[i](to_check, parts[i], own);
  });
  for (CheckReport& part : parts) {
    findings.take(part);
    take_measures(report, std::move(part));
  }
  report.cancelled = execution.cancelled();
}

bool has_layers(const TetMesh& mesh) { return !mesh.layers.empty() || !mesh.layers.quads.empty(); }

void count_cells(const TetMesh& mesh, CheckReport& report) {
  report.tets = mesh.tets.size();
  report.points = mesh.points.size();
  report.faces = mesh.faces.size();
  report.edges = mesh.edges.size();
}

void note_layers(const TetMesh& mesh, CheckReport& report) {
  const LayerCells& layers = mesh.layers;
  report.notes.push_back(
      fmt::format("the mesh has {} prisms, {} pyramids and {} quadrangles, which have positive Jacobians and "
                  "conform; the other guarantees were judged with these cut into tets and triangles",
                  layers.prisms.size(), layers.pyramids.size(), layers.quads.size()));
}

/// Judges the angles of the tets outside layers. `to_check`: the mesh with its layers cut into tets.
void check_core(const TetMesh& mesh, const MeshToCheck& to_check, CheckReport& report) {
  TetMesh labelled = mesh;
  labelled.features = features_of(to_check);
  labelled.features.resize(mesh.points.size());
  labelled.face_patch.assign(
      to_check.match.face_patch.begin(),
      to_check.match.face_patch.begin() + static_cast<std::ptrdiff_t>(mesh.faces.size()));
  Bounds bounds = to_check.options.bounds;
  if (bounds.thin_angle == 0) bounds.thin_angle = least_core_angle;
  check_core_angles(labelled, walls_below(mesh), to_check.plc, bounds, report);
}

/// Judges a mesh of tets. `with_layers`: null, or the mesh whose layers were cut into tets to make `mesh`.
void check_tet_mesh(const TetMesh& mesh, const TetMesh* with_layers, const Plc& plc,
                    const CheckOptions& options, const Execution& execution, CheckReport& report,
                    Findings& findings) {
  MeshToCheck given = make_mesh_to_check(mesh, plc, options);
  if (!check_points(given, findings)) return;
  const std::size_t before = findings.total();
  const std::optional<TetMesh> placed = place_by_position(given, report, findings);
  if (findings.total() > before || !check_labels(placed ? *placed : mesh, plc, findings)) return;
  MeshToCheck to_check = placed ? make_mesh_to_check(*placed, plc, options) : std::move(given);
  if (with_layers != nullptr) to_check.first_part = static_cast<Index>(with_layers->tets.size());
  judge(to_check, report, findings, execution);
  if (with_layers != nullptr && !report.cancelled) check_core(*with_layers, to_check, report);
}

[[noreturn]] void refuse_mesh(const Finding& finding) {
  const std::string message = fmt::format(
      "The mesh does not cover the shape that it should follow: {} Name the input that the mesh was made "
      "from, or adapt the mesh without an input.",
      finding.message);
  throw PlcError(message, {{PlcFault::Kind::intersection, message, finding.ids, finding.where}});
}

CheckReport check_by_all_threads(const TetMesh& mesh, const Plc& plc, const CheckOptions& options,
                                 const Execution& execution) {
  CheckReport report;
  Findings findings(report, options.findings_per_guarantee);
  count_cells(mesh, report);
  if (!check_arrays(mesh, findings)) return report;
  if (!has_layers(mesh)) {
    check_tet_mesh(mesh, nullptr, plc, options, execution, report, findings);
    return report;
  }
  check_layer_cells(mesh, report, options.findings_per_guarantee);
  if (report.findings_total > 0) return report;
  check_tet_mesh(tets_of_layers(mesh), &mesh, plc, options, execution, report, findings);
  count_cells(mesh, report);
  note_layers(mesh, report);
  return report;
}

}  // namespace

namespace checks {

TetMesh labelled(const TetMesh& mesh, const Plc& plc, const CheckOptions& options,
                 const Execution& execution) {
  CheckReport report;
  Findings findings(report, 1);
  const auto refuse_if_any = [&] {
    using guarantee::of_shapes;
    for (const Finding& finding : report.findings)
      if (std::find(of_shapes.begin(), of_shapes.end(), finding.guarantee) == of_shapes.end())
        refuse_mesh(finding);
  };
  if (!check_arrays(mesh, findings)) refuse_if_any();
  const MeshToCheck given = make_mesh_to_check(mesh, plc, options);
  if (!check_points(given, findings)) refuse_if_any();
  std::optional<TetMesh> placed = place_by_position(given, report, findings);
  TetMesh result = mesh;
  if (placed) result = std::move(*placed);
  if (!check_labels(result, plc, findings)) refuse_if_any();
  MeshToCheck to_check = make_mesh_to_check(result, plc, options);
  judge(to_check, report, findings, execution);
  refuse_if_any();
  result.features = features_of(to_check);
  result.face_patch = std::move(to_check.match.face_patch);
  result.edge_curve = std::move(to_check.match.edge_curve);
  return result;
}

}  // namespace checks

CheckReport check(const TetMesh& mesh, const Plc& plc, const CheckOptions& options,
                  const Execution& execution) {
  CheckReport report;
  ThreadLimit(options.threads).run([&] { report = check_by_all_threads(mesh, plc, options, execution); });
  return report;
}

}  // namespace collarmesh
