#include "common/flat_features.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/distances.h"

namespace collarmesh {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double infinite = std::numeric_limits<double>::infinity();
// The maximum number of rounds in which a place is brought within the limit of its curve, and then of the
// plane of each of the curve's patches. Few are enough: the planes nearly coincide, or meet in the curve.
constexpr int most_turns = 20;
// Places are moved back to this share of the limit, so that rounding cannot leave them beyond it.
constexpr double inside = 0.99;

Point nearest_on_chain(const std::vector<Point>& points, const std::vector<Index>& chain, const Point& p) {
  Point nearest = points[chain.front()];
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const Point q = nearest_point_on_segment(p, points[chain[i - 1]], points[chain[i]]);
    if (squared_distance(p, q) < squared_distance(p, nearest)) nearest = q;
  }
  return nearest;
}

double rounding_of(const Plc& plc) {
  double largest = 0;
  for (std::size_t axis = 0; axis < 3 && !plc.bounds.empty(); ++axis)
    largest = std::max({largest, std::fabs(plc.bounds.min[axis]), std::fabs(plc.bounds.max[axis])});
  return 0.5e-12 * (plc.bounds.empty() ? 0 : plc.bounds.diagonal()) + 4 * epsilon * largest;
}

}  // namespace

FlatFeatures::FlatFeatures(const Plc& plc)
    : plc_(plc), curve_room_(plc.curves.size(), infinite), patch_room_(plc.patches.size(), infinite) {
  const double rounding = rounding_of(plc);
  const auto permitted = [&](double deviation) { return std::min(4 * deviation, plc.planar_tolerance); };
  for (Index c = 0; c < plc.curves.size(); ++c) {
    const std::vector<Index>& chain = plc.curves[c].points;
    if (!plc.curves[c].straight) continue;
    double deviation = 0;
    for (const Index i : chain)
      deviation = std::max(
          deviation, distance_to_segment(plc.points[i], plc.points[chain.front()], plc.points[chain.back()]));
    curve_room_[c] = 0.5 * permitted(deviation) + rounding;
  }
  for (Index k = 0; k < plc.patches.size(); ++k) {
    const Plc::Patch& patch = plc.patches[k];
    if (!patch.planar) continue;
    double deviation = 0;
    for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t)
      for (const Index i : plc.triangles[t].points)
        deviation = std::max(deviation, std::fabs(dot(plc.points[i] - patch.origin, patch.normal)));
    patch_room_[k] = permitted(deviation) + rounding;
  }
}

ExactGeometry FlatFeatures::limit(const ExactGeometry& exact) const {
  return [this, &exact](unsigned dimension, Index feature, const Point& p) -> std::optional<Point> {
    const std::optional<Point> place = exact(dimension, feature, p);
    return place ? keep(dimension, feature, *place) : place;
  };
}

std::optional<Point> FlatFeatures::keep(unsigned dimension, Index feature, Point place) const {
  if (dimension == 2) {
    put_on_plane(feature, place);
    return place;
  }
  for (int turn = 0; turn < most_turns; ++turn) {
    bool moved = put_on_curve(feature, place);
    for (const Index patch : plc_.curves[feature].patches) moved = put_on_plane(patch, place) || moved;
    if (!moved) return place;
  }
  return std::nullopt;
}

// Moves a place back if it is too far from a straight curve's polyline. Returns whether it moved the place.
bool FlatFeatures::put_on_curve(Index curve, Point& p) const {
  if (curve_room_[curve] == infinite) return false;
  const Point q = nearest_on_chain(plc_.points, plc_.curves[curve].points, p);
  const double off = distance(p, q);
  if (!(off > curve_room_[curve])) return false;
  p = q + inside * curve_room_[curve] / off * (p - q);
  return true;
}

bool FlatFeatures::put_on_plane(Index patch, Point& p) const {
  const Plc::Patch& plane = plc_.patches[patch];
  if (patch_room_[patch] == infinite) return false;
  const double off = dot(p - plane.origin, plane.normal);
  if (!(std::fabs(off) > patch_room_[patch])) return false;
  p = p - (off - std::copysign(inside * patch_room_[patch], off)) * plane.normal;
  return true;
}

}  // namespace collarmesh
