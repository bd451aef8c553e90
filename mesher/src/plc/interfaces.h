#pragma once

#include "facets/complex_draft.h"

namespace collarmesh::plc {

/// Gives two flat pieces of different soups the same triangles if they have the same border, as where
/// separately triangulated solids touch. The later piece gets the triangles of the earlier one; its inner
/// points are dropped unless the earlier piece has them. Precondition: the triangles of each soup are
/// oriented.
void unify_interfaces(facets::ComplexDraft& draft);

}  // namespace collarmesh::plc
