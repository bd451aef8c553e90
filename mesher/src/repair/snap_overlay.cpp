#include "repair/snap_overlay.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/distances.h"
#include "repair/snap_corners.h"

namespace collarmesh::repairing {

using namespace facets;

bool Overlay::run() {
  cuts_.clear();
  crossing_.clear();
  count_ = 0;
  first_ = static_cast<Index>(state_.draft().points.size());
  std::vector<std::pair<Index, Index>> pairs;
  state_.triangles().for_each_near_pair(state_.take_unseen(SnapState::by_overlay),
                                        [&](Index s, Index t) { pairs.emplace_back(s, t); });
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [s, t] : pairs) {
    find_near_corners(s, t);
    find_near_corners(t, s);
    find_crossings(s, t);
  }
  if (cuts_.empty()) return false;
  find_crossings_inside();
  count_ = crossing_.size() + cuts_.triangles_with_points();
  cuts_.apply();
  return true;
}

// If the edges of two triangles cross on a third triangle, adds their crossing to the third triangle, too.
void Overlay::find_crossings_inside() {
  cuts_.for_each_along([&](Index t, const std::vector<Edge>& edges) {
    const Corners& corners = state_.draft().triangles[t];
    std::set<Index> on_sides;
    for (unsigned i = 0; i < 3; ++i) {
      const std::vector<Index> points = cuts_.chain(corners[i], corners[(i + 1) % 3]);
      on_sides.insert(points.begin(), points.end());
    }
    for (const Edge& edge : edges) {
      const std::vector<SnapCuts::OnEdge>* crossings = cuts_.on(edge);
      if (crossings == nullptr) continue;
      for (const SnapCuts::OnEdge& crossing : *crossings) {
        state_.work().spend(1 + cuts_.points_inside(t));
        if (on_sides.count(crossing.point) == 0) cuts_.add_if_inside(t, crossing.point);
      }
    }
  });
}

// Adds to t the corners of s that are near t, except corners that both have, and records the edges at the
// added corners.
void Overlay::find_near_corners(Index s, Index t) {
  const Corners& corners = state_.draft().triangles[t];
  for (unsigned k = 0; k < 3; ++k) {
    const Index p = state_.draft().triangles[s][k];
    if (std::find(corners.begin(), corners.end(), p) != corners.end() || !cuts_.add_if_inside(t, p)) continue;
    cuts_.add_along(t, edge_key(p, state_.draft().triangles[s][(k + 1) % 3]));
    cuts_.add_along(t, edge_key(p, state_.draft().triangles[s][(k + 2) % 3]));
  }
}

// Returns whether the edge is farther than the limit from the plane of a triangle.
bool Overlay::beyond(const Edge& edge, Index t) const {
  const Vector& normal = state_.triangles().normal(t);
  const Point& origin = state_.draft().corner(t, 0);
  const double a = dot(normal, at(edge[0]) - origin), b = dot(normal, at(edge[1]) - origin);
  const double reach = beyond_plane * state_.limit();
  return std::min(a, b) > reach || std::max(a, b) < -reach;
}

void Overlay::find_crossings(Index s, Index t) {
  for (unsigned i = 0; i < 3; ++i) {
    const Edge e = edge_key(state_.draft().triangles[s][i], state_.draft().triangles[s][(i + 1) % 3]);
    if (beyond(e, t)) continue;
    for (unsigned j = 0; j < 3; ++j) {
      const Edge f = edge_key(state_.draft().triangles[t][j], state_.draft().triangles[t][(j + 1) % 3]);
      if (!consider_crossing(e, f)) continue;
      cuts_.add_along(s, f);
      cuts_.add_along(t, e);
    }
  }
}

// Adds a new point between two edges that pass each other closely, away from their ends. Returns whether both
// edges get a common point in this run.
bool Overlay::consider_crossing(const Edge& e, const Edge& f) {
  if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return false;
  const Point &p = at(e[0]), &r = at(f[0]);
  const Vector u = at(e[1]) - p, v = at(f[1]) - r, w = p - r;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 1e-12 * uu * vv)) return false;  // almost parallel: their ends are near each other
  const double a = (uv * vw - vv * uw) / determinant, b = (uu * vw - uv * uw) / determinant;
  if (!(a > 0 && a < 1 && b > 0 && b < 1)) return false;
  const Point on_e = p + a * u, on_f = r + b * v;
  const double d = distance(on_e, on_f);
  if (d > state_.limit()) return false;
  for (const auto& [end, on] : {std::pair{e[0], on_f}, {e[1], on_f}, {f[0], on_e}, {f[1], on_e}})
    if (distance(at(end), on) <= state_.limit())
      return false;  // this end is near the other edge, so
                     // no new point is needed
  const auto key = e < f ? std::pair{e, f} : std::pair{f, e};
  if (crossing_.count(key) > 0) return true;
  if (!crossed_before_.insert(key).second) return false;
  crossing_.insert(key);
  const Index point = crossing_at(on_e, on_f);
  for (const Edge& edge : {e, f}) {
    const double parameter = parameter_on_segment(at(point), at(edge[0]), at(edge[1]));
    const Point foot = at(edge[0]) + parameter * (at(edge[1]) - at(edge[0]));
    cuts_.add(edge, {parameter, point}, distance(at(point), foot));
  }
  return true;
}

// Returns the point for a crossing. If more than two edges cross at a place, all get the same point.
Index Overlay::crossing_at(const Point& on_e, const Point& on_f) {
  const Point p = 0.5 * (on_e + on_f);
  const Index known = crossing_points_.nearest(p, [&](Index q) {
    return q >= first_ && distance(at(q), on_e) <= state_.limit() && distance(at(q), on_f) <= state_.limit();
  });
  if (known != none) return known;
  const auto added = static_cast<Index>(state_.draft().points.size());
  state_.draft().points.push_back(p);
  state_.draft().point_tags.push_back(0);
  crossing_points_.add(added);
  return added;
}

}  // namespace collarmesh::repairing
