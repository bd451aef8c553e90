#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "facets/draft.h"
#include "repair/changing_triangles.h"
#include "repair/snapping.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// What the parts of snapping share: the triangles that come and go, which of them each part has not looked
/// at yet, and what was done.
class SnapState {
 public:
  /// The parts that look at triangles.
  enum By : std::uint8_t { by_corners = 1, by_overlay = 2, by_both = 3 };

  /// A change to be told.
  struct Done {
    enum class What { merged, cut_edge, cut_triangle, more } what;
    Index point;
    double moved;
  };

  /// Keeps the draft and the work by reference. All but the triangles that are known (empty: none) are to be
  /// looked at.
  SnapState(facets::Draft& draft, double limit, SnapWhat what, Work& work, const std::vector<bool>& known);

  facets::Draft& draft() { return draft_; }
  const facets::Draft& draft() const { return draft_; }
  ChangingTriangles& triangles() { return triangles_; }
  const ChangingTriangles& triangles() const { return triangles_; }
  Work& work() { return work_; }
  /// Absolute.
  double limit() const { return limit_; }
  const Point& at(Index p) const { return draft_.points[p]; }

  /// Only borders take part in some snapping.
  bool takes_part(const Edge& edge) const { return what_ != SnapWhat::borders || is_border(edge); }
  bool takes_part(Index triangle) const;
  /// `pinned`: of a segment or loose.
  bool takes_part(Index point, bool pinned) const;

  void put(const facets::Corners& corners, const facets::Origin& origin);
  void take(Index triangle);

  /// Returns the triangles that are still there and were not looked at, in order; they count as looked at
  /// from now on.
  std::vector<Index> take_unseen(By by);
  /// Corners look at this triangle again in the next round.
  void defer(Index triangle);
  /// Returns by triangle of the compacted draft whether it is still to be looked at.
  std::vector<bool> unseen(By by) const;

  /// Triangles that came since this was called last, some of which are gone.
  std::vector<Index> take_added() { return std::exchange(added_, {}); }
  /// The corners of triangles that came or went since then, some several times.
  std::vector<Index> take_touched() { return std::exchange(touched_, {}); }
  void touch(Index point) { touched_.push_back(point); }

  std::vector<Done>& done() { return done_; }

 private:
  bool is_border(const Edge& edge) const { return triangles_.sides(edge).size() == 1; }
  std::vector<Index>& list_of(By by) { return unseen_[by == by_corners ? 0 : 1]; }

  facets::Draft& draft_;
  double limit_;
  SnapWhat what_;
  Work& work_;
  ChangingTriangles triangles_;
  std::vector<std::uint8_t> flags_;           // by triangle: who has not looked at it yet
  std::array<std::vector<Index>, 2> unseen_;  // triangles, by corners and by overlay; some are gone
  std::vector<Index> added_, touched_;
  std::vector<Done> done_;
};

}  // namespace collarmesh::repairing
