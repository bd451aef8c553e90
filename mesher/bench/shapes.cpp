#include "shapes.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/property_map.h>
#include <CGAL/spatial_sort.h>

#include <cmath>
#include <numbers>
#include <random>

namespace collarmesh::bench {

std::vector<Point> well_spaced_points(std::size_t n) {
  const auto side = static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(n))));
  const double spacing = 1 / static_cast<double>(side);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> position(0.1, 0.9);
  std::vector<Point> points;
  points.reserve(side * side * side);
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t j = 0; j < side; ++j)
      for (std::size_t k = 0; k < side; ++k)
        points.push_back(spacing * Point{static_cast<double>(i) + position(random),
                                         static_cast<double>(j) + position(random),
                                         static_cast<double>(k) + position(random)});
  return points;
}

std::vector<Point> random_points(std::size_t n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Point> points(n);
  for (Point& p : points) p = {unit(random), unit(random), unit(random)};
  return points;
}

std::vector<Point> spatially_sorted(const std::vector<Point>& points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> positions;
  std::vector<std::size_t> order;
  for (const Point& p : points) {
    order.push_back(positions.size());
    positions.emplace_back(p.x, p.y, p.z);
  }
  const auto position = CGAL::make_property_map(positions);
  CGAL::spatial_sort(order.begin(), order.end(),
                     CGAL::Spatial_sort_traits_adapter_3<Kernel, decltype(position)>(position));
  std::vector<Point> sorted;
  sorted.reserve(points.size());
  for (const std::size_t i : order) sorted.push_back(points[i]);
  return sorted;
}

PolygonSoup unit_box() {
  PolygonSoup soup;
  soup.name = "box";
  for (unsigned i = 0; i < 8; ++i)
    soup.points.push_back(
        {static_cast<double>(i & 1U), static_cast<double>(i >> 1U & 1U), static_cast<double>(i >> 2U)});
  constexpr std::array<std::array<Index, 4>, 6> sides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& side : sides) soup.add_facet(side);
  return soup;
}

PolygonSoup sphere(Index rings) {
  PolygonSoup soup;
  soup.name = "sphere";
  const Index around = 2 * rings;
  soup.points.push_back({0, 0, -1});
  for (Index i = 1; i <= rings; ++i) {
    const double latitude = std::numbers::pi * (static_cast<double>(i) / (rings + 1) - 0.5);
    for (Index k = 0; k < around; ++k) {
      const double longitude = 2 * std::numbers::pi * k / around;
      soup.points.push_back({std::cos(latitude) * std::cos(longitude),
                             std::cos(latitude) * std::sin(longitude), std::sin(latitude)});
    }
  }
  const auto north = static_cast<Index>(soup.points.size());
  soup.points.push_back({0, 0, 1});
  const auto at = [around](Index ring, Index k) { return 1 + ring * around + k % around; };
  const auto add = [&soup](Index a, Index b, Index c) { soup.add_facet(std::array<Index, 3>{a, b, c}); };
  for (Index k = 0; k < around; ++k) {
    add(0, at(0, k + 1), at(0, k));
    add(north, at(rings - 1, k), at(rings - 1, k + 1));
    for (Index ring = 0; ring + 1 < rings; ++ring) {
      add(at(ring, k), at(ring, k + 1), at(ring + 1, k));
      add(at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k));
    }
  }
  return soup;
}

}  // namespace collarmesh::bench
