#include "pipeline/wall_layers.h"

#include <map>
#include <set>
#include <utility>

#include "check/layer_cells.h"
#include "check/layer_walls.h"
#include "layers/wall_choice.h"

namespace collarmesh::pipeline {

namespace {

ImproveOptions options_of_core(const MeshJob& job) {
  constexpr double least_angle = 8;  // where the profile bounds no angles
  ImproveOptions options = improve_options(job.options.improve == 0 ? 2 : job.options.improve);
  options.bounds = job.bounds();
  options.bounds.tolerance = job.refined_with.bounds.tolerance;
  if (options.bounds.thin_angle == 0) options.bounds.thin_angle = least_angle;
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

/// Returns by how much layers may change the volume of each region. Walls keep their triangles, so only
/// other patches count, along which nodes slide: before and after, their triangles are within their
/// tolerance of the surface, so that at most twice that times the area lies between. Planar patches are as
/// flat as the complex was built.
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

/// Measures the tets again. Regions keep the volumes of before, as those of curved prisms are not measured.
void measure_with_layers(const TetMesh& mesh, MeshMeasures& measures) {
  MeshMeasures measured = measure_mesh(mesh);
  measured.region_volumes = std::move(measures.region_volumes);
  measures = std::move(measured);
}

}  // namespace

void add_layers(MeshJob& job) {
  if (!job.given.layers.any()) return;
  job.control.begin("layers", 0.9, 0.96);
  TetMesh& mesh = job.made.result.mesh;
  const auto volumes = checks::volumes_with_layers(mesh);
  const Areas areas = areas_of(mesh);
  const checks::AskedWalls walls = layering::WallChoice(job.options.layers, *job.plc).counts(*job.plc);
  const checks::WallGeometry wall_geometry(mesh, walls);
  const ImproveOptions options = options_of_core(job);
  const SecondOrderOptions second_order{
      .exact = job.options.exact, .bounds = job.bounds(), .threads = job.options.mesh.threads};
  job.made.layers = make_layers(mesh, *job.plc, job.options.layers, options, second_order, job.execution());
  if (job.made.layers->cancelled) job.control.stop();
  checks::check_layer_cells(mesh, job.made.check);
  checks::check_layer_walls(walls, wall_geometry, mesh, *job.made.layers, job.made.check);
  checks::check_core_angles(mesh, job.made.layers->walls, *job.plc, options.bounds, job.made.check);
  const SurfaceTolerance tolerance =
      options.bounds.tolerance ? *options.bounds.tolerance : tolerance_of_any_size(*job.plc, options.bounds);
  checks::check_layer_volumes(volumes, mesh, volume_allowances(job, areas, tolerance), job.made.check);
  measure_with_layers(mesh, job.made.check.measures);
  job.control.stop_if_asked();
}

}  // namespace collarmesh::pipeline
