#pragma once

#include <vector>

#include "collarmesh/plc.h"

/// The gap size by its definition (paper, Definition 2): an oracle.
namespace collarmesh::testing {

/// The features that contain a point: one vertex with its curves and patches, or one curve with its patches.
struct Containing {
  Index vertex = none;
  std::vector<Index> curves, patches;

  bool has_curve(Index c) const;
  bool has_patch(Index p) const;
};

Containing features_of_vertex(const Plc& plc, Index v);

double brute_force_gap(const Plc& plc, const Point& p, const Containing& features);

double distance_to_segment(const Point& p, const Point& a, const Point& b);

/// Returns evenly spaced points inside each segment of a curve.
std::vector<Point> points_along(const Plc& plc, Index curve, unsigned per_segment);

}  // namespace collarmesh::testing
