// Benchmarks of repair. One input is a cubic lattice of spheres, each rotated differently, that intersect
// their neighbours; the other one is a valid surface.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "collarmesh/repair.h"
#include "shapes.h"

namespace collarmesh::bench {
namespace {

Point turned(const Point& p, double a, double b) {
  const Point q{std::cos(a) * p.x - std::sin(a) * p.y, std::sin(a) * p.x + std::cos(a) * p.y, p.z};
  return {q.x, std::cos(b) * q.y - std::sin(b) * q.z, std::sin(b) * q.y + std::cos(b) * q.z};
}

void add(PolygonSoup& soup, const PolygonSoup& part, double turn, const Vector& by) {
  const auto first = static_cast<Index>(soup.points.size());
  for (const Point& p : part.points) soup.points.push_back(turned(p, 1 + turn, 2 + 3 * turn) + by);
  for (Index q = 0; q < part.polygon_count(); ++q) {
    const auto c = part.polygon(q);
    soup.add_facet(std::array{first + c[0], first + c[1], first + c[2]}, 1);
  }
}

/// Returns side^3 spheres of 4 * rings^2 triangles each, in one soup.
PolygonSoup bunch(Index side, Index rings) {
  constexpr double spacing = 1.7;
  PolygonSoup soup;
  const PolygonSoup one = sphere(rings);
  for (Index i = 0; i < side * side * side; ++i)
    add(soup, one, 0.1 * i,
        spacing * Vector{static_cast<double>(i % side), static_cast<double>(i / side % side),
                         static_cast<double>(i / side / side)});
  return soup;
}

void repairing(benchmark::State& state, const PolygonSoup& soup) {
  RepairedPlc repaired;
  for (auto _ : state) repaired = build_repaired_plc({&soup, 1});
  state.counters["triangles"] = soup.facet_count();
  state.counters["pairs"] = static_cast<double>(repaired.report.cut.count);
  state.counters["regions"] = static_cast<double>(repaired.plc.regions.size()) - 1;
}

void building(benchmark::State& state, const PolygonSoup& soup) {
  for (auto _ : state) benchmark::DoNotOptimize(build_plc({&soup, 1}));
  state.counters["triangles"] = soup.facet_count();
}

BENCHMARK_CAPTURE(repairing, bunch, bunch(3, 30))->Unit(benchmark::kMillisecond)->Iterations(1);
// Repair of a valid surface should take no longer than the builder alone, so these two times should be equal.
BENCHMARK_CAPTURE(repairing, sphere, sphere(158))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(building, sphere, sphere(158))->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace collarmesh::bench
