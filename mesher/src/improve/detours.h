#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "improve/remedies.h"

namespace collarmesh::improvement {

/// Detours: where no operation helps a tet, one is made all the same, at the tet or beside it, and the tets
/// that it makes are improved, for some steps. What that comes to is kept if it is better than what was
/// there, else undone. Better is compared from the worst tet up, so the mesh never returns to an earlier
/// state.
///
/// One thread. Precondition: `Remedies::forget` was called; so a trial that is made again comes to the same.
class Detours {
 public:
  /// All are kept by reference. At most `most_trials` operations are tried, and those at one tet.
  Detours(Workpiece& workpiece, Remedies& remedies, Operations& operations, std::size_t most_trials);

  /// Take detours for these tets, and for poor ones that detours leave, where the number of vertices may
  /// change: worst first, at each tet itself before beside any, and again where something has changed at a
  /// corner, until nothing helps. Returns how many were taken. `stopped` is asked between tets. Precondition:
  /// the workpiece is prepared for trials.
  std::size_t take_all(std::vector<Index> tets, const std::function<bool()>& stopped);

  /// Operations tried so far.
  std::size_t trials() const { return trials_; }

 private:
  enum class Operation : std::uint8_t { contraction, contraction_turned, insertion, removal };
  /// What a detour begins with: an operation at an edge of a tet.
  struct FirstStep {
    Index tet;
    unsigned edge;
    Operation operation;
  };
  /// What a trial comes to.
  struct Result {
    bool better = false;
    bool more_thin = false;  ///< are there more thin tets than before?
    double worst = 0;        ///< of the tets that it has changed, at most the wanted quality
  };
  /// First steps are tried at the tet itself, then at those across its faces and its edges, then anywhere
  /// there though more tets are thin and not all others are good afterwards.
  enum class Effort : std::uint8_t { at_tet, beside, last_resort };
  /// By tet: how many detours had been taken when it was asked, plus 1; 0: not asked.
  using Asked = std::vector<std::uint32_t>;

  bool exhausted() const;
  bool is_new_to(Index tet, const Asked& asked) const;
  bool take_round(std::vector<Index>& tets, Effort effort, const std::function<bool()>& stopped);
  bool help(Index tet, Effort effort);
  void note_changes(std::vector<Index>& tets);
  std::vector<Index> places(Index tet, Effort effort) const;
  Change first_step(const FirstStep& step);
  Result attempt(const FirstStep& step);
  bool is_worth_it(const Result& result, Effort effort) const;
  void begin_trial();
  void apply(Change change);
  void improve_changed();
  Result result() const;
  void see_before(Index tet);
  void set_changed(Index tet);
  const TetComplex& complex() const { return workpiece_.complex; }

  Workpiece& workpiece_;
  Remedies& remedies_;
  Operations& operations_;
  std::size_t most_trials_, trials_ = 0;
  std::uint32_t taken_ = 0;
  bool ended_ = false;                         // all trials are spent, or it was stopped
  std::vector<std::uint32_t> last_detour_at_;  // by vertex: that changed a tet there
  std::array<Asked, 3> asked_;                 // by Effort

  // Of the trial that is made.
  std::uint32_t trial_ = 0;
  std::vector<std::uint32_t> last_trial_of_;  // by tet: that changed it
  std::vector<Index> changed_;                // tets, some of them gone again
  std::vector<double> before_;                // qualities of the tets that were there, at most the wanted one
  std::size_t thin_before_ = 0;
  std::vector<Index> to_improve_;
};

}  // namespace collarmesh::improvement
