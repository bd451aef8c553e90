#include "repair/snap_corners.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "common/distances.h"
#include "facets/edges.h"

namespace collarmesh::repairing {

using namespace facets;

// Orders by length, longer edges first, then by distance, nearer corners first.
bool CornerSnapper::NearEdge::operator<(const NearEdge& other) const {
  return std::tie(other.length, distance, edge, corner.point) <
         std::tie(length, other.distance, other.edge, other.corner.point);
}

CornerSnapper::Outcome CornerSnapper::snap(std::size_t most_triangles) {
  cuts_.clear();
  const std::size_t done_before = state_.done().size();
  choose(near_edges());
  if (!cuts_.has_edges()) return Outcome::nothing_near;
  if (cuts_.pieces() > most_triangles) {
    state_.done().resize(done_before);
    cuts_.for_each_edge([&](const Edge& edge) {
      for (const Index side : state_.triangles().sides(edge)) state_.defer(side / 3);
    });
    return Outcome::too_many;
  }
  cuts_.apply();
  return Outcome::snapped;
}

std::vector<CornerSnapper::NearEdge> CornerSnapper::near_edges() {
  const std::vector<Index> looked_at = state_.take_unseen(SnapState::by_corners);
  std::vector<NearEdge> found;
  state_.triangles().for_each_corner_near_edge(
      looked_at, [&](Index p, const Edge& edge) { find_near_edge(p, edge, found); });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end(),
                          [](const NearEdge& a, const NearEdge& b) {
                            return a.edge == b.edge && a.corner.point == b.corner.point;
                          }),
              found.end());
  return found;
}

// Chooses the edges that are cut in this round. If a corner is too near to other corners chosen for its edge,
// the edge's triangles are examined again in the next round.
void CornerSnapper::choose(const std::vector<NearEdge>& found) {
  struct EdgeState {
    std::vector<Index> sides;
    bool deferred = false;
  };
  std::map<Edge, EdgeState> states;
  for (const NearEdge& near : found) {
    const auto [at, added] = states.try_emplace(near.edge);
    EdgeState& state = at->second;
    if (added) state.sides = state_.triangles().sides(near.edge);
    state_.work().spend(state.sides.size());
    if (!has_room(near)) {
      if (!std::exchange(state.deferred, true))
        for (const Index side : state.sides) state_.defer(side / 3);
      continue;
    }
    if (may_cut(near, state.sides)) cuts_.add(near.edge, near.corner, near.distance);
  }
}

// Returns whether an edge may be cut. So that the process ends, the new edges from the corner to the opposite
// corners must be shorter than the edge; each edge may violate this once after each overlay.
bool CornerSnapper::may_cut(const NearEdge& near, std::span<const Index> sides) {
  const bool shorter = std::all_of(sides.begin(), sides.end(), [&](Index side) {
    const Index opposite = apex(state_.draft().triangles, side);
    return opposite == near.corner.point || distance(at(opposite), at(near.corner.point)) < near.length;
  });
  return shorter || cut_before_.insert(near.edge).second;
}

// Returns whether a corner is far enough along its edge from the other corners that the edge gets.
bool CornerSnapper::has_room(const NearEdge& near) const {
  const std::vector<SnapCuts::OnEdge>* others = cuts_.on(near.edge);
  if (others == nullptr) return true;
  const double length = distance(at(near.edge[0]), at(near.edge[1]));
  return std::all_of(others->begin(), others->end(), [&](const SnapCuts::OnEdge& o) {
    return std::fabs(o.parameter - near.corner.parameter) * length > 2 * state_.limit();
  });
}

void CornerSnapper::find_near_edge(Index p, const Edge& edge, std::vector<NearEdge>& found) const {
  const double limit = state_.limit();
  const Vector along = at(edge[1]) - at(edge[0]), to = at(p) - at(edge[0]);
  const double ll = squared_norm(along), d1 = dot(to, along);
  if (!(d1 > 0 && d1 < ll)) return;
  if (squared_norm(cross(along, to)) > beyond_plane * beyond_plane * limit * limit * ll) return;
  const double parameter = parameter_on_segment(at(p), at(edge[0]), at(edge[1]));
  const double d = distance(at(p), at(edge[0]) + parameter * along);
  if (d > limit || !(parameter > 0 && parameter < 1) || !state_.takes_part(edge) ||
      !state_.triangles().uses(p))
    return;
  if (state_.triangles().sides(edge).empty()) return;  // the edge no longer exists
  found.push_back({std::sqrt(ll), d, edge, {parameter, p}});
}

}  // namespace collarmesh::repairing
