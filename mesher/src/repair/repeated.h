#pragma once

#include <cstddef>
#include <vector>

#include "facets/complex_draft.h"

namespace collarmesh::repairing {

struct RepeatedReport {
  std::size_t count = 0;
  std::vector<Point> where;
};

/// Drops duplicate triangles. If triangles of a soup have the same corners and orientation, drops all but one
/// of them if that lowers the number of open edges; otherwise they stay, because two closed solids may share
/// a facet. In complexes, always drops all but one of the triangles with the same corners. Cost: O(n log n).
RepeatedReport drop_repeated(facets::ComplexDraft& draft);

}  // namespace collarmesh::repairing
