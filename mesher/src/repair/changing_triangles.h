#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <span>
#include <utility>
#include <vector>

#include "common/box_frame.h"
#include "common/box_tree.h"
#include "facets/complex_draft.h"
#include "repair/item_trees.h"
#include "repair/polygon_cutter.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// The triangles of a draft while some are replaced by others. Triangles keep their numbers. Finds the
/// triangles at a point or an edge, pairs of near triangles, and corners near edges, without visiting all
/// triangles. Between calls points may be added to the draft, but only these functions may change its
/// triangles.
class ChangingTriangles {
 public:
  /// Makes the lists of sides. Two triangles are near each other if each comes within `reach` (absolute) of
  /// the plane of the other, and if their boxes meet. Boxes are parallel to the axes of a frame, and enlarged
  /// by half of `reach` on all sides. Each visited pair of boxes that meet costs a unit of `work`.
  ChangingTriangles(facets::ComplexDraft& draft, double reach, Work& work);

  /// Returns the number of triangles.
  std::size_t count() const { return count_; }
  /// Returns one more than the largest number of a triangle.
  Index end() const { return static_cast<Index>(draft_.triangles.size()); }
  bool alive(Index triangle) const { return alive_[triangle]; }

  /// Adds a triangle and returns its number.
  Index add(const facets::Corners& corners, const facets::Origin& origin);
  void remove(Index triangle);

  /// Calls visit(3 t + i) for each triangle t whose side i starts at this point. The visitor must not change
  /// triangles.
  template <class Visit>
  void for_each_at(Index point, const Visit& visit) const {
    if (point < first_.size())
      for (Index side = first_[point]; side != none; side = next_[side]) visit(side);
  }
  bool uses(Index point) const { return point < first_.size() && first_[point] != none; }
  /// Returns the corner of a triangle at which the fewest triangles meet.
  Index least_busy(const facets::Corners& corners) const;
  /// Returns the sides on an edge, in order.
  std::vector<Index> sides(const Edge& edge) const;

  /// Returns the unit normal of a triangle, or zero if its corners are collinear.
  const Vector& normal(Index triangle) const { return normals_[triangle]; }

  /// Calls visit(s, t), s < t, once for each pair of near triangles of which at least one is `changed`; the
  /// changed ones must exist and be sorted. Cost: O(k log n + p) for k changed triangles and p pairs of
  /// boxes that meet; O(n log n + p) if k is a large share of n.
  template <class Visit>
  void for_each_near_pair(const std::vector<Index>& changed, const Visit& visit) {
    assert(std::ranges::is_sorted(changed) &&
           std::ranges::all_of(changed, [this](Index t) { return alive_[t]; }));
    std::vector<bool> among(end(), false);
    for (const Index t : changed) among[t] = true;
    const auto box_of = [&](Index t) { return box_around(draft_.triangles[t]); };
    const auto meet = [&](Index s, Index t) {
      work_.spend(1);
      if (!alive_[s] || !alive_[t] || beyond(s, t) || beyond(t, s)) return;
      visit(std::min(s, t), std::max(s, t));
    };
    if (few * changed.size() > count_) {
      const std::vector<Index> all = triangles_from(0);
      BoxTree(boxes_of(all, box_of)).for_each_pair([&](Index i, Index j) {
        if (among[all[i]] || among[all[j]]) meet(all[i], all[j]);
      });
      return;
    }
    const auto meet_once = [&](Index s, Index t) {
      if (t != s && !(among[t] && t < s)) meet(s, t);
    };
    if (trees_.empty() && !std::exchange(searched_triangles_, true)) {
      const BoxTree tree(boxes_of(changed, box_of));
      for (const Index t : triangles_from(0))
        tree.for_each_meeting(box_of(t), [&](Index i) { meet_once(changed[i], t); });
      return;
    }
    trees_.renew(
        end(), count_, [&](Index from) { return triangles_from(from); }, box_of);
    for (const Index s : changed) trees_.for_each_meeting(box_of(s), [&](Index t) { meet_once(s, t); });
  }

  /// Calls visit(p, edge) for each corner p and each edge that does not end at p, if their enlarged boxes
  /// meet and a changed triangle has the corner or the edge. Visits some pairs several times, and some
  /// corners and edges that no longer exist. Each pair costs a unit of `work`. Cost: as for
  /// `for_each_near_pair`, however many triangles are at a corner.
  template <class Visit>
  void for_each_corner_near_edge(const std::vector<Index>& changed, const Visit& visit) {
    const std::vector<Index> corners = corners_of(changed);
    const std::vector<Edge> edges = edges_of(changed);
    std::vector<bool> among(draft_.points.size(), false);
    for (const Index p : corners) among[p] = true;
    const auto box_of_corner = [&](Index p) { return box_around({&p, 1}); };
    const auto box_of_edge = [&](const Edge& edge) { return box_around(edge); };
    const auto meet = [&](Index p, const Edge& edge) {
      work_.spend(1);
      if (p != edge[0] && p != edge[1]) visit(p, edge);
    };
    if (few * changed.size() <= count_ && edge_trees_.empty() && !std::exchange(searched_corners_, true)) {
      const BoxTree corner_tree(boxes_of(corners, box_of_corner)), edge_tree(boxes_of(edges, box_of_edge));
      for (const Index t : triangles_from(0))
        for (const Edge& edge : edges_of(draft_.triangles[t]))
          corner_tree.for_each_meeting(box_of_edge(edge), [&](Index i) { meet(corners[i], edge); });
      for (Index p = 0; p < first_.size(); ++p)
        if (uses(p) && !among[p])
          edge_tree.for_each_meeting(box_of_corner(p), [&](Index i) { meet(p, edges[i]); });
      return;
    }
    edge_trees_.renew(
        end(), count_, [&](Index from) { return edges_of(triangles_from(from)); }, box_of_edge);
    for (const Index p : corners)
      edge_trees_.for_each_meeting(box_of_corner(p), [&](const Edge& edge) { meet(p, edge); });
    if (changed.size() == count_) return;
    corner_trees_.renew(
        end(), count_, [&](Index from) { return corners_of(triangles_from(from)); }, box_of_corner);
    for (const Edge& edge : edges)
      corner_trees_.for_each_meeting(box_of_edge(edge), [&](Index p) {
        if (!among[p]) meet(p, edge);
      });
  }

  /// Returns the draft without removed triangles. The others keep their order, but get new numbers.
  facets::ComplexDraft compacted() const;

  /// For assertions and tests: returns whether the lists at these points contain sides of existing triangles
  /// only, and the right number of them.
  bool consistent(const facets::Corners& corners) const;

 private:
  static constexpr std::size_t few = 8;  // if at most one triangle in eight has changed, changed triangles
                                         // are looked up one by one

  // Returns existing triangles from this number on.
  std::vector<Index> triangles_from(Index first) const;
  // Returns the corners of some triangles, each once.
  std::vector<Index> corners_of(const std::vector<Index>& triangles) const;
  std::vector<Edge> edges_of(const std::vector<Index>& triangles) const;
  static std::array<Edge, 3> edges_of(const facets::Corners& c) {
    return {edge_key(c[0], c[1]), edge_key(c[1], c[2]), edge_key(c[2], c[0])};
  }
  Box box_around(std::span<const Index> points) const;
  // Returns whether t is farther than `reach` from the plane of s.
  bool beyond(Index s, Index t) const;
  void link(Index triangle);

  facets::ComplexDraft& draft_;
  double reach_;
  Work& work_;
  const BoxFrame frame_;  // axes of the boxes
  // Whether `for_each_near_pair` or `for_each_corner_near_edge` was already called with few changed
  // triangles. The first such call makes trees of the changed triangles only; later ones use trees of all
  // triangles.
  bool searched_triangles_ = false, searched_corners_ = false;
  std::size_t count_ = 0;
  std::vector<bool> alive_;
  std::vector<Vector> normals_;
  // Doubly linked lists of the sides that start at a point: `first_` by point, the others by side.
  std::vector<Index> first_, next_, previous_;
  std::vector<Index> degree_;  // by point: length of the list
  ItemTrees<Index> trees_, corner_trees_;
  ItemTrees<Edge> edge_trees_;
};

}  // namespace collarmesh::repairing
