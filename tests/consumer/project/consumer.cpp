#include <collarmesh/error.h>
#include <collarmesh/io/soup_io.h>
#include <collarmesh/io/tet_mesh_io.h>
#include <collarmesh/pipeline.h>

#include <cstdio>
#include <string>

namespace {

// Checks that the library, which reads no CAD shapes, says which library does.
bool cad_is_told() {
  try {
    collarmesh::io::read_soup("part.STEP");
    return false;
  } catch (const collarmesh::ReadError& error) {
    return std::string(error.what()).find("mesh_files") != std::string::npos;
  }
}

}  // namespace

// consumer SURFACE MESH: meshes a file, certifies the result and writes it in every format.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  if (!cad_is_told()) return 3;
  const collarmesh::PolygonSoup soups[] = {collarmesh::io::read_soup(argv[1])};
  const collarmesh::SoupPipelineResult made = collarmesh::run_pipeline(soups);
  const collarmesh::TetMesh& mesh = made.result.mesh;
  collarmesh::io::write_tet_mesh(argv[2], mesh);
  for (const std::string& format : collarmesh::io::written_tet_mesh_formats())
    if (format != ".polymesh")  // except the format with fixed file names
      collarmesh::io::write_tet_mesh(argv[2] + format, mesh);
  std::printf("%zu tets, %zu findings\n", mesh.tets.size(), made.check.findings_total);
  return made.guarantees_hold() ? 0 : 1;
}
