#include "pipeline/wall_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "check/layer_cells.h"
#include "check/layer_walls.h"
#include "layers/make.h"
#include "layers/wall_choice.h"

namespace collarmesh::pipeline {

namespace {

ImproveOptions options_of_core(const MeshJob& job) {
  ImproveOptions options = improve_options(job.options.improve == 0 ? 2 : job.options.improve);
  options.bounds = job.bounds();
  options.bounds.tolerance = job.refined_with.bounds.tolerance;
  if (options.bounds.thin_angle == 0) options.bounds.thin_angle = checks::least_core_angle;
  options.threads = job.options.mesh.threads;
  return options;
}

/// Areas of patches, by patch and the region beside them.
using Areas = std::map<std::pair<Index, Index>, double>;

Areas areas_of(const TetMesh& mesh) {
  Areas areas;
  const auto& p = mesh.points;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    for (const Index region : mesh.face_regions[f])
      areas[{mesh.face_patch[f], region}] += 0.5 * norm(cross(p[b] - p[a], p[c] - p[a]));
  }
  return areas;
}

/// Returns how much layers may change the volume of each region. Walls keep their triangles, so only patches
/// along which nodes slide count. Their triangles are within the tolerance of the surface before and after,
/// so the volume in between is at most twice the tolerance times the area. For planar patches, the planar
/// tolerance of the complex counts.
std::map<Index, double> volume_allowances(const MeshJob& job, const Areas& areas,
                                          const SurfaceTolerance& tolerance) {
  std::set<Tag> walls;
  for (const LayersReport::Patch& patch : job.made.layers->patches) walls.insert(patch.tag);
  std::map<Index, double> allowed;
  for (const auto& [at, area] : areas) {
    const auto& [number, region] = at;
    if (number == none) continue;
    const Plc::Patch& patch = job.plc->patches[number];
    if (walls.contains(patch.tag)) continue;
    const double off = patch.planar ? job.plc->planar_tolerance : tolerance.largest_on_patch(number);
    allowed[region] += 2 * off * area;
  }
  return allowed;
}

/// Adds to the list of straightened mid-edge nodes in `made` the nodes of walls that were straightened before
/// there were layers, as listed in `given`. They get their present numbers.
void keep_straightened(const checks::WallGeometry& before, const checks::WallGeometry& now,
                       const SecondOrderReport& given, SecondOrderReport& made) {
  if (before.mid_nodes.size() != now.mid_nodes.size()) return;  // the walls differ, which the check reports
  std::map<Index, const SecondOrderReport::Straightened*> straightened;  // by their numbers before
  for (const auto& node : given.straightened) straightened.emplace(node.point, &node);
  std::set<Index> listed;
  for (const auto& node : made.straightened) listed.insert(node.point);
  for (std::size_t i = 0; i < now.mid_nodes.size(); ++i) {
    const auto found = straightened.find(before.mid_nodes[i].node);
    if (found == straightened.end() || !listed.insert(now.mid_nodes[i].node).second) continue;
    SecondOrderReport::Straightened kept = *found->second;
    kept.point = now.mid_nodes[i].node;
    kept.edge = now.mid_nodes[i].edge;
    made.straightened.push_back(kept);
  }
  std::ranges::sort(made.straightened, [](const auto& a, const auto& b) { return a.point < b.point; });
}

/// Returns a warning if layers cover little; empty otherwise.
std::string warning_of(const LayersReport& layers) {
  constexpr double enough = 0.8;
  if (layers.coverage() >= enough) return {};
  std::string text = fmt::format("layers cover only {:.1f}% of the walls", 100 * layers.coverage());
  const auto most = std::ranges::max_element(
      layers.reductions,
      [](const LayersReport::Reduction& a, const LayersReport::Reduction& b) { return a.nodes < b.nodes; });
  if (most != layers.reductions.end())
    text += fmt::format(", mostly (at {} nodes) because {}", most->nodes, most->why);
  return text + "; use a smaller first height or thickness, a smaller count or a smaller size";
}

/// Checks all guarantees again. Keeps the notes of earlier stages.
void certify_with_layers(MeshJob& job) {
  job.control.begin("check layers", 0.94, 0.96);
  CheckReport& made = job.made.check;
  CheckReport now = check(
      job.made.result.mesh, *job.plc,
      {.bounds = job.promised, .exact = job.options.exact_measures, .threads = job.options.mesh.threads},
      job.execution());
  std::vector<std::string> notes = std::move(made.notes);
  for (std::string& note : now.notes)
    if (std::ranges::find(notes, note) == notes.end()) notes.push_back(std::move(note));
  now.notes = std::move(notes);
  made = std::move(now);
  if (std::string warning = warning_of(*job.made.layers); !warning.empty())
    made.warnings.push_back(std::move(warning));
}

}  // namespace

void add_layers(MeshJob& job) {
  if (!job.given.layers.any()) return;
  job.control.begin("layers", 0.9, 0.94);
  TetMesh& mesh = job.made.result.mesh;
  const auto volumes = checks::volumes_with_layers(mesh);
  const Areas areas = areas_of(mesh);
  const checks::AskedWalls walls = layering::WallChoice(job.options.layers, *job.plc).counts(*job.plc);
  const checks::WallGeometry wall_geometry(mesh, walls);
  const ImproveOptions options = options_of_core(job);
  const SecondOrderOptions second_order{
      .exact = job.options.exact, .bounds = job.bounds(), .threads = job.options.mesh.threads};
  SecondOrderReport made;
  job.made.layers =
      layering::make(mesh, *job.plc, job.options.layers, options, second_order, job.execution(), made);
  if (job.made.layers->cancelled) job.control.stop();
  const std::vector<SecondOrderReport::Straightened> moved = made.straightened;
  if (mesh.order() == 2) {
    keep_straightened(wall_geometry, checks::WallGeometry(mesh, walls), job.made.second_order, made);
    job.made.second_order = std::move(made);
  }
  certify_with_layers(job);
  checks::check_layer_walls(walls, wall_geometry, mesh, *job.made.layers, job.made.check, moved);
  const SurfaceTolerance tolerance =
      options.bounds.tolerance ? *options.bounds.tolerance : tolerance_of_any_size(*job.plc, options.bounds);
  checks::check_layer_volumes(volumes, mesh, volume_allowances(job, areas, tolerance), job.made.check);
  job.control.stop_if_asked();
}

}  // namespace collarmesh::pipeline
