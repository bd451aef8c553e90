#include "plc/interfaces.h"

#include <algorithm>
#include <map>

#include "facets/edges.h"
#include "facets/flat_clusters.h"

namespace collarmesh::plc {

using namespace facets;

namespace {

using Border = std::vector<Index>;  // edges, sorted

class InterfaceFinder {
 public:
  explicit InterfaceFinder(ComplexDraft& draft)
      : draft_(draft),
        edges_(draft.triangles, draft.points.size()),
        clusters_(find_flat_clusters(draft, edges_)) {}

  void run() {
    const auto clusters = clusters_on_common_edges();
    std::map<Border, Index> first_of_border;
    std::vector<bool> removed(draft_.triangles.size(), false);
    ComplexDraft added;
    for (const auto& [seed, triangles] : clusters) {
      const auto [at, is_first] = first_of_border.try_emplace(border(seed, triangles), seed);
      const Index first = at->second;
      if (is_first || draft_.origins[first].soup == draft_.origins[seed].soup) continue;
      for (const Index t : triangles) removed[t] = true;
      copy(clusters.at(first), seed, added);
    }
    if (!added.triangles.empty()) replace(removed, added);
  }

 private:
  // Returns by seed the triangles of each cluster that has an edge at which several soups meet.
  std::map<Index, std::vector<Index>> clusters_on_common_edges() const {
    std::vector<bool> wanted(draft_.triangles.size(), false);
    for (Index e = 0; e < edges_.size(); ++e) {
      const auto sides = edges_.sides(e);
      if (draft_.origins[sides.front() / 3].soup == draft_.origins[sides.back() / 3].soup) continue;
      for (const Index side : sides) wanted[clusters_.seed[side / 3]] = true;
    }
    std::map<Index, std::vector<Index>> clusters;
    for (Index t = 0; t < draft_.triangles.size(); ++t)
      if (wanted[clusters_.seed[t]]) clusters[clusters_.seed[t]].push_back(t);
    return clusters;
  }

  // Returns the edges that exactly one triangle of the cluster has.
  Border border(Index seed, const std::vector<Index>& triangles) const {
    Border result;
    for (const Index t : triangles)
      for (unsigned i = 0; i < 3; ++i) {
        const auto sides = edges_.sides(edges_.edge_of(3 * t + i));
        const auto count =
            std::ranges::count_if(sides, [&](Index side) { return clusters_.seed[side / 3] == seed; });
        if (count == 1) result.push_back(edges_.edge_of(3 * t + i));
      }
    std::ranges::sort(result);
    return result;
  }

  void copy(const std::vector<Index>& triangles, Index seed, ComplexDraft& added) const {
    for (const Index t : triangles) {
      Corners corners = draft_.triangles[t];
      if (dot(clusters_.normal[t], clusters_.normal[seed]) < 0) std::swap(corners[1], corners[2]);
      added.add_triangle(corners, draft_.origins[seed]);
    }
  }

  void replace(const std::vector<bool>& removed, const ComplexDraft& added) {
    Index kept = 0;
    for (Index t = 0; t < draft_.triangles.size(); ++t) {
      if (removed[t]) continue;
      draft_.triangles[kept] = draft_.triangles[t];
      draft_.origins[kept++] = draft_.origins[t];
    }
    draft_.triangles.resize(kept);
    draft_.origins.resize(kept);
    for (Index t = 0; t < added.triangles.size(); ++t)
      draft_.add_triangle(added.triangles[t], added.origins[t]);
  }

  ComplexDraft& draft_;
  EdgeTable edges_;
  FlatClusters clusters_;
};

}  // namespace

void unify_interfaces(ComplexDraft& draft) { InterfaceFinder(draft).run(); }

}  // namespace collarmesh::plc
