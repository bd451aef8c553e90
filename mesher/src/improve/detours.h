#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "improve/remedies.h"

namespace collarmesh::improvement {

/// Detours: where no operation helps a tet, one is made all the same, at the tet or beside it, and the tets
/// that it makes are improved, for some steps. What that comes to is kept if it is better than what was
/// there, else undone. Better is compared from the worst tet up, so that no detour is taken twice.
///
/// One thread; the result depends on the mesh alone.
class Detours {
 public:
  /// All are kept by reference. At most about `most_trials` operations are tried.
  Detours(Workpiece& workpiece, const SliverRule& rule, Remedies& remedies, Operations& operations,
          std::size_t most_trials);

  /// Take detours for these tets, and for poor ones that detours leave, where the number of vertices may
  /// change: worst first, and again where something has changed at a corner, until nothing helps. Returns how
  /// many were taken. `stopped` is asked between them.
  std::size_t take(std::vector<Index> tets, const std::function<bool()>& stopped);
  /// Operations tried so far.
  std::size_t trials() const { return trials_; }

 private:
  /// An operation by its number, at an edge of a tet.
  struct FirstStep {
    Index tet;
    unsigned operation;
  };
  // So many operations may be tried before a first detour is taken, and so many more with each one that is.
  static constexpr std::size_t first_trials = 1500, trials_per_detour = 150;

  /// What a trial comes to.
  struct Outcome {
    double worst = -1;          ///< of the tets it has changed, at most the wanted quality; -1: no better
    std::size_t more_thin = 0;  ///< tets than before
  };

  bool exhausted() const {
    return trials_ >= std::min(most_trials_, first_trials + trials_per_detour * taken_);
  }
  bool is_new_to(Index tet) const;
  void note_changes();
  bool take(Index tet);
  std::vector<Index> places(Index tet) const;
  Change first_step(const FirstStep& step);
  Outcome attempt(const FirstStep& step);
  void apply(Change change);
  void improve_changed();
  Outcome outcome() const;
  void see_before(Index tet);
  void set_changed(Index tet);
  bool is_thin(Index tet) const { return !rule_.is_within_bound(complex().corners(tet)); }
  const TetComplex& complex() const { return workpiece_.complex; }

  Workpiece& workpiece_;
  const SliverRule& rule_;
  Remedies& remedies_;
  Operations& operations_;
  std::size_t most_trials_, trials_ = 0;
  std::uint32_t taken_ = 0;
  std::vector<std::uint32_t> changed_at_;  // by vertex: the last detour that changed a tet there
  std::vector<std::uint32_t> asked_at_;  // by tet: how many detours had been taken when it was asked, plus 1

  // Of the trial that is made.
  std::uint32_t trial_ = 0;
  std::vector<std::uint32_t> changed_in_;  // the trial that changed a tet last
  std::vector<Index> changed_;
  std::vector<double> before_;  // qualities of the tets that were there, at most the wanted one
  std::size_t thin_before_ = 0;
  std::vector<Index> to_improve_;
};

}  // namespace collarmesh::improvement
