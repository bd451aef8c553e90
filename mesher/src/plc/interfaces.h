#pragma once

#include "facets/draft.h"

namespace collarmesh::plc {

/// Gives flat pieces of two soups that have the same border the same triangles, as when two solids touch that
/// were triangulated separately: the later piece gets the triangles of the first. Points inside the later
/// piece that are no corners of the first are dropped. Precondition: the triangles of each soup are oriented.
void unify_interfaces(facets::Draft& draft);

}  // namespace collarmesh::plc
