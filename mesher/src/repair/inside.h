#pragma once

#include <cstddef>
#include <vector>

#include "facets/draft.h"

namespace collarmesh::repairing {

/// Do the triangles enclose nothing, whatever their orientation? Precondition: they meet in common edges and
/// corners only, or are copies of each other. True is certain: nothing is left when triangles with an edge of
/// their own are taken away one after the other, as closed surfaces have none. Only that is looked at, so
/// false is not. Cost: O(n).
bool peels_away(const facets::Draft& draft);

/// What `turn_components` did.
struct TurnReport {
  std::size_t turned_components = 0;
  std::vector<Point> places;
};

/// Turn those closed components of surfaces whose orientation contradicts the rest: those oriented inwards
/// that lie in nothing, and those inside a component that is turned. A component is what is connected by
/// edges that two triangles of one soup share. Cost: O(n log n).
TurnReport turn_components(facets::Draft& draft);

/// What `drop_flakes` did.
struct FlakeReport {
  double volume = 0;          ///< of all that were dropped
  std::vector<Point> places;  ///< one in each
};

/// Drop closed components thinner than `thickness` (absolute: twice the volume by the area) with hardly any
/// of the volume of all. Components are those of `turn_components`; of complexes none is dropped. Cost: O(n
/// log n).
FlakeReport drop_flakes(facets::Draft& draft, double thickness);

/// What `keep_boundaries` did.
struct InsideReport {
  std::size_t removed_triangles = 0;  ///< inside a solid, or enclosing nothing
  double removed_area = 0;
  std::size_t internal_facets = 0;  ///< open sheets inside a solid, which stay
  std::size_t dropped_sheets = 0;   ///< triangles of open sheets outside of all solids
  double dropped_area = 0;          ///< of these
  std::vector<Point> places;
  double chamber_volume = 0;          ///< of thin chambers that became part of their neighbours
  std::vector<Point> chamber_places;  ///< one in each
};

/// Of a clean arrangement keep the triangles that bound something. Inside a soup is where the winding number
/// of its surface is above 1/2; where several soups are inside, the first one is. Each soup then has the
/// boundary of its place, oriented outwards; what parts two soups has a copy for each. Components of which
/// every edge has two triangles of one soup, oriented alike, stay as they are. So do the facets of complexes.
/// A chamber that is thinner than `thickness` (absolute: twice its volume by its area), as sheets that nearly
/// coincide have many between them, becomes part of what it has most of its area in common with.
/// Precondition: triangles meet in common edges and corners only, or are copies of each other.
/// Cost: O(n log n).
InsideReport keep_boundaries(facets::Draft& draft, double thickness);

}  // namespace collarmesh::repairing
