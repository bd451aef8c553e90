#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/box_tree.h"
#include "facets/complex_draft.h"
#include "facets/edges.h"

namespace collarmesh::facets {

/// A triangle, a loose segment or a loose point.
struct Simplex {
  Corners points{none, none, none};
  unsigned size = 0;
  std::span<const Index> corners() const { return {points.data(), size}; }
};

/// The simplices of a draft and their boxes: its triangles, with the same numbers, then its segments that are
/// not sides of triangles, then its loose points.
class Simplices {
 public:
  Simplices(const ComplexDraft& draft, const EdgeTable& edges);

  std::span<const Simplex> list() const { return list_; }
  /// Returns the tree of the simplices' boxes. The triangles of one facet form a group, because they come
  /// from one triangulation and need no test against each other; every other simplex is a group of its own.
  const BoxTree& boxes() const { return boxes_; }
  /// Returns a tree of the same items for finding pairs. Its boxes may lie along other axes.
  const BoxTree& boxes_for_pairs() const { return turned_ ? *turned_ : boxes_; }

 private:
  std::vector<Simplex> list_;
  BoxTree boxes_;
  std::optional<BoxTree> turned_;  // exists if boxes along other axes are much smaller
};

}  // namespace collarmesh::facets
