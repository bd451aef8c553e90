// Benchmarks of meshing through the library, and of the certificate.
#include <benchmark/benchmark.h>

#include <span>

#include "collarmesh/check.h"
#include "collarmesh/mesher.h"
#include "collarmesh/plc_builder.h"
#include "shapes.h"

namespace collarmesh::bench {
namespace {

Plc complex_of(const PolygonSoup& soup) { return build_plc(std::span(&soup, 1)); }

MeshResult mesh(const Plc& plc, const benchmark::State& state) {
  MeshOptions options;
  options.size = plc.bounds.diagonal() / static_cast<double>(state.range(0));
  return generate(plc, options);
}

void count_tets(benchmark::State& state, const MeshResult& result) {
  state.counters["tets"] = static_cast<double>(result.mesh.tets.size());
  state.counters["tets/s"] = benchmark::Counter(static_cast<double>(result.mesh.tets.size()),
                                                benchmark::Counter::kIsIterationInvariantRate);
}

void meshing(benchmark::State& state, const PolygonSoup& soup) {
  const Plc plc = complex_of(soup);
  MeshResult result;
  for (auto _ : state) result = mesh(plc, state);
  count_tets(state, result);
}

void checking(benchmark::State& state, const PolygonSoup& soup) {
  const Plc plc = complex_of(soup);
  const MeshResult result = mesh(plc, state);
  for (auto _ : state) {
    if (!check(result.mesh, plc).passed()) state.SkipWithError("a guarantee does not hold");
  }
  count_tets(state, result);
}

// The argument is the diagonal divided by the target edge length.
BENCHMARK_CAPTURE(meshing, box, unit_box())->Arg(20)->Arg(60)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(meshing, sphere, sphere(50))->Arg(20)->Arg(60)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(checking, box, unit_box())->Arg(20)->Arg(60)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(checking, sphere, sphere(50))->Arg(20)->Arg(60)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace collarmesh::bench
