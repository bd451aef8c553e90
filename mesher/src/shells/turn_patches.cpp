#include "shells/turn_patches.h"

#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/edge_key.h"

namespace collarmesh::shells {

namespace {

/// A side of a triangle on a curve: its patch, and whether it runs from the smaller to the larger point.
struct Side {
  Index patch;
  bool ascending;
};

struct Neighbour {
  Index patch;
  bool alike;  // whether both patches already have consistent orientations there
};

std::vector<std::vector<Neighbour>> neighbours_of(const TetMesh& mesh, std::size_t patches) {
  std::unordered_map<std::uint64_t, std::vector<Side>> sides;
  for (const auto& [a, b] : mesh.edges) sides[edge_key(a, b)];
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = mesh.faces[f][i], b = mesh.faces[f][(i + 1) % 3];
      if (const auto found = sides.find(edge_key(a, b)); found != sides.end())
        found->second.push_back({mesh.face_patch[f], a < b});
    }
  std::vector<std::vector<Neighbour>> neighbours(patches);
  for (const auto& [a, b] : mesh.edges) {
    const std::vector<Side>& two = sides[edge_key(a, b)];
    if (two.size() != 2 || two[0].patch == two[1].patch) continue;
    const bool alike = two[0].ascending != two[1].ascending;
    neighbours[two[0].patch].push_back({two[1].patch, alike});
    neighbours[two[1].patch].push_back({two[0].patch, alike});
  }
  return neighbours;
}

}  // namespace

void turn_patches(TetMesh& mesh, const Plc& plc) {
  const auto neighbours = neighbours_of(mesh, plc.patches.size());
  enum class Turn { unknown, keep, turn };
  std::vector<Turn> turns(plc.patches.size(), Turn::unknown);
  for (Index p = 0; p < plc.patches.size(); ++p) {
    const auto& [behind, front] = plc.patches[p].regions;
    if (behind > 0 || front > 0) turns[p] = behind > 0 ? Turn::keep : Turn::turn;
  }
  for (Index first = 0; first < plc.patches.size(); ++first) {
    if (turns[first] != Turn::unknown) continue;
    turns[first] = Turn::keep;
    std::vector<Index> queue{first};
    while (!queue.empty()) {
      const Index patch = queue.back();
      queue.pop_back();
      for (const Neighbour& n : neighbours[patch]) {
        if (turns[n.patch] != Turn::unknown) continue;
        const bool turn = (turns[patch] == Turn::turn) == n.alike;
        turns[n.patch] = turn ? Turn::turn : Turn::keep;
        queue.push_back(n.patch);
      }
    }
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (turns[mesh.face_patch[f]] != Turn::turn) continue;
    std::swap(mesh.faces[f][1], mesh.faces[f][2]);
    if (!mesh.face_mid_nodes.empty()) std::swap(mesh.face_mid_nodes[f][0], mesh.face_mid_nodes[f][2]);
  }
}

}  // namespace collarmesh::shells
