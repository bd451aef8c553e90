#include "facets/box_around.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace collarmesh::facets {

namespace {

bool has_points_only(const PolygonSoup& soup) {
  return soup.facet_count() == 0 && soup.segments.empty() && soup.vertices.empty();
}

Box bounds_of(std::span<const PolygonSoup> soups) {
  Box bounds;
  for (const PolygonSoup& soup : soups)
    for (const Point& p : soup.points)
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) bounds.add(p);
  return bounds;
}

// Returns a tag that no facet has; 0 if all facets have tag 0.
Tag unused_tag(std::span<const PolygonSoup> soups) {
  Tag largest = 0;
  for (const PolygonSoup& soup : soups)
    for (Index f = 0; f < soup.facet_count(); ++f) largest = std::max(largest, soup.facet_tag(f));
  return largest == 0 ? 0 : largest + 1;
}

PolygonSoup box_soup(const Box& inner, double margin, Tag tag) {
  const Vector sides = inner.max - inner.min;
  const double extent = std::max({sides.x, sides.y, sides.z});
  const double distance = margin * (extent > 0 ? extent : 1);
  const std::array<Point, 2> ends{inner.min - Vector{distance, distance, distance},
                                  inner.max + Vector{distance, distance, distance}};
  PolygonSoup box;
  box.name = "the box around the input";
  for (unsigned corner = 0; corner < 8; ++corner)
    box.points.push_back({ends[corner & 1U].x, ends[(corner >> 1U) & 1U].y, ends[(corner >> 2U) & 1U].z});
  constexpr std::array<std::array<Index, 4>, 6> facets{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& corners : facets) box.add_facet(corners, tag);
  return box;
}

}  // namespace

std::vector<PolygonSoup> with_box(std::span<const PolygonSoup> soups, const PlcOptions& options) {
  std::vector<PolygonSoup> all(soups.begin(), soups.end());
  for (PolygonSoup& soup : all) {
    if (!has_points_only(soup)) continue;
    soup.vertices.resize(soup.points.size());
    std::iota(soup.vertices.begin(), soup.vertices.end(), Index{0});
  }
  const bool any = std::ranges::any_of(all, [](const auto& soup) { return !soup.points.empty(); });
  if (any) all.push_back(box_soup(bounds_of(soups), options.box_margin, unused_tag(soups)));
  return all;
}

PlcOptions enclosed(PlcOptions options) {
  options.domain = DomainShape::enclosed;
  return options;
}

}  // namespace collarmesh::facets
