#include "collarmesh/mesh_measures.h"

#include <algorithm>

namespace collarmesh {

namespace {

std::size_t bin_of(double value, double width) {
  const double bin = value / width;
  return bin < static_cast<double>(MeshMeasures::bins) ? static_cast<std::size_t>(bin)
                                                       : MeshMeasures::bins - 1;
}

}  // namespace

void MeshMeasures::add(const TetQuality& quality, Index region, Kind kind) {
  min_dihedral = std::min(min_dihedral, quality.min_dihedral);
  max_dihedral = std::max(max_dihedral, quality.max_dihedral);
  double& radius_edge = kind == Kind::collar ? max_collar_radius_edge
                        : kind == Kind::thin ? max_thin_radius_edge
                                             : max_radius_edge;
  radius_edge = std::max(radius_edge, quality.radius_edge);
  ++min_dihedrals[bin_of(quality.min_dihedral, 10)];
  ++max_dihedrals[bin_of(quality.max_dihedral, 10)];
  ++radius_edges[bin_of(quality.radius_edge, 0.25)];
  region_volumes[region] += quality.volume;
}

MeshMeasures measure_mesh(const TetMesh& mesh) {
  MeshMeasures measures;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    measures.add(measure(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]),
                 t < mesh.tet_region.size() ? mesh.tet_region[t] : 1,
                 t < mesh.tet_collar.size() && mesh.tet_collar[t] != 0 ? MeshMeasures::Kind::collar
                 : t < mesh.tet_thin.size() && mesh.tet_thin[t] != 0   ? MeshMeasures::Kind::thin
                                                                       : MeshMeasures::Kind::plain);
  }
  return measures;
}

}  // namespace collarmesh
