#include "repair/snap_points.h"

#include <algorithm>
#include <map>

namespace collarmesh::repairing {

using namespace facets;

PointMerger::PointMerger(SnapState& state, const std::vector<bool>& known)
    : state_(state), grid_(state.draft().points, state.limit()) {
  const ComplexDraft& draft = state.draft();
  pinned_.assign(draft.points.size(), false);
  for (const Segment& s : draft.segments) pinned_[s.a] = pinned_[s.b] = true;
  for (const Index p : draft.loose_points) pinned_[p] = true;
  in_grid_.assign(draft.points.size(), false);
  for (Index t = 0; t < known.size(); ++t)
    if (known[t] && state.takes_part(t))
      for (const Index p : draft.triangles[t]) in_grid_[p] = true;
  for (Index p = 0; p < draft.points.size(); ++p)
    if (in_grid_[p])
      grid_.add(p);
    else
      state.touch(p);
}

bool PointMerger::before(Index p, Index q) const {
  const Point &a = state_.at(p), &b = state_.at(q);
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z != b.z ? a.z < b.z : p < q;
}

bool PointMerger::merge() {
  std::vector<Index> order = points_to_compare();
  std::vector<std::pair<Index, Index>> merged;  // a point, and the one it is merged with
  for (const Index p : order) {
    const Index near = grid_.nearest(state_.at(p), [&](Index q) { return in_grid_[q]; });
    if (near == none) {
      in_grid_[p] = true;
      grid_.add(p);
      continue;
    }
    merged.emplace_back(p, near);
    state_.done().push_back({SnapState::Done::What::merged, p, distance(state_.at(p), state_.at(near))});
  }
  if (merged.empty()) return false;
  keep_pinned(merged);
  rename_points(state_, merged);
  return true;
}

// Returns the new points and the points of the grid that are near them, sorted by coordinates. Removes the
// latter from the grid.
std::vector<Index> PointMerger::points_to_compare() {
  in_grid_.resize(state_.draft().points.size(), false);
  std::vector<Index> order, touched = state_.take_touched();
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  state_.work().spend(touched.size());
  for (const Index p : touched) {
    const bool takes = state_.takes_part(p, is_pinned(p));
    if (takes && !in_grid_[p]) order.push_back(p);
    if (!takes) in_grid_[p] = false;
  }
  for (std::size_t i = 0, fresh = order.size(); i < fresh; ++i)
    grid_.for_each_near(state_.at(order[i]), [&](Index q) {
      if (!in_grid_[q]) return;
      in_grid_[q] = false;
      order.push_back(q);
    });
  std::sort(order.begin(), order.end(), [&](Index p, Index q) { return before(p, q); });
  return order;
}

void PointMerger::keep_pinned(const std::vector<std::pair<Index, Index>>& merged) {
  for (const auto& [p, into] : merged) {
    if (!is_pinned(p)) continue;
    pinned_.resize(std::max<std::size_t>(pinned_.size(), into + 1), false);
    pinned_[into] = true;
  }
}

void rename_points(SnapState& state, const std::vector<std::pair<Index, Index>>& merged) {
  if (merged.empty()) return;
  ComplexDraft& draft = state.draft();
  std::map<Index, Index> name(merged.begin(), merged.end());
  const auto renamed = [&](Index p) {
    const auto found = name.find(p);
    return found == name.end() ? p : found->second;
  };
  std::vector<Index> changed;
  for (const auto& [p, into] : merged)
    state.triangles().for_each_at(p, [&](Index side) { changed.push_back(side / 3); });
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  for (const Index t : changed) {
    const Corners before = draft.triangles[t];
    const Corners corners{renamed(before[0]), renamed(before[1]), renamed(before[2])};
    const Origin origin = draft.origins[t];
    state.take(t);
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      state.put(corners, origin);
  }
  for (Segment& s : draft.segments) s = {renamed(s.a), renamed(s.b), s.tag, s.soup};
  std::erase_if(draft.segments, [](const Segment& s) { return s.a == s.b; });
  for (Index& p : draft.loose_points) p = renamed(p);
}

}  // namespace collarmesh::repairing
