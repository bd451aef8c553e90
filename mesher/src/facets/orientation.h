#pragma once

#include "facets/complex_draft.h"
#include "facets/edges.h"
#include "facets/faults.h"

namespace collarmesh::facets {

/// Orients the triangles of each soup consistently across every edge that exactly two of its triangles share.
/// A component gets the orientation for which the fewest triangles have to be turned. If any are turned, the
/// orientation of the component does not tell inside from outside (Origin::oriented). A component that cannot
/// be oriented is a fault. The edge table must fit the draft's triangles and is updated.
void orient_components(ComplexDraft& draft, EdgeTable& edges, Faults& faults);

}  // namespace collarmesh::facets
