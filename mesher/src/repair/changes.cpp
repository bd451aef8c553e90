#include "repair/changes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <tuple>
#include <utility>

#include "common/disjoint_sets.h"
#include "facets/edges.h"
#include "facets/intersections.h"
#include "facets/simplices.h"

namespace collarmesh::repairing {

namespace {

using namespace facets;

// A triangle, rotated to begin with its smallest corner, with its soup and tag.
struct CellKey {
  Corners corners;
  Index soup;
  Tag tag;
  Index triangle;

  auto identity() const { return std::tie(corners, soup, tag); }
};

std::vector<CellKey> sorted_keys(const ComplexDraft& draft) {
  std::vector<CellKey> keys;
  keys.reserve(draft.triangles.size());
  for (Index t = 0; t < draft.triangles.size(); ++t) {
    Corners c = draft.triangles[t];
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    keys.push_back({c, draft.origins[t].soup, draft.origins[t].tag, t});
  }
  std::sort(keys.begin(), keys.end(), [](const CellKey& a, const CellKey& b) {
    return std::tuple_cat(a.identity(), std::tie(a.triangle)) <
           std::tuple_cat(b.identity(), std::tie(b.triangle));
  });
  return keys;
}

std::array<Index, 2> edge_of(Index a, Index b) { return a < b ? std::array{a, b} : std::array{b, a}; }

bool same(const Segment& s, const Segment& t) {
  return edge_of(s.a, s.b) == edge_of(t.a, t.b) && s.tag == t.tag && s.soup == t.soup;
}
bool in_order(const Segment& s, const Segment& t) {
  const auto key = [](const Segment& x) { return std::tuple(edge_of(x.a, x.b), x.tag, x.soup); };
  return key(s) < key(t);
}

// Returns the places whose triangles intersect other triangles, some several times. Unchanged triangles are
// not compared with each other.
std::vector<Index> places_that_meet(ComplexDraft draft, const std::vector<Index>& place) {
  for (Index t = 0; t < draft.origins.size(); ++t) draft.origins[t].facet = t;
  const EdgeTable edges(draft.triangles, draft.points.size());
  const Simplices simplices(draft, edges);
  std::vector<bool> unchanged(simplices.list().size(), false);
  for (Index t = 0; t < place.size(); ++t) unchanged[t] = place[t] == none;
  std::vector<Index> met;
  for (const auto& [i, j] : intersecting_pairs(draft, simplices, unchanged))
    for (const Index k : {i, j})
      if (k < place.size() && place[k] != none) met.push_back(place[k]);
  return met;
}

}  // namespace

Changes::Changes(const ComplexDraft& before, const ComplexDraft& after) : before_(before), after_(after) {
  assert(before.points.size() <= after.points.size() &&
         std::equal(before.points.begin(), before.points.end(), after.points.begin()));
  match();
  find_places();
}

// Gives triangles that both states have the place `none`; all others get the temporary place 0.
void Changes::match() {
  of_gone_.assign(before_.triangles.size(), none);
  of_come_.assign(after_.triangles.size(), none);
  const std::vector<CellKey> gone = sorted_keys(before_), come = sorted_keys(after_);
  auto g = gone.begin();
  auto c = come.begin();
  while (g != gone.end() || c != come.end()) {
    if (c == come.end() || (g != gone.end() && g->identity() < c->identity())) {
      of_gone_[g++->triangle] = 0;
    } else if (g == gone.end() || c->identity() < g->identity()) {
      of_come_[c++->triangle] = 0;
    } else {
      ++g;
      ++c;
    }
  }
}

void Changes::find_places() {
  struct Part {
    std::vector<Index>& places;
    const std::vector<Corners>& triangles;
  };
  const std::array<Part, 2> parts{Part{of_gone_, before_.triangles}, Part{of_come_, after_.triangles}};
  std::vector<std::pair<Index*, const Corners*>> changed;
  for (const Part& part : parts)
    for (Index t = 0; t < part.places.size(); ++t)
      if (part.places[t] != none) changed.emplace_back(&part.places[t], &part.triangles[t]);
  for (Index k = 0; k < changed.size(); ++k) {
    const Corners& c = *changed[k].second;
    for (unsigned i = 0; i < 3; ++i) edges_.push_back({edge_of(c[i], c[(i + 1) % 3]), k});
  }
  std::sort(edges_.begin(), edges_.end());
  DisjointSets sets(changed.size());
  for (std::size_t i = 1; i < edges_.size(); ++i)
    if (edges_[i].first == edges_[i - 1].first) sets.unite(edges_[i].second, edges_[i - 1].second);
  for (Index k = 0; k < changed.size(); ++k)
    *changed[k].first = sets.find(k) == k ? places_++ : *changed[sets.find(k)].first;
  for (auto& [edge, k] : edges_) k = *changed[k].first;
}

Index Changes::place_at(Index a, Index b) const {
  const auto edge = edge_of(a, b);
  const auto found = std::lower_bound(edges_.begin(), edges_.end(), std::pair{edge, Index{0}});
  return found == edges_.end() || found->first != edge ? none : found->second;
}

ComplexDraft Changes::without(const std::vector<bool>& taken_back, std::vector<Index>& place) const {
  ComplexDraft mixed = after_;
  mixed.triangles.clear();
  mixed.origins.clear();
  place.clear();
  const auto add = [&](const ComplexDraft& from, const std::vector<Index>& of, bool only_changed, bool back) {
    for (Index t = 0; t < of.size(); ++t) {
      if (of[t] == none ? only_changed : taken_back[of[t]] != back) continue;
      mixed.add_triangle(from.triangles[t], from.origins[t]);
      place.push_back(of[t]);
    }
  };
  add(after_, of_come_, false, false);
  add(before_, of_gone_, true, true);
  mix_segments(taken_back, mixed);
  mix_loose_points(taken_back, mixed);
  return mixed;
}

// Combines the segments of both states: a segment that only one state has belongs to the place of the
// triangles at it.
void Changes::mix_segments(const std::vector<bool>& taken_back, ComplexDraft& mixed) const {
  std::vector<Segment> before = before_.segments, after = after_.segments;
  std::sort(before.begin(), before.end(), in_order);
  std::sort(after.begin(), after.end(), in_order);
  const auto back = [&](const Segment& s) {
    const Index place = place_at(s.a, s.b);
    return place != none && taken_back[place];
  };
  mixed.segments.clear();
  for (const Segment& s : after_.segments) {
    const auto [first, last] = std::equal_range(before.begin(), before.end(), s, in_order);
    if (first != last || !back(s)) mixed.segments.push_back(s);
  }
  for (const Segment& s : before) {
    const auto [first, last] = std::equal_range(after.begin(), after.end(), s, in_order);
    if (first == last && back(s)) mixed.segments.push_back(s);
  }
  std::stable_sort(mixed.segments.begin(), mixed.segments.end(), in_order);
  mixed.segments.erase(std::unique(mixed.segments.begin(), mixed.segments.end(), same), mixed.segments.end());
}

void Changes::mix_loose_points(const std::vector<bool>& taken_back, ComplexDraft& mixed) const {
  std::vector<Index> place_at_point(before_.points.size(), none);
  for (Index t = 0; t < of_gone_.size(); ++t)
    if (of_gone_[t] != none)
      for (const Index p : before_.triangles[t]) place_at_point[p] = of_gone_[t];
  for (std::size_t i = 0; i < std::min(before_.loose_points.size(), mixed.loose_points.size()); ++i) {
    const Index place = place_at_point[before_.loose_points[i]];
    if (place != none && taken_back[place]) mixed.loose_points[i] = before_.loose_points[i];
  }
}

ComplexDraft without_what_meets(const Changes& changes, std::vector<bool>& taken_back) {
  constexpr unsigned most_rounds = 8;
  for (unsigned round = 0;; ++round) {
    std::vector<Index> place;
    ComplexDraft draft = changes.without(taken_back, place);
    if (std::find(taken_back.begin(), taken_back.end(), true) == taken_back.end() && round > 0) return draft;
    const std::vector<bool> before_round = taken_back;
    for (const Index p : places_that_meet(draft, place)) taken_back[p] = true;
    if (taken_back == before_round) return draft;
    if (round == most_rounds) taken_back.assign(taken_back.size(), true);
  }
}

}  // namespace collarmesh::repairing
