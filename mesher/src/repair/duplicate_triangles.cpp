#include "repair/duplicate_triangles.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "common/disjoint_sets.h"
#include "facets/edges.h"
#include "facets/faults.h"
#include "facets/orientation.h"
#include "repair/inside.h"

namespace collarmesh::repairing {

using namespace facets;

namespace {

// One of several triangles of a soup with the same corners.
struct Duplicate {
  bool odd;  // whether its corners are an odd permutation of the sorted ones; odd and even duplicates have
             // opposite orientations
  Index triangle;
};

bool is_odd(const Corners& c) { return (c[0] > c[1]) != ((c[1] > c[2]) != (c[0] > c[2])); }

std::vector<Index> all_triangles(const ComplexDraft& draft) {
  std::vector<Index> all(draft.triangles.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

// Visits each group of two or more of these triangles that have the same corners and are of one soup. In a
// group, even duplicates come before odd ones, and each kind is sorted by number.
template <class Visit>
void for_each_group(const ComplexDraft& draft, const std::vector<Index>& triangles, const Visit& visit) {
  struct Key {
    Corners corners;
    Index soup;
    Duplicate duplicate;
  };
  std::vector<Key> keys;
  keys.reserve(triangles.size());
  for (const Index t : triangles) {
    keys.push_back({draft.triangles[t], draft.origins[t].soup, {is_odd(draft.triangles[t]), t}});
    std::sort(keys.back().corners.begin(), keys.back().corners.end());
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.corners, a.soup, a.duplicate.odd, a.duplicate.triangle) <
           std::tie(b.corners, b.soup, b.duplicate.odd, b.duplicate.triangle);
  });
  std::vector<Duplicate> duplicates;
  for (auto first = keys.begin(); first != keys.end();) {
    duplicates.clear();
    auto last = first;
    for (; last != keys.end() && last->corners == first->corners && last->soup == first->soup; ++last)
      duplicates.push_back(last->duplicate);
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

std::vector<Index> cancelled_among(const ComplexDraft& draft, const std::vector<Index>& triangles) {
  std::vector<Index> cancelled;
  for_each_group(draft, triangles, [&](const std::vector<Duplicate>& duplicates) {
    if (draft.soup_is_complex[draft.origins[duplicates[0].triangle].soup]) {
      for (auto duplicate = duplicates.begin() + 1; duplicate != duplicates.end(); ++duplicate)
        cancelled.push_back(duplicate->triangle);
      return;
    }
    const auto middle = std::ranges::find_if(duplicates, &Duplicate::odd);
    for (auto even = duplicates.begin(), odd = middle; even != middle && odd != duplicates.end();
         ++even, ++odd) {
      cancelled.push_back(even->triangle);
      cancelled.push_back(odd->triangle);
    }
  });
  return cancelled;
}

std::size_t cancel_duplicates(ComplexDraft& draft) {
  std::vector<bool> removed(draft.triangles.size(), false);
  for (const Index t : cancelled_among(draft, all_triangles(draft))) removed[t] = true;
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
  for_each_group(draft, all_triangles(draft), [&](const std::vector<Duplicate>& duplicates) {
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
