#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/box_tree.h"
#include "facets/draft.h"
#include "facets/edges.h"

namespace collarmesh::facets {

/// A triangle, a loose segment or a loose point.
struct Simplex {
  Corners points{none, none, none};
  unsigned size = 0;
  std::span<const Index> corners() const { return {points.data(), size}; }
};

/// The triangles of a draft, numbered as there, then its segments that are no triangle's side, then its loose
/// points; and where they are.
class Simplices {
 public:
  Simplices(const Draft& draft, const EdgeTable& edges);

  std::span<const Simplex> list() const { return list_; }
  /// The triangles of a facet, which come from one triangulation, are a group; all else is alone.
  const BoxTree& boxes() const { return boxes_; }
  /// To find pairs: the same, along any axes.
  const BoxTree& boxes_for_pairs() const { return turned_ ? *turned_ : boxes_; }

 private:
  std::vector<Simplex> list_;
  BoxTree boxes_;
  std::optional<BoxTree> turned_;  // where boxes along other axes are much smaller
};

}  // namespace collarmesh::facets
