#include "common/box_frame.h"

#include <limits>

namespace collarmesh {

namespace {

using Triangles = std::span<const std::array<Index, 3>>;

template <class Visit>
void for_each_edge(std::span<const Point> points, Triangles triangles, const Visit& visit) {
  for (const auto& t : triangles)
    for (unsigned i = 0; i < 3; ++i) visit(points[t[(i + 1) % 3]] - points[t[i]]);
}

/// Returns the main direction of the edges' components orthogonal to `across`, which is a unit vector or
/// zero; zero if all these components are zero. Starts with the direction of the longest component; each step
/// turns it towards the directions of the others.
Vector main_direction(std::span<const Point> points, Triangles triangles, const Vector& across) {
  constexpr unsigned steps = 3;
  const auto part_of = [&](const Vector& edge) { return edge - dot(edge, across) * across; };
  Vector longest;
  for_each_edge(points, triangles, [&](const Vector& edge) {
    if (squared_norm(part_of(edge)) > squared_norm(longest)) longest = part_of(edge);
  });
  if (!(norm(longest) > 0)) return {};
  Vector direction = longest / norm(longest);
  for (unsigned step = 0; step < steps; ++step) {
    Vector sum;
    for_each_edge(points, triangles,
                  [&](const Vector& edge) { sum = sum + dot(part_of(edge), direction) * part_of(edge); });
    if (norm(sum) > 0) direction = sum / norm(sum);
  }
  return direction;
}

double area_of_boxes(std::span<const Point> points, Triangles triangles, const BoxFrame& frame) {
  double area = 0;
  for (const auto& t : triangles) {
    Box box;
    for (const Index p : t) frame.add(box, points[p]);
    const Vector side = box.max - box.min;
    area += side.x * side.y + side.y * side.z + side.z * side.x;
  }
  return area;
}

}  // namespace

BoxFrame::BoxFrame(std::span<const Point> points, Triangles triangles) {
  constexpr double worthwhile = 1. / 8;  // the frame is turned if this makes the boxes' total area
                                         // smaller than this share of what it was
  constexpr double roundings = 32;
  BoxFrame turned;
  Box bounds;
  for (const auto& t : triangles)
    for (const Index p : t) bounds.add(points[p]);
  if (bounds.empty()) return;
  turned.turned_ = true;
  turned.origin_ = bounds.centre();
  turned.error_ = roundings * std::numeric_limits<double>::epsilon() * bounds.diagonal();
  turned.axes_[0] = main_direction(points, triangles, {});
  const Vector second = main_direction(points, triangles, turned.axes_[0]),
               third = cross(turned.axes_[0], second);
  if (!(norm(third) > 0)) return;
  turned.axes_[2] = third / norm(third);
  turned.axes_[1] = cross(turned.axes_[2], turned.axes_[0]);
  if (area_of_boxes(points, triangles, turned) < worthwhile * area_of_boxes(points, triangles, *this))
    *this = turned;
}

}  // namespace collarmesh
