#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "common/box_tree.h"
#include "plc/draft.h"
#include "repair/polygon_cutter.h"
#include "repair/work.h"

namespace collarmesh::repairing {

/// The triangles of a draft while some are replaced by others. They keep their numbers; those at a
/// point, those at an edge and those near others are found without looking at all of them.
/// Holds between calls: the draft's points may have grown, its triangles change by these functions alone.
class ChangingTriangles {
 public:
  /// Triangles are near each other where their boxes, larger by half of `reach` (absolute) on all sides,
  /// meet, and each comes within `reach` of the plane of the other. Pairs of boxes that meet are spent from
  /// `work`.
  ChangingTriangles(build::Draft& draft, double reach, Work& work);

  /// How many there are.
  std::size_t count() const { return count_; }
  /// One more than the largest number.
  Index end() const { return static_cast<Index>(draft_.triangles.size()); }
  bool alive(Index triangle) const { return alive_[triangle]; }

  /// Its number.
  Index add(const build::Corners& corners, const build::Origin& origin);
  void remove(Index triangle);

  /// Calls visit(side) with the sides (3 t + i) that start in this point. Nothing may change meanwhile.
  template <class Visit>
  void for_each_at(Index point, const Visit& visit) const {
    if (point < first_.size())
      for (Index side = first_[point]; side != none; side = next_[side]) visit(side);
  }
  bool uses(Index point) const { return point < first_.size() && first_[point] != none; }
  /// The sides on an edge, in order.
  std::vector<Index> sides(const Edge& edge) const;

  /// The unit normal of a triangle, or zero.
  const Vector& normal(Index triangle) const { return normals_[triangle]; }

  /// Calls visit(s, t), s < t, once for each pair of triangles near each other of which one at least is
  /// `changed`; those are alive and in order. Cost: O(k log n + p) for k changed ones and p pairs of boxes;
  /// O(n log n + p) where k is no small share of n.
  template <class Visit>
  void for_each_near_pair(const std::vector<Index>& changed, const Visit& visit) {
    std::vector<bool> among(end(), false);
    for (const Index t : changed) among[t] = true;
    const auto meet = [&](Index s, Index t) {
      work_.spend(1);
      if (!alive_[s] || !alive_[t] || beyond(s, t) || beyond(t, s)) return;
      visit(std::min(s, t), std::max(s, t));
    };
    if (few * changed.size() > count_) {
      all_.build(*this, 0);
      late_.clear();
      all_.tree->for_each_pair([&](Index i, Index j) {
        const Index s = all_.triangles[i], t = all_.triangles[j];
        if (among[s] || among[t]) meet(s, t);
      });
      return;
    }
    if (!all_.tree && !searched_) {
      searched_ = true;
      search_from_all(changed, [&](Index s, Index t) {
        if (t != s && !(among[t] && t < s)) meet(s, t);
      });
      return;
    }
    renew_trees();
    for (const Index s : changed) {
      const Box box = box_of(s);
      for (const Tree* tree : {&all_, &late_}) {
        if (!tree->tree) continue;
        tree->tree->for_each_meeting(box, [&](Index i) {
          const Index t = tree->triangles[i];
          if (t != s && !(among[t] && t < s)) meet(s, t);
        });
      }
    }
  }

  /// The draft without gaps: triangles stay in order, but have other numbers there.
  build::Draft compacted() const;

 private:
  static constexpr std::size_t few = 8;  // changed ones of which each is looked for alone, as a share of all

  struct Tree {
    std::vector<Index> triangles;
    std::unique_ptr<BoxTree> tree;
    void build(const ChangingTriangles& of, Index from);
    void clear() { tree.reset(), triangles.clear(); }
    Index end = 0;  // it holds those before
  };

  // Without a tree of all: visit(s, t) for changed ones s and all t.
  template <class Visit>
  void search_from_all(const std::vector<Index>& changed, const Visit& visit) const {
    std::vector<Box> boxes;
    boxes.reserve(changed.size());
    for (const Index s : changed) boxes.push_back(box_of(s));
    const BoxTree tree(boxes);
    for (Index t = 0; t < end(); ++t)
      if (alive_[t]) tree.for_each_meeting(box_of(t), [&](Index i) { visit(changed[i], t); });
  }

  Box box_of(Index triangle) const;
  // Does t keep its distance from the plane of s?
  bool beyond(Index s, Index t) const;
  void renew_trees();
  void link(Index triangle);

  build::Draft& draft_;
  double reach_;
  Work& work_;
  bool searched_ = false;  // for a few changed ones, without a tree of all
  std::size_t count_ = 0;
  std::vector<bool> alive_;
  std::vector<Vector> normals_;
  std::vector<Index> first_, next_;  // by point and by side: the sides that start there, a list
  std::vector<Index> degree_;        // by point: how long the list is
  Tree all_, late_;                  // of most triangles, and of those that came later
};

}  // namespace collarmesh::repairing
