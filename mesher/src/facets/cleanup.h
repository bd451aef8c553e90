#pragma once

#include "facets/draft.h"

namespace collarmesh::facets {

/// Removes the triangles whose corners lie exactly on one line. Neighbours at such a triangle's long edge
/// are cut at the corner in between, so the surface keeps the same points and stays closed.
void remove_collinear_triangles(Draft& draft);

/// Keeps the first of the triangles of one soup with the same corners.
void remove_twins_within_soups(Draft& draft);

/// Keeps the first of the triangles of several soups with the same corners: where two solids touch
/// they share one interface. The sides that the others took for solid become claims.
/// Precondition: the triangles of each soup are oriented.
void merge_twins_across_soups(Draft& draft);

}  // namespace collarmesh::facets
