#pragma once

#include <array>
#include <cassert>
#include <unordered_map>
#include <utility>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// A subsegment of a curve's chain; it is valid as long as the stamp is the subsegment's.
struct ChainLink {
  Index subsegment;
  std::uint32_t stamp;
};

/// The crease curves that have no collar yet, in runs that create collars while the loop refines ("in the
/// pass", see CollarCreator): the history of their chains, and which of the creases may have become isolated.
///
/// Invariant: an open crease that has changed since it was last tested is touched, and is in the list of
/// touched creases once. CurveChains opens creases and reports their chains; CollarCreator touches them,
/// tests them, and closes those that get their balls. All functions except `chain` do nothing for curves that
/// are not open.
class OpenCreases {
 public:
  struct Chain {
    std::vector<ChainLink> links;           ///< all links so far
    std::size_t unresolved = 0;             ///< number of its points that the crease still waits for
    bool split = false;                     ///< a subsegment has been split
    std::array<Index, 2> ends{none, none};  ///< unresolved points where the crease leaves the balls at its
                                            ///< ends
  };

  void open(Index curve) { creases_[curve] = {}; }
  bool is_open(Index curve) const { return creases_.contains(curve); }
  /// Returns all open creases, in no particular order.
  std::vector<Index> curves() const {
    std::vector<Index> found;
    for (const auto& [curve, crease] : creases_) found.push_back(curve);
    return found;
  }
  /// Returns the chain of a crease. Precondition: the crease is open.
  const Chain& chain(Index curve) const {
    assert(is_open(curve));
    return creases_.at(curve).chain;
  }

  /// Reports that the crease waits for one more unresolved point of its chain.
  void note_unresolved(Index curve) {
    if (Crease* crease = find(curve)) ++crease->chain.unresolved;
  }
  /// Reports that one of the chain's unresolved points is resolved or no longer needed. Returns whether it
  /// was the last one and the chain has been split.
  bool note_resolved(Index curve) {
    Crease* crease = find(curve);
    return crease != nullptr && --crease->chain.unresolved == 0 && crease->chain.split;
  }
  void note_split(Index curve) {
    if (Crease* crease = find(curve)) crease->chain.split = true;
  }
  void note_link(Index curve, const ChainLink& link) {
    if (Crease* crease = find(curve)) crease->chain.links.push_back(link);
    touch(curve);
  }
  /// Reports that the crease leaves a ball at its first (0) or last (1) end at this point.
  void note_end(Index curve, unsigned side, Index point) {
    if (Crease* crease = find(curve)) crease->chain.ends[side] = point;
  }

  /// Reports that the crease may have become isolated.
  void touch(Index curve) {
    Crease* crease = find(curve);
    if (crease != nullptr && !std::exchange(crease->touched, true)) touched_.push_back(curve);
  }
  bool any_touched() const { return !touched_.empty(); }
  /// Returns the crease that was touched last and untouches it; none if it was closed since.
  Index take_touched() {
    const Index curve = touched_.back();
    touched_.pop_back();
    Crease* crease = find(curve);
    if (crease == nullptr) return none;
    crease->touched = false;
    return curve;
  }

  /// Closes a crease because balls replace its chain. Returns the chain. Precondition: the crease is open.
  Chain close(Index curve) {
    assert(is_open(curve));
    Chain chain = std::move(creases_.at(curve).chain);
    creases_.erase(curve);
    return chain;
  }

 private:
  struct Crease {
    Chain chain;
    bool touched = false;  // whether it is in touched_
  };
  Crease* find(Index curve) {
    const auto found = creases_.find(curve);
    return found == creases_.end() ? nullptr : &found->second;
  }

  std::unordered_map<Index, Crease> creases_;  // by curve
  std::vector<Index> touched_;
};

}  // namespace collarmesh
