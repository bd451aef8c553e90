#include "files/cell_decomposition.h"

#include <string_view>

#include "io/file_writer.h"

namespace collarmesh::files {

// Writes the format described in OpenFOAM's user guide, "Basic input/output file format" and "Decomposition
// of mesh and initial field data".
void write_cell_decomposition(const std::string& path, const TetMesh& mesh) {
  io::FileWriter out(path);
  out << std::string_view(
             "FoamFile\n{\n    version 2.0;\n    format ascii;\n    class labelList;\n    location "
             "\"constant\";\n    object cellDecomposition;\n}\n")
      << mesh.tet_partition.size() << "\n(\n";
  for (const Index partition : mesh.tet_partition) out << partition << '\n';
  out << ")\n";
  out.commit();
}

}  // namespace collarmesh::files
