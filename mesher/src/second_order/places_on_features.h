#pragma once

#include <cassert>

#include "collarmesh/exact_geometry.h"
#include "common/flat_features.h"
#include "location/feature_shapes.h"

namespace collarmesh::second_order {

/// A search for the places of nodes on curves and patches: on the exact geometry or, where there is none, on
/// the complex.
class PlacesOnFeatures {
 public:
  /// Keeps references to both.
  PlacesOnFeatures(const Plc& plc, const ExactGeometry& exact)
      : plc_(plc), shapes_(plc), flat_(plc), exact_(exact ? flat_.limit(exact) : ExactGeometry{}) {}
  PlacesOnFeatures(const PlacesOnFeatures&) = delete;
  PlacesOnFeatures& operator=(const PlacesOnFeatures&) = delete;

  static bool is_known(const TetMesh::VertexFeature& feature) {
    return feature.feature != none && (feature.dimension == 1 || feature.dimension == 2);
  }
  bool is_smooth(const TetMesh::VertexFeature& feature) const {
    if (!is_known(feature)) return false;
    return feature.dimension == 1 ? !plc_.curves[feature.feature].straight
                                  : !plc_.patches[feature.feature].planar;
  }
  bool is_flat(const TetMesh::VertexFeature& feature) const {
    return is_known(feature) && !is_smooth(feature);
  }
  /// Returns whether a place at this distance from the middle of an edge of this length belongs to the edge.
  /// A half circle has the ratio 0.5, so farther places lie on another part of the feature.
  static bool belongs(double distance, double length) { return distance <= 0.5 * length; }
  /// Returns whether nodes on this feature may have a place off their chords.
  bool has_places(const TetMesh::VertexFeature& feature) const {
    return is_known(feature) && (exact_ || is_smooth(feature));
  }
  /// Returns the place of a node. Precondition: has_places(feature).
  Point place(const TetMesh::VertexFeature& feature, const Point& p) {
    assert(has_places(feature));
    if (exact_)
      if (const auto place = exact_(feature.dimension, feature.feature, p)) return *place;
    return is_smooth(feature) ? shapes_.nearest(feature, p) : p;
  }

 private:
  const Plc& plc_;
  FeatureShapes shapes_;
  FlatFeatures flat_;
  ExactGeometry exact_;  // limited by `flat_`; empty if there is no exact geometry
};

}  // namespace collarmesh::second_order
