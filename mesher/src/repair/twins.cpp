#include "repair/twins.h"

#include <algorithm>
#include <tuple>

namespace collarmesh::repairing {

using namespace build;

bool is_odd(const Corners& c) { return (c[0] > c[1]) != ((c[1] > c[2]) != (c[0] > c[2])); }

std::vector<Index> cancelled_among(std::vector<Twin> twins, bool in_complex) {
  std::vector<Index> cancelled;
  if (twins.size() < 2) return cancelled;
  std::sort(twins.begin(), twins.end());
  if (in_complex) {
    for (auto twin = twins.begin() + 1; twin != twins.end(); ++twin) cancelled.push_back(twin->triangle);
    return cancelled;
  }
  const auto middle = std::find_if(twins.begin(), twins.end(), [](const Twin& twin) { return twin.odd; });
  for (auto even = twins.begin(), odd = middle; even != middle && odd != twins.end(); ++even, ++odd) {
    cancelled.push_back(even->triangle);
    cancelled.push_back(odd->triangle);
  }
  return cancelled;
}

std::size_t cancel_twins(Draft& draft) {
  struct Key {
    Corners corners;
    Index soup, triangle;
  };
  std::vector<Key> keys(draft.triangles.size());
  for (Index t = 0; t < keys.size(); ++t) {
    keys[t] = {draft.triangles[t], draft.origins[t].soup, t};
    std::sort(keys[t].corners.begin(), keys[t].corners.end());
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.corners, a.soup, a.triangle) < std::tie(b.corners, b.soup, b.triangle);
  });
  std::vector<bool> removed(draft.triangles.size(), false);
  std::vector<Twin> twins;
  for (auto first = keys.begin(); first != keys.end();) {
    twins.clear();
    auto last = first;
    for (; last != keys.end() && last->corners == first->corners && last->soup == first->soup; ++last)
      twins.push_back({is_odd(draft.triangles[last->triangle]), last->triangle});
    if (twins.size() > 1)
      for (const Index t : cancelled_among(twins, draft.soup_is_complex[first->soup])) removed[t] = true;
    first = last;
  }
  std::size_t kept = 0;
  for (Index t = 0; t < draft.triangles.size(); ++t) {
    if (removed[t]) continue;
    draft.triangles[kept] = draft.triangles[t];
    draft.origins[kept++] = draft.origins[t];
  }
  const std::size_t count = draft.triangles.size() - kept;
  draft.triangles.resize(kept);
  draft.origins.resize(kept);
  return count;
}

}  // namespace collarmesh::repairing
