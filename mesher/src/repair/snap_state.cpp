#include "repair/snap_state.h"

#include <algorithm>
#include <utility>

#include "common/sort_uniquely.h"
#include "repair/duplicate_triangles.h"

namespace collarmesh::repairing {

using namespace facets;

SnapState::SnapState(ComplexDraft& draft, double limit, SnapWhat what, Work& work,
                     const std::vector<bool>& known)
    : draft_(draft),
      limit_(limit),
      what_(what),
      work_(work),
      triangles_(draft, limit, work),
      flags_(draft.triangles.size(), 0) {
  for (Index t = 0; t < triangles_.end(); ++t) {
    if (!takes_part(t) || (!known.empty() && known[t])) continue;
    flags_[t] = by_both;
    for (auto& list : unseen_) list.push_back(t);
    if (!known.empty()) added_.push_back(t);
  }
}

// Returns whether a triangle takes part in snapping. With `SnapWhat::borders`, it must have a border edge.
bool SnapState::takes_part(Index triangle) const {
  const Corners& c = draft_.triangles[triangle];
  return takes_part(edge_key(c[0], c[1])) || takes_part(edge_key(c[1], c[2])) ||
         takes_part(edge_key(c[2], c[0]));
}

bool SnapState::takes_part(Index point, bool pinned) const {
  if (what_ != SnapWhat::borders) return triangles_.uses(point) || pinned;
  bool border = false;
  triangles_.for_each_at(point, [&](Index side) {
    for (const Index k : {1U, 2U})
      border = border || is_border(edge_key(point, draft_.triangles[side / 3][(side % 3 + k) % 3]));
  });
  return border;
}

void SnapState::put(const Corners& corners, const Origin& origin) {
  const Index t = triangles_.add(corners, origin);
  flags_.push_back(by_both);
  for (auto& list : unseen_) list.push_back(t);
  added_.push_back(t);
  touched_.insert(touched_.end(), corners.begin(), corners.end());
}

void SnapState::take(Index t) {
  triangles_.remove(t);
  touched_.insert(touched_.end(), draft_.triangles[t].begin(), draft_.triangles[t].end());
}

std::vector<Index> SnapState::take_unseen(By by) {
  std::vector<Index>& list = list_of(by);
  std::erase_if(list, [&](Index t) { return !triangles_.alive(t) || (flags_[t] & by) == 0; });
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  for (const Index t : list) flags_[t] = static_cast<std::uint8_t>(flags_[t] & ~by);
  return std::exchange(list, {});
}

void SnapState::defer(Index t) {
  flags_[t] |= by_corners;
  list_of(by_corners).push_back(t);
}

std::vector<bool> SnapState::unseen(By by) const {
  std::vector<bool> result;
  result.reserve(triangles_.count());
  for (Index t = 0; t < triangles_.end(); ++t)
    if (triangles_.alive(t)) result.push_back((flags_[t] & by) != 0);
  return result;
}

std::size_t cancel_new_duplicates(SnapState& state) {
  const ComplexDraft& draft = state.draft();
  // Duplicates meet at their corners. A corner with many triangles is searched once for all of them.
  std::vector<Index> corners;
  for (const Index t : state.take_added())
    if (state.triangles().alive(t)) corners.push_back(state.triangles().least_busy(draft.triangles[t]));
  sort_uniquely(corners);
  std::size_t count = 0;
  std::vector<Index> there;
  for (const Index corner : corners) {
    there.clear();
    state.triangles().for_each_at(corner, [&](Index side) { there.push_back(side / 3); });
    const std::vector<Index> cancelled = cancelled_among(draft, there);
    for (const Index t : cancelled) state.take(t);
    count += cancelled.size();
  }
  return count;
}

}  // namespace collarmesh::repairing
