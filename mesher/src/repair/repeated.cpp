#include "repair/repeated.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <tuple>

#include "common/disjoint_sets.h"
#include "facets/edges.h"
#include "repair/most_places.h"

namespace collarmesh::repairing {

namespace {

using namespace facets;

// Returns for each triangle whether it is a copy of an earlier one of its soup: with the same corners and,
// except in complexes, the same orientation.
std::vector<bool> find_copies(const ComplexDraft& draft) {
  struct Key {
    Corners corners;
    Index soup;
    bool odd;
    Index triangle;
  };
  std::vector<Key> keys(draft.triangles.size());
  for (Index t = 0; t < keys.size(); ++t) {
    Corners c = draft.triangles[t];
    const Index soup = draft.origins[t].soup;
    const bool odd = (c[0] > c[1]) != ((c[1] > c[2]) != (c[0] > c[2]));
    std::sort(c.begin(), c.end());
    keys[t] = {c, soup, odd && !draft.soup_is_complex[soup], t};
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    return std::tie(a.corners, a.soup, a.odd, a.triangle) < std::tie(b.corners, b.soup, b.odd, b.triangle);
  });
  std::vector<bool> copy(draft.triangles.size(), false);
  for (std::size_t i = 1; i < keys.size(); ++i)
    copy[keys[i].triangle] = keys[i].corners == keys[i - 1].corners && keys[i].soup == keys[i - 1].soup &&
                             keys[i].odd == keys[i - 1].odd;
  return copy;
}

// Groups of copies connected by edges. Tells for each group whether dropping it leaves as many open edges as
// before, or more.
class CopyGroups {
 public:
  CopyGroups(const ComplexDraft& draft, const std::vector<bool>& copy) : sets_(draft.triangles.size()) {
    const EdgeTable edges(draft.triangles, draft.points.size());
    std::vector<Index> copies;
    for (Index e = 0; e < edges.size(); ++e) {
      copies.clear();
      for (const Index side : edges.sides(e))
        if (copy[side / 3]) copies.push_back(side / 3);
      for (const Index t : copies)
        if (draft.origins[t].soup == draft.origins[copies[0]].soup) sets_.unite(t, copies[0]);
    }
    for (Index e = 0; e < edges.size(); ++e) add_edge(draft, copy, edges, e);
  }

  bool opens(Index triangle) { return change_[sets_.find(triangle)] >= 0; }

 private:
  void add_edge(const ComplexDraft& draft, const std::vector<bool>& copy, const EdgeTable& edges, Index e) {
    struct Sum {
      int before = 0, of_copies = 0;
      Index group = none;
    };
    std::map<Index, Sum> by_soup;
    for (const Index side : edges.sides(e)) {
      Sum& sum = by_soup[draft.origins[side / 3].soup];
      const int way = ascending(draft.triangles, side) ? 1 : -1;
      sum.before += way;
      if (!copy[side / 3]) continue;
      sum.of_copies += way;
      sum.group = sets_.find(side / 3);
    }
    for (const auto& [soup, sum] : by_soup)
      if (sum.group != none)
        change_[sum.group] += std::abs(sum.before - sum.of_copies) - std::abs(sum.before);
  }

  DisjointSets sets_;
  std::map<Index, int> change_;  // by group: change of the number of open edges if the group is dropped
};

}  // namespace

RepeatedReport drop_repeated(ComplexDraft& draft) {
  RepeatedReport report;
  const std::vector<bool> copy = find_copies(draft);
  if (std::none_of(copy.begin(), copy.end(), [](bool c) { return c; })) return report;
  CopyGroups groups(draft, copy);
  std::size_t kept = 0;
  for (Index t = 0; t < draft.triangles.size(); ++t) {
    const bool drop = copy[t] && (draft.soup_is_complex[draft.origins[t].soup] || !groups.opens(t));
    if (drop) {
      ++report.count;
      if (report.where.size() < most_places) report.where.push_back(draft.corner(t, 0));
      continue;
    }
    draft.triangles[kept] = draft.triangles[t];
    draft.origins[kept++] = draft.origins[t];
  }
  draft.triangles.resize(kept);
  draft.origins.resize(kept);
  return report;
}

}  // namespace collarmesh::repairing
