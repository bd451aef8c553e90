// Meshes the solid inside a surface by CGAL's Mesh_3, which then perturbs and exudes slivers, for comparison
// with our improvement: cgal_mesh INPUT.off SIZE DISTANCE OUT.mesh
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/File_medit.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/make_mesh_3.h>

#include <cstdlib>
#include <fstream>
#include <iostream>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Mesh_polyhedron_3<Kernel>::type;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex =
    CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: cgal_mesh INPUT.off SIZE DISTANCE OUT.mesh\n";
    return 2;
  }
  Polyhedron polyhedron;
  std::ifstream in(argv[1]);
  if (!(in >> polyhedron)) {
    std::cerr << argv[1] << ": no closed surface that CGAL reads\n";
    return 3;
  }
  Domain domain(polyhedron);
  domain.detect_features(30);
  const double size = std::strtod(argv[2], nullptr), distance = std::strtod(argv[3], nullptr);
  namespace parameters = CGAL::parameters;
  // facet_size and cell_size bound circumradii. These bounds are somewhat larger than the circumradii of a
  // regular triangle and of a regular tetrahedron with edges of length `size`.
  const Criteria criteria(parameters::edge_size = size, parameters::facet_angle = 25,
                          parameters::facet_size = 0.7 * size, parameters::facet_distance = distance,
                          parameters::cell_radius_edge_ratio = 2, parameters::cell_size = 0.79 * size);
  const Complex complex =
      CGAL::make_mesh_3<Complex>(domain, criteria, parameters::perturb(), parameters::exude());
  std::ofstream out(argv[4]);
  complex.output_to_medit(out);
  std::cout << complex.number_of_cells_in_complex() << " tets\n";
}
