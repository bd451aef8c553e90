#include "facets/cleanup.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "common/disjoint_sets.h"
#include "common/face_finder.h"
#include "common/sort_by_vertex.h"
#include "common/sort_uniquely.h"
#include "common/sorted.h"
#include "facets/exact.h"

namespace collarmesh::facets {

namespace {

using Edge = std::array<Index, 2>;

// Groups of triangles with collinear corners: triangles of a group are connected by edges, so all lie on one
// line. Each of their edges is cut at every point of the group between its ends.
class CollinearGroups {
 public:
  CollinearGroups(const ComplexDraft& draft, const std::vector<Index>& flat)
      : draft_(draft), points_(flat.size()) {
    DisjointSets sets(flat.size());
    for (Index i = 0; i < flat.size(); ++i)
      for (unsigned side = 0; side < 3; ++side) {
        const Corners& t = draft.triangles[flat[i]];
        const auto [at, added] = group_of_edge_.try_emplace(sorted(t[side], t[(side + 1) % 3]), i);
        if (!added) sets.unite(at->second, i);
      }
    for (auto& [edge, group] : group_of_edge_) group = sets.find(group);
    for (Index i = 0; i < flat.size(); ++i) {
      auto& group = points_[sets.find(i)];
      group.insert(group.end(), draft.triangles[flat[i]].begin(), draft.triangles[flat[i]].end());
    }
    for (auto& group : points_) sort_uniquely(group);
  }

  /// Returns the points that cut the edge from a to b, in order from a.
  std::vector<Index> cuts(Index a, Index b) const {
    std::vector<Index> result;
    const auto at = group_of_edge_.find(sorted(a, b));
    if (at == group_of_edge_.end()) return result;
    const auto& p = draft_.points;
    for (const Index c : points_[at->second])
      if (c != a && c != b && between(p[a], p[c], p[b])) result.push_back(c);
    std::ranges::sort(result, [&](Index c, Index d) { return between(p[a], p[c], p[d]); });
    return result;
  }

 private:
  const ComplexDraft& draft_;
  std::map<Edge, Index> group_of_edge_;
  std::vector<std::vector<Index>> points_;  // by group
};

// Cuts a triangle at the cuts of its sides. Each step makes a fan from the corner opposite a side with cuts.
void add_cut(const Corners& triangle, const Origin& origin, const CollinearGroups& groups,
             ComplexDraft& result) {
  std::vector<Corners> stack{triangle};
  while (!stack.empty()) {
    const Corners t = stack.back();
    stack.pop_back();
    bool cut = false;
    for (unsigned side = 0; side < 3 && !cut; ++side) {
      std::vector<Index> chain = groups.cuts(t[side], t[(side + 1) % 3]);
      if (chain.empty()) continue;
      cut = true;
      chain.insert(chain.begin(), t[side]);
      chain.push_back(t[(side + 1) % 3]);
      for (std::size_t i = 0; i + 1 < chain.size(); ++i)
        stack.push_back({chain[i], chain[i + 1], t[(side + 2) % 3]});
    }
    if (!cut) result.add_triangle(t, origin);
  }
}

void add_cut(const Segment& segment, const CollinearGroups& groups, ComplexDraft& result) {
  Segment piece = segment;
  for (const Index cut : groups.cuts(segment.a, segment.b)) {
    piece.b = cut;
    result.segments.push_back(piece);
    piece.a = cut;
  }
  piece.b = segment.b;
  result.segments.push_back(piece);
}

// A triangle and its sorted corners, for sorting triangles.
struct TriangleByCorners {
  Corners key;  // sorted corners
  Index triangle;

  friend bool operator<(const TriangleByCorners& a, const TriangleByCorners& b) {
    return std::tie(a.key, a.triangle) < std::tie(b.key, b.triangle);
  }
};

// Sorts triangles so that those with the same corners follow each other, in their original order.
std::vector<TriangleByCorners> sort_by_corners(const ComplexDraft& draft) {
  const auto by_corners = [&](std::size_t t) {
    return TriangleByCorners{sorted(draft.triangles[t]), static_cast<Index>(t)};
  };
  return sorted_by_vertex(draft.triangles.size(), draft.points.size(), by_corners,
                          [](const TriangleByCorners& t) { return t.key[0]; });
}

// Removes the marked triangles and renumbers the claims on the remaining ones. Returns the number of removed
// triangles.
Index compact(ComplexDraft& draft, const std::vector<bool>& removed) {
  std::vector<Index> moved(draft.triangles.size());
  Index kept = 0;
  for (Index t = 0; t < draft.triangles.size(); ++t) {
    moved[t] = kept;
    if (removed[t]) continue;
    draft.triangles[kept] = draft.triangles[t];
    draft.origins[kept++] = draft.origins[t];
  }
  const auto count = static_cast<Index>(draft.triangles.size()) - kept;
  draft.triangles.resize(kept);
  draft.origins.resize(kept);
  for (Claim& claim : draft.claims) claim.side = 2 * moved[claim.side / 2] + claim.side % 2;
  return count;
}

}  // namespace

void remove_collinear_triangles(ComplexDraft& draft) {
  std::vector<Index> flat;
  for (Index t = 0; t < draft.triangles.size(); ++t)
    if (collinear(draft.corner(t, 0), draft.corner(t, 1), draft.corner(t, 2))) flat.push_back(t);
  draft.cleanup.degenerate_triangles += static_cast<Index>(flat.size());
  if (flat.empty()) return;
  const CollinearGroups groups(draft, flat);
  ComplexDraft result;
  for (Index t = 0, next = 0; t < draft.triangles.size(); ++t) {
    if (next < flat.size() && flat[next] == t)
      ++next;
    else
      add_cut(draft.triangles[t], draft.origins[t], groups, result);
  }
  for (const Segment& segment : draft.segments) add_cut(segment, groups, result);
  draft.triangles = std::move(result.triangles);
  draft.segments = std::move(result.segments);
  draft.origins = std::move(result.origins);
}

void remove_duplicates_within_soups(ComplexDraft& draft) {
  const std::vector<TriangleByCorners> order = sort_by_corners(draft);
  std::vector<bool> removed(draft.triangles.size(), false);
  for (std::size_t i = 1; i < order.size(); ++i)
    removed[order[i].triangle] =
        order[i].key == order[i - 1].key &&
        draft.origins[order[i].triangle].soup == draft.origins[order[i - 1].triangle].soup;
  draft.cleanup.repeated_triangles += compact(draft, removed);
}

void merge_duplicates_across_soups(ComplexDraft& draft) {
  const std::vector<TriangleByCorners> order = sort_by_corners(draft);
  std::vector<bool> removed(draft.triangles.size(), false);
  std::set<std::pair<Tag, Tag>> replaced;
  for (std::size_t i = 1, first = 0; i < order.size(); ++i) {
    if (order[i].key != order[first].key) {
      first = i;
      continue;
    }
    const Index kept = order[first].triangle, dropped = order[i].triangle;
    removed[dropped] = true;
    const Origin& origin = draft.origins[dropped];
    const Tag tag = draft.origins[kept].tag;
    if (origin.tag != tag) replaced.insert({origin.tag, tag});
    if (!origin.oriented && !draft.soup_is_complex[origin.soup]) continue;
    const bool alike = FaceFinder::alike(draft.triangles[kept], draft.triangles[dropped]);
    draft.claims.push_back({alike ? back_side(kept) : front_side(kept), origin.soup});
  }
  draft.cleanup.shared_triangles += compact(draft, removed);
  draft.cleanup.replaced_tags.assign(replaced.begin(), replaced.end());
}

}  // namespace collarmesh::facets
