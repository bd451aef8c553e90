// Benchmarks of readers and of the builder of the complex, on a sphere of 4 * n^2 triangles; n: the argument.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include "collarmesh/io/soup_io.h"
#include "collarmesh/plc_builder.h"
#include "shapes.h"

namespace collarmesh::bench {
namespace {

void write_stl(const PolygonSoup& soup, std::ofstream& out) {
  const std::string header(80, ' ');
  out << header;
  const std::uint32_t triangles = soup.facet_count();
  out.write(reinterpret_cast<const char*>(&triangles), 4);
  for (Index f = 0; f < soup.facet_count(); ++f) {
    std::array<float, 12> record{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        record[3 + 3 * k + axis] = static_cast<float>(soup.points[soup.polygon(f)[k]][axis]);
    out.write(reinterpret_cast<const char*>(record.data()), 48);
    out.write("\0\0", 2);
  }
}

void write_off_body(const PolygonSoup& soup, std::ofstream& out) {
  out.precision(17);
  for (const Point& p : soup.points) out << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto corners = soup.polygon(f);
    out << corners.size();
    for (const Index c : corners) out << ' ' << c;
    out << '\n';
  }
}

void write_ply(const PolygonSoup& soup, std::ofstream& out) {
  out << "ply\nformat ascii 1.0\nelement vertex " << soup.points.size()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << soup.facet_count()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  write_off_body(soup, out);
}

void write_off(const PolygonSoup& soup, std::ofstream& out) {
  out << "OFF\n" << soup.points.size() << ' ' << soup.facet_count() << " 0\n";
  write_off_body(soup, out);
}

using Writer = void (*)(const PolygonSoup&, std::ofstream&);

void reading(benchmark::State& state, const std::string& extension, Writer write) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("collarmesh_reading_bench" + extension);
  {
    std::ofstream out(path, std::ios::binary);
    write(sphere(static_cast<Index>(state.range(0))), out);
  }
  Index triangles = 0;
  for (auto _ : state) triangles = io::read_soup(path.string()).facet_count();
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(std::filesystem::file_size(path)));
  state.counters["triangles/s"] =
      benchmark::Counter(static_cast<double>(triangles), benchmark::Counter::kIsIterationInvariantRate);
  std::filesystem::remove(path);
}

void building(benchmark::State& state) {
  const PolygonSoup soup = sphere(static_cast<Index>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(build_plc(std::span(&soup, 1)));
  state.counters["triangles/s"] = benchmark::Counter(static_cast<double>(soup.facet_count()),
                                                     benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK_CAPTURE(reading, stl_binary, ".stl", write_stl)->Arg(50)->Arg(300)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(reading, ply_ascii, ".ply", write_ply)->Arg(50)->Arg(300)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(reading, off, ".off", write_off)->Arg(50)->Arg(300)->Unit(benchmark::kMillisecond);
BENCHMARK(building)->Arg(16)->Arg(50)->Arg(150)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace collarmesh::bench
