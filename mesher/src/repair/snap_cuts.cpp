#include "repair/snap_cuts.h"

#include <cmath>
#include <set>

#include "repair/polygon_cutter.h"

namespace collarmesh::repairing {

using namespace facets;

void SnapCuts::clear() {
  on_edge_.clear();
  inside_.clear();
  along_.clear();
}

void SnapCuts::add(const Edge& edge, const OnEdge& point, double moved) {
  using What = SnapState::Done::What;
  auto& points = on_edge_[edge];
  if (std::any_of(points.begin(), points.end(), [&](const OnEdge& o) { return o.point == point.point; }))
    return;
  state_.done().push_back({points.empty() ? What::cut_edge : What::more, point.point, moved});
  points.push_back(point);
}

bool SnapCuts::add_if_inside(Index t, Index p) {
  using What = SnapState::Done::What;
  const ComplexDraft& draft = state_.draft();
  const Point &a = draft.corner(t, 0), &b = draft.corner(t, 1), &c = draft.corner(t, 2), &q = at(p);
  const Vector n = cross(b - a, c - a);
  const double nn = squared_norm(n);
  if (!(nn > 0)) return false;
  const double height = std::fabs(dot(q - a, n)) / std::sqrt(nn);
  if (height > state_.limit()) return false;
  if (dot(cross(b - a, q - a), n) <= 0 || dot(cross(c - b, q - b), n) <= 0 ||
      dot(cross(a - c, q - c), n) <= 0)
    return false;
  auto& points = inside_[t];
  if (std::find(points.begin(), points.end(), p) != points.end()) return true;
  state_.done().push_back({points.empty() ? What::cut_triangle : What::more, p, height});
  points.push_back(p);
  return true;
}

const std::vector<SnapCuts::OnEdge>* SnapCuts::on(const Edge& edge) const {
  const auto found = on_edge_.find(edge);
  return found == on_edge_.end() ? nullptr : &found->second;
}

std::size_t SnapCuts::points_inside(Index triangle) const {
  const auto found = inside_.find(triangle);
  return found == inside_.end() ? 0 : found->second.size();
}

std::size_t SnapCuts::pieces() const {
  std::size_t count = 0;
  for (const auto& [edge, points] : on_edge_) count += points.size() * state_.triangles().sides(edge).size();
  return count;
}

void SnapCuts::apply() {
  ComplexDraft& draft = state_.draft();
  std::vector<Index> affected;
  for (auto& [edge, points] : on_edge_) {
    std::sort(points.begin(), points.end(), [](const OnEdge& a, const OnEdge& b) {
      return a.parameter != b.parameter ? a.parameter < b.parameter : a.point < b.point;
    });
    for (const Index side : state_.triangles().sides(edge)) affected.push_back(side / 3);
  }
  for (const auto& [t, points] : inside_) affected.push_back(t);
  std::sort(affected.begin(), affected.end());
  affected.erase(std::unique(affected.begin(), affected.end()), affected.end());
  state_.work().spend(affected.size());
  for (const Index t : affected) {
    const Corners corners = draft.triangles[t];
    const Origin origin = draft.origins[t];
    state_.take(t);
    cut(t, corners, origin);
  }
  cut_segments();
}

void SnapCuts::cut_segments() {
  if (on_edge_.empty()) return;
  ComplexDraft& draft = state_.draft();
  std::vector<Segment> segments;
  segments.reserve(draft.segments.size());
  for (const Segment& s : draft.segments) {
    const std::vector<Index> points = chain(s.a, s.b);
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      if (points[i] != points[i + 1]) segments.push_back({points[i], points[i + 1], s.tag, s.soup});
  }
  draft.segments = std::move(segments);
}

void SnapCuts::cut(Index t, const Corners& corners, const Origin& origin) {
  PolygonCuts cuts;
  for (unsigned i = 0; i < 3; ++i) {
    const std::vector<Index> points = chain(corners[i], corners[(i + 1) % 3]);
    cuts.border.insert(cuts.border.end(), points.begin(), points.end() - 1);
  }
  if (const auto found = inside_.find(t); found != inside_.end()) cuts.inside = found->second;
  std::vector<Index> sorted = cuts.border;
  std::sort(sorted.begin(), sorted.end());
  const bool simple = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  // If only sides are cut, cut from opposite corners: a triangulation might contain the whole side again.
  const bool plain = cuts.inside.empty() && along_.empty();
  if (simple && !plain) {
    const Vector normal = cross(at(corners[1]) - at(corners[0]), at(corners[2]) - at(corners[0]));
    cuts.edges = constraints(t, corners);
    if (const auto pieces = cut_polygon(state_.draft().points, normal, cuts)) {
      for (const Corners& piece : *pieces) state_.put(piece, origin);
      return;
    }
  }
  std::vector<Corners> pieces{corners};
  for (const Index p : cuts.inside) insert(p, pieces);
  for (const Corners& piece : pieces) add_cut(piece, origin);
}

// Returns the pieces of other triangles' edges that lie in a triangle and not on one of its sides.
std::vector<Edge> SnapCuts::constraints(Index t, const Corners& corners) const {
  std::vector<Edge> result;
  const auto found = along_.find(t);
  if (found == along_.end()) return result;
  std::map<Index, unsigned> sides;  // by point: bits of the sides that it is on; 8: inside
  for (unsigned i = 0; i < 3; ++i) {
    const std::vector<Index> points = chain(corners[i], corners[(i + 1) % 3]);
    for (const Index p : points) sides[p] |= 1U << i;
  }
  if (const auto inside = inside_.find(t); inside != inside_.end())
    for (const Index p : inside->second) sides[p] |= 8U;
  std::set<Edge> seen;
  for (const Edge& edge : found->second) {
    if (!seen.insert(edge).second) continue;
    const std::vector<Index> points = chain(edge[0], edge[1]);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const auto a = sides.find(points[i]), b = sides.find(points[i + 1]);
      if (a == sides.end() || b == sides.end() || (a->second & b->second & 7U) != 0) continue;
      result.push_back({points[i], points[i + 1]});
    }
  }
  return result;
}

// Inserts a point into the piece that contains it, in the projection along the piece's normal.
void SnapCuts::insert(Index p, std::vector<Corners>& pieces) const {
  std::size_t best = 0;
  double depth = -INFINITY;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& [a, b, c] = pieces[i];
    if (a == p || b == p || c == p) return;
    const Vector n = cross(at(b) - at(a), at(c) - at(a));
    const double nn = squared_norm(n);
    if (!(nn > 0)) continue;
    const double least =
        std::min({dot(cross(at(b) - at(a), at(p) - at(a)), n), dot(cross(at(c) - at(b), at(p) - at(b)), n),
                  dot(cross(at(a) - at(c), at(p) - at(c)), n)}) /
        nn;
    if (least <= depth) continue;
    depth = least;
    best = i;
  }
  const Corners t = pieces[best];
  pieces[best] = {t[0], t[1], p};
  pieces.push_back({t[1], t[2], p});
  pieces.push_back({t[2], t[0], p});
}

// Returns the points of an edge from a to b, both included.
std::vector<Index> SnapCuts::chain(Index a, Index b) const {
  std::vector<Index> points{a};
  if (const auto found = on_edge_.find(edge_key(a, b)); found != on_edge_.end()) {
    for (const OnEdge& o : found->second) points.push_back(o.point);
    if (a > b) std::reverse(points.begin() + 1, points.end());
  }
  points.push_back(b);
  return points;
}

// Cuts a triangle at the points on its sides. Each step makes a fan from the corner opposite a side with
// points.
void SnapCuts::add_cut(const Corners& triangle, const Origin& origin) {
  std::vector<std::pair<Corners, unsigned>> stack{{triangle, 0}};  // with flags of the finished sides
  while (!stack.empty()) {
    const auto [t, done] = stack.back();
    stack.pop_back();
    bool cut = false;
    for (unsigned i = 0; i < 3 && !cut; ++i) {
      if ((done >> i & 1U) != 0) continue;
      const std::vector<Index> points = chain(t[i], t[(i + 1) % 3]);
      if (points.size() == 2) continue;
      cut = true;
      const Index apex = t[(i + 2) % 3];
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        // Side 0 of a new triangle is a piece of a cut edge; sides 1 and 2 are whole edges only in the last
        // and the first triangle of the fan.
        const bool first = k == 0, last = k + 2 == points.size();
        const unsigned side_after = done >> ((i + 1) % 3) & 1U, side_before = done >> ((i + 2) % 3) & 1U;
        const unsigned flags = 1U | (last ? side_after : 1U) << 1U | (first ? side_before : 1U) << 2U;
        stack.push_back({{points[k], points[k + 1], apex}, flags});
      }
    }
    if (!cut && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) state_.put(t, origin);
  }
}

}  // namespace collarmesh::repairing
