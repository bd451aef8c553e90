// Measures how many seconds reading a surface file and building its complex take, and the peak memory:
//   surface_to_plc write RINGS FILE     write a sphere of 4 * RINGS^2 triangles
//   surface_to_plc read FILE            read a file into a complex, and print the measures
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <span>
#include <string_view>

#include "collarmesh/io/soup_io.h"
#include "collarmesh/plc_builder.h"
#include "common/stopwatch.h"
#include "shapes.h"

namespace {

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

void read(const char* path) {
  collarmesh::Stopwatch stopwatch;
  const collarmesh::PolygonSoup soup = collarmesh::io::read_soup(path);
  const double read = stopwatch.seconds(), read_processor = processor_seconds();
  stopwatch = collarmesh::Stopwatch();
  const collarmesh::Plc plc = collarmesh::build_plc(std::span(&soup, 1));
  std::printf("%u triangles, %zu regions: read %.2f s (CPU %.2f), complex %.2f s (CPU %.2f), peak %.0f MB\n",
              soup.facet_count(), plc.regions.size() - 1, read, read_processor, stopwatch.seconds(),
              processor_seconds() - read_processor, peak_megabytes());
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view command = argc > 1 ? argv[1] : "";
  if (command == "write" && argc == 4) {
    collarmesh::io::write_soup(
        argv[3],
        collarmesh::bench::sphere(static_cast<collarmesh::Index>(std::strtoul(argv[2], nullptr, 10))));
  } else if (command == "read" && argc == 3) {
    read(argv[2]);
  } else {
    std::fprintf(stderr, "usage: surface_to_plc write RINGS FILE | surface_to_plc read FILE\n");
    return 2;
  }
  return 0;
}
