#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/colour_text.h"
#include "report/layers_report.h"
#include "report/mesh_groups.h"
#include "report/options_json.h"
#include "report/periodic_report.h"
#include "report/report.h"
#include "report/split_report.h"

namespace collarmesh::report {

using Json = nlohmann::ordered_json;

namespace {

Json point_json(const Point& p) { return Json::array({p.x, p.y, p.z}); }

/// Returns a number, or null for infinity and NaN, which JSON does not have.
Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Makes an object from distinct keys, without comparing each key with all earlier ones.
template <class Number, class Value>
Json by_number(const std::map<Number, Value>& values) {
  Json::object_t object;
  for (const auto& [number, value] : values) object.emplace_back(std::to_string(number), value);
  return object;
}

const char* kind_name(Crease::Kind kind) {
  switch (kind) {
    case Crease::Kind::facets: return "facets";
    case Crease::Kind::segments: return "segments";
    case Crease::Kind::segment_and_facet: return "segment_and_facet";
    case Crease::Kind::facets_in_vertex: return "facets_in_vertex";
    case Crease::Kind::patch_fold: return "patch_fold";
  }
  return "unknown";
}

const char* status_name(MeshStatus status) {
  switch (status) {
    case MeshStatus::complete: return "complete";
    case MeshStatus::guarantee_missed: return "guarantee_missed";
    case MeshStatus::budget_hit: return "budget_hit";
    case MeshStatus::cancelled: return "cancelled";
  }
  return "unknown";
}

/// Returns the number of places of a change, the size of the change, and some of the places. `size` is the
/// key for the size; null: leave the size out.
Json places_json(const RepairPlaces& places, const char* size) {
  Json where = Json::array();
  for (const Point& p : places.where) where.push_back(point_json(p));
  Json json{{"count", places.count}};
  if (size != nullptr) json[size] = number_json(places.size);
  json["where"] = std::move(where);
  return json;
}

Json filled_json(const std::vector<FilledHole>& holes) {
  Json json = Json::array();
  for (const FilledHole& hole : holes)
    json.push_back({{"tag", hole.tag},
                    {"edges", hole.edges},
                    {"length", hole.length},
                    {"area", hole.area},
                    {"where", point_json(hole.where)}});
  return json;
}

Json counts_json(const WorkCounts& c) {
  return {{"located", c.located},
          {"relocated", c.relocated},
          {"looks", c.looks},
          {"gap_queries", c.gap_queries},
          {"gap_cells", c.gap_cells},
          {"gap_interviews", c.gap_interviews},
          {"largest_degree", c.largest_degree},
          {"largest_cavity", c.largest_cavity},
          {"largest_cavity_outside_hubs", c.largest_cavity_outside_hubs},
          {"peak_cells_per_vertex", c.peak_cells_per_vertex},
          {"before_quality", c.before_quality},
          {"ripped_out", c.ripped_out},
          {"smallest_aspect", c.smallest_aspect},
          {"largest_aspect", c.largest_aspect}};
}

Json statistics_json(const MeshStatistics& s) {
  return {{"vertices_inserted", s.vertices_inserted},
          {"vertices_in_blocks", s.vertices_in_blocks},
          {"cells", s.cells},
          {"exact_predicates", s.exact_predicates},
          {"warps", s.warps},
          {"yields", s.yields},
          {"peak_bytes", s.peak_bytes},
          {"seconds", s.seconds},
          {"counts", counts_json(s.counts)}};
}

Json projection_json(const Plc& plc, const ProjectReport& r) {
  Json exceptions = Json::array();
  for (const ProjectReport::Exception& e : r.exceptions)
    exceptions.push_back({{"point", e.point},
                          {e.dimension == 1 ? "edge" : "face",
                           e.dimension == 1 ? plc.curves[e.feature].tag : plc.patches[e.feature].tag},
                          {"where", point_json(e.where)},
                          {"distance", number_json(e.distance)}});
  return {{"vertices", r.vertices},
          {"largest_move", r.largest_move},
          {"moved_inside", r.moved_inside},
          {"largest_distance", number_json(r.largest_distance)},
          {"exceptions", std::move(exceptions)}};
}

Json interior_json(const InteriorNodesReport& r) {
  return {{"found", r.found},
          {"inserted_nodes", r.inserted_nodes},
          {"removed_edges", r.removed_edges},
          {"remaining", r.remaining}};
}

Json improvement_json(const ImproveReport& r) {
  return {{"candidates", r.candidates},
          {"remaining", r.remaining},
          {"edge_removals", r.edge_removals},
          {"boundary_flips", r.boundary_flips},
          {"moved_vertices", r.moved_vertices},
          {"contracted_edges", r.contracted_edges},
          {"inserted_vertices", r.inserted_vertices},
          {"detours", r.detours},
          {"seconds", r.seconds}};
}

Json coarsening_json(const CoarsenReport& r) {
  return {{"tets_before", r.tets_before},
          {"tets_after", r.tets_after},
          {"contracted_edges", r.contracted_edges},
          {"repaired", r.repaired},
          {"seconds", r.seconds}};
}

Json second_order_json(const SecondOrderReport& r) {
  Json straightened = Json::array();
  for (const auto& s : r.straightened)
    straightened.push_back({{"point", s.point},
                            {"edge", s.edge},
                            {"dimension", s.feature.dimension},
                            {"tag", s.tag},
                            {"where", point_json(s.where)},
                            {"distance", s.distance}});
  return {{"nodes", r.nodes},
          {"curved", r.curved},
          {"more_tets", r.more_tets},
          {"moved_inside", r.moved_inside},
          {"straightened", std::move(straightened)},
          {"seconds", r.seconds}};
}

Json worst_json(const std::vector<WorstTet>& worst) {
  Json list = Json::array();
  for (const WorstTet& w : worst) {
    Json corners = Json::array();
    for (const Point& p : w.corners) corners.push_back(point_json(p));
    list.push_back(
        {{"tet", w.tet}, {"smallest", w.smallest}, {"largest", w.largest}, {"corners", std::move(corners)}});
  }
  return list;
}

/// Returns the measures of the partition; null for a mesh that is not partitioned.
Json partitions_json(const PartitionMeasures& m) {
  if (m.partitions == 0) return nullptr;
  return {{"count", m.partitions},
          {"smallest", m.smallest},
          {"largest", m.largest},
          {"imbalance", m.imbalance},
          {"cut_faces", m.cut_faces}};
}

/// Returns the name of a tag; null if it has none.
Json name_json(const Plc& plc, GroupNames names, std::size_t dimension, Tag tag) {
  const std::string name = name_of(plc.names, names, dimension, tag);
  return name.empty() ? Json(nullptr) : Json(name);
}

/// Returns the colour of a tag; null if the file gave none.
Json colour_json(const std::map<Tag, Colour>& colours, Tag tag) {
  const auto found = colours.find(tag);
  return found == colours.end() ? Json(nullptr) : Json(colour_text(found->second));
}

/// Returns an estimate: rounded to a whole number if it is at most 2^53, because doubles hold all whole
/// numbers up to there; else as a double, or null if it is infinite.
Json whole_json(double value) {
  constexpr double exact = 9007199254740992;  // 2^53
  return std::fabs(value) <= exact ? Json(std::llround(value)) : number_json(value);
}

}  // namespace

Json complex_json(const Plc& plc, const PlcSummary& s, GroupNames names, const TagColours& colours) {
  Json regions = Json::array();
  for (std::size_t r = 1; r < plc.regions.size(); ++r)
    regions.push_back({{"region", r},
                       {"tag", plc.regions[r].tag},
                       {"name", name_json(plc, names, 3, plc.regions[r].tag)},
                       {"input", plc.regions[r].name},
                       {"colour", colour_json(colours.regions, plc.regions[r].tag)},
                       {"volume", plc.regions[r].volume}});
  Json patch_list = Json::array();
  for (const PatchSummary& p : summarize_patches(plc))
    patch_list.push_back({{"tag", p.tag},
                          {"name", name_json(plc, names, 2, p.tag)},
                          {"colour", colour_json(colours.patches, p.tag)},
                          {"patches", p.count},
                          {"planar", p.planar},
                          {"area", p.area},
                          {"where", point_json(p.where)}});
  Json curve_list = Json::array();
  for (const CurveSummary& c : summarize_curves(plc))
    curve_list.push_back({{"tag", c.tag},
                          {"name", name_json(plc, names, 1, c.tag)},
                          {"curves", c.count},
                          {"straight", c.straight},
                          {"length", c.length},
                          {"where", point_json(c.where)}});
  Json creases = Json::array();
  for (const Crease& crease : s.creases)
    creases.push_back({{"kind", kind_name(crease.kind)},
                       {"angle", crease.angle},
                       {"where", point_json(crease.where)},
                       {"message", describe(plc, crease)}});
  Json warnings = Json::array();
  for (const Plc::Warning& warning : plc.warnings)
    warnings.push_back({{"message", warning.message}, {"where", point_json(warning.where)}});
  return {{"points", s.points},
          {"triangles", s.triangles},
          {"vertices", s.vertices},
          {"curves", s.curves},
          {"straight_curves", s.straight_curves},
          {"patches", s.patches},
          {"planar_patches", s.planar_patches},
          {"bounds", Json::array({point_json(plc.bounds.min), point_json(plc.bounds.max)})},
          {"diagonal", s.diagonal},
          {"smallest_angle", s.smallest_angle},
          {"shortest_segment", number_json(s.shortest_segment)},
          {"spread", number_json(s.spread)},
          {"planar_tolerance", plc.planar_tolerance},
          {"largest_deviation", s.largest_deviation},
          {"regions", std::move(regions)},
          {"patch_list", std::move(patch_list)},
          {"curve_list", std::move(curve_list)},
          {"creases", std::move(creases)},
          {"warnings", std::move(warnings)}};
}

Json measures_json(const TetMesh& mesh, const MeshMeasures& m) {
  return {{"points", mesh.points.size()},
          {"tets", mesh.tets.size()},
          {"faces", mesh.faces.size()},
          {"edges", mesh.edges.size()},
          {"prisms", mesh.layers.prisms.size()},
          {"pyramids", mesh.layers.pyramids.size()},
          {"quads", mesh.layers.quads.size()},
          {"min_dihedral", m.min_dihedral},
          {"max_dihedral", m.max_dihedral},
          {"max_radius_edge", number_json(m.max_radius_edge)},
          {"max_thin_radius_edge", number_json(m.max_thin_radius_edge)},
          {"max_collar_radius_edge", number_json(m.max_collar_radius_edge)},
          {"region_volumes", by_number(m.region_volumes)},
          {"region_names", by_number(names_of_regions(mesh))},
          {"partitions", partitions_json(measure_partitions(mesh))},
          {"histograms",
           {{"min_dihedral", {{"bin_width", 10}, {"tets", m.min_dihedrals}}},
            {"max_dihedral", {{"bin_width", 10}, {"tets", m.max_dihedrals}}},
            {"radius_edge", {{"bin_width", 0.25}, {"tets", m.radius_edges}}}}}};
}

/// Returns, for each feature from number `first` on, its number, its measure in the input, its measure in the
/// mesh, and the difference in percent.
Json kept_json(const std::vector<double>& input, const std::vector<double>& mesh, std::size_t first = 0) {
  Json all = Json::array();
  for (std::size_t i = first; i < std::min(input.size(), mesh.size()); ++i)
    all.push_back({{"number", i},
                   {"input", number_json(input[i])},
                   {"mesh", number_json(mesh[i])},
                   {"percent", number_json(percent_off(mesh[i], input[i]))}});
  return all;
}

/// Returns the measures of triangles; null for a mesh of tets.
Json triangles_json(const std::optional<TriangleMeasures>& m) {
  if (!m) return nullptr;
  return {{"triangles", m->triangles},
          {"min_angle", m->min_angle},
          {"max_angle", m->max_angle},
          {"at_sharp_corners", m->at_sharp_corners},
          {"histograms",
           {{"min_angle", {{"bin_width", 10}, {"triangles", m->min_angles}}},
            {"max_angle", {{"bin_width", 10}, {"triangles", m->max_angles}}}}}};
}

Json check_json(const CheckReport& r) {
  Json findings = Json::array();
  for (const Finding& finding : r.findings)
    findings.push_back({{"guarantee", finding.guarantee},
                        {"message", finding.message},
                        {"ids", finding.ids},
                        {"where", point_json(finding.where)}});
  std::map<std::size_t, double> volumes;
  for (std::size_t k = 1; k < r.region_volumes.size(); ++k)
    volumes.emplace_hint(volumes.end(), k, r.region_volumes[k]);
  return {{"passed", r.passed()},
          {"findings_total", r.findings_total},
          {"findings", std::move(findings)},
          {"notes", r.notes},
          {"warnings", r.warnings},
          {"tets", r.tets},
          {"points", r.points},
          {"faces", r.faces},
          {"edges", r.edges},
          {"collar_tets", r.collar_tets},
          {"thin_tets", r.thin_tets},
          {"surface_tets", r.surface_tets},
          {"max_radius_edge", number_json(r.max_radius_edge)},
          {"max_thin_radius_edge", number_json(r.max_thin_radius_edge)},
          {"forced_tets", r.forced_tets},
          {"min_forced_dihedral", r.min_forced_dihedral},
          {"min_dihedral", r.min_dihedral},
          {"max_dihedral", r.max_dihedral},
          {"min_collar_dihedral", r.collar_tets > 0 ? Json(r.min_collar_dihedral) : Json(nullptr)},
          {"max_collar_dihedral", r.max_collar_dihedral},
          {"max_surface_distance", number_json(r.max_surface_distance)},
          {"median_edge", r.median_edge},
          {"triangles", triangles_json(r.triangles)},
          {"region_volumes", by_number(volumes)},
          {"kept",
           {{"region_volumes", kept_json(r.of_input.volumes, r.of_mesh.volumes, 1)},
            {"shell_volumes", kept_json(r.of_input.shells, r.of_mesh.shells)},
            {"patch_areas", kept_json(r.of_input.areas, r.of_mesh.areas)},
            {"curve_lengths", kept_json(r.of_input.lengths, r.of_mesh.lengths)}}}};
}

Json small_features_json(const std::vector<SmallFeature>& features) {
  constexpr std::array kinds{"curve", "patch", "tip"};  // in the order of SmallFeature::Kind
  Json list = Json::array();
  for (const SmallFeature& feature : features)
    list.push_back({{"kind", kinds[static_cast<std::size_t>(feature.kind)]},
                    {"size", feature.size},
                    {"tag", feature.tag},
                    {"where", point_json(feature.where)}});
  return list;
}

Json repair_json(const RepairReport& r) {
  return {{"repaired", r.repaired},
          {"wrapped", r.wrapped},
          {"tolerance", r.tolerance},
          {"largest_distance", number_json(r.largest_distance)},
          {"largest_distance_of_input", number_json(r.largest_distance_of_input)},
          {"split_polygons", r.split_polygons},
          {"dropped_polygons", r.dropped_polygons},
          {"repeated", places_json(r.repeated, nullptr)},
          {"turned", places_json(r.turned, nullptr)},
          {"stitched", places_json(r.stitched, "largest_distance")},
          {"cut", places_json(r.cut, nullptr)},
          {"flakes", places_json(r.flakes, "volume")},
          {"second_sides", r.second_sides},
          {"merged", places_json(r.merged, "area")},
          {"dropped", r.dropped.count},
          {"dropped_share", r.dropped.size},
          {"thin_chambers", places_json(r.thin_chambers, "volume")},
          {"vanished", places_json(r.vanished, "volume")},
          {"united", places_json(r.united, nullptr)},
          {"collapsed", places_json(r.collapsed, "largest_distance")},
          {"kept", places_json(r.kept, nullptr)},
          {"filled", filled_json(r.filled)},
          {"feature_size", r.feature_size},
          {"small_features", small_features_json(r.small_features)},
          {"lost_tags", r.lost_tags},
          {"lost_groups", r.lost_groups},
          {"lost_regions", r.lost_regions},
          {"messages", describe(r)}};
}

Json repair_run_json(const RequestedRun& arguments, const Plc& plc, const PlcSummary& summary,
                     const RepairReport& report) {
  return {{"program", "collarmesh"},       {"version", COLLARMESH_VERSION},
          {"inputs", arguments.inputs},    {"output", arguments.output},
          {"repair", repair_json(report)}, {"complex", complex_json(plc, summary)}};
}

Json prediction_json(const Prediction& prediction) {
  return {{"size", prediction.size},
          {"tets", whole_json(prediction.tets)},
          {"seconds", number_json(prediction.seconds)}};
}

Json predictions_json(const std::vector<Prediction>& predictions) {
  Json list = Json::array();
  for (const Prediction& p : predictions) list.push_back(prediction_json(p));
  return list;
}

namespace {

Json remeshing_json(const RemeshReport& r) {
  return {{"tets_before", r.tets_before},
          {"min_dihedral_before", number_json(r.smallest_angle_before)},
          {"max_dihedral_before", number_json(r.largest_angle_before)},
          {"divided_edges", r.divided_edges},
          {"contracted_edges", r.contracted_edges},
          {"rounds", r.rounds},
          {"smooth_surface", r.smooth_surface}};
}

}  // namespace

Json run_json(const RequestedRun& arguments, const MeshRun& run) {
  Json seconds = Json::object();
  for (const auto& [stage, time] : run.times.stages())  // add up stages that occur several times
    seconds[stage] = seconds.value(stage, 0.0) + time;
  seconds["total"] = run.times.total();
  Json json{{"program", "collarmesh"},
            {"version", COLLARMESH_VERSION},
            {"inputs", arguments.inputs},
            {"output", arguments.output},
            {"options", options_json(arguments)},
            {"warnings", run.warnings},
            {"status", status_name(run.result.status)},
            {"message", run.result.message},
            {"guarantees_hold", run.guarantees_hold()},
            {"repair", repair_json(run.repair)},
            {"complex", complex_json(run.plc, run.summary, run.result.mesh.group_names, run.colours)},
            {"mesh", measures_json(run.result.mesh, run.check.measures)},
            {"worst", worst_json(run.worst)},
            {"check", check_json(run.check)},
            {"statistics", statistics_json(run.result.statistics)},
            {"notes", run.notes},
            {"projection", run.projection ? projection_json(run.plc, *run.projection) : Json(nullptr)},
            {"coarsening", run.coarsening ? coarsening_json(*run.coarsening) : Json(nullptr)},
            {"improvement", improvement_json(run.improvement)},
            {"second_order", arguments.order == 2 ? second_order_json(run.second_order) : Json(nullptr)},
            {"interior_nodes", run.interior_nodes ? interior_json(*run.interior_nodes) : Json(nullptr)},
            {"periodic", run.periodic ? periodic_json(*run.periodic, run.result.mesh) : Json(nullptr)},
            {"layers", run.layers ? layers_json(*run.layers) : Json(nullptr)},
            {"split", run.split ? split_json(*run.split) : Json(nullptr)},
            {"seconds", std::move(seconds)}};
  if (run.remeshing) json["remeshing"] = remeshing_json(*run.remeshing);
  return json;
}

}  // namespace collarmesh::report
