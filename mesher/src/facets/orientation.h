#pragma once

#include "facets/draft.h"
#include "facets/edges.h"
#include "facets/faults.h"

namespace collarmesh::facets {

/// Orients the triangles of each soup alike across every edge that exactly two of its triangles share. A
/// component keeps the orientation that turns the fewest triangles; one where any had to be turned says
/// nothing about inside and outside (Origin::oriented). A component that cannot be oriented is a fault. The
/// table is that of the draft's triangles, before and after.
void orient_components(Draft& draft, EdgeTable& edges, Faults& faults);

}  // namespace collarmesh::facets
