#include "collarmesh/mesh_measures.h"

#include <algorithm>
#include <functional>

#include "collarmesh/shape_measures.h"
#include "common/layer_jacobians.h"

namespace collarmesh {

namespace {

std::size_t bin_of(double value, double width) {
  const double bin = value / width;
  return bin < static_cast<double>(MeshMeasures::bins) ? static_cast<std::size_t>(bin)
                                                       : MeshMeasures::bins - 1;
}

/// Inserts a tet into the list of the most extreme ones, if it belongs there; equal angles stay in the order
/// of the tets.
template <class IsWorse>
void insert(const MeshMeasures::Extreme& extreme, std::vector<MeshMeasures::Extreme>& worst,
            const IsWorse& is_worse) {
  if (worst.size() == MeshMeasures::listed && !is_worse(extreme.angle, worst.back().angle)) return;
  const auto place = std::find_if(worst.begin(), worst.end(), [&](const MeshMeasures::Extreme& other) {
    return is_worse(extreme.angle, other.angle);
  });
  worst.insert(place, extreme);
  if (worst.size() > MeshMeasures::listed) worst.pop_back();
}

}  // namespace

void MeshMeasures::add(Index tet, const TetQuality& quality, Index region, Kind kind) {
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
  insert({quality.min_dihedral, tet}, smallest_angles, std::less<double>());
  insert({quality.max_dihedral, tet}, largest_angles, std::greater<double>());
}

namespace {

/// Adds the volumes of prisms and pyramids, with straight edges, to those of their regions.
void add_volumes_of_layers(const TetMesh& mesh, MeshMeasures& measures) {
  const LayerCells& layers = mesh.layers;
  const auto& p = mesh.points;
  for (std::size_t i = 0; i < layers.prisms.size(); ++i) {
    const auto& [a, b, c, d, e, f] = layers.prisms[i];
    measures.region_volumes[layers.prism_region[i]] +=
        volume_of(PrismCorners{p[a], p[b], p[c], p[d], p[e], p[f]});
  }
  for (std::size_t i = 0; i < layers.pyramids.size(); ++i) {
    const auto& [a, b, c, d, e] = layers.pyramids[i];
    measures.region_volumes[layers.pyramid_region[i]] +=
        volume_of(PyramidCorners{p[a], p[b], p[c], p[d], p[e]});
  }
}

}  // namespace

TetQuality measure_tet(const TetMesh& mesh, Index tet) {
  const auto& [a, b, c, d] = mesh.tets[tet];
  TetQuality quality = measure(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
  if (mesh.order() == 2) quality.volume = volume(curved_tet(mesh, tet));
  return quality;
}

MeshMeasures measure_mesh(const TetMesh& mesh) {
  MeshMeasures measures;
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    measures.add(t, measure_tet(mesh, t), t < mesh.tet_region.size() ? mesh.tet_region[t] : 1,
                 t < mesh.tet_collar.size() && mesh.tet_collar[t] != 0 ? MeshMeasures::Kind::collar
                 : t < mesh.tet_thin.size() && mesh.tet_thin[t] != 0   ? MeshMeasures::Kind::thin
                                                                       : MeshMeasures::Kind::plain);
  }
  add_volumes_of_layers(mesh, measures);
  return measures;
}

}  // namespace collarmesh
