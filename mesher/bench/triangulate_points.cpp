// Measures the CPU time that CGAL takes for the Delaunay triangulation of a mesh's vertices. Refinement,
// which also has to find these vertices, is compared with this time.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cstdio>
#include <ctime>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/io/tet_mesh_io.h"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::vector<Kernel::Point_3> read_points(const char* path) {
  const collarmesh::TetMesh mesh = collarmesh::io::read_tet_mesh(path);
  std::vector<Kernel::Point_3> points;
  points.reserve(mesh.points.size());
  for (const collarmesh::Point& p : mesh.points) points.emplace_back(p.x, p.y, p.z);
  return points;
}

void triangulate(const std::vector<Kernel::Point_3>& points) {
  const double begin = cpu_seconds();
  // The constructor first sorts the points along a space-filling curve.
  const CGAL::Delaunay_triangulation_3<Kernel> triangulation(points.begin(), points.end());
  const double seconds = cpu_seconds() - begin;
  std::printf("%zu points, %zu finite cells, %.6f s\n", points.size(),
              static_cast<std::size_t>(triangulation.number_of_finite_cells()), seconds);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: triangulate_points MESH (.vtu, .msh or .mesh)\n");
    return 2;
  }
  try {
    triangulate(read_points(argv[1]));
  } catch (const collarmesh::Error& error) {
    std::fprintf(stderr, "triangulate_points: %s\n", error.what());
    return 3;
  }
  return 0;
}
