#include "constrained/boundary_recovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "collarmesh/error.h"
#include "common/edge_key.h"
#include "delaunay/predicates.h"

namespace collarmesh::constrained {

namespace {

// Before an edge is removed, edges around it may be removed first, recursively to this depth.
constexpr unsigned most_depth = 2;
constexpr double most_errors = 512;  // rounding errors by which a point may be off its edge
// Largest and smallest distance from a flat tetrahedron at which a point beside it is tried, relative to the
// longest side of the crossed face.
constexpr double farthest_room = 0.1, nearest_room = 1e-6;
// After this many triangulated rings for one missing edge or facet, edges are removed only if no other edge
// has to be removed first.
constexpr std::size_t most_rings = 1000;
// Limit of added points: `most_times` times the number of points of the complex, plus `some`.
constexpr std::size_t most_times = 20, some = 1000;

bool same_sign(int a, int b, int c) { return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0); }

/// Returns whether the line from one vertex to another passes from one side of a triangle to the other,
/// through its interior or its border.
bool crosses(const Tetrahedra& mesh, Index from, Index to, const std::array<Index, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  return mesh.orientation(a, b, c, from) * mesh.orientation(a, b, c, to) < 0 &&
         same_sign(mesh.orientation(from, to, a, b), mesh.orientation(from, to, b, c),
                   mesh.orientation(from, to, c, a));
}

/// The obstacles to a missing edge: faces that it passes through.
class InTheWayOfEdge final : public Obstacles {
 public:
  InTheWayOfEdge(const Tetrahedra& mesh, Index a, Index b) : mesh_(mesh), a_(a), b_(b) {}

  int face(Index p, Index q, Index r) const override {
    for (const Index v : {p, q, r})
      if (v == a_ || v == b_) return 0;
    return crosses(mesh_, a_, b_, {p, q, r}) ? 1 : 0;
  }
  int edge(Index, Index) const override { return 0; }

 private:
  const Tetrahedra& mesh_;
  Index a_, b_;
};

/// The obstacles to a missing triangle: edges that pass through it.
class InTheWayOfFacet final : public Obstacles {
 public:
  InTheWayOfFacet(const Tetrahedra& mesh, const std::array<Index, 3>& corners)
      : mesh_(mesh), corners_(corners) {}

  int face(Index, Index, Index) const override { return 0; }
  int edge(Index p, Index q) const override {
    for (const Index v : corners_)
      if (v == p || v == q) return 0;
    return crosses(mesh_, p, q, corners_) ? 1 : 0;
  }

 private:
  const Tetrahedra& mesh_;
  std::array<Index, 3> corners_;
};

// Limit on the sum of two angles, radians: a little more than half a circle, so that edges are not flipped
// back and forth.
constexpr double straight_angle = 3.1415926536 + 1e-6;

double angle(const Point& a, const Point& at, const Point& b) {
  return std::atan2(norm(cross(a - at, b - at)), dot(a - at, b - at));
}

/// Returns whether the line cd separates a from b. Precondition: all four points lie in one plane. Exact:
/// decides in the projection along the axis nearest to the normal or, if this maps all points to a line,
/// along the next axis.
bool parts(const Point& c, const Point& d, const Point& a, const Point& b) {
  const Vector normal = cross(d - c, a - c);
  std::array<unsigned, 3> axes{0, 1, 2};
  std::ranges::stable_sort(axes, std::greater<>(), [&](unsigned axis) { return std::fabs(normal[axis]); });
  for (const unsigned axis : axes) {
    const auto flat = [axis](const Point& p) { return Point{p[(axis + 1) % 3], p[(axis + 2) % 3], 0}; };
    const Point low = flat(c), high = flat(d), above{low.x, low.y, 1};
    const int of_a = predicates::orientation(low, high, flat(a), above),
              of_b = predicates::orientation(low, high, flat(b), above);
    if (of_a * of_b < 0) return true;
    if (of_a * of_b > 0) return false;
  }
  return false;
}

/// Returns the place where the line ab meets the plane pqr, as a share of the distance from a to b.
double share_to_plane(const Point& a, const Point& b, const Point& p, const Point& q, const Point& r) {
  const double from = std::fabs(six_volume(p, q, r, a)), to = std::fabs(six_volume(p, q, r, b));
  return from + to > 0 ? from / (from + to) : 0.5;
}

}  // namespace

BoundaryRecovery::BoundaryRecovery(Tetrahedra& mesh, const Plc& plc, RecoveryWay way)
    : mesh_(mesh),
      plc_(plc),
      way_(way),
      changes_(mesh, required_),
      most_added_(most_times * plc.points.size() + some) {
  assert(
      mesh.point_count() >= plc.points.size() &&
      (plc.points.empty() || (mesh.point(0) == plc.points.front() &&
                              mesh.point(static_cast<Index>(plc.points.size() - 1)) == plc.points.back())));
  for (const Plc::Triangle& t : plc.triangles) add_facet(t.points, t.patch);
  for (Index c = 0; c < plc.curves.size(); ++c) {
    const auto& points = plc.curves[c].points;
    for (std::size_t i = plc.curves[c].closed ? 0 : 1; i < points.size(); ++i)
      require(points[i == 0 ? points.size() - 1 : i - 1], points[i]).curve = c;
  }
  make_planar_facets_delaunay();
  if (way_.reversed) std::ranges::reverse(edges_to_do_);
}

/// Flips edges between facets in one plane, so that most of these edges belong to Delaunay tetrahedra.
void BoundaryRecovery::make_planar_facets_delaunay() {
  std::vector<std::uint64_t> to_do;
  to_do.reserve(edges_to_do_.size());
  for (const EdgeToDo& edge : edges_to_do_) to_do.push_back(edge_key(edge.a, edge.b));
  while (!to_do.empty()) {
    const std::uint64_t key = to_do.back();
    to_do.pop_back();
    turn_edge(key, straight_angle, to_do);
  }
  std::erase_if(edges_to_do_, [&](const EdgeToDo& e) { return !required_.contains(edge_key(e.a, e.b)); });
}

/// Flips an edge between two facets in one plane if the sum of the angles opposite it is at least
/// `least_angles` (radians). Then adds the four edges around it to `changed`.
bool BoundaryRecovery::turn_edge(std::uint64_t key, double least_angles,
                                 std::vector<std::uint64_t>& changed) {
  const auto at = edges_.find(key);
  if (at == edges_.end() || at->second.curve != none || at->second.facets.size() != 2) return false;
  const auto [f, g] = std::array{at->second.facets[0], at->second.facets[1]};
  const Facet first = facets_[f], second = facets_[g];
  if (first.patch != second.patch) return false;
  const auto a = static_cast<Index>(key >> 32U), b = static_cast<Index>(key);
  const auto third = [&](const Facet& facet) {
    return *std::ranges::find_if(facet.corners, [&](Index v) { return v != a && v != b; });
  };
  const Index c = third(first), d = third(second);
  if (required_.contains(edge_key(c, d))) return false;
  if (!plc_.patches[first.patch].planar && mesh_.orientation(a, b, c, d) != 0) return false;
  const Point &pa = mesh_.point(a), &pb = mesh_.point(b), &pc = mesh_.point(c), &pd = mesh_.point(d);
  if (angle(pa, pc, pb) + angle(pa, pd, pb) < least_angles) return false;
  if (!parts(pc, pd, pa, pb) || !parts(pa, pb, pc, pd)) return false;
  remove_facet(f), remove_facet(g);
  edges_.erase(key);
  required_.erase(key);
  for (const Index end : {a, b}) {
    std::array<Index, 3> corners = first.corners;
    std::ranges::replace(corners, end == a ? b : a, d);
    add_facet(corners, first.patch);
  }
  for (const Index end : {a, b})
    for (const Index tip : {c, d}) changed.push_back(edge_key(end, tip));
  return true;
}

/// Flips an edge between two facets in one plane, unless that was tried before.
bool BoundaryRecovery::turn_once(Index a, Index b) {
  std::vector<std::uint64_t> around;
  return turned_.insert(edge_key(a, b)).second && turn_edge(edge_key(a, b), 0, around);
}

BoundaryRecovery::RequiredEdge& BoundaryRecovery::require(Index a, Index b) {
  const std::uint64_t key = edge_key(a, b);
  if (required_.insert(key).second) edges_to_do_.push_back({a, b, 0});
  return edges_[key];
}

void BoundaryRecovery::add_facet(const std::array<Index, 3>& corners, Index patch) {
  const auto number = static_cast<Index>(facets_.size());
  facets_.push_back({corners, patch});
  facets_to_do_.push_back(number);
  for (unsigned i = 0; i < 3; ++i) require(corners[i], corners[(i + 1) % 3]).facets.push_back(number);
}

void BoundaryRecovery::remove_facet(Index facet) {
  Facet& f = facets_[facet];
  f.alive = false;
  for (unsigned i = 0; i < 3; ++i)
    std::erase(edges_[edge_key(f.corners[i], f.corners[(i + 1) % 3])].facets, facet);
}

/// Replaces a required edge by two edges, and each triangle at it by two.
void BoundaryRecovery::divide_required(Index a, Index b, Index x) {
  const auto at = edges_.find(edge_key(a, b));
  const RequiredEdge edge = at->second;
  for (const Index f : edge.facets) remove_facet(f);
  edges_.erase(edge_key(a, b));
  required_.erase(edge_key(a, b));
  for (const Index end : {a, b})
    if (RequiredEdge& half = require(end, x); edge.curve != none) half.curve = edge.curve;
  for (const Index f : edge.facets)
    for (const Index end : {a, b}) {
      std::array<Index, 3> corners = facets_[f].corners;
      if (std::ranges::find(corners, x) != corners.end()) continue;  // this half of the facet is degenerate
      std::ranges::replace(corners, end, x);
      add_facet(corners, facets_[f].patch);
    }
}

bool BoundaryRecovery::run(const std::function<bool()>& go_on) {
  while (!edges_to_do_.empty() || !facets_to_do_.empty()) {
    if (!go_on()) return false;
    if (!edges_to_do_.empty()) {
      const EdgeToDo edge = edges_to_do_.front();
      edges_to_do_.pop_front();
      if (required_.contains(edge_key(edge.a, edge.b))) recover_edge(edge);
      continue;
    }
    const Index facet = facets_to_do_.front();
    facets_to_do_.pop_front();
    if (facets_[facet].alive) recover_facet(facet);
  }
  return true;
}

/// Makes a change, and undoes it unless it leaves fewer obstacles.
bool BoundaryRecovery::reduce(const std::function<std::optional<int>()>& change) {
  const std::size_t before = mesh_.mark();
  const std::optional<int> gain = change();
  if (gain && *gain < 0) {
    mesh_.keep();
    return true;
  }
  mesh_.undo_to(before);
  return false;
}

/// Recovers an edge, or divides it. If changes to the edge's depth do not suffice, puts it at the end of the
/// queue with a larger depth.
void BoundaryRecovery::recover_edge(const EdgeToDo& edge) {
  const auto [a, b, depth] = edge;
  const InTheWayOfEdge obstacles(mesh_, a, b);
  changes_.set_budget(most_rings);
  std::vector<CrossedFace> crossed;
  while (mesh_.tet_at(a, b) == none) {
    if (const Index vertex = find_crossed(a, b, crossed); vertex != none) {
      divide_required(a, b, vertex);
      return;
    }
    if (clear_edge(crossed, obstacles, depth)) continue;
    if (depth < most_depth) {
      edges_to_do_.push_back({a, b, depth + 1});
      return;
    }
    if (way_.turns_first && turn_once(a, b)) return;
    const Index x = divide_at_crossing(a, b, crossed);
    if (x == none) {
      if (turn_once(a, b)) return;
      if (!add_room(crossed)) fail(a, "An edge");
      edges_to_do_.push_back({a, b, 0});
    } else {
      divide_required(a, b, x);
    }
    return;
  }
}

/// Finds the faces that the interior of ab meets. Returns a vertex that lies on ab, or none.
Index BoundaryRecovery::find_crossed(Index a, Index b, std::vector<CrossedFace>& crossed) const {
  crossed.clear();
  const InTheWayOfEdge obstacles(mesh_, a, b);
  std::vector<Index> tets;
  mesh_.star(a, tets);
  std::unordered_set<Index> seen;
  std::vector<Index> next;
  const auto look_at = [&](const Tetrahedra::Face& face) {
    const auto [p, q, r] = side_corners(mesh_.corners(face.tet), face.corner);
    if (obstacles.face(p, q, r) == 0) return;
    const Index beyond = mesh_.beyond(face);
    if (seen.contains(beyond)) return;
    crossed.push_back(
        {face, mesh_.corners(face.tet),
         share_to_plane(mesh_.point(a), mesh_.point(b), mesh_.point(p), mesh_.point(q), mesh_.point(r))});
    if (std::ranges::find(next, beyond) == next.end()) next.push_back(beyond);
  };
  for (const Index t : tets) {
    const unsigned corner = place_of(a, mesh_.corners(t));
    if (const auto [p, q, r] = side_corners(mesh_.corners(t), corner); obstacles.face(p, q, r) == 0) continue;
    seen.insert(t);
    next.push_back(t);
  }
  while (!next.empty()) {
    const Index t = next.back();
    next.pop_back();
    seen.insert(t);
    for (unsigned k = 0; k < 4; ++k)
      if (mesh_.beyond({t, k}) != none) look_at({t, k});
  }
  for (const CrossedFace& c : crossed) {
    const auto v = side_corners(c.corners, c.face.corner);
    const std::array<bool, 3> on_line{mesh_.orientation(a, b, v[0], v[1]) == 0,
                                      mesh_.orientation(a, b, v[1], v[2]) == 0,
                                      mesh_.orientation(a, b, v[2], v[0]) == 0};
    for (unsigned i = 0; i < 3; ++i)
      if (on_line[i] && on_line[(i + 2) % 3]) return v[i];
  }
  return none;
}

/// Changes the mesh at faces that the edge crosses. Returns whether it changed anything.
bool BoundaryRecovery::clear_edge(const std::vector<CrossedFace>& crossed, const Obstacles& obstacles,
                                  unsigned depth) {
  bool changed = false;
  const auto is_there = [&](const CrossedFace& c) {
    return mesh_.alive(c.face.tet) && mesh_.corners(c.face.tet) == c.corners;
  };
  for (const CrossedFace& c : crossed) {
    if (!is_there(c)) continue;
    bool gone = reduce([&] { return changes_.remove_face(c.face, obstacles); });
    const auto v = side_corners(c.corners, c.face.corner);
    for (unsigned i = 0; i < 3 && !gone; ++i)
      gone = reduce([&] { return changes_.remove_edge(v[i], v[(i + 1) % 3], depth, obstacles, -1); });
    changed |= gone;
  }
  return changed;
}

/// Adds a point on an edge: at a crossing with a face, preferably near the edge's middle. A rounded crossing
/// may lie beyond a feature, so that it cannot be inserted. Then tries the middles of the parts of the edge
/// beside the crossings and, if these fail, places up to `most_errors` rounding errors away from the
/// crossings. Returns none if no place can be used.
Index BoundaryRecovery::divide_at_crossing(Index a, Index b, std::vector<CrossedFace>& crossed) {
  if (++added_ > most_added_) fail(a, "An edge");
  std::ranges::sort(crossed, {}, [](const CrossedFace& c) { return std::fabs(c.place - 0.5); });
  const auto insert = [&](const Point& x, const std::vector<Index>& cavity) {
    if (x == mesh_.point(a) || x == mesh_.point(b)) return none;
    const Index made = changes_.insert(x, cavity);
    if (made != none) mesh_.keep();
    return made;
  };
  const auto on_edge = [&](double place) {
    return mesh_.point(a) + place * (mesh_.point(b) - mesh_.point(a));
  };
  for (const CrossedFace& c : crossed)
    if (const Index x = insert(on_edge(c.place), {c.face.tet, mesh_.beyond(c.face)}); x != none) return x;
  for (const CrossedFace& c : crossed)
    for (const auto& [place, tet] : places_beside(c, crossed))
      if (const Index x = insert(on_edge(place), {tet}); x != none) return x;
  for (double errors = 1; errors <= most_errors; errors *= 8)
    for (const CrossedFace& c : crossed)
      for (unsigned way = 0; way < 6; ++way) {
        Point x = on_edge(c.place);
        const double largest = std::max({std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)});
        double& coordinate = way < 2 ? x.x : way < 4 ? x.y : x.z;
        coordinate += (way % 2 == 0 ? 1 : -1) * errors * 0x1p-52 * largest;
        if (const Index made = insert(x, {c.face.tet, mesh_.beyond(c.face)}); made != none) return made;
      }
  return none;
}

/// Returns the middles of the parts of an edge before and behind a crossed face, and the tetrahedra there.
std::array<std::pair<double, Index>, 2> BoundaryRecovery::places_beside(
    const CrossedFace& face, const std::vector<CrossedFace>& crossed) const {
  double before = 0, behind = 1;
  for (const CrossedFace& c : crossed) {
    if (c.place < face.place) before = std::max(before, c.place);
    if (c.place > face.place) behind = std::min(behind, c.place);
  }
  return {
      {{0.5 * (before + face.place), face.face.tet}, {0.5 * (face.place + behind), mesh_.beyond(face.face)}}};
}

/// Adds a point inside a tetrahedron that the edge crosses, so that the mesh can be changed there. If none
/// can hold a point, as between coplanar points, adds the point beside one of them.
bool BoundaryRecovery::add_room(const std::vector<CrossedFace>& crossed) {
  const auto add = [&](const CrossedFace& c, const Vector& off) {
    Point sum;
    for (const Index v : c.corners) sum = sum + mesh_.point(v);
    if (changes_.insert(0.25 * sum + off, {c.face.tet}) == none) return false;
    mesh_.keep();
    return true;
  };
  for (const CrossedFace& c : crossed)
    if (add(c, {})) return true;
  for (double share = farthest_room; share > nearest_room; share *= 0.1)
    for (const CrossedFace& c : crossed) {
      const Vector off = share * across(c);
      if (add(c, off) || add(c, -1 * off)) return true;
    }
  return false;
}

/// Returns a vector normal to a crossed face, as long as the face's longest side.
Vector BoundaryRecovery::across(const CrossedFace& c) const {
  const auto v = side_corners(c.corners, c.face.corner);
  const std::array<Vector, 3> sides{mesh_.point(v[1]) - mesh_.point(v[0]),
                                    mesh_.point(v[2]) - mesh_.point(v[1]),
                                    mesh_.point(v[0]) - mesh_.point(v[2])};
  const Vector normal = cross(sides[0], sides[1]);
  const double length = norm(normal);
  if (length == 0) return {};
  return std::max({norm(sides[0]), norm(sides[1]), norm(sides[2])}) / length * normal;
}

void BoundaryRecovery::recover_facet(Index facet) {
  const Facet f = facets_[facet];
  const auto& [a, b, c] = f.corners;
  const InTheWayOfFacet obstacles(mesh_, f.corners);
  changes_.set_budget(most_rings);
  for (;;) {
    if (const Tetrahedra::Face face = mesh_.face_of(a, b, c); face.tet != none) {
      mesh_.set_facet(face, facet);
      return;
    }
    const std::vector<Ends> piercing = find_piercing(f, obstacles);
    if (piercing.empty()) fail(a, "A facet");
    bool changed = false;
    for (unsigned depth = 0; depth <= most_depth && !changed; ++depth)
      for (const auto& ends : piercing)
        changed |= reduce([&] { return changes_.remove_edge(ends[0], ends[1], depth, obstacles, -1); });
    if (changed) continue;
    divide_facet(facet, piercing);
    return;
  }
}

/// Finds the edges that pass through a triangle, beginning around one of its sides.
std::vector<BoundaryRecovery::Ends> BoundaryRecovery::find_piercing(const Facet& facet,
                                                                    const Obstacles& obstacles) const {
  std::vector<Ends> found;
  std::unordered_set<std::uint64_t> seen;
  Tetrahedra::Ring ring;
  const auto look_at_ring = [&](Index p, Index q) {
    const Index at = mesh_.tet_at(p, q);
    if (at == none) return;
    mesh_.ring(at, p, q, ring);
    for (const Index t : ring.tets) {
      const auto& v = mesh_.corners(t);
      for (unsigned i = 0; i < 4; ++i)
        for (unsigned j = i + 1; j < 4; ++j)
          if (seen.insert(edge_key(v[i], v[j])).second && obstacles.edge(v[i], v[j]) != 0)
            found.push_back({v[i], v[j]});
    }
  };
  for (unsigned i = 0; i < 3 && found.empty(); ++i)
    look_at_ring(facet.corners[i], facet.corners[(i + 1) % 3]);
  for (std::size_t i = 0; i < found.size(); ++i) look_at_ring(found[i][0], found[i][1]);
  return found;
}

/// Divides a triangle into three at a point where an edge passes through it.
void BoundaryRecovery::divide_facet(Index facet, const std::vector<Ends>& piercing) {
  const Facet f = facets_[facet];
  const auto& [a, b, c] = f.corners;
  if (++added_ > most_added_) fail(a, "A facet");
  for (const auto& [p, q] : piercing) {
    const double share =
        share_to_plane(mesh_.point(p), mesh_.point(q), mesh_.point(a), mesh_.point(b), mesh_.point(c));
    Tetrahedra::Ring ring;
    mesh_.ring(mesh_.tet_at(p, q), p, q, ring);
    const Index x = changes_.insert(mesh_.point(p) + share * (mesh_.point(q) - mesh_.point(p)), ring.tets);
    if (x == none) continue;
    mesh_.keep();
    remove_facet(facet);
    for (unsigned i = 0; i < 3; ++i) add_facet({f.corners[i], f.corners[(i + 1) % 3], x}, f.patch);
    return;
  }
  fail(a, "A facet");
}

void BoundaryRecovery::fail(Index at, const char* what) const {
  const Point& p = mesh_.point(at);
  const std::string message = fmt::format(
      "{} at ({:.9g}, {:.9g}, {:.9g}) could not be made a part of a mesh: features there are too near "
      "to each other for double precision; raise the repair tolerance.",
      what, p.x, p.y, p.z);
  throw PlcError(message, {{PlcFault::Kind::intersection, message, {at}, p}});
}

}  // namespace collarmesh::constrained
