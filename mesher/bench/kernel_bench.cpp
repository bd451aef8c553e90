// Compares our Delaunay kernel with CGAL's: both get the same points in the same order.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <benchmark/benchmark.h>

#include <iterator>
#include <vector>

#include "delaunay/triangulation.h"
#include "shapes.h"

namespace collarmesh::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalTriangulation = CGAL::Delaunay_triangulation_3<Kernel>;
using CellHandle = CgalTriangulation::Cell_handle;

Kernel::Point_3 to_cgal(const Point& p) { return {p.x, p.y, p.z}; }

/// Returns a box much larger than the unit cube. Refinement puts such a box around its input.
Box surrounding_box() {
  Box box;
  box.add(Point{-0.87, -0.89, -0.91});
  box.add(Point{1.87, 1.89, 1.91});
  return box;
}

/// Walks from `cell` towards p and returns the first cell on the way that is in conflict with p. The signs of
/// rounded volumes choose the way; a wrong sign costs no more than a detour.
Index conflicting_cell(const Triangulation& mesh, Index cell, const Point& p) {
  FaceId entered = no_face;
  while (!mesh.in_conflict(cell, p)) {
    FaceId leave = no_face;
    double farthest = 0;
    for (unsigned i = 0; i < 4; ++i) {
      const FaceId face = face_id(cell, i);
      if (face == entered || mesh.opposite(face) == no_face) continue;
      const auto v = mesh.face_vertices(face);
      const double beyond = six_volume(mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]), p);
      if (leave != no_face && beyond <= farthest) continue;
      leave = face;
      farthest = beyond;
    }
    entered = mesh.opposite(leave);
    cell = cell_of(entered);
  }
  return cell;
}

void insert_all(Triangulation& mesh, const std::vector<Point>& points) {
  ConflictZone zone;
  Index cell = 0;
  for (const Point& p : points) {
    mesh.find_conflict_zone(p, conflicting_cell(mesh, cell, p), zone);
    cell = mesh.incident_cell(mesh.insert(zone));
  }
}

void insert_all(CgalTriangulation& mesh, const std::vector<Point>& points) {
  CellHandle cell;
  for (const Point& p : points) cell = mesh.insert(to_cgal(p), cell)->cell();
}

std::vector<Point> points_of(const benchmark::State& state) {
  return spatially_sorted(well_spaced_points(static_cast<std::size_t>(state.range(0))));
}

void count_rates(benchmark::State& state, std::size_t points, std::size_t cells) {
  const auto rate = benchmark::Counter::kIsIterationInvariantRate;
  state.counters["points/s"] = benchmark::Counter(static_cast<double>(points), rate);
  state.counters["cells/s"] = benchmark::Counter(static_cast<double>(cells), rate);
}

void insertion(benchmark::State& state) {
  const std::vector<Point> points = points_of(state);
  std::size_t cells = 0;
  for (auto _ : state) {
    Triangulation mesh(surrounding_box());
    insert_all(mesh, points);
    cells = mesh.cell_count();
    state.counters["bytes/cell"] = static_cast<double>(mesh.bytes()) / static_cast<double>(cells);
  }
  count_rates(state, points.size(), cells);
}

void insertion_cgal(benchmark::State& state) {
  const std::vector<Point> points = points_of(state);
  std::size_t cells = 0;
  for (auto _ : state) {
    CgalTriangulation mesh;
    insert_all(mesh, points);
    cells = mesh.number_of_finite_cells();
  }
  count_rates(state, points.size(), cells);
}

/// Returns the points whose conflict zones the benchmark searches. Like the inserted points, they are in the
/// order of a space-filling curve, so that caches behave as in refinement.
std::vector<Point> queries() { return spatially_sorted(random_points(20'000, 17)); }

void conflict_zone(benchmark::State& state) {
  Triangulation mesh(surrounding_box());
  insert_all(mesh, points_of(state));
  const std::vector<Point> points = queries();
  std::vector<Index> starts;
  Index cell = mesh.incident_cell(mesh.vertex_count() - 1);
  for (const Point& p : points) starts.push_back(cell = conflicting_cell(mesh, cell, p));
  ConflictZone zone;
  std::size_t cells = 0;
  for (auto _ : state) {
    cells = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      mesh.find_conflict_zone(points[i], starts[i], zone);
      cells += zone.cells.size();
    }
  }
  count_rates(state, points.size(), cells);
}

void conflict_zone_cgal(benchmark::State& state) {
  CgalTriangulation mesh;
  insert_all(mesh, points_of(state));
  std::vector<Kernel::Point_3> points;
  std::vector<CellHandle> starts;
  CellHandle near;
  for (const Point& p : queries()) {
    points.push_back(to_cgal(p));
    starts.push_back(near = mesh.locate(points.back(), near));
  }
  std::vector<CellHandle> zone;
  std::vector<CgalTriangulation::Facet> border;
  std::size_t cells = 0;
  for (auto _ : state) {
    cells = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      zone.clear();
      border.clear();
      mesh.find_conflicts(points[i], starts[i], std::back_inserter(border), std::back_inserter(zone));
      cells += zone.size();
    }
  }
  count_rates(state, points.size(), cells);
}

BENCHMARK(insertion)->Arg(10'000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(insertion_cgal)->Arg(10'000)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(conflict_zone)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
BENCHMARK(conflict_zone_cgal)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace collarmesh::bench
