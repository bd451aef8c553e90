#pragma once

#include <cstddef>
#include <vector>

#include "facets/draft.h"

namespace collarmesh::repairing {

/// Returns whether the triangles enclose nothing, whatever their orientation. Precondition: they only meet in
/// common edges and corners, or are copies of each other. Removes triangles with an edge of their own one
/// after the other: if none is left, they enclose nothing, because closed surfaces have no such triangle. The
/// converse is not tested. Cost: O(n).
bool peels_away(const facets::Draft& draft);

/// The result of `turn_components`.
struct TurnReport {
  std::size_t turned_components = 0;
  std::vector<Point> places;
};

/// Reverses closed components of surfaces whose orientation contradicts the rest: those oriented inwards that
/// lie in nothing, and those inside a reversed component. A component is connected by edges that two
/// triangles of one soup share. Cost: O(n log n).
TurnReport turn_components(facets::Draft& draft);

/// The result of `drop_flakes`.
struct FlakeReport {
  double volume = 0;          ///< volume of all that were dropped
  std::vector<Point> places;  ///< a place in each
};

/// Drops closed components thinner than `thickness` (absolute: twice the volume by the area) if they have
/// hardly any of the total volume. Components are those of `turn_components`; those of complexes stay. Cost:
/// O(n log n).
FlakeReport drop_flakes(facets::Draft& draft, double thickness);

/// The result of `keep_boundaries`.
struct InsideReport {
  std::size_t removed_triangles = 0;  ///< inside a solid, or enclosing nothing
  double removed_area = 0;
  std::size_t internal_facets = 0;  ///< open sheets inside a solid, which stay
  std::size_t dropped_sheets = 0;   ///< triangles of open sheets outside of all solids
  double dropped_area = 0;          ///< area of these
  std::vector<Point> places;
  double chamber_volume = 0;          ///< volume of thin chambers that became part of their neighbours
  std::vector<Point> chamber_places;  ///< a place in each
};

/// Keeps the triangles of a clean arrangement that bound something. A place is inside a soup if the winding
/// number of its surface is above 1/2 there; if it is inside several soups, the first one counts. Each soup
/// then has the boundary of its part of space, oriented outwards; triangles between two soups have a copy for
/// each. Components of which every edge has two triangles of one soup, with consistent orientation, stay as
/// they are, and so do the facets of complexes. A chamber thinner than `thickness` (absolute: twice its
/// volume by its area), many of which lie between sheets that nearly coincide, becomes part of the neighbour
/// with the largest common area. Precondition: triangles only meet in common edges and corners, or are copies
/// of each other. Cost: O(n log n).
InsideReport keep_boundaries(facets::Draft& draft, double thickness);

}  // namespace collarmesh::repairing
