#pragma once

#include <cstddef>
#include <vector>

#include "facets/draft.h"

namespace collarmesh::repairing {

struct RepeatedReport {
  std::size_t count = 0;
  std::vector<Point> where;
};

/// Drops duplicate triangles: those of one soup with the same corners and orientation, if that does not open
/// the surface (two solids may share a facet), and in complexes all copies but one. Cost: O(n log n).
RepeatedReport drop_repeated(facets::Draft& draft);

}  // namespace collarmesh::repairing
