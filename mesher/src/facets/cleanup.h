#pragma once

#include "facets/complex_draft.h"

namespace collarmesh::facets {

/// Removes the triangles whose corners lie exactly on one line. A neighbour at the long edge of such a
/// triangle is cut at the corner in between, so the surface keeps the same points and stays closed.
void remove_collinear_triangles(ComplexDraft& draft);

/// Removes all but the first of the triangles of a soup with the same corners.
void remove_duplicates_within_soups(ComplexDraft& draft);

/// Removes all but the first of the triangles with the same corners, whatever their soups: touching solids
/// then share one interface. If the soup of a removed triangle had its solid on one side, the soup gets a
/// claim (Claim) to that side. Precondition: the triangles of each soup are oriented.
void merge_duplicates_across_soups(ComplexDraft& draft);

}  // namespace collarmesh::facets
