// Writes the sample mesh in the format of each name given, for programs of others to read:
//   write_sample_mesh N OUT...
// and prints what they have to find in it.
#include <cstdlib>
#include <iostream>

#include "collarmesh/io/tet_mesh_io.h"
#include "support/sample_mesh.h"

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: write_sample_mesh N OUT...\n";
    return 2;
  }
  const collarmesh::TetMesh mesh =
      collarmesh::testing::sample_mesh(static_cast<collarmesh::Index>(std::strtoul(argv[1], nullptr, 10)));
  for (int i = 2; i < argc; ++i) collarmesh::io::write_tet_mesh(argv[i], mesh);
  std::cout << mesh.points.size() << ' ' << mesh.tets.size() << ' ' << mesh.faces.size() << ' '
            << mesh.edges.size() << '\n';
  return 0;
}
