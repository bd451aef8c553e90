// Meshes a planar domain by CGAL's Delaunay refinement (Ruppert's algorithm, with Shewchuk's changes), for
// planar_domains.py. Standard input: the number of points, and their coordinates; the number of segments,
// and the numbers of their points; the number of holes, and a point in each. Arguments: the required
// smallest angle in degrees, and the longest permitted edge (0: no limit). Prints the smallest and the
// largest angle in degrees, the number of triangles, and the seconds that the refinement took.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesh_size_criteria_2.h>
#include <CGAL/Delaunay_mesh_vertex_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Structure = CGAL::Triangulation_data_structure_2<CGAL::Delaunay_mesh_vertex_base_2<Kernel>,
                                                       CGAL::Delaunay_mesh_face_base_2<Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure>;
using Criteria = CGAL::Delaunay_mesh_size_criteria_2<Triangulation>;
using Point2 = Kernel::Point_2;

static double degrees(const Point2& p, const Point2& q, const Point2& r) {
  const auto u = q - p, v = r - p;
  return std::atan2(std::fabs(u.x() * v.y() - u.y() * v.x()), u * v) * 180 / M_PI;
}

int main(int, char** argv) {
  const double angle = std::atof(argv[1]), size = std::atof(argv[2]), sine = std::sin(angle * M_PI / 180);
  std::size_t count = 0;
  const auto read_points = [&] {
    std::cin >> count;
    std::vector<Point2> points(count);
    for (Point2& p : points) std::cin >> p;
    return points;
  };
  const std::vector<Point2> points = read_points();
  Triangulation domain;
  std::cin >> count;
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t a = 0, b = 0;
    std::cin >> a >> b;
    domain.insert_constraint(points[a], points[b]);
  }
  const std::vector<Point2> holes = read_points();
  const auto begin = std::chrono::steady_clock::now();
  CGAL::refine_Delaunay_mesh_2(domain, holes.begin(), holes.end(), Criteria(sine * sine, size));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  double least = 180, largest = 0;
  std::size_t triangles = 0;
  for (auto f = domain.finite_faces_begin(); f != domain.finite_faces_end(); ++f) {
    if (!f->is_in_domain()) continue;
    ++triangles;
    for (int i = 0; i < 3; ++i) {
      const double at =
          degrees(f->vertex(i)->point(), f->vertex((i + 1) % 3)->point(), f->vertex((i + 2) % 3)->point());
      least = std::min(least, at);
      largest = std::max(largest, at);
    }
  }
  std::printf("%.4f %.4f %zu %.4f\n", least, largest, triangles, seconds.count());
}
