#pragma once

#include "plc/draft.h"

namespace collarmesh::build {

/// Remove the triangles whose corners lie exactly on one line. What has such a triangle's long edge
/// is cut at the corner in between, so the surface keeps the same points and stays closed.
void remove_collinear_triangles(Draft& draft);

/// Of the triangles of one soup with the same corners keep the first.
void remove_twins_within_soups(Draft& draft);

/// Of the triangles of several soups with the same corners keep the first: where two solids touch
/// they share one interface. The sides that the others took for solid become claims.
/// Precondition: the triangles of each soup are oriented.
void merge_twins_across_soups(Draft& draft);

}  // namespace collarmesh::build
