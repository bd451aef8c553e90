#include "mesh_measures.h"

#include <algorithm>

namespace collarmesh::cli {

namespace {

std::size_t bin_of(double value, double width) {
  const double bin = value / width;
  return bin < static_cast<double>(MeshMeasures::bins) ? static_cast<std::size_t>(bin)
                                                       : MeshMeasures::bins - 1;
}

}  // namespace

MeshMeasures measure_mesh(const TetMesh& mesh) {
  MeshMeasures m;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const TetQuality quality = measure(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
    m.min_dihedral = std::min(m.min_dihedral, quality.min_dihedral);
    m.max_dihedral = std::max(m.max_dihedral, quality.max_dihedral);
    const bool in_collar = t < mesh.tet_collar.size() && mesh.tet_collar[t] != 0;
    double& radius_edge = in_collar ? m.max_collar_radius_edge : m.max_radius_edge;
    radius_edge = std::max(radius_edge, quality.radius_edge);
    ++m.min_dihedrals[bin_of(quality.min_dihedral, 10)];
    ++m.max_dihedrals[bin_of(quality.max_dihedral, 10)];
    ++m.radius_edges[bin_of(quality.radius_edge, 0.25)];
    const Index region = t < mesh.tet_region.size() ? mesh.tet_region[t] : 1;
    m.region_volumes[region] += quality.volume;
  }
  return m;
}

}  // namespace collarmesh::cli
