#include "repair/duplicate_triangles.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "common/disjoint_sets.h"
#include "facets/edges.h"
#include "facets/faults.h"
#include "facets/orientation.h"
#include "repair/inside.h"

namespace collarmesh::repairing {

using namespace facets;

bool is_odd(const Corners& c) { return (c[0] > c[1]) != ((c[1] > c[2]) != (c[0] > c[2])); }

std::vector<Index> cancelled_among(std::vector<DuplicateTriangle> duplicates, bool in_complex) {
  std::vector<Index> cancelled;
  if (duplicates.size() < 2) return cancelled;
  std::sort(duplicates.begin(), duplicates.end());
  if (in_complex) {
    for (auto duplicate = duplicates.begin() + 1; duplicate != duplicates.end(); ++duplicate)
      cancelled.push_back(duplicate->triangle);
    return cancelled;
  }
  const auto middle = std::find_if(duplicates.begin(), duplicates.end(),
                                   [](const DuplicateTriangle& duplicate) { return duplicate.odd; });
  for (auto even = duplicates.begin(), odd = middle; even != middle && odd != duplicates.end();
       ++even, ++odd) {
    cancelled.push_back(even->triangle);
    cancelled.push_back(odd->triangle);
  }
  return cancelled;
}

namespace {

// Visits each group of two or more triangles of one soup that have the same corners.
template <class Visit>
void for_each_group(const ComplexDraft& draft, const Visit& visit) {
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
  std::vector<DuplicateTriangle> duplicates;
  for (auto first = keys.begin(); first != keys.end();) {
    duplicates.clear();
    auto last = first;
    for (; last != keys.end() && last->corners == first->corners && last->soup == first->soup; ++last)
      duplicates.push_back({is_odd(draft.triangles[last->triangle]), last->triangle});
    if (duplicates.size() > 1) visit(duplicates);
    first = last;
  }
}

// Removes the marked triangles. Returns their number.
std::size_t drop(ComplexDraft& draft, const std::vector<bool>& removed) {
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

// Returns the components of triangles that are connected by common corners, as sets of points.
DisjointSets components_of(const ComplexDraft& draft) {
  DisjointSets sets(draft.points.size());
  for (const Corners& t : draft.triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
  }
  return sets;
}

}  // namespace

std::size_t cancel_duplicates(ComplexDraft& draft) {
  std::vector<bool> removed(draft.triangles.size(), false);
  for_each_group(draft, [&](const std::vector<DuplicateTriangle>& duplicates) {
    for (const Index t :
         cancelled_among(duplicates, draft.soup_is_complex[draft.origins[duplicates[0].triangle].soup]))
      removed[t] = true;
  });
  return drop(draft, removed);
}

bool is_two_sided(const ComplexDraft& draft) {
  constexpr double least = 1e-6;  // six times the volume, relative to area^(3/2)
  const Point centre = draft.bounds.centre();
  double six = 0, area = 0;
  for (Index t = 0; t < draft.triangles.size(); ++t) {
    six += dot(draft.corner(t, 0) - centre, cross(draft.corner(t, 1) - centre, draft.corner(t, 2) - centre));
    area += area_of(draft, draft.triangles[t]);
  }
  return std::fabs(six) < least * std::pow(area, 1.5);
}

std::size_t keep_one_side(ComplexDraft& draft) {
  std::vector<bool> second(draft.triangles.size(), false);
  for_each_group(draft, [&](std::vector<DuplicateTriangle> duplicates) {
    std::sort(duplicates.begin(), duplicates.end());
    for (std::size_t i = 1; i < duplicates.size(); ++i) second[duplicates[i].triangle] = true;
  });
  DisjointSets component = components_of(draft);
  std::vector<bool> closed(draft.points.size(), true);
  const EdgeTable edges(draft.triangles, draft.points.size());
  for (Index e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    const auto left =
        std::count_if(sides.begin(), sides.end(), [&](Index side) { return !second[side / 3]; });
    if (left % 2 != 0) closed[component.find(edges.ends(e)[0])] = false;
  }
  for (Index t = 0; t < second.size(); ++t)
    second[t] = second[t] && closed[component.find(draft.triangles[t][0])];
  const std::size_t count = drop(draft, second);
  if (count == 0) return 0;
  EdgeTable left(draft.triangles, draft.points.size());
  Faults one_sided;
  orient_components(draft, left, one_sided);
  turn_components(draft);
  return count;
}

}  // namespace collarmesh::repairing
