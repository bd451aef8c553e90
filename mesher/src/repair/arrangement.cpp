// Computes the arrangement of triangles: Zhou, Grinspun, Zorin, Jacobson, "Mesh arrangements for solid
// geometry", 2016.
#include "repair/arrangement.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "delaunay/predicates.h"
#include "facets/cleanup.h"
#include "facets/edges.h"
#include "facets/exact.h"
#include "facets/intersections.h"
#include "facets/simplices.h"
#include "repair/changes.h"
#include "repair/most_places.h"
#include "repair/snapping.h"

namespace collarmesh::repairing {

namespace {

using namespace facets;

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactPoint = Kernel::Point_3;
// The number of an inserted point, counted from 1; 0 for a vertex that the triangulation made at a crossing
// of constraints.
struct Inserted {
  Index number = 0;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Inserted, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using PlaneTriangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_intersections_tag>;
using Edge = std::array<Index, 2>;

constexpr std::size_t most_rounds = 12;
constexpr std::size_t work_of_a_cut = 1000;  // work of cutting a pair of facets, in units of `Work`

Edge edge_key(Index a, Index b) { return a < b ? Edge{a, b} : Edge{b, a}; }

Point rounded(const ExactPoint& p) {
  // Rounds the exact value, so that equal points are rounded to the same doubles.
  return {CGAL::to_double(p.x().exact()), CGAL::to_double(p.y().exact()), CGAL::to_double(p.z().exact())};
}

// Points and segments in a triangle's plane that cut its interior.
struct Cuts {
  std::vector<ExactPoint> points;
  std::vector<std::array<ExactPoint, 2>> segments;
};

// One round of cutting: cuts intersecting pairs exactly, then rounds the new points.
class Cutter {
 public:
  Cutter(ComplexDraft& draft, const EdgeTable& edges, std::span<const Simplex> simplices)
      : draft_(draft), edges_(edges), simplices_(simplices) {}

  std::size_t run(const std::vector<std::pair<Index, Index>>& pairs) {
    for (const auto& [i, j] : pairs) add_pair(simplices_[i], i, simplices_[j], j);
    for (auto& [edge, points] : on_edge_) {
      std::sort(points.begin(), points.end());
      points.erase(std::unique(points.begin(), points.end()), points.end());
      const Index e = edges_.find(edge[0], edge[1]);
      if (e != none)
        for (const Index side : edges_.sides(e)) cuts_[side / 3];
    }
    const std::size_t count = cuts_.size();
    cut_segments();
    cut_triangles();
    return count;
  }

 private:
  ExactPoint exact(Index p) const {
    const Point& q = draft_.points[p];
    return {q.x, q.y, q.z};
  }
  Kernel::Triangle_3 triangle(const Simplex& s) const {
    return {exact(s.points[0]), exact(s.points[1]), exact(s.points[2])};
  }
  Kernel::Segment_3 segment(const Simplex& s) const { return {exact(s.points[0]), exact(s.points[1])}; }

  void add_pair(const Simplex& a, Index i, const Simplex& b, Index j) {
    if (a.size < b.size) return add_pair(b, j, a, i);
    if (b.size == 1) return add_point(a, i, exact(b.points[0]));
    if (a.size == 3 && b.size == 3) {
      if (add_crossing(a.points, i, b.points, j) || add_coplanar(a.points, i, b.points, j)) return;
      if (const auto met = CGAL::intersection(triangle(a), triangle(b))) add_meeting(a, i, b, j, *met);
    } else if (a.size == 3) {
      if (const auto met = CGAL::intersection(triangle(a), segment(b))) add_meeting(a, i, b, j, *met);
    } else if (const auto met = CGAL::intersection(segment(a), segment(b))) {
      add_meeting(a, i, b, j, *met);
    }
  }

  // Finds where the sides of s pierce t. Returns false if a corner of s that t lacks lies in the plane of t,
  // or a side of s meets an edge of t: other functions construct such points.
  bool find_piercings(const facets::Corners& s, const facets::Corners& t, Index number,
                      std::vector<ExactPoint>& found) {
    const auto at = [&](Index p) -> const Point& { return draft_.points[p]; };
    const auto shared = [&](Index p) { return p == t[0] || p == t[1] || p == t[2]; };
    std::array<int, 3> above{};
    for (unsigned k = 0; k < 3; ++k) {
      if (shared(s[k])) continue;
      above[k] = predicates::orientation(at(t[0]), at(t[1]), at(t[2]), at(s[k]));
      if (above[k] == 0) return false;
    }
    for (unsigned k = 0; k < 3; ++k) {
      const unsigned next = (k + 1) % 3;
      if (above[k] * above[next] >= 0) continue;
      const Point &p = at(s[k]), &q = at(s[next]);
      const std::array<int, 3> around{predicates::orientation(p, q, at(t[0]), at(t[1])),
                                      predicates::orientation(p, q, at(t[1]), at(t[2])),
                                      predicates::orientation(p, q, at(t[2]), at(t[0]))};
      const auto [low, high] = std::minmax({around[0], around[1], around[2]});
      if (low < 0 && high > 0) continue;
      if (low == 0 || high == 0) return false;
      found.push_back(piercing(edge_key(s[k], s[next]), t, number));
    }
    return true;
  }

  // Returns the point where an edge pierces a triangle. Computes it once for all triangles at the edge.
  ExactPoint piercing(const Edge& edge, const facets::Corners& t, Index number) {
    const auto [at, added] = piercings_.try_emplace({edge[0], edge[1], number});
    if (!added) return at->second;
    const ExactPoint p = exact(edge[0]), q = exact(edge[1]), origin = exact(t[0]);
    const Kernel::Vector_3 normal = CGAL::cross_product(exact(t[1]) - origin, exact(t[2]) - origin);
    const Kernel::FT from = normal * (p - origin), to = normal * (q - origin);
    at->second = p + from / (from - to) * (q - p);
    on_edge_[edge].push_back(at->second);
    return at->second;
  }

  // Adds the cuts of two triangles if they cross in general position, with at most one common corner. Returns
  // whether they do.
  bool add_crossing(const facets::Corners& s, Index i, const facets::Corners& t, Index j) {
    std::vector<ExactPoint> ends;
    std::size_t common = 0;
    for (const Index p : s)
      if (p == t[0] || p == t[1] || p == t[2]) {
        ++common;
        ends.push_back(exact(p));
      }
    if (common > 1 || !find_piercings(s, t, j, ends) || !find_piercings(t, s, i, ends) || ends.size() != 2)
      return false;
    cuts_[i].segments.push_back({ends[0], ends[1]});
    cuts_[j].segments.push_back({ends[0], ends[1]});
    return true;
  }

  // Adds the cuts of two triangles if they lie in one plane: each is cut by the sides of the other. Returns
  // false if they do not.
  bool add_coplanar(const facets::Corners& s, Index i, const facets::Corners& t, Index j) {
    const auto at = [&](Index p) -> const Point& { return draft_.points[p]; };
    for (const Index p : t)
      if (predicates::orientation(at(s[0]), at(s[1]), at(s[2]), at(p)) != 0) return false;
    const Vector normal = cross(at(s[1]) - at(s[0]), at(s[2]) - at(s[0]));
    const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
    const unsigned axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    if (planar_orientation(axis, at(s[0]), at(s[1]), at(s[2])) == 0 ||
        planar_orientation(axis, at(t[0]), at(t[1]), at(t[2])) == 0)
      return false;
    for (unsigned k = 0; k < 3; ++k) {
      clip(edge_key(t[k], t[(k + 1) % 3]), s, i, axis);
      clip(edge_key(s[k], s[(k + 1) % 3]), t, j, axis);
    }
    return true;
  }

  // Adds the common part of a triangle and an edge in its plane: nothing, a point or a segment, whose ends
  // are ends of the edge, corners, or crossings with the sides.
  void clip(const Edge& e, const facets::Corners& t, Index number, unsigned axis) {
    if (!clipped_.insert({number, e}).second) return;
    const auto turn = [&](Index p, Index q, Index r) {
      return planar_orientation(axis, draft_.points[p], draft_.points[q], draft_.points[r]);
    };
    const int inwards = turn(t[0], t[1], t[2]);
    std::array<std::array<int, 3>, 2> within{};  // by end of e, and side of t; > 0: on the inner side
    for (unsigned end = 0; end < 2; ++end)
      for (unsigned k = 0; k < 3; ++k) within[end][k] = inwards * turn(t[k], t[(k + 1) % 3], e[end]);
    bool along = false;
    for (unsigned k = 0; k < 3; ++k) {
      if (within[0][k] < 0 && within[1][k] < 0) return;
      along |= within[0][k] == 0 && within[1][k] == 0;
    }
    std::vector<ExactPoint> common;
    for (unsigned end = 0; end < 2; ++end) add_end(e[end], t, within[end], common);
    std::array<int, 3> beside{};  // by corner: the side of the edge on which it lies
    for (unsigned k = 0; k < 3; ++k) beside[k] = turn(e[0], e[1], t[k]);
    for (unsigned k = 0; k < 3; ++k) {
      const unsigned next = (k + 1) % 3;
      if (beside[k] * beside[next] < 0 && within[0][k] * within[1][k] < 0)
        common.push_back(crossing(e, edge_key(t[k], t[next]), axis));
      if (beside[k] == 0 && t[k] != e[0] && t[k] != e[1] &&
          between(draft_.points[e[0]], draft_.points[t[k]], draft_.points[e[1]])) {
        common.push_back(exact(t[k]));
        on_edge_[e].push_back(common.back());
      }
    }
    if (common.size() == 2 && !along) cuts_[number].segments.push_back({common[0], common[1]});
  }

  // Adds p, an end of an edge, if it lies in t.
  void add_end(Index p, const facets::Corners& t, const std::array<int, 3>& within,
               std::vector<ExactPoint>& common) {
    if (*std::min_element(within.begin(), within.end()) < 0) return;
    common.push_back(exact(p));
    if (std::count(within.begin(), within.end(), 0) != 1) return;
    const auto k = static_cast<unsigned>(std::find(within.begin(), within.end(), 0) - within.begin());
    on_edge_[edge_key(t[k], t[(k + 1) % 3])].push_back(common.back());
  }

  // Computes the crossing of two edges once for all triangles at them.
  ExactPoint crossing(const Edge& e, const Edge& f, unsigned axis) {
    const auto [at, added] = crossings_.try_emplace(e < f ? std::pair{e, f} : std::pair{f, e});
    if (!added) return at->second;
    const ExactPoint p = exact(e[0]), q = exact(e[1]), r = exact(f[0]), s = exact(f[1]);
    const auto u = static_cast<int>((axis + 1) % 3), v = static_cast<int>((axis + 2) % 3);
    const auto area = [&](const ExactPoint& x) -> Kernel::FT {
      return (s[u] - r[u]) * (x[v] - r[v]) - (s[v] - r[v]) * (x[u] - r[u]);
    };
    const Kernel::FT from = area(p), to = area(q);
    at->second = p + from / (from - to) * (q - p);
    on_edge_[e].push_back(at->second);
    on_edge_[f].push_back(at->second);
    return at->second;
  }

  template <class Meeting>
  void add_meeting(const Simplex& a, Index i, const Simplex& b, Index j, const Meeting& met) {
    const std::vector<ExactPoint> corners = boost::apply_visitor(Corners3(), met);
    for (const auto& [simplex, number] : {std::pair{&a, i}, std::pair{&b, j}}) {
      for (const ExactPoint& p : corners) add_point(*simplex, number, p);
      if (simplex->size < 3 || corners.size() < 2) continue;
      auto& segments = cuts_[number].segments;
      if (corners.size() == 2) segments.push_back({corners[0], corners[1]});
      for (std::size_t k = 0; corners.size() > 2 && k < corners.size(); ++k)
        segments.push_back({corners[k], corners[(k + 1) % corners.size()]});
    }
  }

  struct Corners3 : boost::static_visitor<std::vector<ExactPoint>> {
    std::vector<ExactPoint> operator()(const ExactPoint& p) const { return {p}; }
    std::vector<ExactPoint> operator()(const Kernel::Segment_3& s) const { return {s.source(), s.target()}; }
    std::vector<ExactPoint> operator()(const Kernel::Triangle_3& t) const { return {t[0], t[1], t[2]}; }
    std::vector<ExactPoint> operator()(const std::vector<ExactPoint>& polygon) const { return polygon; }
  };

  // Adds a point at which a simplex is cut. If it lies on an edge, all triangles at the edge get it.
  void add_point(const Simplex& s, Index number, const ExactPoint& p) {
    std::array<ExactPoint, 3> corners;
    for (unsigned i = 0; i < s.size; ++i) {
      corners[i] = exact(s.points[i]);
      if (corners[i] == p) return;
    }
    if (s.size == 2) {
      on_edge_[edge_key(s.points[0], s.points[1])].push_back(p);
      return;
    }
    if (s.size < 3) return;
    for (unsigned i = 0; i < 3; ++i) {
      if (!CGAL::collinear(corners[i], corners[(i + 1) % 3], p)) continue;
      on_edge_[edge_key(s.points[i], s.points[(i + 1) % 3])].push_back(p);
      return;
    }
    cuts_[number].points.push_back(p);
  }

  // Returns the points on an edge from a to b, both included.
  std::vector<ExactPoint> chain(Index a, Index b) const {
    std::vector<ExactPoint> points{exact(a)};
    if (const auto found = on_edge_.find(edge_key(a, b)); found != on_edge_.end()) {
      // The points are in lexicographic order, which is an order along the edge.
      if (exact(a) < exact(b))
        points.insert(points.end(), found->second.begin(), found->second.end());
      else
        points.insert(points.end(), found->second.rbegin(), found->second.rend());
    }
    points.push_back(exact(b));
    return points;
  }

  Index add_rounded(const ExactPoint& p) {
    draft_.points.push_back(rounded(p));
    draft_.point_tags.push_back(0);
    return static_cast<Index>(draft_.points.size() - 1);
  }

  void cut_segments() {
    std::vector<Segment> result;
    for (const Segment& s : draft_.segments) {
      const std::vector<ExactPoint> points = chain(s.a, s.b);
      Segment piece = s;
      for (std::size_t i = 1; i < points.size(); ++i) {
        piece.b = i + 1 == points.size() ? s.b : add_rounded(points[i]);
        result.push_back(piece);
        piece.a = piece.b;
      }
    }
    draft_.segments = std::move(result);
  }

  void cut_triangles() {
    std::vector<facets::Corners> triangles;
    std::vector<Origin> origins;
    std::vector<facets::Corners> before = std::move(draft_.triangles);
    std::vector<Origin> origins_before = std::move(draft_.origins);
    draft_.triangles.clear();
    draft_.origins.clear();
    for (Index t = 0; t < before.size(); ++t) {
      const auto found = cuts_.find(t);
      if (found == cuts_.end())
        draft_.add_triangle(before[t], origins_before[t]);
      else
        cut_triangle(before[t], origins_before[t], found->second);
    }
  }

  void cut_triangle(const facets::Corners& t, const Origin& origin, const Cuts& cuts) {
    const Kernel::Plane_3 plane(exact(t[0]), exact(t[1]), exact(t[2]));
    const std::array<double, 3> normal{std::fabs(CGAL::to_double(plane.a())),
                                       std::fabs(CGAL::to_double(plane.b())),
                                       std::fabs(CGAL::to_double(plane.c()))};
    const auto axis = static_cast<int>(std::max_element(normal.begin(), normal.end()) - normal.begin());
    const auto project = [&](const ExactPoint& p) {
      return Kernel::Point_2(p[(axis + 1) % 3], p[(axis + 2) % 3]);
    };
    PlaneTriangulation mesh;
    const auto insert = [&](const ExactPoint& p) {
      const auto vertex = mesh.insert(project(p));
      if (vertex->info().number == 0) {
        inserted_.push_back(p);
        vertex->info().number = static_cast<Index>(inserted_.size());
      }
      return vertex;
    };
    const auto constrain = [&](PlaneTriangulation::Vertex_handle a, PlaneTriangulation::Vertex_handle b) {
      if (a != b) mesh.insert_constraint(a, b);
    };
    inserted_.clear();
    ids_.clear();
    for (unsigned i = 0; i < 3; ++i) insert(exact(t[i]));
    ids_.assign(t.begin(), t.end());
    for (unsigned i = 0; i < 3; ++i) {
      const std::vector<ExactPoint> points = chain(t[i], t[(i + 1) % 3]);
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const auto a = insert(points[k]), b = insert(points[k + 1]);
        constrain(a, b);
      }
    }
    for (const ExactPoint& p : cuts.points) insert(p);
    for (const auto& [a, b] : cuts.segments) {
      const auto from = insert(a), to = insert(b);
      constrain(from, to);
    }
    emit(mesh, plane, axis, origin);
  }

  void emit(PlaneTriangulation& mesh, const Kernel::Plane_3& plane, int axis, const Origin& origin) {
    const std::array<Kernel::FT, 3> n{plane.a(), plane.b(), plane.c()};
    const auto a1 = static_cast<std::size_t>((axis + 1) % 3), a2 = static_cast<std::size_t>((axis + 2) % 3),
               a0 = static_cast<std::size_t>(axis);
    const bool turned = CGAL::sign(n[a0]) == CGAL::NEGATIVE;
    ids_.resize(inserted_.size(), none);
    for (const auto vertex : mesh.finite_vertex_handles()) {
      Index& info = vertex->info().number;
      if (info == 0) {
        std::array<Kernel::FT, 3> q;
        q[a1] = vertex->point().x();
        q[a2] = vertex->point().y();
        q[a0] = -(n[a1] * q[a1] + n[a2] * q[a2] + plane.d()) / n[a0];
        inserted_.emplace_back(q[0], q[1], q[2]);
        ids_.push_back(none);
        info = static_cast<Index>(inserted_.size());
      }
      if (ids_[info - 1] == none) ids_[info - 1] = add_rounded(inserted_[info - 1]);
    }
    for (const auto face : mesh.finite_face_handles()) {
      facets::Corners corners{ids_[face->vertex(0)->info().number - 1],
                              ids_[face->vertex(1)->info().number - 1],
                              ids_[face->vertex(2)->info().number - 1]};
      if (turned) std::swap(corners[1], corners[2]);
      draft_.add_triangle(corners, origin);
    }
  }

  ComplexDraft& draft_;
  const EdgeTable& edges_;
  std::span<const Simplex> simplices_;
  std::map<Edge, std::vector<ExactPoint>> on_edge_;
  std::map<std::array<Index, 3>, ExactPoint> piercings_;  // by edge and triangle
  std::map<std::pair<Edge, Edge>, ExactPoint> crossings_;
  std::set<std::pair<Index, Edge>> clipped_;  // triangles, and edges in their planes
  std::map<Index, Cuts> cuts_;                // by triangle
  // Data of the current triangle:
  std::vector<ExactPoint> inserted_;
  std::vector<Index> ids_;  // numbers of these points in the draft; none: not added yet
};

void note_places(const ComplexDraft& draft, std::span<const Simplex> simplices,
                 const std::vector<std::pair<Index, Index>>& pairs, std::vector<Point>& places) {
  const std::size_t step = pairs.size() / most_places + 1;
  for (std::size_t i = 0; i < pairs.size(); i += step) {
    std::array<Box, 2> boxes;
    for (const Index p : simplices[pairs[i].first].corners()) boxes[0].add(draft.points[p]);
    for (const Index p : simplices[pairs[i].second].corners()) boxes[1].add(draft.points[p]);
    Box both;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      both.min[axis] = std::max(boxes[0].min[axis], boxes[1].min[axis]);
      both.max[axis] = std::min(boxes[0].max[axis], boxes[1].max[axis]);
    }
    places.push_back(both.centre());
  }
}

// A set of simplices of an earlier round, with look-up by corners. Points never move, so simplices with the
// same corners are at the same place.
class KnownSimplices {
 public:
  void clear() { corners_.clear(); }
  bool empty() const { return corners_.empty(); }
  void add(const Corners& corners) { corners_.push_back(corners); }
  void close() { std::sort(corners_.begin(), corners_.end()); }
  bool has(const Corners& corners) const {
    return std::binary_search(corners_.begin(), corners_.end(), corners);
  }

 private:
  std::vector<Corners> corners_;
};

// Simplices without intersections in the last round. They can only intersect simplices created since.
class Settled {
 public:
  /// Returns for each simplex whether it existed in the last round and intersected nothing.
  std::vector<bool> among(std::span<const Simplex> simplices) const {
    std::vector<bool> result;
    if (known_.empty()) return result;
    result.reserve(simplices.size());
    for (const Simplex& s : simplices) result.push_back(known_.has(s.points));
    return result;
  }

  void settle(std::span<const Simplex> simplices, const std::vector<std::pair<Index, Index>>& pairs) {
    std::vector<bool> met(simplices.size(), false);
    for (const auto& [i, j] : pairs) met[i] = met[j] = true;
    known_.clear();
    for (std::size_t i = 0; i < simplices.size(); ++i)
      if (!met[i]) known_.add(simplices[i].points);
    known_.close();
  }

 private:
  KnownSimplices known_;
};

// A tool that merges corners that come near other corners or edges. Does not compare two triangles that both
// remain from its last run.
class GrainSnapper {
 public:
  GrainSnapper(ComplexDraft& draft, double reach, Work* work, bool cancel, KeptMerges kept)
      : draft_(draft), reach_(reach), work_(work), cancel_(cancel), kept_(kept) {}

  // Pauses or resumes snapping after a round that did not help: if snapping undoes cuts, rounds without
  // snapping may help.
  void change() { pausing_ = !pausing_; }
  /// Resumes snapping. Returns false if it was not paused, or if the reach is 0, so that nothing is snapped.
  bool resume() { return std::exchange(pausing_, false) && reach_ > 0; }

  void run() {
    if (pausing_ || !(reach_ > 0)) return;
    std::vector<bool> known;
    known.reserve(draft_.triangles.size());
    for (const Corners& t : draft_.triangles) known.push_back(known_.has(t));
    if (kept_ == KeptMerges::all)
      snap_near_features(draft_, reach_, SnapWhat::corners, work_, known, cancel_);
    else
      snap_where_nothing_meets(known);
    known_.clear();
    for (const Corners& t : draft_.triangles) known_.add(t);
    known_.close();
  }

 private:
  void snap_where_nothing_meets(const std::vector<bool>& known) {
    const ComplexDraft before = draft_;
    snap_near_features(draft_, reach_, SnapWhat::corners, work_, known, cancel_);
    const ComplexDraft after = std::move(draft_);
    const Changes changes(before, after);
    std::vector<bool> taken_back(changes.places(), false);
    draft_ = without_what_meets(changes, taken_back);
  }

  ComplexDraft& draft_;
  double reach_;
  bool pausing_ = false;
  Work* work_;
  bool cancel_;
  KeptMerges kept_;
  KnownSimplices known_;
};

}  // namespace

void unify_equal_points(ComplexDraft& draft) {
  std::vector<Index> order(draft.points.size()), merged(draft.points.size());
  std::iota(order.begin(), order.end(), Index{0});
  const auto key = [&](Index p) {
    const Point& q = draft.points[p];
    return std::array{q.x, q.y, q.z};
  };
  std::sort(order.begin(), order.end(), [&](Index p, Index q) {
    const auto a = key(p), b = key(q);
    return a != b ? a < b : p < q;
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    merged[order[i]] =
        i > 0 && draft.points[order[i]] == draft.points[order[i - 1]] ? merged[order[i - 1]] : order[i];
  std::size_t kept = 0;
  for (Index t = 0; t < draft.triangles.size(); ++t) {
    facets::Corners corners = draft.triangles[t];
    for (Index& c : corners) c = merged[c];
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    draft.triangles[kept] = corners;
    draft.origins[kept++] = draft.origins[t];
  }
  draft.triangles.resize(kept);
  draft.origins.resize(kept);
  for (Segment& s : draft.segments) s = {merged[s.a], merged[s.b], s.tag, s.soup};
  std::erase_if(draft.segments, [](const Segment& s) { return s.a == s.b; });
  for (Index& p : draft.loose_points) p = merged[p];
}

ArrangementReport arrange(ComplexDraft& draft, double grain, Work* work, bool cancel_duplicates,
                          KeptMerges kept) {
  ArrangementReport report;
  constexpr std::size_t few = 1000;
  Settled settled;
  GrainSnapper snapper(draft, grain, work, cancel_duplicates, kept);
  std::optional<ComplexDraft> clean_before;
  for (std::size_t fewest = none;; ++report.rounds) {
    unify_equal_points(draft);
    remove_collinear_triangles(draft);
    for (Index t = 0; t < draft.origins.size(); ++t) draft.origins[t].facet = t;
    const EdgeTable edges(draft.triangles, draft.points.size());
    const Simplices simplices(draft, edges);
    const auto pairs = intersecting_pairs(draft, simplices, settled.among(simplices.list()));
    report.clean = pairs.empty();
    if (report.rounds == 0) {
      report.intersecting_pairs = pairs.size();
      note_places(draft, simplices.list(), pairs, report.places);
    }
    // Snap corners that the rounds without snapping left; undo that if facets intersect afterwards.
    if (report.clean && !clean_before && snapper.resume()) {
      clean_before = draft;
      snapper.run();
      continue;
    }
    if (!report.clean && clean_before) {
      draft = std::move(*clean_before);
      report.clean = true;
    }
    // Rounding may increase the number of pairs; the rounds then do not converge.
    if (report.clean || report.rounds == most_rounds || pairs.size() > 2 * fewest + few) return report;
    if (pairs.size() >= fewest) snapper.change();
    fewest = std::min(fewest, pairs.size());
    settled.settle(simplices.list(), pairs);
    if (work != nullptr) work->spend(work_of_a_cut * pairs.size());
    report.cut_triangles += Cutter(draft, edges, simplices.list()).run(pairs);
    unify_equal_points(draft);
    snapper.run();
  }
}

}  // namespace collarmesh::repairing
