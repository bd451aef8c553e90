#include "report/worst_tets.h"

#include <algorithm>

namespace collarmesh::report {

std::vector<WorstTet> worst_tets(const TetMesh& mesh, const MeshMeasures& measures) {
  std::vector<WorstTet> tets;
  const auto add = [&](Index tet) {
    if (std::any_of(tets.begin(), tets.end(), [&](const WorstTet& other) { return other.tet == tet; }))
      return;
    const auto& v = mesh.tets[tet];
    const std::array<Point, 4> p{mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]};
    const TetQuality quality = measure(p[0], p[1], p[2], p[3]);
    tets.push_back({tet, quality.min_dihedral, quality.max_dihedral, p});
  };
  for (const MeshMeasures::Extreme& extreme : measures.smallest_angles) add(extreme.tet);
  for (const MeshMeasures::Extreme& extreme : measures.largest_angles) add(extreme.tet);
  return tets;
}

}  // namespace collarmesh::report
