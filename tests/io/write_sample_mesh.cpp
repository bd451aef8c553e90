// Writes the sample mesh in the format of each name given, for programs of others to read:
//   write_sample_mesh N ORDER OUT...
//   write_sample_mesh layers ORDER OUT...     a mesh of prisms, pyramids and tets
//   write_sample_mesh prisms ORDER OUT...     a mesh of prisms and tets
// and prints what they have to find in it. Surface formats get its boundary and interface.
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "collarmesh/io/soup_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "support/layer_mesh.h"
#include "support/sample_mesh.h"
#include "support/second_order.h"

using collarmesh::Index;

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "usage: write_sample_mesh N ORDER OUT...\n";
    return 2;
  }
  const std::string_view kind = argv[1];
  const bool layers = kind == "layers" || kind == "prisms";
  collarmesh::TetMesh mesh =
      kind == "layers" ? collarmesh::testing::layer_mesh()
      : kind == "prisms"
          ? collarmesh::testing::mesh_of_prisms()
          : collarmesh::testing::sample_mesh(static_cast<Index>(std::strtoul(argv[1], nullptr, 10)));
  if (argv[2][0] == '2') mesh = collarmesh::testing::second_order(mesh);
  collarmesh::PolygonSoup surface;
  surface.points = mesh.points;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) surface.add_facet(mesh.faces[f], mesh.face_tag[f]);
  for (std::size_t t = mesh.tets.size(); t-- > 0;)
    if (surface.region_points.empty() || surface.region_points[0].tag != mesh.tet_tag[t]) {
      const auto& [a, b, c, d] = mesh.tets[t];
      surface.region_points.push_back(
          {0.25 * (mesh.points[a] + mesh.points[b] + mesh.points[c] + mesh.points[d]), mesh.tet_tag[t]});
      if (surface.region_points.size() == 2) break;
    }
  for (int i = 3; i < argc; ++i)
    if (collarmesh::io::is_soup_format(argv[i]))
      collarmesh::io::write_soup(argv[i], surface);
    else
      collarmesh::io::write_tet_mesh(argv[i], mesh);
  std::cout << mesh.points.size() << ' ' << mesh.tets.size() << ' ' << mesh.faces.size() << ' '
            << mesh.edges.size();
  if (layers)
    std::cout << ' ' << mesh.layers.prisms.size() << ' ' << mesh.layers.pyramids.size() << ' '
              << mesh.layers.quads.size();
  std::cout << '\n';
  return 0;
}
