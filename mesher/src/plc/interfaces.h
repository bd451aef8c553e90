#pragma once

#include "facets/draft.h"

namespace collarmesh::plc {

/// Where flat pieces of two soups have the same border but different triangles, as when two solids
/// touch that were triangulated apart, give the later one the triangles of the first. Points inside
/// the later piece that are no corners of the first are dropped.
/// Precondition: the triangles of each soup are oriented.
void unify_interfaces(facets::Draft& draft);

}  // namespace collarmesh::plc
