#pragma once

#include <array>
#include <cassert>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/plc.h"
#include "common/distances.h"
#include "common/hierarchy.h"
#include "location/centred_box.h"
#include "location/segment_bundle.h"

namespace collarmesh {

/// Bounding-volume hierarchy over triangles. A set of its nodes stands for the triangles below them. A mesh
/// vertex keeps the nodes that meet its Voronoi cell: coarse nodes while the cell is large, so that neither
/// memory nor queries grow with the input's resolution.
class TriangleHierarchy {
 public:
  /// A triangle that a segment crosses; `direction` is +1 if the segment goes from behind the triangle to its
  /// front (the side its normal points to), else -1.
  struct Crossing {
    Index triangle;
    int direction;
  };

  /// Marks of the nodes that a search has met. Each thread that searches keeps its own.
  class Marks {
   public:
    std::size_t bytes() const { return of_nodes_.capacity() * sizeof(OfNode); }

   private:
    friend class TriangleHierarchy;
    struct OfNode {
      std::uint32_t met = 0, started = 0;  // number of the last search that met the node, and of the last one
                                           // that started from it
    };
    std::vector<OfNode> of_nodes_;
    std::uint32_t search_ = 0;
  };

  /// Builds the hierarchy. Keeps the points by reference. A segment or point is a triangle with equal
  /// corners, which no segment crosses.
  TriangleHierarchy(std::span<const Point> points, std::vector<std::array<Index, 3>> triangles);

  bool empty() const { return tree_.empty(); }
  std::size_t triangle_count() const { return triangles_.size(); }
  Index root() const { return 0; }
  const std::array<Index, 3>& points(Index triangle) const { return triangles_[triangle]; }
  std::array<Point, 3> corners(Index triangle) const {
    const auto& t = triangles_[triangle];
    return {points_[t[0]], points_[t[1]], points_[t[2]]};
  }

  /// Replaces `found` by nodes that contain all triangles that meet `box`: the coarsest nodes whose boxes
  /// meet it and are not longer than `extent`, and leaves of larger triangles, unless these certainly miss
  /// it. Precondition: the nodes of `from` contain all triangles that meet `box`. A node found may contain no
  /// such triangle. Cost: linear in the nodes found plus the levels between them and `from`.
  void nodes_meeting(const Box& box, double extent, std::span<const Index> from, Marks& marks,
                     std::vector<Index>& found) const;

  /// Replaces `found` by the triangles below `nodes` that the segment pq crosses. Exact; ties are broken by
  /// moving the segment by (e, e^2, e^3) for an infinitesimal e, so that a closed surface is crossed an even
  /// number of times by every segment with both ends on one side.
  void crossings(const Point& p, const Point& q, std::span<const Index> nodes,
                 std::vector<Crossing>& found) const;

  /// A crossing of a segment of a bundle and a triangle.
  struct BundleCrossing {
    Index segment;
    Crossing crossing;
  };
  /// Finds the crossings of all segments of a bundle, in the order of the segments.
  void crossings(const SegmentBundle& bundle, std::span<const Index> nodes,
                 std::vector<BundleCrossing>& found) const;

  /// Returns the direction in which the segment pq crosses one triangle; 0 if it does not cross it.
  int crossing(const Point& p, const Point& q, Index triangle) const;

  /// Returns the squared distance from p to the nearest triangle, and its number in `nearest`, if the squared
  /// distance is below `bound`. Otherwise returns `bound` and leaves `nearest` unchanged.
  double squared_distance_to(const Point& p, double bound = INFINITY, Index* nearest = nullptr) const {
    return squared_distance_to(p, bound, nearest, [](Index) { return true; });
  }
  /// Returns the squared distance to the nearest triangle that `counts` accepts, with the same use of
  /// `bound`.
  template <class Counts>
  double squared_distance_to(const Point& p, double bound, Index* nearest, const Counts& counts) const {
    return squared_distance_to(
        p, bound, nearest, [](Index) { return false; }, counts);
  }
  /// Does the same, but leaves out triangles below nodes that `skips` accepts.
  template <class Skips, class Counts>
  double squared_distance_to(const Point& p, double bound, Index* nearest, const Skips& skips,
                             const Counts& counts) const;

  /// Returns a triangle whose squared distance from p is below `bound` (the `hint` if it is such a triangle),
  /// or none.
  Index triangle_within(const Point& p, double bound, Index hint = none) const {
    return triangle_within(p, bound, hint, [](Index) { return true; });
  }
  /// Returns a triangle within the bound among those that `counts` accepts. Precondition: `counts` accepts
  /// the hint.
  template <class Counts>
  Index triangle_within(const Point& p, double bound, Index hint, const Counts& counts) const;

  /// Visits the triangles whose boxes have squared distances from p below the bound: for each of the `nodes`
  /// the triangles below it, near ones first. The visitor may lower the bound.
  template <class Visit>
  void visit_near(std::span<const Index> nodes, const Point& p, const double& squared_bound,
                  const Visit& visit) const {
    visit_near(
        nodes, p, squared_bound, [](Index) { return false; }, visit);
  }
  /// Visits the same triangles, except those below nodes that `skips` accepts.
  template <class Skips, class Visit>
  void visit_near(std::span<const Index> nodes, const Point& p, const double& squared_bound,
                  const Skips& skips, const Visit& visit) const;

  /// Returns for each node the label that all triangles below it have, or none if they differ. Precondition:
  /// one label per triangle.
  std::vector<Index> common_labels(std::span<const Index> label_of_triangle) const;

  std::size_t bytes() const;

 private:
  struct Bounds {
    CentredBox box;
    double extent;  // longest side of the box
    Index parent = none;

    Bounds() = default;
    explicit Bounds(const Box& of_triangles);
  };

  void descend(Index node, const CentredBox& box, double extent, Marks& marks,
               std::vector<Index>& found) const;

  std::span<const Point> points_;
  std::vector<std::array<Index, 3>> triangles_;
  Hierarchy<Bounds> tree_;  // every leaf is one triangle
};

/// Builds a hierarchy over the triangles of one patch. Keeps the complex's points by reference.
std::unique_ptr<TriangleHierarchy> hierarchy_of_patch(const Plc& plc, Index patch);

template <class Skips, class Counts>
double TriangleHierarchy::squared_distance_to(const Point& p, double bound, Index* nearest,
                                              const Skips& skips, const Counts& counts) const {
  if (tree_.empty()) return bound;
  const Index top = root();
  visit_near({&top, 1}, p, bound, skips, [&](Index triangle) {
    if (!counts(triangle)) return;
    const auto t = corners(triangle);
    const double d = squared_distance_to_triangle(p, t[0], t[1], t[2]);
    if (d >= bound) return;
    bound = d;
    if (nearest != nullptr) *nearest = triangle;
  });
  return bound;
}

template <class Skips, class Visit>
void TriangleHierarchy::visit_near(std::span<const Index> nodes, const Point& p, const double& squared_bound,
                                   const Skips& skips, const Visit& visit) const {
  const auto distance = [&](Index node) {
    return skips(node) ? INFINITY : tree_.bounds(node).box.squared_distance(p);
  };
  for (const Index start : nodes) tree_.visit_near(start, squared_bound, distance, visit);
}

template <class Counts>
Index TriangleHierarchy::triangle_within(const Point& p, double bound, Index hint,
                                         const Counts& counts) const {
  const auto is_near = [&](Index triangle) {
    const auto t = corners(triangle);
    return is_within(bound, p, t[0], t[1], t[2]);
  };
  if (tree_.empty()) return none;
  assert(hint == none || counts(hint));
  if (hint != none && is_near(hint)) return hint;
  Index found = none;
  tree_.descend<ChildOrder::right_first>(
      root(), [&](const Bounds& bounds) { return bounds.box.squared_distance(p) < bound; },
      [&](Index triangle) {
        if (!counts(triangle) || !is_near(triangle)) return false;
        found = triangle;
        return true;
      });
  return found;
}

}  // namespace collarmesh
