#include "collarmesh/openmesh_io/read_om.h"

#include <fmt/format.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <sstream>

#include "collarmesh/error.h"
#include "double_mesh.h"
#include "om_layout.h"

namespace collarmesh::openmesh_io {

namespace {

using Mesh = DoubleMesh;

[[noreturn]] void fail(const std::string& path, const std::string& message) {
  throw ReadError(fmt::format("{}: {}", path, message));
}

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) fail(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  return bytes;
}

Mesh load(const std::string& path, const OmLayout& layout) {
  const Quiet quiet;
  Mesh mesh;
  mesh.request_face_status();
  OpenMesh::IO::Options options(OpenMesh::IO::Options::Binary);
  options += OpenMesh::IO::Options::Status;
  std::istringstream stream(layout.safe_bytes, std::ios::binary);
  bool read = false;
  try {
    read = OpenMesh::IO::read_mesh(mesh, stream, ".om", options);
  } catch (const std::exception& error) {
    fail(path, fmt::format("OpenMesh cannot read it: {}", error.what()));
  }
  if (!read) fail(path, "OpenMesh cannot read it");
  if (mesh.n_vertices() != layout.vertices || mesh.n_faces() != layout.faces)
    fail(path,
         fmt::format("byte 4: expected {} vertices and {} faces, but OpenMesh has read {} and {} (an edge of "
                     "more than two faces?); save the surface as .off",
                     layout.vertices, layout.faces, mesh.n_vertices(), mesh.n_faces()));
  return mesh;
}

void add_points(const std::string& path, const Mesh& mesh, PolygonSoup& soup) {
  soup.points.reserve(mesh.n_vertices());
  for (const auto vertex : mesh.all_vertices()) {
    const Mesh::Point& p = mesh.point(vertex);
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
      fail(path, fmt::format("vertex {}, ({}, {}, {}), is not finite", vertex.idx(), p[0], p[1], p[2]));
    soup.points.push_back({p[0], p[1], p[2]});
  }
}

/// Returns the corners of a face. Fails if the face's halfedges form no cycle, as in a damaged file.
std::vector<Index> corners_of(const std::string& path, const Mesh& mesh, OpenMesh::FaceHandle face) {
  std::vector<Index> corners;
  const OpenMesh::HalfedgeHandle first = mesh.halfedge_handle(face);
  OpenMesh::HalfedgeHandle at = first;
  do {
    if (!at.is_valid() || mesh.face_handle(at) != face || corners.size() > mesh.n_halfedges())
      fail(path, fmt::format("the halfedges of face {} form no cycle; the file is damaged", face.idx()));
    corners.push_back(static_cast<Index>(mesh.to_vertex_handle(at).idx()));
    at = mesh.next_halfedge_handle(at);
  } while (at != first);
  if (corners.size() < 3) fail(path, fmt::format("face {} has {} corners", face.idx(), corners.size()));
  return corners;
}

}  // namespace

PolygonSoup read_om(const std::string& path) {
  const Mesh mesh = load(path, check_om_layout(path, read_bytes(path)));
  PolygonSoup soup;
  soup.name = path;
  add_points(path, mesh, soup);
  for (const auto face : mesh.all_faces())
    if (!mesh.status(face).deleted()) soup.add_facet(corners_of(path, mesh, face));
  return soup;
}

}  // namespace collarmesh::openmesh_io
