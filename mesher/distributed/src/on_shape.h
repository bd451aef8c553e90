#pragma once

#include "collarmesh/distributed.h"
#include "common/flat_features.h"
#include "second_order/nearest_on_features.h"

namespace collarmesh::distributed {

/// Finds the places on a shape of nodes on curves and patches. Keeps a reference to the shape.
class OnShape {
 public:
  explicit OnShape(const Shape& shape)
      : plc_(shape.plc),
        nearest_(shape.plc),
        flat_(shape.plc),
        exact_(shape.exact ? flat_.limit(shape.exact) : ExactGeometry{}) {}
  OnShape(const OnShape&) = delete;
  OnShape& operator=(const OnShape&) = delete;

  bool is_smooth(const TetMesh::VertexFeature& feature) const {
    return feature.dimension == 1   ? !plc_.curves[feature.feature].straight
           : feature.dimension == 2 ? !plc_.patches[feature.feature].planar
                                    : false;
  }
  /// Returns whether nodes on this feature may have a place off their chords.
  bool has_places(const TetMesh::VertexFeature& feature) const {
    const bool on_feature = feature.dimension == 1 || feature.dimension == 2;
    return on_feature && feature.feature != none && (exact_ || is_smooth(feature));
  }
  /// Returns the place of a node. Precondition: has_places(feature).
  Point place(const TetMesh::VertexFeature& feature, const Point& p) {
    if (exact_)
      if (const auto place = exact_(feature.dimension, feature.feature, p)) return *place;
    return is_smooth(feature) ? nearest_.nearest(feature, p) : p;
  }
  /// Returns the distance to the complex's own polyline or triangles.
  double distance_to_complex(const TetMesh::VertexFeature& feature, const Point& p) {
    return distance(nearest_.nearest(feature, p), p);
  }

 private:
  const Plc& plc_;
  second_order::NearestOnFeatures nearest_;
  FlatFeatures flat_;
  ExactGeometry exact_;
};

}  // namespace collarmesh::distributed
