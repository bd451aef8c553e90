#pragma once

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh {

/// The thickness of a region, or of the outside between two parts of the surface, at each triangle of the
/// surface: the distance along the normal to the end of the region.
class Thickness {
 public:
  /// Keeps the complex by reference. Cost: near linear in the triangles.
  explicit Thickness(const Plc& plc);

  /// A ray from the centre of a triangle along its smooth normal or against it. The triangle's patch is the
  /// ray's first patch.
  struct Ray {
    Point from;
    Vector way;  ///< unit vector; zero if the normal is unknown
  };
  struct Opposite {
    double distance = INFINITY;
    Index triangle = none;  ///< triangle where the ray leaves the region; none if it meets none
    unsigned side = 0;      ///< side of that triangle on which the region lies
    double facing = 0;      ///< absolute cosine of the angle between the ray and that triangle's normal
  };
  struct Opposites {
    Opposite apart;         ///< nearest opposite triangle that is not at a slant, of a patch that does not
                            ///< meet the ray's first patch in a crease
    Opposite first;         ///< nearest opposite triangle, of any patch and at any angle to the ray
    bool is_wedge = false;  ///< whether the patch of `first` meets the ray's first patch in a crease
  };
  /// Scratch space of a thread.
  using Crossings = std::vector<TriangleHierarchy::Crossing>;

  /// Returns the ray from the triangle towards its side 0 (behind) or 1 (in front).
  Ray ray(Index triangle, unsigned side) const;
  /// Returns what this ray meets within a distance (`reach`).
  Opposites at(Index triangle, unsigned side, Crossings& crossings, double reach = INFINITY) const;

 private:
  const Plc& plc_;
  TriangleHierarchy triangles_;
  // Pairs of patches that meet in a crease: the wedge between them may be thin.
  std::set<std::pair<Index, Index>> creases_;
  std::vector<Vector> normals_;  // by triangle: unit normals of the smooth surface, which needles of its
                                 // tessellation do not disturb
};

}  // namespace collarmesh
