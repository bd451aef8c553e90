#include "check/region_locator.h"

#include <array>
#include <cmath>

#include "mesh/orientation.h"

namespace collarmesh::checks {

namespace {

using CornerPoints = std::array<Point, 3>;

CornerPoints corners_of(const Plc& plc, const Plc::Triangle& t) {
  return {plc.points[t.points[0]], plc.points[t.points[1]], plc.points[t.points[2]]};
}

std::vector<CornerPoints> all_corners(const Plc& plc) {
  std::vector<CornerPoints> corners;
  for (const Plc::Triangle& t : plc.triangles) corners.push_back(corners_of(plc, t));
  return corners;
}

std::vector<Box> all_boxes(const Plc& plc) {
  std::vector<Box> boxes(plc.triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const Index p : plc.triangles[i].points) boxes[i].add(plc.points[p]);
  return boxes;
}

enum class Crossing { none, inside, at_border };

struct Meeting {
  Crossing crossing;
  bool in_front;  // the segment begins on the side that the normal points to
};

// Returns how the segment from p, which is not on the triangle, to q meets the triangle.
Meeting meet(const Point& p, const Point& q, const CornerPoints& t) {
  const int from = exact_orientation(t[0], t[1], t[2], p), to = exact_orientation(t[0], t[1], t[2], q);
  if (from == 0 && to == 0) return {Crossing::at_border, false};  // the segment lies in the triangle's plane
  if (from == to || from == 0) return {Crossing::none, false};
  bool on_border = to == 0, left = false, right = false;
  for (unsigned i = 0; i < 3; ++i) {
    const int side = exact_orientation(p, q, t[i], t[(i + 1) % 3]);
    on_border = on_border || side == 0;
    left = left || side > 0;
    right = right || side < 0;
  }
  if (left && right) return {Crossing::none, false};
  return {on_border ? Crossing::at_border : Crossing::inside, from > 0};
}

// Returns where the segment pq meets the plane of the triangle: 0 at p, 1 at q.
double place_of_plane(const Point& p, const Point& q, const CornerPoints& t) {
  const double from = std::fabs(six_volume(t[0], t[1], t[2], p)),
               to = std::fabs(six_volume(t[0], t[1], t[2], q));
  return from + to > 0 ? from / (from + to) : 0;
}

}  // namespace

const RegionLocator::Trees& RegionLocator::trees() const {
  std::call_once(once_, [&] {
    trees_.emplace(Trees{DistanceTree(all_corners(plc_)), BoxTree(all_boxes(plc_))});
  });
  return *trees_;
}

// Follows the ray from p through `target` to twice the target's distance. Returns the region on p's side of
// the first triangle that the ray meets; none if the ray meets no triangle, or meets the border of a
// triangle.
Index RegionLocator::region_on_the_way(const Point& p, const Point& target) const {
  const Point beyond = target + (target - p);
  double first = INFINITY;
  Index region = none;
  bool doubtful = false;
  trees().boxes.for_each_near_segment(p, beyond, [&](Index i) {
    const Plc::Triangle& triangle = plc_.triangles[i];
    const CornerPoints corners = corners_of(plc_, triangle);
    const Meeting meeting = meet(p, beyond, corners);
    if (meeting.crossing == Crossing::none) return;
    doubtful = doubtful || meeting.crossing == Crossing::at_border;
    const double place = place_of_plane(p, beyond, corners);
    if (place >= first) return;
    first = place;
    region = plc_.patches[triangle.patch].regions[meeting.in_front ? 1 : 0];
  });
  return doubtful ? none : region;
}

Index RegionLocator::region_at(const Point& p) const {
  constexpr std::array<Vector, 6> places{{{0.3713, 0.3241, 0.3046},
                                          {0.5377, 0.2839, 0.1784},
                                          {0.1588, 0.6622, 0.1790},
                                          {0.2426, 0.1784, 0.5790},
                                          {0.7254, 0.1631, 0.1115},
                                          {0.0912, 0.1377, 0.7711}}};
  const auto towards = [&](Index t) {
    const CornerPoints c = corners_of(plc_, plc_.triangles[t]);
    if (exact_orientation(c[0], c[1], c[2], p) == 0) return none;
    for (const Vector& weights : places)
      if (const Index region = region_on_the_way(p, weights.x * c[0] + weights.y * c[1] + weights.z * c[2]);
          region != none)
        return region;
    return none;
  };
  const Index nearest = trees().triangles.nearest(p).triangle;
  if (nearest == none) return 0;
  Index region = towards(nearest);
  for (Index t = 0; t < plc_.triangles.size() && region == none; ++t) region = towards(t);
  return region == none ? 0 : region;
}

}  // namespace collarmesh::checks
