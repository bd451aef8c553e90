#include "collar/collar_system.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "collar/collar_placement.h"

namespace collarmesh {

CollarSystem::CollarSystem(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases) {
  if (creases.empty()) return;
  features_ = std::make_unique<const FeatureHierarchy>(plc, points);
  vertex_ball_.assign(plc.vertices.size(), none);
  crease_curve_.assign(plc.curves.size(), false);
  for (const Crease& crease : creases) {
    if (crease.vertex != none) crease_vertices_.push_back(crease.vertex);
    if (crease.curve != none) crease_curve_[crease.curve] = true;
  }
  for (Index c = 0; c < plc.curves.size(); ++c)
    if (crease_curve_[c] && !plc.curves[c].closed)
      crease_vertices_.insert(crease_vertices_.end(), plc.curves[c].ends.begin(), plc.curves[c].ends.end());
  std::sort(crease_vertices_.begin(), crease_vertices_.end());
  crease_vertices_.erase(std::unique(crease_vertices_.begin(), crease_vertices_.end()),
                         crease_vertices_.end());
  plant(plc, points);
}

CollarSystem::CollarSystem(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases,
                           const CollarOptions& options)
    : CollarSystem(plc, points, creases) {
  if (creases.empty()) return;
  GapInHierarchy gap(plc, *features_);
  if (!CollarPlacement(plc, points, gap, options, *this).place_all()) balls_.clear();
}

// Builds the tree over creases. A curve is one leaf, because its balls are added at once.
void CollarSystem::plant(const Plc& plc, std::span<const Point> points) {
  std::vector<Item> items;
  std::vector<Feature> creases;
  for (const Index vertex : crease_vertices_) {
    creases.push_back({0, vertex});
    items.push_back({points[plc.vertices[vertex].point], {}});
  }
  for (Index curve = 0; curve < plc.curves.size(); ++curve) {
    if (!crease_curve_[curve]) continue;
    Box box;
    for (const Index p : plc.curves[curve].points) box.add(points[p]);
    creases.push_back({1, curve});
    items.push_back({box.centre(), {}});
  }
  std::vector<Index> order(items.size());
  std::iota(order.begin(), order.end(), Index{0});
  Box box;
  build(order, items, 0, box);
  branches_.resize(nodes_.size());
  leaves_.assign(plc.vertices.size() + plc.curves.size(), none);
  for (Index n = 0; n < nodes_.size(); ++n) {
    Node& node = nodes_[n];
    node.box = CentredBox::empty();
    if (node.left == none) {
      const Feature& crease = creases[node.right];
      leaves_[crease.index + (crease.dimension == 1 ? plc.vertices.size() : 0)] = n;
      node.right = none;  // no balls yet
    } else {
      branches_[node.left].parent = branches_[node.right].parent = n;
    }
  }
}

void CollarSystem::complete() {
  if (branches_.empty()) return;
  branches_.clear();
  leaves_.clear();
  nodes_.clear();
  Box box;
  if (!balls_.empty()) build_over_balls(0, box);
}

// Adds the balls since the last call to the tree. Precondition: the system is not complete.
void CollarSystem::index_balls(const Feature& crease) {
  assert(!branches_.empty());
  if (indexed_ == balls_.size()) return;
  Box box;
  const Index root = build_over_balls(indexed_, box), leaf = leaf_of(crease);
  indexed_ = static_cast<Index>(balls_.size());
  nodes_[leaf] = nodes_[root];
  for (Index n = leaf; n != none; n = branches_[n].parent) {
    branches_[n].box.add(box);
    nodes_[n].box = CentredBox(branches_[n].box);
  }
}

Index CollarSystem::build_over_balls(Index first, Box& box) {
  std::vector<Item> items;
  for (std::size_t i = first; i < balls_.size(); ++i) {
    const Point& centre = balls_[i].centre;
    const Vector reach = balls_[i].radius * (1 + 1e-9) * Vector{1, 1, 1};
    items.push_back({centre, {centre - reach, centre + reach}});
  }
  std::vector<Index> order(items.size());
  std::iota(order.begin(), order.end(), Index{0});
  return build(order, items, first, box);
}

Index CollarSystem::build(std::span<Index> order, std::span<const Item> items, Index first, Box& box) {
  const auto node = static_cast<Index>(nodes_.size());
  nodes_.push_back({{}, none, none});
  Box below;
  if (order.size() == 1) {
    below = items[order[0]].box;
    nodes_[node].right = first + order[0];
  } else {
    Box spread;
    for (const Index item : order) spread.add(items[item].centre);
    const Vector sides = spread.max - spread.min;
    const std::size_t axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    const std::size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                     [&](Index a, Index b) {
                       const double x = items[a].centre[axis], y = items[b].centre[axis];
                       return x != y ? x < y : a < b;
                     });
    const Index left = build(order.subspan(0, half), items, first, below);
    const Index right = build(order.subspan(half), items, first, below);
    nodes_[node].left = left;
    nodes_[node].right = right;
  }
  nodes_[node].box = CentredBox(below);
  box.add(below);
  return node;
}

// Visits the balls below nodes whose box qualifies, until visit_ball returns true.
template <class Meets, class Visit>
void CollarSystem::visit(const Meets& meets_box, const Visit& visit_ball) const {
  std::array<Index, 128> stack;
  std::size_t top = 0;
  if (!nodes_.empty()) stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (!meets_box(node.box)) continue;
    if (node.left != none) {
      stack[top++] = node.right;
      stack[top++] = node.left;
    } else if (node.right != none && visit_ball(node.right)) {
      return;
    }
  }
}

Index CollarSystem::ball_containing(const Point& p) const {
  Index found = none;
  visit([&](const CentredBox& box) { return box.squared_distance(p) == 0; },
        [&](Index ball) {
          if (!contains(ball, p)) return false;
          found = ball;
          return true;
        });
  return found;
}

void CollarSystem::balls_meeting(const Point& p, double radius, std::size_t most,
                                 std::vector<Index>& found) const {
  found.clear();
  visit([&](const CentredBox& box) { return box.squared_distance(p) <= radius * radius; },
        [&](Index ball) {
          const double reach = radius + balls_[ball].radius;
          if (squared_distance(p, balls_[ball].centre) <= reach * reach) found.push_back(ball);
          return found.size() >= most;
        });
}

void CollarSystem::balls_on_segment(const Point& p, const Point& q, std::vector<Index>& found) const {
  found.clear();
  const SegmentAgainstBoxes segment(p, q);
  visit([&](const CentredBox& box) { return segment.may_meet(box); },
        [&](Index ball) {
          if (contains(ball, nearest_point_on_segment(balls_[ball].centre, p, q))) found.push_back(ball);
          return false;
        });
}

}  // namespace collarmesh
