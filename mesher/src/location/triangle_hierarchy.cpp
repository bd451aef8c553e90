#include "location/triangle_hierarchy.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "delaunay/predicates.h"

namespace collarmesh {

namespace {

// Returns whether the box lies on one side of the triangle's plane; false in doubt. Rounding changes the
// compared terms by some 16 * 2^-53 of the product of sums below, and the slack is 1e-14 of that product.
bool misses_plane(const CentredBox& box, const std::array<Point, 3>& t) {
  const auto sum = [](const Vector& v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z); };
  const Vector u = t[1] - t[0], v = t[2] - t[0], n = cross(u, v), d = box.centre - t[0];
  const double reach =
      std::fabs(n.x) * box.half.x + std::fabs(n.y) * box.half.y + std::fabs(n.z) * box.half.z;
  const double slack = 1e-14 * sum(u) * sum(v) * (sum(d) + sum(box.half));
  return std::fabs(dot(n, d)) > reach + slack;
}

int side(const Point& a, const Point& b, const Point& c, const Point& p) {
  const int sign = predicates::orientation(a, b, c, p);
  return sign != 0 ? sign : predicates::cross_product_sign_exact(a, b, a, c);
}

// Returns the side on which the line pq passes the edge ab.
int passes(const Point& p, const Point& q, const Point& a, const Point& b) {
  const int sign = predicates::orientation(p, q, a, b);
  return sign != 0 ? sign : predicates::cross_product_sign_exact(p, q, a, b);
}

// Returns whether a triangle stands for a segment or point: its last two corners are equal.
bool is_segment(const std::array<Point, 3>& t) { return t[1] == t[2]; }

// Returns whether the box misses the triangle; false in doubt. Segments have a test of their own, because
// boxes around oblique ones exclude little: a point among long segments may be in many of their boxes.
bool misses(const CentredBox& box, const std::array<Point, 3>& t) {
  return is_segment(t) ? !SegmentAgainstBoxes(t[0], t[1]).may_meet(box) : misses_plane(box, t);
}

int crossing_direction(const Point& p, const Point& q, const std::array<Point, 3>& t) {
  if (is_segment(t)) return 0;
  const int to = side(t[0], t[1], t[2], q);
  if (to == 0 || side(t[0], t[1], t[2], p) == to) return 0;
  const int first = passes(p, q, t[0], t[1]);
  if (first == 0 || passes(p, q, t[1], t[2]) != first || passes(p, q, t[2], t[0]) != first) return 0;
  return to;
}

}  // namespace

TriangleHierarchy::TriangleHierarchy(std::span<const Point> points,
                                     std::vector<std::array<Index, 3>> triangles)
    : points_(points), triangles_(std::move(triangles)) {
  if (triangles_.empty()) return;
  std::vector<Point> centres;
  centres.reserve(triangles_.size());
  for (const auto& t : triangles_) centres.push_back((points_[t[0]] + points_[t[1]] + points_[t[2]]) / 3);
  const std::vector<SpatialKey> keys = spatial_order(centres);
  tree_.reserve(2 * triangles_.size());
  const auto box_of = [&](Index place, Index) {
    Box box;
    for (const Index point : triangles_[keys[place].item]) box.add(points_[point]);
    return box;
  };
  tree_.add(0, static_cast<Index>(keys.size()), 1, spatial_splits(keys), box_of, joined);
  tree_.renumber([&](Index place) { return keys[place].item; });
  for (Index node = 0; node < tree_.node_count(); ++node)
    if (!tree_.is_leaf(node))
      tree_.bounds(tree_.left(node)).parent = tree_.bounds(tree_.right(node)).parent = node;
}

TriangleHierarchy::Bounds::Bounds(const Box& of_triangles) : box(of_triangles) {
  const Vector sides = of_triangles.max - of_triangles.min;
  extent = std::max({sides.x, sides.y, sides.z});
}

// Works from the last node to the first, because children come after their parents.
std::vector<Index> TriangleHierarchy::common_labels(std::span<const Index> label_of_triangle) const {
  assert(label_of_triangle.size() == triangles_.size());
  std::vector<Index> labels(tree_.node_count());
  for (Index node = tree_.node_count(); node-- > 0;) {
    if (tree_.is_leaf(node)) {
      labels[node] = label_of_triangle[tree_.first(node)];
    } else {
      const Index of_left = labels[tree_.left(node)];
      labels[node] = of_left == labels[tree_.right(node)] ? of_left : none;
    }
  }
  return labels;
}

void TriangleHierarchy::nodes_meeting(const Box& box, double extent, std::span<const Index> from,
                                      Marks& marks, std::vector<Index>& found) const {
  found.clear();
  marks.of_nodes_.resize(tree_.node_count());
  ++marks.search_;
  const CentredBox range(box);
  for (Index node : from) {
    if (marks.of_nodes_[node].started == marks.search_) continue;
    marks.of_nodes_[node].started = marks.search_;
    for (Index above = tree_.bounds(node).parent; above != none && tree_.bounds(above).extent <= extent;
         above = tree_.bounds(node).parent)
      node = above;
    descend(node, range, extent, marks, found);
  }
}

void TriangleHierarchy::descend(Index node, const CentredBox& box, double extent, Marks& marks,
                                std::vector<Index>& found) const {
  if (marks.of_nodes_[node].met == marks.search_) return;
  marks.of_nodes_[node].met = marks.search_;
  const Bounds& bounds = tree_.bounds(node);
  if (!box.meets(bounds.box)) return;
  if (bounds.extent <= extent) {
    found.push_back(node);
  } else if (tree_.is_leaf(node)) {
    if (!misses(box, corners(tree_.first(node)))) found.push_back(node);
  } else {
    descend(tree_.left(node), box, extent, marks, found);
    descend(tree_.right(node), box, extent, marks, found);
  }
}

void TriangleHierarchy::crossings(const Point& p, const Point& q, std::span<const Index> nodes,
                                  std::vector<Crossing>& found) const {
  found.clear();
  const SegmentAgainstBoxes segment(p, q);
  for (const Index start : nodes)
    tree_.descend<ChildOrder::right_first>(
        start, [&](const Bounds& bounds) { return segment.may_meet(bounds.box); },
        [&](Index triangle) {
          const int direction = crossing_direction(p, q, corners(triangle));
          if (direction != 0) found.push_back({triangle, direction});
        });
}

void TriangleHierarchy::crossings(const SegmentBundle& bundle, std::span<const Index> nodes,
                                  std::vector<BundleCrossing>& found) const {
  using Mask = SegmentBundle::Mask;
  found.clear();
  for (std::size_t part = 0; part < bundle.part_count(); ++part)
    for (const Index start : nodes)
      tree_.descend<ChildOrder::right_first>(
          start, bundle.all(part),
          [&](const Bounds& bounds, Mask candidates) {
            return bundle.may_meet(bounds.box, part, candidates);
          },
          [&](Index number, Mask meeting) {
            const auto triangle = corners(number);
            for (; meeting != 0; meeting &= meeting - 1) {
              const auto segment =
                  static_cast<Index>(part * SegmentBundle::part_size + std::countr_zero(meeting));
              const int direction = crossing_direction(bundle.from(segment), bundle.to(segment), triangle);
              if (direction != 0) found.push_back({segment, {number, direction}});
            }
          });
  std::ranges::stable_sort(
      found, [](const BundleCrossing& a, const BundleCrossing& b) { return a.segment < b.segment; });
}

int TriangleHierarchy::crossing(const Point& p, const Point& q, Index triangle) const {
  return crossing_direction(p, q, corners(triangle));
}

std::size_t TriangleHierarchy::bytes() const {
  return tree_.bytes() + triangles_.capacity() * sizeof(triangles_[0]);
}

std::unique_ptr<TriangleHierarchy> hierarchy_of_patch(const Plc& plc, Index patch) {
  const Plc::Patch& p = plc.patches[patch];
  std::vector<std::array<Index, 3>> triangles;
  triangles.reserve(p.triangle_count);
  for (Index t = p.first_triangle; t < p.first_triangle + p.triangle_count; ++t)
    triangles.push_back(plc.triangles[t].points);
  return std::make_unique<TriangleHierarchy>(plc.points, std::move(triangles));
}

}  // namespace collarmesh
