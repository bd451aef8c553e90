#include "collar/gap_size.h"

namespace collarmesh {

bool contains(const Plc& plc, const Feature& other, const Feature& vertex_or_curve) {
  const Index index = vertex_or_curve.index;
  if (other.dimension <= vertex_or_curve.dimension) return other == vertex_or_curve;
  if (vertex_or_curve.dimension == 1) return plc.curve_on_patch(index, other.index);
  return other.dimension == 1 ? plc.vertex_on_curve(index, other.index)
                              : plc.vertex_on_patch(index, other.index);
}

double GapInHierarchy::at_vertex(Index vertex, double bound) {
  return features_.distance_to_features(features_.nearest_point({0, vertex}, {}), bound,
                                        [&](const Feature& feature) {
                                          return !contains(plc_, feature, {0, vertex});
                                        });
}

double GapInHierarchy::on_curve(Index curve, const Point& p, double bound) {
  return features_.distance_to_features(p, bound, [&](const Feature& feature) {
    return !contains(plc_, feature, {1, curve});
  });
}

}  // namespace collarmesh
