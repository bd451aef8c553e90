#pragma once

#include <TopoDS_Face.hxx>
#include <array>
#include <string>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::brep {

/// The outline of a face, with the points that its neighbours use. A node is a point with parameters; points
/// of a seam have two nodes.
struct Outline {
  std::vector<Index> points;  ///< by node: its point's index in the shape's tessellation
  std::vector<Point> places;
  std::vector<std::array<double, 2>> parameters;
  std::vector<std::array<Index, 2>> chords;  ///< chords between nodes
};

/// Triangles of one face, oriented like its surface's normal.
struct MendedFace {
  TopoDS_Face face;  ///< possibly healed; the parameters refer to its surface
  std::vector<Point> points;
  std::vector<std::array<double, 2>> parameters;  ///< by point, or empty
  std::vector<Index> outline_points;              ///< by point: its entry in `Outline::points`, or none
  std::vector<std::array<Index, 3>> triangles;    ///< empty if all ways failed
  bool fits = false;                              ///< whether the border of the triangles is the outline
  std::string how;  ///< the way that was used, for a note, such as "alone after shape healing"
};

/// Triangulates a face for which the tessellation of the whole shape fails, by the first of these ways that
/// fits the outline: the face alone, as it is and after shape healing; its outline in the parameter plane,
/// with inner points of the surface; its outline in a fitted plane; the face alone with a larger deflection.
/// If none fits, chooses the way with the fewest `sides_off`. The deflection is absolute, the angle is in
/// radians.
MendedFace mend_face(const TopoDS_Face& face, const Outline& outline, double deflection, double angle);

/// Returns the number of sides that occur an odd number of times among the sides of a face's triangles and
/// the chords of its outline, taken together; 0: the outline is the border of the triangles. Triangles and
/// chords refer to the same points.
std::size_t sides_off(const std::vector<std::array<Index, 3>>& triangles,
                      const std::vector<std::array<Index, 2>>& chords);

}  // namespace collarmesh::brep
