#pragma once

#include <TopoDS_Face.hxx>
#include <array>
#include <string>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::brep {

/// The outline of a face as its neighbours cut it. A node is a point with parameters: points of a seam have
/// two.
struct Outline {
  std::vector<Index> points;  ///< of the shape's tessellation, by node
  std::vector<Point> places;
  std::vector<std::array<double, 2>> parameters;
  std::vector<std::array<Index, 2>> chords;  ///< of nodes
};

/// Triangles of one face, in the sense of its surface's normal.
struct MendedFace {
  TopoDS_Face face;  ///< healed, perhaps; its surface is that of the parameters
  std::vector<Point> points;
  std::vector<std::array<double, 2>> parameters;  ///< one per point, or empty
  std::vector<Index> outline_points;              ///< one per point: which of the outline it is, or none
  std::vector<std::array<Index, 3>> triangles;    ///< none: all ways failed
  bool fits = false;                              ///< its border is the outline
  std::string how;                                ///< "by ...", for a note
};

/// Triangulate a face that the tessellation of the whole shape fails on, by the first of these ways that fits
/// the outline: the face alone, as it is and after shape healing; its outline in the parameter plane, with
/// inner points of the surface; its outline in a fitted plane; the face alone with a larger deflection. If
/// none fits, by that which leaves the fewest sides off it. Lengths are absolute, the angle is in radians.
MendedFace mend_face(const TopoDS_Face& face, const Outline& outline, double deflection, double angle);

/// How many sides of a face's triangles and chords of its outline have no counterpart; 0: the outline is the
/// border of the triangles. Corners and chords are indices of the same points.
std::size_t sides_off(const std::vector<std::array<Index, 3>>& triangles,
                      const std::vector<std::array<Index, 2>>& chords);

}  // namespace collarmesh::brep
