#include <collarmesh/check.h>
#include <collarmesh/io/soup_io.h>
#include <collarmesh/io/tet_mesh_io.h>
#include <collarmesh/mesher.h>
#include <collarmesh/plc_builder.h>

#include <cstdio>
#include <string>

// consumer SURFACE MESH: mesh a file, certify the result and write it in every format.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const collarmesh::PolygonSoup soups[] = {collarmesh::io::read_soup(argv[1])};
  const collarmesh::Plc plc = collarmesh::build_plc(soups);
  const collarmesh::MeshResult result = collarmesh::generate(plc);
  const collarmesh::CheckReport report = collarmesh::check(result.mesh, plc);
  collarmesh::io::write_tet_mesh(argv[2], result.mesh);
  for (const std::string& format : collarmesh::io::written_tet_mesh_formats())
    collarmesh::io::write_tet_mesh(argv[2] + format, result.mesh);
  std::printf("%zu tets, %zu findings\n", result.mesh.tets.size(), report.findings_total);
  return result.status == collarmesh::MeshStatus::complete && report.passed() ? 0 : 1;
}
