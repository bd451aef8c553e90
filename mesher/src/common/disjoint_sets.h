#pragma once

#include <cassert>
#include <numeric>
#include <utility>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Union-find over 0 .. n-1. The representative of a set is its smallest element.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parents_(n) {
    std::iota(parents_.begin(), parents_.end(), Index{0});
  }

  Index find(Index i) {
    assert(i < parents_.size());
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void unite(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a > b) std::swap(a, b);
    parents_[b] = a;
  }
  bool same(Index a, Index b) { return find(a) == find(b); }

 private:
  std::vector<Index> parents_;
};

}  // namespace collarmesh
