#pragma once

#include "facets/complex_draft.h"
#include "facets/edges.h"
#include "facets/faults.h"

namespace collarmesh::facets {

/// Orients the triangles of each soup consistently across every edge that exactly two of its triangles share.
/// A component keeps the orientation that turns the fewest triangles. If any had to be turned, its
/// orientation does not tell inside from outside (Origin::oriented). A component that cannot be oriented is a
/// fault. The edge table must fit the draft's triangles and is updated.
void orient_components(ComplexDraft& draft, EdgeTable& edges, Faults& faults);

}  // namespace collarmesh::facets
