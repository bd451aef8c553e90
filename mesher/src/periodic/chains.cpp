#include "periodic/chains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "common/distances.h"

namespace collarmesh::periodicity {

namespace {

constexpr double near = 0.3;  // relative to the shortest edge of the chain at a node: a node this near to a
                              // place is moved there
constexpr double good_removal = 0.3;  // quality that a removal must leave; otherwise the node is kept and
                                      // inserted on the pair's other curve
constexpr double good_enough = 0.1;   // quality that a move must leave unless tets are poorer already

/// Returns the chain of one curve's edges: from `start` or, if `start` is none, around a closed curve.
Chain follow(std::vector<std::array<Index, 2>> edges, Index start) {
  std::map<Index, std::vector<Index>> joined;
  for (const auto& [a, b] : edges) joined[a].push_back(b), joined[b].push_back(a);
  Chain chain;
  chain.closed = start == none;
  Index before = none, node = chain.closed ? edges.front()[0] : start;
  const Index first = node;
  do {
    chain.nodes.push_back(node);
    const auto& next = joined.at(node);
    const bool back = next.size() == 1 || next[0] != before;
    if (next.size() == 1 && next[0] == before) return chain;
    const Index after = back ? next[0] : next[1];
    before = node;
    node = after;
  } while (node != first && chain.nodes.size() <= edges.size());
  if (!chain.closed) chain.nodes.push_back(node);
  return chain;
}

/// An editor of one chain.
class ChainEditor {
 public:
  ChainEditor(CavityEditor& editor, Index curve, Chain& chain)
      : editor_(editor), curve_(curve), chain_(chain), stays_(chain.nodes.size(), false) {
    for (std::size_t i = 0; i < stays_.size(); ++i)
      stays_[i] = editor.mesh().features[chain.nodes[i]].dimension == 0;
  }

  ChainChange add(std::span<const Point> places, std::vector<Index>& nodes) {
    move_and_insert(places);
    for (std::size_t i = 0; i < size(); ++i)
      if (stays_[i]) nodes.push_back(chain_.nodes[i]);
    return std::move(change_);
  }

  ChainChange put(std::span<const Point> places) {
    move_and_insert(places);
    remove_others();
    return std::move(change_);
  }

 private:
  std::size_t size() const { return chain_.nodes.size(); }
  const Point& at(std::size_t i) const { return editor_.at(chain_.nodes[i % size()]); }

  double shortest_edge_at(std::size_t i) const {
    const double ahead = distance(at(i), at(i + 1)), behind = distance(at(i), at(i + size() - 1));
    if (!chain_.closed && i == 0) return ahead;
    if (!chain_.closed && i + 1 == size()) return behind;
    return std::min(ahead, behind);
  }

  void move_and_insert(std::span<const Point> places) {
    std::vector<Point> to_insert;
    for (const Point& place : places)
      if (!move_one_to(place)) to_insert.push_back(place);
    for (const Point& place : to_insert) insert(place);
  }

  bool move_one_to(const Point& place) {
    std::size_t best = size();
    double least = INFINITY;
    for (std::size_t i = 0; i < size(); ++i)
      if (const double d = distance(at(i), place); !stays_[i] && d < least) best = i, least = d;
    if (best == size() || least > near * shortest_edge_at(best)) return false;
    const Index node = chain_.nodes[best];
    const Cavity cavity = editor_.around_vertex(node);
    const double now = editor_.worst(cavity, editor_.at(node), node);
    if (editor_.worst(cavity, place, node) < std::min(now, good_enough)) return false;
    editor_.move(node, place);
    return stays_[best] = true;
  }

  void insert(const Point& place) {
    std::size_t nearest = 0;
    double least = INFINITY;
    for (std::size_t i = 0; i < chain_.edges(); ++i)
      if (const double d = squared_distance_to_segment(place, at(i), at(i + 1)); d < least)
        nearest = i, least = d;
    const Index a = chain_.nodes[nearest], b = chain_.end(nearest);
    const Cavity cavity = editor_.around_edge(a, b);
    if (editor_.worst(cavity, place, none) < 0) return;  // the certificate will report the missing node
    const Index node = editor_.insert(cavity, place, {1, curve_});
    editor_.divide_curve_edge(a, node, b);
    const auto position = static_cast<std::ptrdiff_t>(nearest + 1);
    chain_.nodes.insert(chain_.nodes.begin() + position, node);
    stays_.insert(stays_.begin() + position, true);
    ++change_.inserted;
  }

  void remove_others() {
    for (std::size_t i = 0; i < size();) {
      if (!stays_[i] && remove(i)) continue;
      if (!stays_[i]) change_.stuck.push_back(at(i));
      ++i;
    }
  }

  // Removes a node by collapsing one of its edges, to the neighbour that leaves better tets.
  bool remove(std::size_t i) {
    if (size() < 4) return false;  // keeps at least three nodes, which a closed chain needs
    const Index node = chain_.nodes[i], before = chain_.nodes[(i + size() - 1) % size()],
                after = chain_.nodes[(i + 1) % size()];
    if (editor_.on_curve(before, after)) return false;
    const Cavity cavity = editor_.around_vertex(node);
    const double to_before = editor_.worst(cavity, editor_.at(before), before),
                 to_after = editor_.worst(cavity, editor_.at(after), after);
    if (std::max(to_before, to_after) < good_removal) return false;
    editor_.join_curve_edges(before, node, after);
    editor_.fill(cavity, to_before > to_after ? before : after);
    chain_.nodes.erase(chain_.nodes.begin() + static_cast<std::ptrdiff_t>(i));
    stays_.erase(stays_.begin() + static_cast<std::ptrdiff_t>(i));
    ++change_.removed;
    return true;
  }

  CavityEditor& editor_;
  Index curve_;
  Chain& chain_;
  std::vector<bool> stays_;  // by position in the chain
  ChainChange change_;
};

}  // namespace

std::vector<Chain> chains_of(const TetMesh& mesh, const Plc& plc) {
  std::vector<std::vector<std::array<Index, 2>>> edges(plc.curves.size());
  for (Index e = 0; e < mesh.edges.size(); ++e)
    if (mesh.edge_curve[e] != none) edges[mesh.edge_curve[e]].push_back(mesh.edges[e]);
  std::vector<Index> node_of(plc.vertices.size(), none);
  for (Index v = 0; v < mesh.features.size(); ++v)
    if (mesh.features[v].dimension == 0 && mesh.features[v].feature != none)
      node_of[mesh.features[v].feature] = v;
  std::vector<Chain> chains(plc.curves.size());
  for (Index curve = 0; curve < chains.size(); ++curve) {
    if (edges[curve].empty()) continue;
    const Index end = plc.curves[curve].ends[0];
    chains[curve] = follow(std::move(edges[curve]), end == none ? none : node_of[end]);
  }
  return chains;
}

ChainChange put_nodes(CavityEditor& editor, Index curve, Chain& chain, std::span<const Point> places) {
  return ChainEditor(editor, curve, chain).put(places);
}

ChainChange add_nodes(CavityEditor& editor, Index curve, Chain& chain, std::span<const Point> places,
                      std::vector<Index>& nodes) {
  return ChainEditor(editor, curve, chain).add(places, nodes);
}

std::vector<Index> corresponding(const TetMesh& mesh, const Chain& first, const Chain& second,
                                 const Motion& motion) {
  const std::size_t n = first.nodes.size();
  if (second.nodes.size() != n || n < 2) return {};
  const auto off = [&](std::size_t i, std::size_t j) {
    return squared_distance(motion(mesh.points[first.nodes[i]]), mesh.points[second.nodes[j % n]]);
  };
  std::size_t start = 0;
  if (first.closed) {
    for (std::size_t j = 1; j < n; ++j)
      if (off(0, j) < off(0, start)) start = j;
  } else if (off(0, n - 1) < off(0, 0)) {
    start = n - 1;
  }
  const bool looped = !first.closed && second.nodes.front() == second.nodes.back();
  const bool alike =
      looped || first.closed ? off(1, start + 1) <= off(1, start + n - 1 - (looped ? 1 : 0)) : start == 0;
  std::vector<Index> nodes;
  if (looped && !alike) start = n - 1;
  for (std::size_t i = 0; i < n; ++i) nodes.push_back(second.nodes[(alike ? start + i : start + n - i) % n]);
  return nodes;
}

}  // namespace collarmesh::periodicity
