#include "split/cohesive.h"

#include <array>

namespace collarmesh::splitting {

void add_prisms(const TetMesh& mesh, const std::vector<SidePair>& pairs, Interfaces& interfaces) {
  for (const SidePair& pair : pairs) {
    const auto [a, b, c] = mesh.faces[pair.minus];
    const auto [p, r, q] = mesh.faces[pair.plus];  // counterclockwise as seen from its own side
    interfaces.prisms.push_back({a, b, c, p, q, r});
    interfaces.prism_tag.push_back(mesh.face_tag[pair.minus]);
    if (mesh.order() == 1) continue;
    const auto [ab, bc, ca] = mesh.face_mid_nodes[pair.minus];
    const auto [rp, qr, pq] = mesh.face_mid_nodes[pair.plus];
    interfaces.prism_mid_nodes.push_back({ab, bc, ca, pq, qr, rp});
  }
}

}  // namespace collarmesh::splitting
