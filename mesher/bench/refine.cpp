// Builds a complex and refines it; makes no certificate and writes no mesh. For profile.sh and versions.py.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <span>

#include "collarmesh/error.h"
#include "collarmesh/io/soup_io.h"
#include "collarmesh/mesher.h"
#include "collarmesh/plc_builder.h"
#include "common/stopwatch.h"

namespace {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void refine(const char* path, double size, unsigned threads) {
  const collarmesh::PolygonSoup soup = collarmesh::io::read_soup(path);
  const collarmesh::Plc plc = collarmesh::build_plc(std::span(&soup, 1));
  const double begin = cpu_seconds();
  const collarmesh::Stopwatch stopwatch;
  collarmesh::MeshOptions options;
  options.size = size;
  options.threads = threads;
  const collarmesh::MeshResult result = collarmesh::generate(plc, options);
  const double seconds = cpu_seconds() - begin;
  const double wall = stopwatch.seconds();
  const auto tets = static_cast<double>(result.mesh.tets.size());
  std::printf(
      "complex %.3f s, refinement %.5f s, %.0f tets, %.0f tets/s, %.0f bytes/tet, %zu exact predicates, wall "
      "time %.5f s\n",
      begin, seconds, tets, tets / seconds, static_cast<double>(result.statistics.peak_bytes) / tets,
      result.statistics.exact_predicates, wall);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    std::fprintf(stderr, "usage: refine INPUT SIZE [THREADS]\n");
    return 2;
  }
  try {
    refine(argv[1], std::atof(argv[2]), argc == 4 ? static_cast<unsigned>(std::atoi(argv[3])) : 1);
  } catch (const collarmesh::Error& error) {
    std::fprintf(stderr, "refine: %s\n", error.what());
    return 3;
  }
  return 0;
}
