#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "facets/complex_draft.h"
#include "repair/changing_triangles.h"
#include "repair/snapping.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// The data that the parts of snapping share: the changing triangles, those that each part has yet to
/// examine, and a record of the changes.
class SnapState {
 public:
  /// The parts that examine triangles, as bits.
  enum By : std::uint8_t { by_corners = 1, by_overlay = 2, by_both = 3 };

  /// A change, for the report. `more`: a further point in an edge or a triangle that already gets one.
  struct Done {
    enum class What { merged, cut_edge, cut_triangle, more } what;
    Index point;
    double moved;
  };

  /// Keeps references to the draft and the work. Triangles marked as `known` (empty: none) count as examined;
  /// each part has to examine all others.
  SnapState(facets::ComplexDraft& draft, double limit, SnapWhat what, Work& work,
            const std::vector<bool>& known);

  facets::ComplexDraft& draft() { return draft_; }
  const facets::ComplexDraft& draft() const { return draft_; }
  ChangingTriangles& triangles() { return triangles_; }
  const ChangingTriangles& triangles() const { return triangles_; }
  Work& work() { return work_; }
  /// Returns the distance limit, absolute.
  double limit() const { return limit_; }
  const Point& at(Index p) const { return draft_.points[p]; }

  /// Returns whether an edge takes part; with `SnapWhat::borders`, only border edges do.
  bool takes_part(const Edge& edge) const { return what_ != SnapWhat::borders || is_border(edge); }
  bool takes_part(Index triangle) const;
  /// Returns whether a point takes part. `pinned`: the point is loose or the end of a segment.
  bool takes_part(Index point, bool pinned) const;

  void put(const facets::Corners& corners, const facets::Origin& origin);
  void take(Index triangle);

  /// Returns the existing triangles that this part has not examined yet, in order, and counts them as
  /// examined.
  std::vector<Index> take_unseen(By by);
  /// Makes the corner snapper examine this triangle again in the next round.
  void defer(Index triangle);
  /// Returns for each triangle of the compacted draft whether this part still has to examine it.
  std::vector<bool> unseen(By by) const;

  /// Returns the triangles added since the last call; some no longer exist.
  std::vector<Index> take_added() { return std::exchange(added_, {}); }
  /// Returns the corners of triangles added or removed since the last call, some several times.
  std::vector<Index> take_touched() { return std::exchange(touched_, {}); }
  void touch(Index point) { touched_.push_back(point); }

  std::vector<Done>& done() { return done_; }

 private:
  bool is_border(const Edge& edge) const { return triangles_.sides(edge).size() == 1; }
  std::vector<Index>& list_of(By by) { return unseen_[by == by_corners ? 0 : 1]; }

  facets::ComplexDraft& draft_;
  double limit_;
  SnapWhat what_;
  Work& work_;
  ChangingTriangles triangles_;
  std::vector<std::uint8_t> flags_;  // by triangle: bits of the parts that have not examined it yet
  /// The triangles that the corner snapper has not examined, and those that the overlay has not. Some no
  /// longer exist.
  std::array<std::vector<Index>, 2> unseen_;
  std::vector<Index> added_, touched_;
  std::vector<Done> done_;
};

/// Cancels duplicates of the triangles added since the last call. For each of these, searches only the corner
/// at which the fewest triangles meet, because a duplicate has all corners in common. Returns the number of
/// cancelled triangles.
std::size_t cancel_new_duplicates(SnapState& state);

}  // namespace collarmesh::repairing
