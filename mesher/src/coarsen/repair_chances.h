#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace collarmesh::remeshing::coarsening {

/// A choice of the vertices whose collapses are tried with repairs. Each trial is costly, and nearly all fail
/// at thin walls that are meshed as coarsely as they can be. So `many` failures in a row halve the share of
/// the vertices that are chosen, and each success doubles it.
class RepairChances {
 public:
  static constexpr std::size_t many = 100, most = 64;

  /// Returns whether the vertex at this place in the order of trials is chosen now.
  bool is_due(std::size_t place) const {
    std::uint64_t mixed = place * spread;
    mixed = (mixed ^ mixed >> 32) * spread;
    return (mixed >> 32) % every_ == 0;
  }

  void note_failure() {
    if (++failures_ < many) return;
    failures_ = 0;
    every_ = std::min(2 * every_, most);
  }
  void note_success() {
    failures_ = 0;
    every_ = std::max<std::size_t>(every_ / 2, 1);
  }

 private:
  // A factor that mixes bits. Vertices that are neighbours in memory are at regular distances in the order of
  // trials, so choosing every n-th place would leave out whole neighbourhoods.
  static constexpr std::uint64_t spread = 0x9E3779B97F4A7C15;

  std::size_t every_ = 1;     // about one in this many vertices is chosen
  std::size_t failures_ = 0;  // in a row
};

}  // namespace collarmesh::remeshing::coarsening
