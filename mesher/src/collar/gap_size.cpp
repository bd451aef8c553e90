#include "collar/gap_size.h"

namespace collarmesh {

double GapSize::at_vertex(Index vertex) const {
  const Point p = features_.nearest_point({0, vertex}, {});
  return features_.distance_to_features(p, [&](const Feature& feature) {
    if (feature.dimension == 0) return feature.index != vertex;
    if (feature.dimension == 1) return !plc_.vertex_on_curve(vertex, feature.index);
    return !plc_.vertex_on_patch(vertex, feature.index);
  });
}

double GapSize::on_curve(Index curve, const Point& p) const {
  return features_.distance_to_features(p, [&](const Feature& feature) {
    if (feature.dimension == 0) return true;
    if (feature.dimension == 1) return feature.index != curve;
    return !plc_.curve_on_patch(curve, feature.index);
  });
}

}  // namespace collarmesh
