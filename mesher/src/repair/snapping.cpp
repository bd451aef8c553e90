#include "repair/snapping.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <unordered_map>

#include "common/box_tree.h"
#include "plc/edges.h"
#include "repair/arrangement.h"

namespace collarmesh::repairing {

namespace {

using namespace build;
using Edge = std::array<Index, 2>;

constexpr std::size_t most_rounds = 50;
constexpr std::size_t most_places = 100;

Edge edge_key(Index a, Index b) { return a < b ? Edge{a, b} : Edge{b, a}; }

// Points in a grid of cells as large as the distance that is looked for.
class PointGrid {
 public:
  PointGrid(const std::vector<Point>& points, double cell) : points_(points), cell_(cell) {}

  void add(Index p) { cells_[key(cell_of(points_[p]))].push_back(p); }

  /// The nearest one within the distance, none if there is none.
  Index nearest(const Point& p, double distance_limit) const {
    const auto c = cell_of(p);
    Index best = none;
    double least = distance_limit * distance_limit;
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto found = cells_.find(key({c[0] + x, c[1] + y, c[2] + z}));
          if (found == cells_.end()) continue;
          for (const Index q : found->second) {
            const double d = squared_distance(p, points_[q]);
            if (d < least || (d == least && best == none)) {
              least = d;
              best = q;
            }
          }
        }
    return best;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const Point& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x / cell_)),
            static_cast<std::int64_t>(std::floor(p.y / cell_)),
            static_cast<std::int64_t>(std::floor(p.z / cell_))};
  }
  // Cells that share a key only cost time.
  static std::uint64_t key(const Cell& c) {
    std::uint64_t h = 0;
    for (const std::int64_t i : c)
      h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15ULL, h ^= h >> 31U;
    return h;
  }

  const std::vector<Point>& points_;
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<Index>> cells_;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel,
                                                CGAL::Triangulation_face_base_with_info_2<bool, Kernel>>;
using PlaneTriangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel,
                                               CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;

// Cuts a polygon that is nearly plane into triangles, with points and edges inside.
class PolygonCutter {
 public:
  PolygonCutter(const std::vector<Point>& points, const Vector& normal) : points_(points) {
    const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
    axis_ = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    turned_ = normal[axis_] < 0;
  }

  /// Nothing where its edges cross each other, seen along the normal.
  std::optional<std::vector<build::Corners>> cut(const std::vector<Index>& polygon, const std::vector<Index>& inside,
                                                 const std::vector<Edge>& constraints) {
    PlaneTriangulation mesh;
    std::map<Index, PlaneTriangulation::Vertex_handle> handles;
    const auto insert = [&](Index p) {
      const auto [at, added] = handles.try_emplace(p);
      if (added) {
        const std::size_t before = mesh.number_of_vertices();
        at->second = mesh.insert(Kernel::Point_2(points_[p][(axis_ + 1) % 3], points_[p][(axis_ + 2) % 3]));
        if (mesh.number_of_vertices() == before) return false;  // above another one
        at->second->info() = p;
      }
      return true;
    };
    try {
      for (const auto* list : {&polygon, &inside})
        for (const Index p : *list)
          if (!insert(p)) return std::nullopt;
      for (std::size_t i = 0; i < polygon.size(); ++i)
        mesh.insert_constraint(handles[polygon[i]], handles[polygon[(i + 1) % polygon.size()]]);
      for (const auto& [a, b] : constraints)
        if (handles.count(a) > 0 && handles.count(b) > 0 && a != b) mesh.insert_constraint(handles[a], handles[b]);
    } catch (const PlaneTriangulation::Intersection_of_constraints_exception&) {
      return std::nullopt;
    }
    mark_outside(mesh, polygon);
    return triangles(mesh, polygon);
  }

 private:
  void mark_outside(PlaneTriangulation& mesh, const std::vector<Index>& polygon) const {
    std::set<Edge> border;
    for (std::size_t i = 0; i < polygon.size(); ++i)
      border.insert(edge_key(polygon[i], polygon[(i + 1) % polygon.size()]));
    for (const auto face : mesh.all_face_handles()) face->info() = false;
    std::vector<PlaneTriangulation::Face_handle> stack{mesh.infinite_face()};
    stack.back()->info() = true;
    while (!stack.empty()) {
      const auto face = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const auto next = face->neighbor(i);
        if (next->info()) continue;
        const auto a = face->vertex(mesh.cw(i)), b = face->vertex(mesh.ccw(i));
        if (!mesh.is_infinite(a) && !mesh.is_infinite(b) && border.count(edge_key(a->info(), b->info())) > 0) continue;
        next->info() = true;
        stack.push_back(next);
      }
    }
  }

  // Nothing unless they have the polygon for a border.
  std::optional<std::vector<build::Corners>> triangles(PlaneTriangulation& mesh,
                                                       const std::vector<Index>& polygon) const {
    std::vector<build::Corners> result;
    std::set<Edge> sides;
    for (const auto face : mesh.finite_face_handles()) {
      if (face->info()) continue;
      build::Corners t{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
      if (turned_) std::swap(t[1], t[2]);
      result.push_back(t);
      for (unsigned i = 0; i < 3; ++i) sides.insert({t[i], t[(i + 1) % 3]});
    }
    for (std::size_t i = 0; i < polygon.size(); ++i)
      if (sides.count({polygon[i], polygon[(i + 1) % polygon.size()]}) == 0) return std::nullopt;
    return result;
  }

  const std::vector<Point>& points_;
  unsigned axis_;
  bool turned_;
};

// What has not been looked at yet, in `Origin::facet`, which means nothing else here.
constexpr Index unseen_by_corners = 1, unseen_by_overlay = 2, unseen = 3;

struct NearestOnSegment {
  double distance, parameter;
};

NearestOnSegment nearest_on_segment(const Point& p, const Point& a, const Point& b) {
  const Vector d = b - a;
  const double length = squared_norm(d);
  const double t = length > 0 ? std::clamp(dot(p - a, d) / length, 0.0, 1.0) : 0;
  return {distance(p, a + t * d), t};
}

class Snapper {
 public:
  Snapper(Draft& draft, double distance_limit, SnapWhat what)
      : draft_(draft), limit_(distance_limit), what_(what) {}

  SnapReport run() {
    report_.cancelled_triangles += cancel_twins(draft_);
    for (Origin& origin : draft_.origins) origin.facet = unseen;
    const std::size_t most_triangles = 2 * draft_.triangles.size() + 1000;
    Draft before = draft_;
    SnapReport report_before;
    if (!snap_all_corners(most_triangles)) return give_back(before, report_before);
    if (what_ != SnapWhat::all) return std::move(report_);
    // Overlays make new corners. They end where each makes fewer of them.
    before = draft_;
    report_before = report_;
    for (std::size_t crossings = none;;) {
      if (!overlay()) return std::move(report_);
      const std::size_t count = crossing_.size() + inside_.size();
      report_.cancelled_triangles += cancel_twins(draft_);
      if (2 * count > crossings || !snap_all_corners(most_triangles)) return give_back(before, report_before);
      crossings = count;
    }
  }

 private:
  struct OnEdge {
    double parameter;  // from the smaller end
    Index point;
  };

  SnapReport give_back(Draft& before, SnapReport& report) {
    draft_ = std::move(before);
    return std::move(report);
  }

  // Until nothing is near or many rounds are over; false where triangles grow and grow.
  bool snap_all_corners(std::size_t most_triangles) {
    for (std::size_t round = 0; round < most_rounds; ++round) {
      const bool merged = merge_points(), snapped = snap_corners();
      if (!merged && !snapped) return true;
      report_.cancelled_triangles += cancel_twins(draft_);
      if (draft_.triangles.size() > most_triangles) return false;
    }
    return true;
  }

  const Point& at(Index p) const { return draft_.points[p]; }

  void note(const Point& where, double moved) {
    report_.largest_distance = std::max(report_.largest_distance, moved);
    if (report_.places.size() < most_places) report_.places.push_back(where);
  }

  // Which points take part, by index.
  std::vector<bool> active_points() const {
    std::vector<bool> active(draft_.points.size(), false);
    if (what_ != SnapWhat::borders) {
      for (const build::Corners& t : draft_.triangles)
        for (const Index p : t) active[p] = true;
      for (const Segment& s : draft_.segments) active[s.a] = active[s.b] = true;
      for (const Index p : draft_.loose_points) active[p] = true;
      return active;
    }
    const EdgeTable edges(draft_.triangles, draft_.points.size());
    for (Index e = 0; e < edges.size(); ++e)
      if (edges.sides(e).size() == 1)
        for (const Index p : edges.ends(e)) active[p] = true;
    return active;
  }

  bool merge_points() {
    const std::vector<bool> active = active_points();
    std::vector<Index> order, merged(draft_.points.size());
    std::iota(merged.begin(), merged.end(), Index{0});
    for (Index p = 0; p < draft_.points.size(); ++p)
      if (active[p]) order.push_back(p);
    // An order that does not depend on that of the input.
    std::sort(order.begin(), order.end(), [&](Index p, Index q) {
      const Point &a = at(p), &b = at(q);
      return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z != b.z ? a.z < b.z : p < q;
    });
    PointGrid grid(draft_.points, limit_);
    std::size_t count = 0;
    for (const Index p : order) {
      const Index near = grid.nearest(at(p), limit_);
      if (near == none) {
        grid.add(p);
        continue;
      }
      merged[p] = near;
      ++count;
      note(at(near), distance(at(p), at(near)));
    }
    if (count == 0) return false;
    report_.merged_points += count;
    rename(merged);
    return true;
  }

  void rename(const std::vector<Index>& merged) {
    std::size_t kept = 0;
    for (Index t = 0; t < draft_.triangles.size(); ++t) {
      build::Corners corners = draft_.triangles[t];
      for (Index& c : corners) c = merged[c];
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
      Origin origin = draft_.origins[t];
      if (corners != draft_.triangles[t]) origin.facet = unseen;
      draft_.triangles[kept] = corners;
      draft_.origins[kept++] = origin;
    }
    draft_.triangles.resize(kept);
    draft_.origins.resize(kept);
    for (Segment& s : draft_.segments) s = {merged[s.a], merged[s.b], s.tag, s.soup};
    std::erase_if(draft_.segments, [](const Segment& s) { return s.a == s.b; });
    for (Index& p : draft_.loose_points) p = merged[p];
  }

  // The pairs of triangles that come near each other and were not looked at yet.
  template <class Visit>
  void for_each_near_pair(Index flag, const Visit& visit) {
    edges_.emplace(draft_.triangles, draft_.points.size());
    std::vector<Box> boxes(draft_.triangles.size());
    const Vector reach = 0.5 * limit_ * Vector{1, 1, 1};
    for (Index t = 0; t < boxes.size(); ++t)
      for (unsigned i = 0; i < 3; ++i) {
        boxes[t].add(draft_.corner(t, i) - reach);
        boxes[t].add(draft_.corner(t, i) + reach);
      }
    std::vector<Vector> normals(boxes.size());
    for (Index t = 0; t < normals.size(); ++t) {
      normals[t] = cross(draft_.corner(t, 1) - draft_.corner(t, 0), draft_.corner(t, 2) - draft_.corner(t, 0));
      const double length = norm(normals[t]);
      if (length > 0) normals[t] = normals[t] / length;
    }
    BoxTree(boxes).for_each_pair([&](Index s, Index t) {
      if (((draft_.origins[s].facet | draft_.origins[t].facet) & flag) == 0) return;
      if (beyond(s, t, normals[s]) || beyond(t, s, normals[t])) return;
      visit(std::min(s, t), std::max(s, t));
    });
  }

  // Does t keep its distance from the plane of s?
  bool beyond(Index s, Index t, const Vector& normal) const {
    const Point& origin = draft_.corner(s, 0);
    double low = INFINITY, high = -INFINITY;
    for (unsigned i = 0; i < 3; ++i) {
      const double height = dot(normal, draft_.corner(t, i) - origin);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    return low > limit_ || high < -limit_;
  }

  void clear() {
    on_edge_.clear();
    inside_.clear();
    crossing_.clear();
    along_.clear();
  }

  bool may_snap(Index triangle, unsigned side) const {
    return what_ != SnapWhat::borders || edges_->sides(edges_->edge_of(3 * triangle + side)).size() == 1;
  }

  // A corner near an edge that it is no end of.
  struct NearEdge {
    double length, distance;  // of the edge, and to it
    Edge edge;
    OnEdge corner;

    friend bool operator<(const NearEdge& a, const NearEdge& b) {
      return std::tie(b.length, a.distance, a.edge, a.corner.point) <
             std::tie(a.length, b.distance, b.edge, b.corner.point);
    }
  };

  // Edges get the corners near them, the longest first. In one round a triangle is cut at one of its sides only.
  bool snap_corners() {
    clear();
    std::vector<NearEdge> found;
    for_each_near_pair(unseen_by_corners, [&](Index s, Index t) {
      find_near_edges(s, t, found);
      find_near_edges(t, s, found);
    });
    for (Index t = 0; t < draft_.triangles.size(); ++t) {
      if ((draft_.origins[t].facet & unseen_by_corners) == 0) continue;
      for (unsigned i = 0; i < 3; ++i) find_near_edge(t, i, draft_.triangles[t][(i + 2) % 3], found);
      draft_.origins[t].facet &= ~unseen_by_corners;
    }
    std::sort(found.begin(), found.end());
    std::vector<Edge> cut(draft_.triangles.size(), Edge{none, none});  // at which side
    for (const NearEdge& near : found) {
      const auto sides = edges_->sides(edges_->find(near.edge[0], near.edge[1]));
      const bool independent = std::all_of(sides.begin(), sides.end(), [&](Index side) {
        return cut[side / 3][0] == none || cut[side / 3] == near.edge;
      });
      if (!independent || !has_room(near)) {
        for (const Index side : sides) draft_.origins[side / 3].facet |= unseen_by_corners;
        continue;
      }
      if (!may_cut(near, sides)) continue;
      for (const Index side : sides) cut[side / 3] = near.edge;
      add_on_edge(near.edge, near.corner, near.distance);
    }
    if (on_edge_.empty()) return false;
    apply();
    return true;
  }

  // Edges that arise are shorter than the one that is cut, or it is cut for the first time: so it ends.
  bool may_cut(const NearEdge& near, std::span<const Index> sides) {
    const bool shorter = std::all_of(sides.begin(), sides.end(), [&](Index side) {
      const Index opposite = apex(draft_.triangles, side);
      return opposite == near.corner.point || distance(at(opposite), at(near.corner.point)) < near.length;
    });
    return shorter || cut_before_.insert(near.edge).second;
  }

  // Is it away from the other corners that the edge gets?
  bool has_room(const NearEdge& near) const {
    const auto found = on_edge_.find(near.edge);
    if (found == on_edge_.end()) return true;
    const double length = distance(at(near.edge[0]), at(near.edge[1]));
    return std::all_of(found->second.begin(), found->second.end(), [&](const OnEdge& o) {
      return std::fabs(o.parameter - near.corner.parameter) * length > 2 * limit_;
    });
  }

  void find_near_edges(Index s, Index t, std::vector<NearEdge>& found) const {
    const build::Corners& corners = draft_.triangles[t];
    for (const Index p : draft_.triangles[s])
      if (std::find(corners.begin(), corners.end(), p) == corners.end())
        for (unsigned i = 0; i < 3; ++i) find_near_edge(t, i, p, found);
  }

  void find_near_edge(Index t, unsigned i, Index p, std::vector<NearEdge>& found) const {
    if (!may_snap(t, i)) return;
    const Edge key = edge_key(draft_.triangles[t][i], draft_.triangles[t][(i + 1) % 3]);
    const auto [d, parameter] = nearest_on_segment(at(p), at(key[0]), at(key[1]));
    if (d <= limit_ && parameter > 0 && parameter < 1) found.push_back({distance(at(key[0]), at(key[1])), d, key, {parameter, p}});
  }

  // Triangles that run along each other get each other's corners and edges.
  bool overlay() {
    clear();
    for_each_near_pair(unseen_by_overlay, [&](Index s, Index t) {
      find_near_corners(s, t);
      find_near_corners(t, s);
      find_crossings(s, t);
    });
    for (Origin& origin : draft_.origins) origin.facet &= ~unseen_by_overlay;
    if (on_edge_.empty() && inside_.empty()) return false;
    apply();
    return true;
  }

  // Those corners of s that t does not have.
  void find_near_corners(Index s, Index t) {
    const build::Corners& corners = draft_.triangles[t];
    for (unsigned k = 0; k < 3; ++k) {
      const Index p = draft_.triangles[s][k];
      if (std::find(corners.begin(), corners.end(), p) != corners.end() || !consider_inside(t, p)) continue;
      along_[t].push_back(edge_key(p, draft_.triangles[s][(k + 1) % 3]));
      along_[t].push_back(edge_key(p, draft_.triangles[s][(k + 2) % 3]));
    }
  }

  void add_on_edge(const Edge& key, const OnEdge& point, double moved) {
    auto& points = on_edge_[key];
    if (std::any_of(points.begin(), points.end(), [&](const OnEdge& o) { return o.point == point.point; })) return;
    if (points.empty()) ++report_.cut_edges;
    points.push_back(point);
    note(at(point.point), moved);
  }

  bool consider_inside(Index t, Index p) {
    const Point &a = draft_.corner(t, 0), &b = draft_.corner(t, 1), &c = draft_.corner(t, 2), &q = at(p);
    const Vector n = cross(b - a, c - a);
    const double nn = squared_norm(n);
    if (!(nn > 0)) return false;
    const double height = std::fabs(dot(q - a, n)) / std::sqrt(nn);
    if (height > limit_) return false;
    if (dot(cross(b - a, q - a), n) <= 0 || dot(cross(c - b, q - b), n) <= 0 || dot(cross(a - c, q - c), n) <= 0)
      return false;
    auto& points = inside_[t];
    if (std::find(points.begin(), points.end(), p) != points.end()) return true;
    if (points.empty()) ++report_.cut_triangles;
    points.push_back(p);
    note(q, height);
    return true;
  }

  void find_crossings(Index s, Index t) {
    for (unsigned i = 0; i < 3; ++i)
      for (unsigned j = 0; j < 3; ++j)
      {
        const Edge e = edge_key(draft_.triangles[s][i], draft_.triangles[s][(i + 1) % 3]),
                   f = edge_key(draft_.triangles[t][j], draft_.triangles[t][(j + 1) % 3]);
        if (!consider_crossing(e, f)) continue;
        along_[s].push_back(f);
        along_[t].push_back(e);
      }
  }

  // Two edges that pass each other closely, away from their ends: a new point in between.
  bool consider_crossing(const Edge& e, const Edge& f) {
    if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return false;
    const Point &p = at(e[0]), &r = at(f[0]);
    const Vector u = at(e[1]) - p, v = at(f[1]) - r, w = p - r;
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-12 * uu * vv)) return false;  // parallel: their ends are near
    const double a = (uv * vw - vv * uw) / determinant, b = (uu * vw - uv * uw) / determinant;
    if (!(a > 0 && a < 1 && b > 0 && b < 1)) return false;
    const Point on_e = p + a * u, on_f = r + b * v;
    const double d = distance(on_e, on_f);
    if (d > limit_) return false;
    for (const auto& [end, on] : {std::pair{e[0], on_f}, {e[1], on_f}, {f[0], on_e}, {f[1], on_e}})
      if (distance(at(end), on) <= limit_) return false;  // that end is near
    const auto key = e < f ? std::pair{e, f} : std::pair{f, e};
    if (!crossing_.insert(key).second) return true;
    if (!crossed_before_.insert(key).second) return false;
    const auto middle = static_cast<Index>(draft_.points.size());
    draft_.points.push_back(0.5 * (on_e + on_f));
    draft_.point_tags.push_back(0);
    add_on_edge(e, {a, middle}, 0.5 * d);
    add_on_edge(f, {b, middle}, 0.5 * d);
    return true;
  }

  void apply() {
    for (auto& [edge, points] : on_edge_)
      std::sort(points.begin(), points.end(), [](const OnEdge& a, const OnEdge& b) {
        return a.parameter != b.parameter ? a.parameter < b.parameter : a.point < b.point;
      });
    std::vector<build::Corners> before = std::move(draft_.triangles);
    const std::vector<Origin> origins = std::move(draft_.origins);
    draft_.triangles.clear();
    draft_.origins.clear();
    for (Index t = 0; t < before.size(); ++t) cut(t, before[t], origins[t]);
    std::vector<Segment> segments;
    for (const Segment& s : draft_.segments) {
      const std::vector<Index> points = chain(s.a, s.b);
      for (std::size_t i = 0; i + 1 < points.size(); ++i)
        if (points[i] != points[i + 1]) segments.push_back({points[i], points[i + 1], s.tag, s.soup});
    }
    draft_.segments = std::move(segments);
  }

  void cut(Index t, const build::Corners& corners, Origin origin) {
    std::vector<Index> polygon;
    for (unsigned i = 0; i < 3; ++i) {
      const std::vector<Index> points = chain(corners[i], corners[(i + 1) % 3]);
      polygon.insert(polygon.end(), points.begin(), points.end() - 1);
    }
    const auto found = inside_.find(t);
    if (polygon.size() == 3 && found == inside_.end()) {
      draft_.add_triangle(corners, origin);
      return;
    }
    origin.facet = unseen;
    const std::vector<Index> inside = found == inside_.end() ? std::vector<Index>() : found->second;
    std::vector<Index> sorted = polygon;
    std::sort(sorted.begin(), sorted.end());
    const bool simple = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
    // A plain step cuts from the opposite corner; a triangulation might take the old edge again.
    const bool plain = inside.empty() && along_.empty();
    if (simple && !plain) {
      const Vector normal = cross(at(corners[1]) - at(corners[0]), at(corners[2]) - at(corners[0]));
      if (const auto pieces = PolygonCutter(draft_.points, normal).cut(polygon, inside, constraints(t, corners))) {
        for (const build::Corners& piece : *pieces) draft_.add_triangle(piece, origin);
        return;
      }
    }
    std::vector<build::Corners> pieces{corners};
    for (const Index p : inside) insert(p, pieces);
    for (const build::Corners& piece : pieces) add_cut(piece, origin);
  }

  // The pieces of other triangles' edges that run along a triangle, inside it.
  std::vector<Edge> constraints(Index t, const build::Corners& corners) const {
    std::vector<Edge> result;
    const auto found = along_.find(t);
    if (found == along_.end()) return result;
    std::map<Index, unsigned> sides;  // by point: bits of the sides it is on, 8 inside
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

  // A corner for the piece that it is in, seen along its normal.
  void insert(Index p, std::vector<build::Corners>& pieces) const {
    std::size_t best = 0;
    double depth = -INFINITY;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const auto& [a, b, c] = pieces[i];
      if (a == p || b == p || c == p) return;
      const Vector n = cross(at(b) - at(a), at(c) - at(a));
      const double nn = squared_norm(n);
      if (!(nn > 0)) continue;
      const double least = std::min({dot(cross(at(b) - at(a), at(p) - at(a)), n),
                                     dot(cross(at(c) - at(b), at(p) - at(b)), n),
                                     dot(cross(at(a) - at(c), at(p) - at(c)), n)}) /
                           nn;
      if (least <= depth) continue;
      depth = least;
      best = i;
    }
    const build::Corners t = pieces[best];
    pieces[best] = {t[0], t[1], p};
    pieces.push_back({t[1], t[2], p});
    pieces.push_back({t[2], t[0], p});
  }

  // From a to b, both included.
  std::vector<Index> chain(Index a, Index b) const {
    std::vector<Index> points{a};
    if (const auto found = on_edge_.find(edge_key(a, b)); found != on_edge_.end()) {
      for (const OnEdge& o : found->second) points.push_back(o.point);
      if (a > b) std::reverse(points.begin() + 1, points.end());
    }
    points.push_back(b);
    return points;
  }

  // Each step fans the apex opposite one cut side.
  void add_cut(const build::Corners& triangle, const Origin& origin) {
    std::vector<std::pair<build::Corners, unsigned>> stack{{triangle, 0}};  // and which sides are done
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
          // Side 0 is a piece of an edge that is cut already; sides 1 and 2 are whole edges at the ends only.
          const bool first = k == 0, last = k + 2 == points.size();
          const unsigned side_after = done >> ((i + 1) % 3) & 1U, side_before = done >> ((i + 2) % 3) & 1U;
          const unsigned flags =
              1U | (last ? side_after : 1U) << 1U | (first ? side_before : 1U) << 2U;
          stack.push_back({{points[k], points[k + 1], apex}, flags});
        }
      }
      if (!cut && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) draft_.add_triangle(t, origin);
    }
  }

  Draft& draft_;
  double limit_;
  SnapWhat what_;
  SnapReport report_;
  std::optional<EdgeTable> edges_;
  std::set<Edge> cut_before_;
  std::map<Edge, std::vector<OnEdge>> on_edge_;
  std::map<Index, std::vector<Index>> inside_;  // by triangle
  std::map<Index, std::vector<Edge>> along_;      // by triangle: edges that come near it
  std::set<std::pair<Edge, Edge>> crossing_, crossed_before_;
};

}  // namespace

SnapReport snap_near_features(Draft& draft, double distance, SnapWhat what) {
  return Snapper(draft, distance, what).run();
}

std::size_t cancel_twins(Draft& draft) {
  struct Key {
    build::Corners corners;
    Index soup, triangle;
    bool odd;
  };
  std::vector<Key> keys(draft.triangles.size());
  for (Index t = 0; t < keys.size(); ++t) {
    build::Corners c = draft.triangles[t];
    const bool odd = (c[0] > c[1]) != ((c[1] > c[2]) != (c[0] > c[2]));
    std::sort(c.begin(), c.end());
    keys[t] = {c, draft.origins[t].soup, t, odd};
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.corners, a.soup, a.odd, a.triangle) < std::tie(b.corners, b.soup, b.odd, b.triangle);
  });
  std::vector<bool> removed(draft.triangles.size(), false);
  const auto same = [](const Key& a, const Key& b) { return a.corners == b.corners && a.soup == b.soup; };
  for (auto first = keys.begin(); first != keys.end();) {
    const auto last = std::find_if(first, keys.end(), [&](const Key& key) { return !same(key, *first); });
    const auto middle = std::find_if(first, last, [](const Key& key) { return key.odd; });
    if (draft.soup_is_complex[first->soup]) {
      for (auto key = first + 1; key != last; ++key) removed[key->triangle] = true;
    } else {
      for (auto even = first, odd = middle; even != middle && odd != last; ++even, ++odd)
        removed[even->triangle] = removed[odd->triangle] = true;
    }
    first = last;
  }
  std::size_t kept = 0;
  for (Index t = 0; t < draft.triangles.size(); ++t) {
    if (removed[t]) continue;
    draft.triangles[kept] = draft.triangles[t];
    draft.origins[kept++] = draft.origins[t];
  }
  const std::size_t count = draft.triangles.size() - kept;
  draft.triangles.resize(kept);
  draft.origins.resize(kept);
  return count;
}

}  // namespace collarmesh::repairing
