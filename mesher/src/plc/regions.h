#pragma once

#include <span>
#include <vector>

#include "collarmesh/plc.h"
#include "common/box_tree.h"
#include "facets/complex_draft.h"
#include "facets/edges.h"
#include "facets/faults.h"

namespace collarmesh::plc {

struct Regions {
  std::vector<Plc::Region> list;  ///< [0] is the outside
  std::vector<Index> of_side;     ///< by side of a triangle (numbered as in Claim::side): its region
  std::vector<Plc::Warning> warnings;
};

/// Finds the region on each side of each triangle. Chambers are the parts into which triangles divide space.
/// A chamber of a complex is a region unless a hole point lies in it. A chamber of a surface is a region if
/// it lies behind a facet, or if no region encloses it and it is not a cavity that touches the surface around
/// it. Precondition: triangles meet in common edges and corners only. A region is named after the soup with
/// the largest part of its boundary. Faults: region and hole points on a facet. Warnings: region and hole
/// points without effect. The first items of `boxes` must be the triangles, in their order.
Regions find_regions(const facets::ComplexDraft& draft, const facets::EdgeTable& edges, const BoxTree& boxes,
                     std::span<const PolygonSoup> soups, facets::Faults& faults);

}  // namespace collarmesh::plc
