#pragma once

#include "facets/complex_draft.h"

namespace collarmesh::plc {

/// Where separately triangulated solids touch, gives flat pieces of two soups with the same border the same
/// triangles. The later piece gets the triangles of the first; its interior points that the first does not
/// have are dropped. Precondition: the triangles of each soup are oriented.
void unify_interfaces(facets::ComplexDraft& draft);

}  // namespace collarmesh::plc
