#include "collar/collar_system.h"

#include <algorithm>
#include <numeric>

#include "collar/collar_placement.h"

namespace collarmesh {

CollarSystem::CollarSystem(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases,
                           const CollarOptions& options) {
  if (creases.empty()) return;
  features_ = std::make_unique<const FeatureHierarchy>(plc, points);
  if (!CollarPlacement(plc, points, creases, options, *this).place()) balls_.clear();
  if (balls_.empty()) return;
  for (const CollarLink& link : links_)
    consecutive_.push_back({std::min(link.balls[0], link.balls[1]), std::max(link.balls[0], link.balls[1])});
  std::sort(consecutive_.begin(), consecutive_.end());
  std::vector<Index> order(balls_.size());
  std::iota(order.begin(), order.end(), Index{0});
  nodes_.reserve(2 * balls_.size());
  Box box;
  build(order, box);
}

bool CollarSystem::consecutive(Index a, Index b) const {
  return std::binary_search(consecutive_.begin(), consecutive_.end(),
                            std::array<Index, 2>{std::min(a, b), std::max(a, b)});
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
  if (nodes_.empty()) return;
  std::array<Index, 128> stack;
  std::size_t top = 0;
  stack[top++] = 0;
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
