#pragma once

#include <cstddef>
#include <vector>

#include "facets/complex_draft.h"

namespace collarmesh::repairing {

struct RepeatedReport {
  std::size_t count = 0;
  std::vector<Point> where;
};

/// Drops duplicate triangles. Keeps one of the triangles of a soup with the same corners and orientation,
/// unless that opens the surface (two solids may share a facet); in complexes keeps one regardless of
/// orientation. Cost: O(n log n).
RepeatedReport drop_repeated(facets::ComplexDraft& draft);

}  // namespace collarmesh::repairing
