#include "facets/simplices.h"

#include <algorithm>
#include <numeric>

#include "common/box_frame.h"
#include "common/sort_uniquely.h"

namespace collarmesh::facets {

namespace {

std::vector<Simplex> collect(const ComplexDraft& draft, const EdgeTable& edges) {
  std::vector<Simplex> simplices;
  simplices.reserve(draft.triangles.size());
  for (const Corners& t : draft.triangles) simplices.push_back({t, 3});
  std::vector<std::array<Index, 2>> loose;
  for (const Segment& s : draft.segments)
    if (edges.find(s.a, s.b) == none) loose.push_back({std::min(s.a, s.b), std::max(s.a, s.b)});
  sort_uniquely(loose);
  for (const auto& [a, b] : loose) simplices.push_back({{a, b, none}, 2});
  for (const Index p : draft.loose_points) simplices.push_back({{p, none, none}, 1});
  return simplices;
}

std::vector<Box> boxes_of(const ComplexDraft& draft, std::span<const Simplex> simplices,
                          const BoxFrame& frame = {}) {
  std::vector<Box> boxes(simplices.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const Index p : simplices[i].corners()) frame.add(boxes[i], draft.points[p]);
  return boxes;
}

std::vector<Index> facets_of(const ComplexDraft& draft, std::span<const Simplex> simplices) {
  std::vector<Index> first_facet{0};  // for each soup, the number of its first facet among all facets
  for (const Origin& origin : draft.origins) {
    if (origin.soup + 1 >= first_facet.size()) first_facet.resize(origin.soup + 2, 0);
    first_facet[origin.soup + 1] = std::max(first_facet[origin.soup + 1], origin.facet + 1);
  }
  std::partial_sum(first_facet.begin(), first_facet.end(), first_facet.begin());
  std::vector<Index> groups;
  groups.reserve(simplices.size());
  for (const Origin& origin : draft.origins) groups.push_back(first_facet[origin.soup] + origin.facet);
  for (Index next = first_facet.back(); groups.size() < simplices.size(); ++next) groups.push_back(next);
  return groups;
}

}  // namespace

Simplices::Simplices(const ComplexDraft& draft, const EdgeTable& edges)
    : list_(collect(draft, edges)), boxes_(boxes_of(draft, list_), facets_of(draft, list_)) {
  if (const BoxFrame frame(draft.points, draft.triangles); frame.turned())
    turned_.emplace(boxes_of(draft, list_, frame), facets_of(draft, list_));
}

}  // namespace collarmesh::facets
