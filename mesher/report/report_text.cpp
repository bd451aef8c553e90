#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "report/conversion_report.h"
#include "report/layer_counts.h"
#include "report/layers_report.h"
#include "report/listed.h"
#include "report/mesh_groups.h"
#include "report/periodic_report.h"
#include "report/report.h"
#include "report/split_report.h"

namespace collarmesh::report {

namespace {

using Out = std::back_insert_iterator<std::string>;

std::string in_brackets(const std::string& name) { return name.empty() ? name : fmt::format(" ({})", name); }

void append_regions(std::string& text, const Plc& plc, GroupNames names) {
  for (std::size_t r = 1; r < std::min(plc.regions.size(), listed + 1); ++r)
    fmt::format_to(Out(text), "  region {}{}: tag {}, volume {:.10g}{}\n", r,
                   in_brackets(name_of(plc.names, names, 3, plc.regions[r].tag)), plc.regions[r].tag,
                   plc.regions[r].volume, in_brackets(plc.regions[r].name));
  if (plc.regions.size() > listed + 1)
    fmt::format_to(Out(text), "  ... and {} more regions\n", plc.regions.size() - listed - 1);
}

void append_creases(std::string& text, const Plc& plc, const std::vector<Crease>& creases) {
  if (creases.empty()) {
    text += "  no creases\n";
    return;
  }
  fmt::format_to(Out(text), "  {} crease{}:\n", creases.size(), creases.size() == 1 ? "" : "s");
  for (std::size_t k = 0; k < std::min(creases.size(), listed); ++k)
    fmt::format_to(Out(text), "    {}\n", describe(plc, creases[k]));
  if (creases.size() > listed) fmt::format_to(Out(text), "    ... and {} more\n", creases.size() - listed);
}

/// Describes the shapes of tets outside collars. A radius-edge ratio of 0 means that all these tets are thin.
std::string shape_text(double min_dihedral, double max_dihedral, double max_radius_edge) {
  if (max_dihedral == 0) return "all tets in collars";
  return fmt::format("dihedral angles from {:.2f} to {:.2f} degrees, {}", min_dihedral, max_dihedral,
                     max_radius_edge > 0 ? fmt::format("radius-edge at most {:.4g}", max_radius_edge)
                                         : std::string("all tets thin or in collars"));
}

std::string times_text(const StageTimes& times) {
  std::string text;
  for (const auto& [stage, seconds] : times.stages())
    fmt::format_to(Out(text), "{}{} {:.2f}", text.empty() ? "" : ", ", stage, seconds);
  return text;
}

/// Returns the part of the report about changes that may exceed the tolerance, such as filled holes, removed
/// parts, and a surface around everything.
RepairReport beyond_tolerance(const RepairReport& report) {
  RepairReport rest;
  rest.turned = report.turned;
  rest.flakes = report.flakes;
  rest.second_sides = report.second_sides;
  rest.merged = report.merged;
  rest.vanished = report.vanished;
  rest.united = report.united;
  rest.filled = report.filled;
  rest.lost_tags = report.lost_tags;
  rest.wrapped = report.wrapped;
  rest.largest_distance = report.largest_distance;
  rest.largest_distance_of_input = report.largest_distance_of_input;
  rest.farthest_of_input = report.farthest_of_input;
  rest.tolerance = report.tolerance;
  rest.repaired = std::max(report.largest_distance, report.largest_distance_of_input) > report.tolerance;
  return rest;
}

/// Appends the patches with their numbers, which options for sizes take and mesh files contain.
void append_patches(std::string& text, const Plc& plc, GroupNames names) {
  const std::vector<PatchSummary> patches = summarize_patches(plc);
  for (std::size_t k = 0; k < std::min(patches.size(), listed); ++k) {
    const PatchSummary& p = patches[k];
    fmt::format_to(Out(text), "  patch {}{}: {}, area {:.6g}, at ({:.6g}, {:.6g}, {:.6g})\n", p.tag,
                   in_brackets(name_of(plc.names, names, 2, p.tag)), p.planar ? "planar" : "smooth", p.area,
                   p.where.x, p.where.y, p.where.z);
  }
  if (patches.size() > listed)
    fmt::format_to(Out(text), "  ... and {} more patches (--json lists all)\n", patches.size() - listed);
}

void append_curves(std::string& text, const Plc& plc, GroupNames names) {
  const std::vector<CurveSummary> curves = summarize_curves(plc);
  for (std::size_t k = 0; k < std::min(curves.size(), listed); ++k) {
    const CurveSummary& c = curves[k];
    fmt::format_to(Out(text), "  curve {}{}: {}, length {:.6g}, at ({:.6g}, {:.6g}, {:.6g})\n", c.tag,
                   in_brackets(name_of(plc.names, names, 1, c.tag)), c.straight ? "straight" : "smooth",
                   c.length, c.where.x, c.where.y, c.where.z);
  }
  if (curves.size() > listed)
    fmt::format_to(Out(text), "  ... and {} more curves (--json lists all)\n", curves.size() - listed);
}

/// Returns a predicted count as text: all its digits below 10^12, three digits for larger counts.
std::string count_text(double count) {
  return count < 1e12 ? fmt::format("{:.0f}", count) : fmt::format("{:.3g}", count);
}

/// Describes the difference of a region's volume from that in the input; empty if the volumes are unknown.
std::string off_text(const CheckReport& r, std::size_t region) {
  if (region >= std::min(r.of_input.volumes.size(), r.of_mesh.volumes.size())) return {};
  const double input = r.of_input.volumes[region];
  return fmt::format(", {:+.2f} % of the input's {:.10g}", percent_off(r.of_mesh.volumes[region], input),
                     input);
}

}  // namespace

std::string warnings_text(const Plc& plc) {
  std::string text;
  for (std::size_t k = 0; k < std::min(plc.warnings.size(), listed); ++k)
    fmt::format_to(Out(text), "warning: {}\n", plc.warnings[k].message);
  if (plc.warnings.size() > listed)
    fmt::format_to(Out(text), "... and {} more warnings\n", plc.warnings.size() - listed);
  return text;
}

std::string repair_text(const RepairReport& report, bool quiet) {
  const std::vector<std::string> lines = describe(quiet ? beyond_tolerance(report) : report);
  std::string text;
  for (std::size_t k = 0; k < std::min(lines.size(), listed); ++k)
    fmt::format_to(Out(text), "repaired: {}\n", lines[k]);
  if (lines.size() > listed) fmt::format_to(Out(text), "... and {} more repairs\n", lines.size() - listed);
  return text;
}

std::string complex_text(const Plc& plc, const PlcSummary& s, GroupNames names) {
  std::string text;
  fmt::format_to(Out(text),
                 "complex: {} vertices, {} curves ({} straight), {} patches ({} planar), {} region{}\n",
                 s.vertices, s.curves, s.straight_curves, s.patches, s.planar_patches, s.regions,
                 s.regions == 1 ? "" : "s");
  fmt::format_to(Out(text), "  made of {} points and {} triangles; diagonal {:.6g}\n", s.points, s.triangles,
                 s.diagonal);
  fmt::format_to(Out(text), "  from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n", plc.bounds.min.x,
                 plc.bounds.min.y, plc.bounds.min.z, plc.bounds.max.x, plc.bounds.max.y, plc.bounds.max.z);
  fmt::format_to(Out(text), "  smallest angle {:.4g} degrees, shortest segment {:.4g}, spread {:.4g}\n",
                 s.smallest_angle, s.shortest_segment, s.spread);
  fmt::format_to(Out(text), "  merging moved the input by at most {:.3g}\n", s.largest_deviation);
  append_regions(text, plc, names);
  append_patches(text, plc, names);
  append_curves(text, plc, names);
  append_creases(text, plc, s.creases);
  return text;
}

std::string predictions_text(const std::vector<Prediction>& predictions) {
  if (predictions.empty()) return {};
  std::string text = fmt::format("estimates:\n  {:>10}  {:>12}  {:>8}\n", "size", "tets", "seconds");
  for (const Prediction& p : predictions)
    fmt::format_to(Out(text), "  {:>10.4g}  {:>12}  {:>8.2g}\n", p.size, count_text(p.tets), p.seconds);
  return text;
}

std::string partitions_text(const PartitionMeasures& m) {
  if (m.partitions == 0) return {};
  return fmt::format("  {} partition{}: {} to {} tets (largest {:.2f} % above the mean), {} faces cut\n",
                     m.partitions, m.partitions == 1 ? "" : "s", m.smallest, m.largest, 100 * m.imbalance,
                     m.cut_faces);
}

std::string forced_text(const CheckReport& r) {
  if (r.forced_tets == 0) return {};
  return fmt::format(
      "narrow places: {} tet{} with angles down to {:.2f} degrees, because the input forces edges to be "
      "short there\n",
      r.forced_tets, r.forced_tets == 1 ? "" : "s", r.min_forced_dihedral);
}

namespace {

std::string angles_text(const TriangleMeasures& m) {
  return fmt::format("angles from {:.2f} to {:.2f} degrees{}", m.min_angle, m.max_angle,
                     m.at_sharp_corners > 0
                         ? fmt::format(", {} triangle{} out of bounds at sharp corners of the input",
                                       m.at_sharp_corners, m.at_sharp_corners == 1 ? "" : "s")
                         : "");
}

/// Describes a mesh of triangles.
std::string surface_text(const TetMesh& mesh, const CheckReport* judged) {
  std::string text = fmt::format("{} triangles, {} points, {} curve edges\n", mesh.faces.size(),
                                 mesh.points.size(), mesh.edges.size());
  if (judged != nullptr && judged->triangles)
    fmt::format_to(Out(text), "  {}\n", angles_text(*judged->triangles));
  return text;
}

}  // namespace

std::string mesh_text(const TetMesh& mesh, const MeshMeasures& m, const CheckReport* judged) {
  if (mesh.is_surface()) return surface_text(mesh, judged);
  if (mesh.is_curves())
    return fmt::format("{} lines on curves, {} points\n", mesh.edges.size(), mesh.points.size());
  std::string text;
  const LayerCells& layers = mesh.layers;
  fmt::format_to(Out(text), "{} tets, {}{} points, {} boundary and interface triangles, {}{} curve edges\n",
                 mesh.tets.size(), layers_text(layers.prisms.size(), layers.pyramids.size()),
                 mesh.points.size(), mesh.faces.size(), quads_text(layers.quads.size()), mesh.edges.size());
  const char* const ratio = m.max_radius_edge > 0 ? "" : "radius-edge ";
  fmt::format_to(
      Out(text), "  {}{}{}\n", shape_text(m.min_dihedral, m.max_dihedral, m.max_radius_edge),
      m.max_thin_radius_edge > 0 ? fmt::format(" ({}of thin tets {:.4g})", ratio, m.max_thin_radius_edge)
                                 : "",
      m.max_collar_radius_edge > 0 ? fmt::format(" ({}in collars {:.4g})", ratio, m.max_collar_radius_edge)
                                   : "");
  if (judged != nullptr && judged->forced_tets > 0) text += "  " + forced_text(*judged);
  std::map<Index, std::string> names = names_of_regions(mesh);
  std::size_t line = 0;
  for (const auto& [region, volume] : m.region_volumes) {
    if (++line > listed) break;
    fmt::format_to(Out(text), "  region {}{}: volume {:.10g}{}\n", region, in_brackets(names[region]), volume,
                   judged != nullptr ? off_text(*judged, region) : "");
  }
  return text + partitions_text(measure_partitions(mesh));
}

std::string findings_text(const CheckReport& r, std::size_t most) {
  std::string text;
  const std::size_t count = std::min(most, r.findings.size());
  for (std::size_t k = 0; k < count; ++k)
    fmt::format_to(Out(text), "missed: {}: {}\n", r.findings[k].guarantee, r.findings[k].message);
  if (r.findings_total > count)
    fmt::format_to(Out(text), "... and {} more findings\n", r.findings_total - count);
  return text;
}

std::string check_text(const CheckReport& r) {
  std::string text = findings_text(r, r.findings.size());
  for (const std::string& note : r.notes) fmt::format_to(Out(text), "note: {}\n", note);
  for (const std::string& warning : r.warnings) fmt::format_to(Out(text), "warning: {}\n", warning);
  if (r.triangles)
    fmt::format_to(Out(text), "{} triangles, {} points, {} edges; {}\n", r.faces, r.points, r.edges,
                   angles_text(*r.triangles));
  else if (r.tets == 0 && r.faces == 0)
    fmt::format_to(Out(text), "{} lines on curves, {} points\n", r.edges, r.points);
  else
    fmt::format_to(Out(text), "{} tets, {} points, {} faces, {} edges; {}\n", r.tets, r.points, r.faces,
                   r.edges, shape_text(r.min_dihedral, r.max_dihedral, r.max_radius_edge));
  if (r.thin_tets > 0)
    fmt::format_to(Out(text), "thin: {} tets, radius-edge up to {:.4g}\n", r.thin_tets,
                   r.max_thin_radius_edge);
  text += forced_text(r);
  if (r.collar_tets > 0)
    fmt::format_to(Out(text), "in collars: {} tets, dihedral angles from {:.2f} to {:.2f} degrees\n",
                   r.collar_tets, r.min_collar_dihedral, r.max_collar_dihedral);
  fmt::format_to(Out(text), "surface distance at most {:.3g}, median edge {:.6g}\n", r.max_surface_distance,
                 r.median_edge);
  for (std::size_t k = 1; k < std::min(r.region_volumes.size(), listed + 1); ++k)
    fmt::format_to(Out(text), "region {}: volume {:.10g}{}\n", k, r.region_volumes[k], off_text(r, k));
  text += r.passed() ? "every guarantee holds\n" : fmt::format("{} findings\n", r.findings_total);
  return text;
}

std::string projection_text(const Plc& plc, const ProjectReport& r, const char* onto) {
  std::string text;
  fmt::format_to(Out(text), "  {} boundary vertices moved onto the {}, by at most {:.3g}", r.vertices, onto,
                 r.largest_move);
  if (r.exceptions.empty()) return text + "\n";
  fmt::format_to(Out(text), "; {} stay off it, by at most {:.3g}:\n", r.exceptions.size(),
                 r.largest_distance);
  for (std::size_t k = 0; k < std::min(listed, r.exceptions.size()); ++k) {
    const ProjectReport::Exception& e = r.exceptions[k];
    fmt::format_to(Out(text), "    {}{} at ({:.6g}, {:.6g}, {:.6g}) by {:.3g}\n",
                   e.dimension == 1 ? "Edge" : "Face",
                   e.dimension == 1 ? plc.curves[e.feature].tag : plc.patches[e.feature].tag, e.where.x,
                   e.where.y, e.where.z, e.distance);
  }
  if (r.exceptions.size() > listed) text += "    ...\n";
  return text;
}

std::string straightened_text(const SecondOrderReport& r, std::size_t most) {
  std::string text;
  const std::size_t count = std::min(most, r.straightened.size());
  for (std::size_t k = 0; k < count; ++k) {
    const auto& s = r.straightened[k];
    fmt::format_to(
        Out(text),
        "straightened: the mid-edge node {} between points {} and {} at ({:.9g}, {:.9g}, {:.9g}) belongs to "
        "the smooth {} with tag {}, but stays {:.3g} away from this feature, because a tet would otherwise "
        "be inverted or nearly so; choose a smaller size there or --elements-per-circle\n",
        s.point, s.edge[0], s.edge[1], s.where.x, s.where.y, s.where.z,
        s.feature.dimension == 1 ? "curve" : "patch", s.tag, s.distance);
  }
  if (r.straightened.size() > count)
    fmt::format_to(Out(text), "... and {} more straightened nodes\n", r.straightened.size() - count);
  return text;
}

std::string run_text(const RequestedRun& arguments, const MeshRun& run) {
  std::string text = arguments.verbose ? complex_text(run.plc, run.summary, run.result.mesh.group_names) : "";
  text += fmt::format("{}: ", arguments.output == "-" ? "standard output" : arguments.output) +
          mesh_text(run.result.mesh, run.check.measures, &run.check);
  fmt::format_to(Out(text), "  median edge {:.4g}, surface distance at most {:.3g}\n", run.check.median_edge,
                 run.check.max_surface_distance);
  if (const auto& r = run.remeshing)
    fmt::format_to(
        Out(text),
        "  before: {} tets, dihedral angles from {:.1f} to {:.1f}; {} edges divided, {} collapsed\n",
        r->tets_before, r->smallest_angle_before, r->largest_angle_before, r->divided_edges,
        r->contracted_edges);
  text += cleanup_text(run.plc.cleanup);
  const MeshStatistics& s = run.result.statistics;
  if (arguments.verbose)
    fmt::format_to(Out(text),
                   "  {} vertices inserted ({} in blocks), {} cells, {} exact predicates, {} candidates "
                   "replaced by points of the input, {} by points on encroached features, {:.1f} MB\n",
                   s.vertices_inserted, s.vertices_in_blocks, s.cells, s.exact_predicates, s.warps, s.yields,
                   static_cast<double>(s.peak_bytes) / 1e6);
  for (const std::string& note : run.notes) fmt::format_to(Out(text), "  {}\n", note);
  const bool smooth = run.remeshing && run.remeshing->smooth_surface;
  if (run.projection)
    text += projection_text(run.plc, *run.projection, smooth ? "smooth surface" : "exact shape");
  if (run.coarsening && arguments.verbose)
    fmt::format_to(Out(text), "  {} tets coarsened to {}: {} edges collapsed, {} of them with repair\n",
                   run.coarsening->tets_before, run.coarsening->tets_after, run.coarsening->contracted_edges,
                   run.coarsening->repaired);
  const ImproveReport& i = run.improvement;
  if (arguments.verbose && i.candidates > 0)
    fmt::format_to(Out(text),
                   "  {} of {} poor tets improved: {} edges removed, {} boundary flips, {} vertices moved, "
                   "{} edges collapsed, {} vertices inserted; {} sequences of several operations\n",
                   i.candidates - std::min(i.remaining, i.candidates), i.candidates, i.edge_removals,
                   i.boundary_flips, i.moved_vertices, i.contracted_edges, i.inserted_vertices, i.detours);
  if (arguments.order == 2)
    fmt::format_to(Out(text),
                   "  second order: {} mid-edge nodes, {} of them on smooth features, {} inside moved, {} "
                   "straightened\n",
                   run.second_order.nodes, run.second_order.curved, run.second_order.moved_inside,
                   run.second_order.straightened.size());
  if (run.interior_nodes)
    fmt::format_to(
        Out(text),
        "  {} tets had all corners on surfaces: {} nodes inserted, {} edges removed; {} such tets remain\n",
        run.interior_nodes->found, run.interior_nodes->inserted_nodes, run.interior_nodes->removed_edges,
        run.interior_nodes->remaining);
  if (run.periodic) text += periodic_text(*run.periodic);
  if (run.layers) text += layers_text(*run.layers);
  if (run.split) text += split_text(*run.split);
  if (run.guarantees_hold()) text += "  every guarantee holds\n";
  fmt::format_to(Out(text), "  {:.2f} s ({})\n", run.times.total(), times_text(run.times));
  return text;
}

}  // namespace collarmesh::report
