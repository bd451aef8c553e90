#pragma once

#include <span>
#include <vector>

#include "common/box_tree.h"
#include "plc/draft.h"
#include "plc/edges.h"

namespace collarmesh::build {

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

 private:
  std::vector<Simplex> list_;
  BoxTree boxes_;
};

}  // namespace collarmesh::build
