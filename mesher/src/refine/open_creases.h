#pragma once

#include <array>
#include <unordered_map>
#include <utility>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// A subsegment of a curve's chain, as long as the stamp is its own.
struct ChainLink {
  Index subsegment;
  std::uint32_t stamp;
};

/// The crease curves that have no collar yet, when collars are created in the pass: what their chains have
/// been, and which of them may have become isolated.
///
/// Invariant: an open crease that has changed since it was asked for is touched, once. CurveChains opens
/// creases and tells of their chains; CollarCreator touches them, asks, and closes those that get their
/// balls. All functions but `chain` do nothing for curves that are not open.
class OpenCreases {
 public:
  struct Chain {
    std::vector<ChainLink> links;           ///< all there have been
    std::size_t unresolved = 0;             ///< of the points that its chain started with
    bool split = false;                     ///< some subsegment was, before all of these were resolved
    std::array<Index, 2> ends{none, none};  ///< unresolved points where it leaves the balls at its ends
  };

  void open(Index curve) { creases_[curve] = {}; }
  bool is_open(Index curve) const { return creases_.contains(curve); }
  /// All open ones, in no particular order.
  std::vector<Index> curves() const {
    std::vector<Index> found;
    for (const auto& [curve, crease] : creases_) found.push_back(curve);
    return found;
  }
  /// Precondition: it is open.
  const Chain& chain(Index curve) const { return creases_.at(curve).chain; }

  /// Its chain starts with one unresolved point more.
  void note_unresolved(Index curve) {
    if (Crease* crease = find(curve)) ++crease->chain.unresolved;
  }
  /// One of these is resolved, or not needed any more. Was it the last one, and has the chain been split?
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
  /// It leaves a ball at its first (0) or last (1) end at this point.
  void note_end(Index curve, unsigned side, Index point) {
    if (Crease* crease = find(curve)) crease->chain.ends[side] = point;
  }

  /// It may have become isolated.
  void touch(Index curve) {
    Crease* crease = find(curve);
    if (crease != nullptr && !std::exchange(crease->touched, true)) touched_.push_back(curve);
  }
  bool any_touched() const { return !touched_.empty(); }
  /// The one that was touched last, which is not touched any more; none if it was closed since.
  Index take_touched() {
    const Index curve = touched_.back();
    touched_.pop_back();
    Crease* crease = find(curve);
    if (crease == nullptr) return none;
    crease->touched = false;
    return curve;
  }

  /// Balls take the place of its chain, which is returned. Precondition: it is open.
  Chain close(Index curve) {
    Chain chain = std::move(creases_.at(curve).chain);
    creases_.erase(curve);
    return chain;
  }

 private:
  struct Crease {
    Chain chain;
    bool touched = false;  // it is in touched_
  };
  Crease* find(Index curve) {
    const auto found = creases_.find(curve);
    return found == creases_.end() ? nullptr : &found->second;
  }

  std::unordered_map<Index, Crease> creases_;  // by curve
  std::vector<Index> touched_;
};

}  // namespace collarmesh
