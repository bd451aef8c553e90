#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/plc.h"
#include "collarmesh/polygon_soup.h"

/// The steps that turn soups into the draft of a complex. Each step has its own file.
namespace collarmesh::facets {

/// The corners of a triangle. Its side i is the edge from corner i to corner i + 1.
using Corners = std::array<Index, 3>;

/// The origin of a triangle in the input.
struct Origin {
  Tag tag = 0;
  Index soup = 0;
  Index facet = 0;
  bool oriented = true;  ///< whether the orientation tells on which side the solid of its soup lies
};

/// An edge that the input gives as a segment.
struct Segment {
  Index a = 0, b = 0;
  Tag tag = 0;
  Index soup = 0;
};

/// The claim of a soup whose triangle was dropped as a duplicate: the soup's solid is on this side of the
/// triangle that is left.
struct Claim {
  Index side = 0;  ///< 2 t behind triangle t, 2 t + 1 in front of it
  Index soup = 0;
};

/// A complex under construction: welded points, triangles with their origins in the soups, explicit segments
/// and points. `build_plc` and `repair` change it step by step, so facets may still intersect.
struct ComplexDraft {
  std::vector<Point> points;
  std::vector<Tag> point_tags;
  std::vector<Corners> triangles;
  std::vector<Origin> origins;  ///< one per triangle
  std::vector<Segment> segments;
  std::vector<Index> loose_points;  ///< points that the input gives as vertices
  std::vector<Claim> claims;

  std::vector<std::string> soup_names;
  std::vector<bool> soup_is_complex;      ///< `is_complex`, by soup
  std::vector<bool> soup_gives_features;  ///< PolygonSoup::given_features, by soup

  Box bounds;
  double planar_tolerance = 0;   ///< permitted distance of a polygon's corners from its plane, absolute
  double largest_deviation = 0;  ///< largest distance of a point from its fitted plane or line, or from the
                                 ///< place where welding puts it; absolute
  Plc::Cleanup cleanup;

  /// Returns the distance by which rounding alone may move points off a plane.
  double rounding() const {
    const auto reach = [](const Point& p) {
      return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    };
    return 32 * 2.2e-16 * std::max(reach(bounds.min), reach(bounds.max));
  }
  const Point& corner(Index triangle, unsigned i) const { return points[triangles[triangle][i]]; }
  void add_triangle(const Corners& corners, const Origin& origin) {
    triangles.push_back(corners);
    origins.push_back(origin);
  }
};

/// Returns half the cross product of two sides.
inline Vector area_vector(const ComplexDraft& draft, const Corners& t) {
  return 0.5 * cross(draft.points[t[1]] - draft.points[t[0]], draft.points[t[2]] - draft.points[t[0]]);
}
inline double area_of(const ComplexDraft& draft, const Corners& t) { return norm(area_vector(draft, t)); }

inline Index back_side(Index triangle) { return 2 * triangle; }
inline Index front_side(Index triangle) { return 2 * triangle + 1; }

}  // namespace collarmesh::facets
