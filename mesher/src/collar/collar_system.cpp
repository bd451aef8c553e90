#include "collar/collar_system.h"

#include <algorithm>
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
}

CollarSystem::CollarSystem(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases,
                           const CollarOptions& options)
    : CollarSystem(plc, points, creases) {
  if (creases.empty()) return;
  GapInHierarchy gap(plc, *features_);
  if (!CollarPlacement(plc, points, gap, options, *this).place_all()) balls_.clear();
}

void CollarSystem::complete() {
  if (trees_.size() <= 1) return;
  trees_.clear();
  nodes_.clear();
  indexed_ = 0;
  index_balls();
}

void CollarSystem::index_balls() {
  const auto count = static_cast<Index>(balls_.size());
  Index first = indexed_;
  while (!trees_.empty() && first - trees_.back().first_ball <= count - first) {
    first = trees_.back().first_ball;
    nodes_.resize(trees_.back().root);
    trees_.pop_back();
  }
  indexed_ = count;
  if (first == count) return;
  std::vector<Index> order(count - first);
  std::iota(order.begin(), order.end(), first);
  Box box;
  trees_.push_back({first, build(order, box)});
}

Index CollarSystem::build(std::span<Index> order, Box& box) {
  const auto node = static_cast<Index>(nodes_.size());
  nodes_.push_back({{}, none, none});
  Box below;
  if (order.size() == 1) {
    const CollarBall& ball = balls_[order[0]];
    const Vector reach = ball.radius * (1 + 1e-9) * Vector{1, 1, 1};
    below.add(ball.centre - reach);
    below.add(ball.centre + reach);
    nodes_[node].right = order[0];
  } else {
    Box spread;
    for (const Index ball : order) spread.add(balls_[ball].centre);
    const Vector sides = spread.max - spread.min;
    const std::size_t axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    const std::size_t half = order.size() / 2;
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(),
                     [&](Index a, Index b) {
                       const double x = balls_[a].centre[axis], y = balls_[b].centre[axis];
                       return x != y ? x < y : a < b;
                     });
    const Index left = build(order.subspan(0, half), below), right = build(order.subspan(half), below);
    nodes_[node].left = left;
    nodes_[node].right = right;
  }
  nodes_[node].box = CentredBox(below);
  box.add(below);
  return node;
}

// Visit the balls below nodes whose box qualifies, until visit_ball returns true.
template <class Meets, class Visit>
void CollarSystem::visit(const Meets& meets_box, const Visit& visit_ball) const {
  std::array<Index, 128> stack;
  std::size_t top = 0;
  for (const Tree& tree : trees_) stack[top++] = tree.root;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (!meets_box(node.box)) continue;
    if (node.left != none) {
      stack[top++] = node.right;
      stack[top++] = node.left;
    } else if (visit_ball(node.right)) {
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
  const Vector d = q - p;
  const double length = squared_norm(d);
  visit([&](const CentredBox& box) { return segment.may_meet(box); },
        [&](Index ball) {
          const Point& centre = balls_[ball].centre;
          const double t = length > 0 ? std::clamp(dot(centre - p, d) / length, 0.0, 1.0) : 0.0;
          if (contains(ball, p + t * d)) found.push_back(ball);
          return false;
        });
}

}  // namespace collarmesh
