#include "facets/edges.h"

#include <algorithm>
#include <utility>

namespace collarmesh::facets {

namespace {

// Sorts pairs. Uses insertion sort for few pairs, because most points have few.
void sort_few(std::span<std::pair<Index, Index>> pairs) {
  constexpr std::size_t few = 16;
  if (pairs.size() > few) {
    std::ranges::sort(pairs);
    return;
  }
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const auto pair = pairs[i];
    std::size_t at = i;
    for (; at > 0 && pair < pairs[at - 1]; --at) pairs[at] = pairs[at - 1];
    pairs[at] = pair;
  }
}

}  // namespace

EdgeTable::EdgeTable(std::span<const Corners> triangles, std::size_t point_count) {
  const std::size_t side_count = 3 * triangles.size();
  std::vector<Index> first(point_count + 1, 0);
  const auto ends_of = [&](Index side) {
    const Corners& t = triangles[side / 3];
    return std::minmax(t[side % 3], t[(side % 3 + 1) % 3]);
  };
  for (Index side = 0; side < side_count; ++side) ++first[ends_of(side).first + 1];
  for (std::size_t p = 0; p < point_count; ++p) first[p + 1] += first[p];

  std::vector<std::pair<Index, Index>> larger_and_side(side_count);
  std::vector<Index> next(first.begin(), first.end() - 1);
  for (Index side = 0; side < side_count; ++side) {
    const auto [small, large] = ends_of(side);
    larger_and_side[next[small]++] = {large, side};
  }

  sides_.resize(side_count);
  edge_of_side_.resize(side_count);
  first_edge_.resize(point_count + 1);
  for (Index p = 0; p < point_count; ++p) {
    first_edge_[p] = size();
    sort_few(std::span(larger_and_side).subspan(first[p], first[p + 1] - first[p]));
    for (Index i = first[p]; i < first[p + 1]; ++i) {
      const auto [large, side] = larger_and_side[i];
      if (i == first[p] || larger_and_side[i - 1].first != large) {
        ends_.push_back({p, large});
        first_side_.push_back(i);
      }
      sides_[i] = side;
      edge_of_side_[side] = size() - 1;
    }
  }
  first_edge_[point_count] = size();
  first_side_.push_back(static_cast<Index>(side_count));
}

Index EdgeTable::find(Index a, Index b) const {
  if (a > b) std::swap(a, b);
  const auto begin = ends_.begin() + first_edge_[a], end = ends_.begin() + first_edge_[a + 1];
  const auto at = std::lower_bound(begin, end, std::array<Index, 2>{a, b});
  return at != end && (*at)[1] == b ? static_cast<Index>(at - ends_.begin()) : none;
}

void EdgeTable::turn(Index triangle) {
  const Index first = 3 * triangle, last = first + 2;
  const auto place_of = [&](Index side) {
    Index place = first_side_[edge_of(side)];
    while (sides_[place] != side) ++place;
    return place;
  };
  std::swap(sides_[place_of(first)], sides_[place_of(last)]);
  std::swap(edge_of_side_[first], edge_of_side_[last]);
}

}  // namespace collarmesh::facets
