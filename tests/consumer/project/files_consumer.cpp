#include <collarmesh/error.h>
#include <collarmesh/io/tet_mesh_io.h>
#include <collarmesh/mesh_files.h>

#include <cmath>
#include <cstdio>
#include <string>

// files_consumer MODEL MESH: meshes a file of any format, certifies the result and writes it. A missing file
// must raise an error that names it.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    collarmesh::mesh_files({"missing.step"});
    return 3;
  } catch (const collarmesh::ReadError& error) {
    if (std::string(error.what()).find("missing.step") == std::string::npos) return 4;
  }
  try {
    collarmesh::RunOptions options;
    options.order = 2;
    const collarmesh::FilesResult made = collarmesh::mesh_files({argv[1]}, options);
    collarmesh::io::write_tet_mesh(argv[2], made.result.mesh);
    std::printf("%zu tets, %zu notes\n", made.result.mesh.tets.size(), made.notes.size());
    // Nodes lie on the exact shape: a mesh on the triangles would have a volume farther from the exact one.
    const double volume = made.check.of_mesh.volumes.at(1), exact = made.check.of_input.volumes.at(1);
    if (!(std::fabs(volume / exact - 1) < 1e-3)) return 5;
    return made.guarantees_hold() && made.result.mesh.order() == 2 ? 0 : 1;
  } catch (const collarmesh::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 6;
  }
}
