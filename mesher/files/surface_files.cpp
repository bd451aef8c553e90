#include "files/surface_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "collarmesh/error.h"
#include "collarmesh/io/mesh_surface_io.h"
#include "collarmesh/io/soup_io.h"
#include "files/cad_files.h"
#include "files/om_files.h"

namespace collarmesh::files {

bool is_surface_format(const std::string& path, std::string_view format) {
  return is_om(path, format) || io::is_soup_format(path, format);
}

std::vector<std::string> surface_formats() {
  std::vector<std::string> formats = io::soup_formats();
  if (is_om("", ".om")) formats.emplace_back(".om");
  return formats;
}

PolygonSoup read_surface(const std::string& path, std::string_view format) {
  if (is_om(path, format)) return read_om(path);
  if (io::is_mesh_surface_format(path, format)) return io::read_mesh_surface(path, format);
  if (!io::is_soup_format(path, format))
    throw ReadError(fmt::format("{}: no surface can be read from a file with the extension '{}'; use {}{}{}",
                                path, std::filesystem::path(path).extension().string(),
                                fmt::join(surface_formats(), " "), CadFiles::formats().empty() ? "" : " ",
                                fmt::join(CadFiles::formats(), " ")));
  return io::read_soup(path, format);
}

void write_surface(const std::string& path, const PolygonSoup& soup, std::string_view format) {
  if (is_om(path, format)) {
    write_om(path, soup);
    return;
  }
  io::write_soup(path, soup, format);
}

PolygonSoup surface_of(const TetMesh& mesh, const std::string& name) {
  PolygonSoup soup;
  soup.name = name;
  soup.points = mesh.points;
  const LayerCells& layers = mesh.layers;
  const std::size_t triangles = mesh.faces.size();
  const auto tag = [&](std::size_t f) {
    return f < triangles ? mesh.face_tag[f] : layers.quad_tag[f - triangles];
  };
  std::vector<std::size_t> order(triangles + layers.quads.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return tag(a) < tag(b); });
  for (const std::size_t f : order)
    if (f < triangles)
      soup.add_facet(mesh.faces[f], tag(f));
    else
      soup.add_facet(layers.quads[f - triangles], tag(f));
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    soup.segments.push_back({mesh.edges[e][0], mesh.edges[e][1], mesh.edge_tag[e]});
  soup.tag_names = mesh.names;
  if (mesh.faces.empty())
    throw ReadError(fmt::format("{}: the mesh has no boundary triangles that could become a surface", name));
  return soup;
}

}  // namespace collarmesh::files
