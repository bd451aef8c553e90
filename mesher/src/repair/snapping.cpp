#include "repair/snapping.h"

#include <algorithm>
#include <utility>

#include "facets/edges.h"
#include "repair/changes.h"
#include "repair/duplicate_triangles.h"
#include "repair/most_places.h"
#include "repair/snap_corners.h"
#include "repair/snap_cuts.h"
#include "repair/snap_overlay.h"
#include "repair/snap_points.h"
#include "repair/snap_state.h"

namespace collarmesh::repairing {

namespace {

using namespace facets;

constexpr std::size_t most_rounds = 50, most_rounds_after_overlay = 12;
constexpr std::size_t most_overlays = 10, few_crossings = 100;

// The snapping, in rounds. Each round only examines triangles that the round before has changed.
class Snapper {
 public:
  Snapper(ComplexDraft& draft, double distance_limit, SnapWhat what, Work& work,
          const std::vector<bool>& known, bool cancel)
      : cancel_(cancel),
        knows_some_(!known.empty()),
        draft_(draft),
        what_(what),
        state_(draft, distance_limit, what, work, known),
        points_(state_, known),
        cuts_(state_),
        corners_(state_, cuts_),
        overlay_(state_, cuts_) {}

  SnapReport run() {
    if (knows_some_) cancel_new_duplicates();
    // Snapping corners adds few triangles, except where triangles run along each other. In that case, this
    // limit ends the snapping.
    const std::size_t count = state_.triangles().count();
    most_triangles_ = count / (what_ == SnapWhat::corners ? 4 : 1) + count + 1000;
    if (ComplexDraft before = draft_; !snap_all_corners())
      return keep_settled(before, 0, SnapState::by_corners);
    return what_ == SnapWhat::all ? overlay_until_settled() : finish();
  }

 private:
  // Overlays triangles until nothing changes. Snaps the new corners after each overlay. Stops early if an
  // overlay makes many crossings and more than half as many as the overlay before it, if corners do not
  // settle, or after too many overlays; then undoes the changes at places that still change.
  SnapReport overlay_until_settled() {
    const ComplexDraft before = state_.triangles().compacted();
    const std::size_t done_before = state_.done().size();
    std::size_t crossings = none;
    for (std::size_t overlays = 0;; ++overlays) {
      corners_.allow_cuts();
      if (!overlay_.run()) return finish();
      cancel_new_duplicates();
      if (overlays == most_overlays ||
          (overlay_.count() > few_crossings && 2 * overlay_.count() > crossings) ||
          !snap_all_corners(most_rounds_after_overlay) || !settled_)
        break;
      crossings = overlay_.count();
    }
    return keep_settled(before, done_before, SnapState::by_both);
  }

  SnapReport finish() {
    draft_ = state_.triangles().compacted();
    for (const SnapState::Done& done : state_.done()) count(done);
    return std::move(report_);
  }

  // Undoes the changes since `before` at places with triangles that the parts `by` still have to examine.
  SnapReport keep_settled(const ComplexDraft& before, std::size_t done_before, SnapState::By by) {
    const ComplexDraft after = state_.triangles().compacted();
    const std::vector<bool> unseen = state_.unseen(by);
    const Changes changes(before, after);
    const std::vector<SnapState::Done>& done = state_.done();
    std::vector<bool> changing(changes.places(), false), kept_at(after.points.size(), true);
    for (Index t = 0; t < after.triangles.size(); ++t)
      if (const Index place = changes.place_of_come()[t]; place != none && unseen[t]) changing[place] = true;
    const auto mark = [&](const ComplexDraft& draft, const std::vector<Index>& place) {
      for (Index t = 0; t < place.size(); ++t)
        if (place[t] != none)
          for (const Index p : draft.triangles[t]) kept_at[p] = !changing[place[t]];
    };
    mark(before, changes.place_of_gone());
    mark(after, changes.place_of_come());
    for (std::size_t i = 0; i < done.size(); ++i)
      if (i < done_before || kept_at[done[i].point]) count(done[i]);
    std::vector<Index> place;
    draft_ = changes.without(changing, place);
    return std::move(report_);
  }

  // Snaps corners until nothing is near or the rounds are over. Returns false if there are more triangles
  // than `most_triangles_`.
  bool snap_all_corners(std::size_t rounds = most_rounds) {
    settled_ = false;
    for (std::size_t round = 0; round < rounds; ++round) {
      const bool merged = points_.merge();
      const CornerSnapper::Outcome snapped = corners_.snap(most_triangles_);
      if (snapped == CornerSnapper::Outcome::too_many) return false;
      settled_ = !merged && snapped == CornerSnapper::Outcome::nothing_near;
      if (settled_) return true;
      cancel_new_duplicates();
      if (state_.triangles().count() > most_triangles_) return false;
    }
    return true;
  }

  void count(const SnapState::Done& done) {
    using What = SnapState::Done::What;
    if (done.what == What::merged) ++report_.merged_points;
    if (done.what == What::cut_edge) ++report_.cut_edges;
    if (done.what == What::cut_triangle) ++report_.cut_triangles;
    report_.largest_distance = std::max(report_.largest_distance, done.moved);
    if (report_.places.size() < most_places) report_.places.push_back(state_.at(done.point));
  }

  void cancel_new_duplicates() {
    if (cancel_) report_.cancelled_triangles += repairing::cancel_new_duplicates(state_);
  }

  bool cancel_;      // whether duplicates are cancelled
  bool knows_some_;  // whether some triangles are known not to be near each other
  ComplexDraft& draft_;
  SnapWhat what_;
  SnapState state_;
  PointMerger points_;
  SnapCuts cuts_;
  CornerSnapper corners_;
  Overlay overlay_;
  SnapReport report_;
  std::size_t most_triangles_ = 0;
  bool settled_ = false;  // whether nothing more is merged or cut
};

}  // namespace

SnapReport snap_near_features(ComplexDraft& draft, double distance, SnapWhat what, Work* work,
                              const std::vector<bool>& known, bool cancel) {
  Work any;
  const std::size_t duplicates = known.empty() && cancel ? cancel_duplicates(draft) : 0;
  SnapReport report;
  if (distance > 0)
    report = Snapper(draft, distance, what, work != nullptr ? *work : any, known, cancel).run();
  report.cancelled_triangles += duplicates;
  return report;
}

}  // namespace collarmesh::repairing
