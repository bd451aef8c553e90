#include "collar/collar_system.h"

#include <algorithm>
#include <numeric>

#include "collar/collar_placement.h"

namespace collarmesh {

CollarSystem::CollarSystem(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases,
                           const CollarOptions& options) {
  if (creases.empty() || !CollarPlacement(plc, points, creases, options, *this).place()) balls_.clear();
  if (balls_.empty()) return;
  for (const CollarLink& link : links_)
    consecutive_.push_back({std::min(link.balls[0], link.balls[1]), std::max(link.balls[0], link.balls[1])});
  std::sort(consecutive_.begin(), consecutive_.end());
  std::vector<Index> order(balls_.size());
  std::iota(order.begin(), order.end(), Index{0});
  nodes_.reserve(2 * balls_.size());
  build(order);
}

bool CollarSystem::consecutive(Index a, Index b) const {
  return std::binary_search(consecutive_.begin(), consecutive_.end(),
                            std::array<Index, 2>{std::min(a, b), std::max(a, b)});
}

Index CollarSystem::build(std::span<Index> order) {
  const auto node = static_cast<Index>(nodes_.size());
  nodes_.push_back({{}, none, none});
  Box box;
  if (order.size() == 1) {
    const CollarBall& ball = balls_[order[0]];
    const Vector reach = ball.radius * (1 + 1e-9) * Vector{1, 1, 1};
    box.add(ball.centre - reach);
    box.add(ball.centre + reach);
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
    const Index left = build(order.subspan(0, half)), right = build(order.subspan(half));
    nodes_[node].left = left;
    nodes_[node].right = right;
    box = nodes_[left].box;
    box.add(nodes_[right].box);
  }
  nodes_[node].box = box;
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
  visit(
      [&](const Box& b) {
        return p.x >= b.min.x && p.x <= b.max.x && p.y >= b.min.y && p.y <= b.max.y && p.z >= b.min.z &&
               p.z <= b.max.z;
      },
      [&](Index ball) {
        if (squared_distance(p, balls_[ball].centre) >= balls_[ball].radius * balls_[ball].radius)
          return false;
        found = ball;
        return true;
      });
  return found;
}

bool CollarSystem::meets(const Point& p, double radius) const {
  bool found = false;
  visit(
      [&](const Box& b) {
        return p.x + radius >= b.min.x && p.x - radius <= b.max.x && p.y + radius >= b.min.y &&
               p.y - radius <= b.max.y && p.z + radius >= b.min.z && p.z - radius <= b.max.z;
      },
      [&](Index ball) {
        const double reach = radius + balls_[ball].radius;
        return found = squared_distance(p, balls_[ball].centre) <= reach * reach;
      });
  return found;
}

void CollarSystem::balls_on_segment(const Point& p, const Point& q, std::vector<Index>& found) const {
  found.clear();
  Box range;
  range.add(p);
  range.add(q);
  const Vector d = q - p;
  const double length = squared_norm(d);
  visit(
      [&](const Box& b) {
        return b.min.x <= range.max.x && b.max.x >= range.min.x && b.min.y <= range.max.y &&
               b.max.y >= range.min.y && b.min.z <= range.max.z && b.max.z >= range.min.z;
      },
      [&](Index index) {
        const CollarBall& ball = balls_[index];
        const double t = length > 0 ? std::clamp(dot(ball.centre - p, d) / length, 0.0, 1.0) : 0.0;
        if (squared_distance(ball.centre, p + t * d) < ball.radius * ball.radius) found.push_back(index);
        return false;
      });
}

}  // namespace collarmesh
