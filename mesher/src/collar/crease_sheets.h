#pragma once

#include <array>
#include <span>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh {

/// A side of a patch at a crease, with the unit direction in which the patch leads away from the crease.
struct Sheet {
  Index patch;
  Vector direction;
};

/// The triangles at creases, from which the directions of sheets follow.
class CreaseSheets {
 public:
  /// Keeps references to `plc` and `points`. Covers only the given vertices and curves.
  CreaseSheets(const Plc& plc, std::span<const Point> points, std::span<const Index> vertices,
               const std::vector<bool>& is_crease_curve);

  /// Returns the sheets at a segment of a crease curve, given by its two points; their directions are
  /// orthogonal to the segment.
  std::vector<Sheet> at_segment(const std::array<Index, 2>& ends) const;
  /// Returns the sheets at a crease vertex: for each triangle of a smooth patch there, the directions to five
  /// places on the side opposite the vertex.
  std::vector<Sheet> at_vertex(Index vertex) const;

 private:
  const Plc& plc_;
  std::span<const Point> points_;
  std::vector<std::pair<std::array<Index, 2>, Index>> segments_;  // points of the segment, triangle; sorted
  std::vector<std::pair<Index, Index>> vertices_;                 // point, triangle; sorted
};

}  // namespace collarmesh
