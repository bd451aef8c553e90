// Wraps any surface with CGAL's Alpha_wrap_3 and meshes the wrap with CGAL's Mesh_3, as a peer of collarmesh
// in real_parts.py: wrap_mesh INPUT.off OUT.mesh
//
// The wrap closes gaps and holes that are narrower than about 1/50 of the input's diagonal, and lies 1/600 of
// the diagonal outside the input. The target edge length is 1/20 of the diagonal.
#include <CGAL/Bbox_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/File_medit.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Polyhedron = CGAL::Mesh_polyhedron_3<Kernel>::type;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex =
    CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

namespace {

struct Soup {
  std::vector<Point> points;
  std::vector<std::array<std::size_t, 3>> triangles;
};

// Reads polygons and cuts them into triangles. Returns an empty soup if the file cannot be read.
Soup read_triangles(const char* file) {
  Soup soup;
  std::vector<std::vector<std::size_t>> polygons;
  if (!CGAL::IO::read_polygon_soup(file, soup.points, polygons)) return {};
  for (const auto& polygon : polygons)
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
      soup.triangles.push_back({polygon[0], polygon[k], polygon[k + 1]});
  return soup;
}

double diagonal_of(const std::vector<Point>& points) {
  const CGAL::Bbox_3 box = CGAL::bbox_3(points.begin(), points.end());
  return std::hypot(box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin());
}

Complex mesh_wrap(const Polyhedron& wrap, double size) {
  Domain domain(wrap);
  namespace parameters = CGAL::parameters;
  // facet_size and cell_size bound circumradii. These bounds are somewhat larger than the circumradii of a
  // regular triangle and of a regular tetrahedron with edges of length `size`. No features are protected,
  // because the offset chamfers the edges of the wrap.
  const Criteria criteria(parameters::facet_angle = 25, parameters::facet_size = 0.7 * size,
                          parameters::facet_distance = size / 20, parameters::cell_radius_edge_ratio = 2,
                          parameters::cell_size = 0.79 * size);
  return CGAL::make_mesh_3<Complex>(domain, criteria, parameters::perturb(), parameters::exude());
}

struct Measures {
  double smallest_angle = 180, largest_angle = 0, volume = 0;
};

Measures measure(const Complex& complex) {
  Measures found;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    const auto tet = complex.triangulation().tetrahedron(cell);
    found.volume += tet.volume();
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) {
        const int k = (i + 1) % 4 == j ? (j + 1) % 4 : (i + 1) % 4, l = 6 - i - j - k;
        const double angle = std::abs(CGAL::approximate_dihedral_angle(tet[i], tet[j], tet[k], tet[l]));
        found.smallest_angle = std::min(found.smallest_angle, angle);
        found.largest_angle = std::max(found.largest_angle, angle);
      }
  }
  return found;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: wrap_mesh INPUT.off OUT.mesh\n";
    return 2;
  }
  const Soup soup = read_triangles(argv[1]);
  if (soup.triangles.empty()) {
    std::cerr << argv[1] << ": error: no triangles that CGAL reads\n";
    return 3;
  }
  const double diagonal = diagonal_of(soup.points);
  Polyhedron wrap;
  CGAL::alpha_wrap_3(soup.points, soup.triangles, diagonal / 50, diagonal / 600, wrap);
  const Complex complex = mesh_wrap(wrap, diagonal / 20);
  std::ofstream out(argv[2]);
  complex.output_to_medit(out);
  const Measures found = measure(complex);
  std::cout << complex.number_of_cells_in_complex() << " tets, dihedral angles " << found.smallest_angle
            << " to " << found.largest_angle << ", volume " << found.volume << '\n';
}
