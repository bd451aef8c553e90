#pragma once

#include <cstddef>
#include <vector>

#include "facets/complex_draft.h"

namespace collarmesh::repairing {

/// Returns true only if the triangles enclose nothing, whatever their orientation. Repeatedly removes
/// triangles with an edge that no other triangle has. Closed surfaces have no such edge, so if no triangle is
/// left, they enclose nothing. May return false for triangles that enclose nothing. Precondition: triangles
/// only meet in common edges and corners, or are copies of each other. Cost: O(n).
bool peels_away(const facets::ComplexDraft& draft);

/// The result of `turn_components`.
struct TurnReport {
  std::size_t turned_components = 0;
  std::vector<Point> places;
};

/// Reverses closed components whose orientation contradicts the rest of their soup: components that are
/// oriented inwards but lie inside nothing, and components inside a reversed one. A component is connected by
/// edges at which exactly two triangles of one soup meet with consistent orientation. Soups that are
/// complexes are not changed. Cost: O(n log n).
TurnReport turn_components(facets::ComplexDraft& draft);

/// The result of `drop_flakes`.
struct FlakeReport {
  double volume = 0;          ///< volume of all dropped components
  std::vector<Point> places;  ///< a place in each of them
};

/// Drops closed components thinner than `thickness` (absolute) that have at most 1/1000 of the total volume.
/// A component's thickness is twice its volume divided by its area. Components are defined at
/// `turn_components`; those of complexes stay. Drops nothing if nothing would be left. Cost: O(n log n).
FlakeReport drop_flakes(facets::ComplexDraft& draft, double thickness);

/// The result of `keep_boundaries`.
struct InsideReport {
  std::size_t removed_triangles = 0;  ///< triangles with the same solid, or with none, on both sides
  double removed_area = 0;
  std::size_t internal_facets = 0;  ///< triangles of open sheets inside a solid, which stay
  std::size_t dropped_sheets = 0;   ///< triangles of open sheets outside of all solids
  double dropped_area = 0;          ///< area of these sheets
  std::vector<Point> places;        ///< centroids of removed triangles
  std::vector<Point> dropped_places;
  double chamber_volume = 0;          ///< volume of thin chambers that became part of their neighbours
  std::vector<Point> chamber_places;  ///< a place in each of them
};

/// Keeps the triangles of a clean arrangement that bound a solid, and open sheets inside solids. A place is
/// inside a soup if the winding number of the soup's surface is above 1/2 there; a place inside several soups
/// belongs to the first one. Afterwards, each soup has the boundary of its part of space, oriented outwards;
/// triangles between two soups have a copy for each. The facets of complexes stay as they are, and so do
/// components in which each edge has two triangles of one soup with consistent orientation. A chamber is a
/// part of space that triangles separate from the rest; its thickness is twice its volume divided by its
/// area. Chambers thinner than `thickness` (absolute), such as those between sheets that nearly coincide,
/// become part of the neighbour with the largest common area. Precondition: triangles only meet in common
/// edges and corners, or are copies of each other. Cost: O(n log n).
InsideReport keep_boundaries(facets::ComplexDraft& draft, double thickness);

}  // namespace collarmesh::repairing
