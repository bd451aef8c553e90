#pragma once

#include <array>
#include <span>
#include <vector>

#include "collarmesh/plc.h"
#include "common/cells_at_vertices.h"
#include "facets/edges.h"
#include "plc/angles.h"

namespace collarmesh::plc {

/// The triangles of one patch around a point, bounded by segments.
struct Fan {
  Index patch = none;
  bool closed = false;
  std::vector<Index> rim;    ///< the other ends of the triangles' edges at the point, in order
  std::vector<Vector> rays;  ///< unit vectors towards them

  std::size_t sector_count() const { return closed ? rim.size() : rim.size() - 1; }
  Sector sector(std::size_t i) const { return {rays[i], rays[(i + 1) % rays.size()]}; }
};

/// The triangles of each patch around its points, divided by segments.
class PatchFans {
 public:
  /// Keeps points and patches by reference. Segments are pairs of points in any order.
  PatchFans(std::span<const Point> points, const std::vector<Plc::Triangle>& triangles,
            const std::vector<Plc::Patch>& patches, std::span<const std::array<Index, 2>> segments);

  const std::vector<facets::Corners>& triangles() const { return triangles_; }
  const facets::EdgeTable& edges() const { return edges_; }
  Index patch_of(Index side) const { return patch_of_[side / 3]; }

  /// Returns the fans around a point, of smooth patches only or of all.
  std::vector<Fan> at(Index point, bool smooth_only);
  /// Returns the side of the same edge in the neighbouring triangle of the patch; none at a segment.
  Index across(Index side) const;

  /// Returns how sharply a smooth patch folds in a fan around the point (degrees, see fold_angle); 180 if its
  /// edges are at most as long as `noise`, because their directions are unreliable.
  double fold(Index point, const Fan& fan, double noise) const;

 private:
  Fan make_fan(Index start);
  Index next_corner(Index corner) const;
  Index previous_corner(Index corner) const;

  std::span<const Point> points_;
  const std::vector<Plc::Patch>& patches_;
  std::vector<facets::Corners> triangles_;
  std::vector<Index> patch_of_;  // by triangle
  facets::EdgeTable edges_;
  std::vector<bool> is_segment_;  // by edge
  CellsAtVertices triangles_at_;
  std::vector<bool> visited_;  // corners that already are in a fan
};

}  // namespace collarmesh::plc
