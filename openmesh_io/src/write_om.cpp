#include "collarmesh/openmesh_io/write_om.h"

#include <fmt/format.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <fstream>

#include "collarmesh/error.h"
#include "double_mesh.h"

namespace collarmesh::openmesh_io {

namespace {

[[noreturn]] void fail(const std::string& path, const std::string& message) {
  throw WriteError(fmt::format("{}: {}", path, message));
}

void add_facet(const std::string& path, const PolygonSoup& soup, Index facet, DoubleMesh& mesh) {
  const auto [first, last] = soup.facet_polygons(facet);
  if (last - first != 1 || soup.polygon(first).size() < 3)
    fail(path,
         fmt::format("facet {} has holes or several polygons, which .om cannot hold; write a .poly", facet));
  std::vector<DoubleMesh::VertexHandle> corners;
  for (const Index corner : soup.polygon(first)) corners.emplace_back(static_cast<int>(corner));
  const Quiet quiet;
  if (mesh.add_face(corners).is_valid()) return;
  const Point& p = soup.points[soup.polygon(first)[0]];
  fail(path, fmt::format("facet {} at ({}, {}, {}) has an edge of more than two faces, neighbours that are "
                         "turned the other way, or a corner twice, which .om cannot hold; write an .off",
                         facet, p.x, p.y, p.z));
}

}  // namespace

void write_om(const std::string& path, const PolygonSoup& soup) {
  DoubleMesh mesh;
  for (const Point& p : soup.points) mesh.add_vertex({p.x, p.y, p.z});
  for (Index f = 0; f < soup.facet_count(); ++f) add_facet(path, soup, f, mesh);
  std::ofstream file(path, std::ios::binary);
  const Quiet quiet;
  if (!file || !OpenMesh::IO::write_mesh(mesh, file, ".om", OpenMesh::IO::Options::Binary) || !file.flush())
    fail(path, "cannot be written; is the disk full?");
}

}  // namespace collarmesh::openmesh_io
