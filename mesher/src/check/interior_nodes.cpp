// Finds tets all of whose corners are on listed faces, from the mesh alone.
#include <algorithm>
#include <vector>

#include "check/mesh_to_check.h"

namespace collarmesh::checks {

void check_interior_nodes(const MeshToCheck& to_check, CheckReport& report, Findings& findings) {
  const TetMesh& mesh = to_check.mesh;
  std::vector<bool> on_face(mesh.points.size(), false);
  for (const auto& face : mesh.faces)
    for (const Index v : face) on_face[v] = true;
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    if (!on_face[a] || !on_face[b] || !on_face[c] || !on_face[d]) continue;
    ++report.surface_tets;
    if (!to_check.options.bounds.interior_node) continue;
    const Point where = 0.25 * ((mesh.points[a] + mesh.points[b]) + (mesh.points[c] + mesh.points[d]));
    findings.add(guarantee::interior_node, where, {t},
                 "Tet {} at {} has all corners on boundaries, interfaces or internal patches; a smaller size "
                 "there leaves room for a node inside.",
                 t, At{where});
  }
}

}  // namespace collarmesh::checks
