#include "periodic/sparse_nodes.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>

namespace collarmesh::periodicity {

namespace {

constexpr double growth = 0.5;           // growth of lengths with the distance from the border
constexpr double least_distance = 0.15;  // distance that two nodes keep, relative to the length there

class PatchNodes {
 public:
  PatchNodes(const TetMesh& mesh, std::span<const Index> faces, const std::vector<double>& targets)
      : mesh_(mesh) {
    for (const Index face : faces)
      for (unsigned i = 0; i < 3; ++i) add_edge(mesh.faces[face][i], mesh.faces[face][(i + 1) % 3]);
    for (Index i = 0; i < nodes_.size(); ++i) lengths_[i] = std::min(lengths_[i], targets[nodes_[i]]);
    grade();
  }

  std::vector<SpacedPlace> sparse() {
    covered_.assign(nodes_.size(), false);
    for (Index i = 0; i < nodes_.size(); ++i)
      if (!is_inside(i)) cover(i);
    std::vector<Index> order(nodes_.size());
    for (Index i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return lengths_[a] > lengths_[b]; });
    std::vector<SpacedPlace> places;
    for (const Index i : order) {
      if (!is_inside(i) || covered_[i]) continue;
      cover(i);
      places.push_back({mesh_.points[nodes_[i]], lengths_[i]});
    }
    return places;
  }

 private:
  struct Reached {
    double at;
    Index node;
    bool operator>(const Reached& other) const { return at > other.at; }
  };

  bool is_inside(Index i) const { return mesh_.features[nodes_[i]].dimension == 2; }
  double between(Index i, Index j) const {
    return distance(mesh_.points[nodes_[i]], mesh_.points[nodes_[j]]);
  }

  Index number(Index node) {
    const auto [found, is_new] = numbers_.try_emplace(node, static_cast<Index>(nodes_.size()));
    if (is_new) {
      nodes_.push_back(node);
      neighbours_.emplace_back();
      lengths_.push_back(INFINITY);
    }
    return found->second;
  }

  // Records an edge. On the border, lengths are at most those of the edges there.
  void add_edge(Index a, Index b) {
    const Index i = number(a), j = number(b);
    neighbours_[i].push_back(j);
    neighbours_[j].push_back(i);
    if (is_inside(i) || is_inside(j)) return;
    for (const Index k : {i, j}) lengths_[k] = std::min(lengths_[k], between(i, j));
  }

  void grade() {
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
    for (Index i = 0; i < nodes_.size(); ++i) queue.push({lengths_[i], i});
    while (!queue.empty()) {
      const Reached next = queue.top();
      queue.pop();
      if (next.at > lengths_[next.node]) continue;
      for (const Index j : neighbours_[next.node])
        if (const double length = next.at + growth * between(next.node, j); length < lengths_[j]) {
          lengths_[j] = length;
          queue.push({length, j});
        }
    }
  }

  // Covers the nodes that are too near to this node and are connected to it through nodes that are too near
  // as well.
  void cover(Index i) {
    covered_[i] = true;
    std::vector<Index> stack{i}, seen{i};
    while (!stack.empty()) {
      const Index at = stack.back();
      stack.pop_back();
      for (const Index j : neighbours_[at]) {
        if (!is_inside(j) || between(i, j) > least_distance * lengths_[i] ||
            std::find(seen.begin(), seen.end(), j) != seen.end())
          continue;
        covered_[j] = true;
        seen.push_back(j);
        stack.push_back(j);
      }
    }
  }

  const TetMesh& mesh_;
  std::unordered_map<Index, Index> numbers_;    // by node of the mesh
  std::vector<Index> nodes_;                    // nodes of the mesh
  std::vector<std::vector<Index>> neighbours_;  // this and the following: by number in `nodes_`
  std::vector<double> lengths_;
  std::vector<bool> covered_;
};

}  // namespace

std::vector<SpacedPlace> sparse_nodes(const TetMesh& mesh, std::span<const Index> faces,
                                      const std::vector<double>& targets) {
  return PatchNodes(mesh, faces, targets).sparse();
}

}  // namespace collarmesh::periodicity
