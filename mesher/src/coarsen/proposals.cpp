#include "coarsen/proposals.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/contains.h"

namespace collarmesh::remeshing::coarsening {

namespace {

// Repairs are tried only for collapses after which each new tet has at least this quality.
constexpr double repairable = 0.15;

}  // namespace

// Tests lengths before shapes, because they rule out most neighbours at less cost.
void Proposer::collapses(Index vertex, bool repairs, VertexProposal& found) {
  found = {};
  find_neighbours(vertex);
  targets_.clear();
  for (const Neighbour& n : neighbours_) {
    if (!is_short(n.squared_length)) break;
    if (edited_.may_share_feature(vertex, n.vertex) && lengths_fit(n.vertex)) targets_.push_back(n.vertex);
  }
  if (targets_.empty()) return;
  rule_.set_mode(Mode::final);
  if (!operations_.begin_collapses(vertex, star_)) return;
  // On features the link condition also depends on the tets at the other end.
  const bool looks_beyond = complex().mesh().features[vertex].dimension < 3;
  for (const Index onto : targets_) {
    if (looks_beyond) found.read.push_back(onto);
    operations_.collapse_onto(onto, 0, 1, found.change);
    if (!found.change.is_none()) return;
  }
  if (!repairs) return;
  found.floor = std::min(1.0, operations_.worst_at_vertex());
  rule_.set_mode(Mode::force);
  for (const Index onto : targets_) {
    Change change;
    operations_.collapse_onto(onto, repairable, -INFINITY, change);
    if (!change.is_none()) found.to_repair.push_back(std::move(change));
  }
}

Change Proposer::improvement_of(Index tet, Mode mode) {
  rule_.set_mode(mode);
  const auto corners = complex()[tet].corners;
  Change change;
  for (const auto& [i, j] : longest_first(complex().corners(tet), squared_distance)) {
    operations_.remove_edge(tet, i, j, change);
    if (change.quality >= improved_below) break;
  }
  for (unsigned i = 0; i < 4 && change.is_none(); ++i) {
    // Whether a move helps depends only on the tets at the corner. If it was tried for another of these tets
    // and nothing has changed since, it would fail again.
    if (mode == Mode::final && stays(corners[i])) continue;
    operations_.move_vertex(corners[i], change);
    if (mode == Mode::final && change.is_none()) stayed_[corners[i]] = changes_.now();
  }
  return change;
}

bool Proposer::is_new(Index vertex) {
  if (stamps_[vertex] == stamp_) return false;
  stamps_[vertex] = stamp_;
  return true;
}

void Proposer::find_neighbours(Index vertex) {
  neighbours_.clear();
  ++stamp_;
  stamps_[vertex] = stamp_;
  squared_shortest_ = INFINITY;
  complex().star(vertex, star_);
  for (const Index t : star_)
    for (const Index w : complex()[t].corners) {
      if (!is_new(w)) continue;
      const Vector edge = complex().edge(vertex, w);
      squared_shortest_ = std::min(squared_shortest_, squared_norm(edge));
      neighbours_.push_back({metric_.squared_length(vertex, w, edge), edge, w});
    }
  std::ranges::sort(neighbours_, {},
                    [](const Neighbour& n) { return std::pair(n.squared_length, n.vertex); });
}

// Returns whether the new edges of a collapse have allowed lengths: none is shorter than the vertex's
// shortest edge, and none is too long, unless the edge that it replaces is at least as long. Begins with the
// farthest neighbours, which rule out most collapses.
bool Proposer::lengths_fit(Index onto) const {
  return std::all_of(neighbours_.rbegin(), neighbours_.rend(), [&](const Neighbour& n) {
    if (n.vertex == onto) return true;
    const Vector after = complex().edge(onto, n.vertex);
    return (squared_norm(after) >= squared_shortest_ && rule_.allows_edge(onto, n.vertex, after, n.edge)) ||
           are_joined_here(onto, n.vertex);
  });
}

// Returns whether a tet at the current vertex joins a and b.
bool Proposer::are_joined_here(Index a, Index b) const {
  return std::ranges::any_of(
      star_, [&](Index t) { return contains(complex()[t].corners, a) && contains(complex()[t].corners, b); });
}

}  // namespace collarmesh::remeshing::coarsening
