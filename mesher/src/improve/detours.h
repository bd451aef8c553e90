#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "improve/operation_chooser.h"
#include "remesh/change_times.h"

namespace collarmesh::remeshing::improvement {

/// Detours: sequences of operations for tets that no single operation improves. The first operation, at the
/// tet or beside it, need not improve any tet; a few further operations then improve the tets that it makes.
/// The detour is kept if it makes the mesh better, else undone. Two states of the mesh are compared by their
/// worst tets; if these are equal, by the next worst ones, and so on. So no state occurs twice.
/// Uses one thread. Precondition: `OperationChooser::forget` was called, so that a repeated trial has the
/// same result.
class Detours {
 public:
  /// Keeps references to the first three arguments. After trying `most_trials` operations or more, completes
  /// the current tet and stops.
  Detours(EditableMesh& edited, OperationChooser& chooser, Operations& operations, std::size_t most_trials)
      : edited_(edited), chooser_(chooser), operations_(operations), most_trials_(most_trials) {}

  /// Takes detours for these tets and for poor tets that detours leave, if the number of vertices may change
  /// at them (`OperationChooser::may_change_vertices`). Begins with the worst tet, and with operations at the
  /// tet itself, then beside it. Tries a tet again if something has changed at its corners. Ends if no detour
  /// helps, or if `stopped`, called between tets, returns true. Returns the number of detours taken.
  /// Precondition: the mesh is prepared for trials.
  std::size_t take_all(std::vector<Index> tets, const std::function<bool()>& stopped);

  /// Returns the number of operations tried so far.
  std::size_t trials() const { return trials_; }

 private:
  enum class Operation : std::uint8_t { collapse, collapse_turned, insertion, removal };
  /// The beginning of a detour: an operation at an edge of a tet.
  struct FirstStep {
    Index tet;
    unsigned edge;
    Operation operation;
  };
  /// The result of a trial.
  struct Result {
    bool better = false, taken = false;
    bool more_thin = false;  ///< more tets are thin than before the trial
    double worst = 0;        ///< smallest quality of the changed tets, or the wanted quality if that is lower
  };
  /// The tets at which the first steps for a poor tet are tried. at_tet: the tet itself; beside: the tets
  /// across its faces and edges; last_resort: the tet and those beside it; detours are then accepted even if
  /// they make more tets thin and leave poor ones.
  enum class Effort : std::uint8_t { at_tet, beside, last_resort };
  /// By tet: 1 plus the number of detours that had been taken when the tet was last tried; 0: not tried.
  using Asked = std::vector<std::uint32_t>;

  std::uint32_t taken() const { return changes_.now(); }
  bool exhausted() const;
  Change propose(Index tet);
  bool is_new_to(Index tet, const Asked& asked) const;
  void sort_worst_first(std::vector<Index>& tets) const;
  bool take_round(std::vector<Index>& tets, Effort effort, const std::function<bool()>& stopped);
  bool help(Index tet, Effort effort);
  void note_changes(std::vector<Index>& tets);
  std::vector<Index> places(Index tet, Effort effort) const;
  Change first_step(const FirstStep& step);
  Result attempt(const FirstStep& step, const std::function<bool(const Result&)>& is_taken);
  bool is_worth_it(const Result& result, Effort effort) const;
  void apply(Trial& trial, Change change);
  void improve_changed(Trial& trial);
  Result result(const Trial& trial) const;
  void take(Trial& trial);
  const TetComplex& complex() const { return edited_.complex; }

  EditableMesh& edited_;
  OperationChooser& chooser_;
  Operations& operations_;
  std::size_t most_trials_, trials_ = 0;
  std::size_t obtuse_ = 0;                               // number of proposals for tets that are too obtuse
  ChangeTimes changes_{complex().mesh().points.size()};  // the time is the number of detours taken
  bool ended_ = false;                                   // no trials remain, or the caller stopped it
  std::array<Asked, 3> asked_;                           // by Effort

  std::vector<Index> changed_;  // tets that the last detour changed; some may have been removed

  // State of the current trial.
  std::vector<double> before_;  // qualities of the changed tets before the trial, each at most the wanted one
  std::size_t thin_before_ = 0;
  std::vector<Index> to_improve_;
};

}  // namespace collarmesh::remeshing::improvement
