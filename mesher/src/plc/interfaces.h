#pragma once

#include "facets/draft.h"

namespace collarmesh::plc {

/// Gives flat pieces of two soups with the same border the same triangles, as where two solids touch that
/// were triangulated separately. The later piece gets the triangles of the first; its interior points that
/// are no corners of the first are dropped. Precondition: the triangles of each soup are oriented.
void unify_interfaces(facets::Draft& draft);

}  // namespace collarmesh::plc
