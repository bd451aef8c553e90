#include "split/sectors.h"

#include <algorithm>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "common/cell_shapes.h"
#include "common/disjoint_sets.h"
#include "common/tet_sides.h"

namespace collarmesh::splitting {

namespace {

/// Returns whether a node lies on the side opposite a corner.
bool is_at_side(std::uint8_t place, unsigned corner) {
  if (place < 4) return place != corner;
  const auto& [a, b] = cell_shapes::tet_edges[place - 4U];
  return a != corner && b != corner;
}

/// The tets at one node.
class Star {
 public:
  Star(const TetMesh& mesh, std::span<const NodeOfTet> members,
       const std::function<bool(const Key&)>& is_split)
      : mesh_(mesh), members_(members), sectors_(members.size()), whole_(members.size()) {
    std::vector<std::pair<Key, Index>> sides;
    for (Index i = 0; i < members.size(); ++i)
      for (unsigned corner = 0; corner < 4; ++corner)
        if (is_at_side(members[i].place, corner)) {
          Key key = side_corners(mesh.tets[members[i].tet], corner);
          std::ranges::sort(key);
          sides.emplace_back(key, i);
        }
    std::ranges::sort(sides);
    for (std::size_t k = 1; k < sides.size(); ++k) {
      if (sides[k].first != sides[k - 1].first) continue;
      whole_.unite(sides[k].second, sides[k - 1].second);
      if (!is_split(sides[k].first)) sectors_.unite(sides[k].second, sides[k - 1].second);
    }
  }

  /// Returns the sectors that get a copy of the node.
  std::vector<std::vector<NodeOfTet>> further() {
    struct Sector {
      Index region = none, whole = none;
      std::vector<NodeOfTet> members;
    };
    std::map<Index, Sector> by_root;
    for (Index i = 0; i < members_.size(); ++i) {
      Sector& sector = by_root[sectors_.find(i)];
      sector.region = std::min(sector.region, mesh_.tet_region[members_[i].tet]);
      sector.whole = whole_.find(i);
      sector.members.push_back(members_[i]);
    }
    std::vector<Sector> order;
    for (auto& [root, sector] : by_root) order.push_back(std::move(sector));
    std::ranges::sort(order, {},
                      [](const Sector& s) { return std::tuple(s.whole, s.region, s.members.front().tet); });
    std::vector<std::vector<NodeOfTet>> result;
    for (std::size_t s = 1; s < order.size(); ++s)
      if (order[s].whole == order[s - 1].whole) result.push_back(std::move(order[s].members));
    return result;
  }

 private:
  const TetMesh& mesh_;
  std::span<const NodeOfTet> members_;
  DisjointSets sectors_, whole_;
};

}  // namespace

void for_each_further_sector(const TetMesh& mesh, std::vector<NodeOfTet> nodes,
                             const std::function<bool(const Key&)>& is_split,
                             const std::function<void(Index, const std::vector<NodeOfTet>&)>& copy) {
  std::ranges::sort(nodes, {}, [](const NodeOfTet& n) { return std::pair(n.node, n.tet); });
  for (std::size_t first = 0, last = 0; first < nodes.size(); first = last) {
    while (last < nodes.size() && nodes[last].node == nodes[first].node) ++last;
    const std::span<const NodeOfTet> members = std::span(nodes).subspan(first, last - first);
    for (const auto& sector : Star(mesh, members, is_split).further()) copy(nodes[first].node, sector);
  }
}

}  // namespace collarmesh::splitting
