#include "pipeline/certification.h"

#include <algorithm>
#include <limits>

#include "check/guarantees.h"
#include "check/periodic.h"
#include "periodic/node_map.h"

namespace collarmesh::pipeline {

bool is_about_shape(const Finding& f) {
  return f.guarantee == guarantee::thin_angles || f.guarantee == guarantee::collar_dihedral ||
         f.guarantee == guarantee::radius_edge;
}

bool misses_volumes_only(const CheckReport& check) {
  return !check.findings.empty() && std::ranges::all_of(check.findings, [](const Finding& f) {
    return f.guarantee == guarantee::volume_kept || f.guarantee == guarantee::thickness_kept;
  });
}

bool misses_far_less(const PipelineResult& constrained, const PipelineResult& refined) {
  constexpr std::size_t few = 20;
  constexpr double share = 0.1;
  const auto findings_per_tet = [](const PipelineResult& made) {
    return static_cast<double>(made.check.findings_total) / static_cast<double>(made.result.mesh.tets.size());
  };
  return refined.check.findings_total > few && !misses_volumes_only(refined.check) &&
         findings_per_tet(constrained) < share * findings_per_tet(refined);
}

std::size_t count_misshapen(const MeshJob& job, const TetMesh& mesh) {
  Bounds promised = job.bounds();
  promised.tolerance = job.refined_with.bounds.tolerance;
  const CheckReport report = check(mesh, *job.plc,
                                   {.bounds = promised,
                                    .findings_per_guarantee = std::numeric_limits<std::size_t>::max(),
                                    .threads = job.options.mesh.threads},
                                   job.execution());
  const auto poor = static_cast<std::size_t>(std::ranges::count_if(report.findings, is_about_shape));
  // `periodic_places` is not counted: `finish_map` makes places exact when the mesh is finished.
  constexpr std::size_t worse = 1000;  // weight of a missing image, relative to a poor tet
  CheckReport of_pairs;
  checks::check_periodic(mesh, of_pairs);
  return poor +
         worse * static_cast<std::size_t>(std::ranges::count_if(of_pairs.findings, [](const Finding& f) {
           return f.guarantee == guarantee::periodic_nodes || f.guarantee == guarantee::periodic_edges ||
                  f.guarantee == guarantee::periodic_faces;
         }));
}

void certify(MeshJob& job, const SurfaceTolerance& tolerance) {
  job.control.begin("check", 0.86, job.given.partitions > 0 ? 0.96 : 1);
  job.promised = job.bounds();
  job.promised.tolerance = tolerance;
  PipelineResult& made = job.made;
  if (made.periodic) periodicity::finish_map(made.result.mesh, *made.periodic);
  made.check = check(
      made.result.mesh, *job.plc,
      {.bounds = job.promised, .exact = job.options.exact_measures, .threads = job.options.mesh.threads},
      job.execution());
  if (!made.result.mesh.periodic.empty()) checks::check_periodic(made.result.mesh, made.check);
  job.control.stop_if_asked();
}

}  // namespace collarmesh::pipeline
