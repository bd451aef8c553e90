#pragma once

#include "facets/complex_draft.h"

namespace collarmesh::facets {

/// Removes the triangles whose corners lie exactly on one line. A neighbour at the long edge of such a
/// triangle is cut at the corner in between, so the surface keeps the same points and stays closed.
void remove_collinear_triangles(ComplexDraft& draft);

/// Removes duplicate triangles within each soup, except the first.
void remove_duplicates_within_soups(ComplexDraft& draft);

/// Removes duplicate triangles of different soups, except the first: touching solids then share one
/// interface. If the soup of a removed triangle had its solid on one side, it gets a claim (Claim) to that
/// side. Precondition: the triangles of each soup are oriented.
void merge_duplicates_across_soups(ComplexDraft& draft);

}  // namespace collarmesh::facets
