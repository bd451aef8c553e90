#include "collarmesh/io/mesh_surface_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "collarmesh/error.h"
#include "io/file_bytes.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

namespace {

struct Format {
  std::string_view extension;
  TetMesh (*read)(const std::string& path);
};

constexpr std::array formats{Format{".msh", read_msh_cells}, Format{".mesh", read_medit_cells},
                             Format{".vtu", read_vtu_cells}, Format{".vtp", read_vtp_cells}};

const Format* find_format(const std::string& path, std::string_view format) {
  const std::string extension = format.empty() ? lower_extension(path) : std::string(format);
  for (const Format& known : formats)
    if (known.extension == extension) return &known;
  return nullptr;
}

}  // namespace

PolygonSoup read_mesh_surface(const std::string& path, std::string_view format) {
  const Format* found = find_format(path, format);
  if (found == nullptr) throw ReadError(fmt::format("{}: is no file of a mesh with triangles", path));
  const TetMesh mesh = found->read(path);
  if (mesh.faces.empty())
    throw ReadError(fmt::format("{}: expected triangles of a surface, found none", path));
  PolygonSoup soup;
  soup.name = path;
  std::vector<Index> number(mesh.points.size(), none);  // points of tets alone are left out
  const auto point = [&](Index p) {
    if (number[p] == none) {
      number[p] = static_cast<Index>(soup.points.size());
      soup.points.push_back(mesh.points[p]);
    }
    return number[p];
  };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    soup.add_facet(std::array{point(a), point(b), point(c)}, mesh.face_tag[f]);
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    soup.segments.push_back({point(mesh.edges[e][0]), point(mesh.edges[e][1]), mesh.edge_tag[e]});
  soup.tag_names = mesh.names;
  return soup;
}

bool is_mesh_surface_format(const std::string& path, std::string_view format) {
  return find_format(path, format) != nullptr;
}

std::vector<std::string> mesh_surface_formats() {
  std::vector<std::string> result;
  result.reserve(formats.size());
  for (const Format& format : formats) result.emplace_back(format.extension);
  return result;
}

}  // namespace collarmesh::io
