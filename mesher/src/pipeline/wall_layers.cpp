#include "pipeline/wall_layers.h"

#include <algorithm>
#include <set>

#include "check/layer_cells.h"

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

/// Returns the share of its volume by which layers may change a region: rounding, and, where they end at
/// curved faces, what the new triangles there cut off.
double volume_allowance(const MeshJob& job) {
  constexpr double rounding = 1e-9, cut_off = 0.01;
  std::set<Tag> walls;
  for (const LayersReport::Patch& patch : job.made.layers->patches) walls.insert(patch.tag);
  const auto& patches = job.plc->patches;
  return std::all_of(patches.begin(), patches.end(),
                     [&](const Plc::Patch& patch) { return patch.planar || walls.contains(patch.tag); })
             ? rounding
             : cut_off;
}

}  // namespace

void add_layers(MeshJob& job) {
  if (!job.given.layers.any()) return;
  job.control.begin("layers", 0.9, 0.96);
  TetMesh& mesh = job.made.result.mesh;
  const auto volumes = checks::volumes_with_layers(mesh);
  const ImproveOptions options = options_of_core(job);
  const SecondOrderOptions second_order{
      .exact = job.options.exact, .bounds = job.bounds(), .threads = job.options.mesh.threads};
  job.made.layers = make_layers(mesh, *job.plc, job.options.layers, options, second_order, job.execution());
  if (job.made.layers->cancelled) job.control.stop();
  checks::check_layer_cells(mesh, job.made.check);
  checks::check_core_angles(mesh, job.made.layers->walls, *job.plc, options.bounds, job.made.check);
  checks::check_layer_volumes(volumes, mesh, volume_allowance(job), job.made.check);
  job.control.stop_if_asked();
}

}  // namespace collarmesh::pipeline
