#include "collarmesh/io/mesh_surface_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "common/disjoint_sets.h"
#include "io/file_format.h"
#include "io/tet_mesh_formats.h"

namespace collarmesh::io {

namespace {

struct MeshFormat {
  std::string_view extension;
  TetMesh (*read)(const std::string& path);
};

constexpr std::array mesh_formats{MeshFormat{".msh", read_msh_cells}, MeshFormat{".mesh", read_medit_cells},
                                  MeshFormat{".vtu", read_vtu_cells}, MeshFormat{".vtp", read_vtp_cells}};

/// Returns a point in each body, with the body's tag. A body consists of tets with one tag that are connected
/// by faces.
std::vector<PolygonSoup::RegionPoint> points_in_regions(const TetMesh& mesh) {
  if (mesh.tet_tag.size() != mesh.tets.size()) return {};
  std::vector<std::pair<std::array<Index, 3>, Index>> sides;  // sorted corners, and the tet
  sides.reserve(4 * mesh.tets.size());
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (unsigned i = 0; i < 4; ++i) {
      const auto& c = mesh.tets[t];
      sides.push_back({{c[(i + 1) % 4], c[(i + 2) % 4], c[(i + 3) % 4]}, t});
      std::sort(sides.back().first.begin(), sides.back().first.end());
    }
  std::sort(sides.begin(), sides.end());
  DisjointSets bodies(mesh.tets.size());
  for (std::size_t i = 1; i < sides.size(); ++i) {
    const Index s = sides[i - 1].second, t = sides[i].second;
    if (sides[i - 1].first == sides[i].first && mesh.tet_tag[s] == mesh.tet_tag[t]) bodies.unite(s, t);
  }
  std::map<Index, std::pair<double, Index>> largest;  // by body: its largest tet, after six times its volume
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const double volume =
        std::fabs(six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]));
    auto& best = largest.try_emplace(bodies.find(t), volume, t).first->second;
    if (volume > best.first) best = {volume, t};
  }
  std::vector<PolygonSoup::RegionPoint> points;
  for (const auto& [body, best] : largest) {
    if (mesh.tet_tag[best.second] == 0 || !(best.first > 0)) continue;
    Point centre{};
    for (const Index corner : mesh.tets[best.second]) centre = centre + 0.25 * mesh.points[corner];
    points.push_back({centre, mesh.tet_tag[best.second], 0});
  }
  return points;
}

}  // namespace

TetMesh read_mesh_cells(const std::string& path, std::string_view format) {
  const MeshFormat* found = find_format(mesh_formats, path, format);
  if (found == nullptr) throw ReadError(fmt::format("{}: is not a mesh file that can have triangles", path));
  return found->read(path);
}

PolygonSoup read_mesh_surface(const std::string& path, std::string_view format) {
  const TetMesh mesh = read_mesh_cells(path, format);
  if (mesh.faces.empty() && mesh.layers.quads.empty())
    throw ReadError(fmt::format("{}: expected triangles of a surface, found none", path));
  PolygonSoup soup;
  soup.name = path;
  std::vector<Index> number(mesh.points.size(), none);  // points of no face and no edge are left out
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
  for (std::size_t f = 0; f < mesh.layers.quads.size(); ++f) {
    const auto& [a, b, c, d] = mesh.layers.quads[f];
    soup.add_facet(std::array{point(a), point(b), point(c), point(d)}, mesh.layers.quad_tag[f]);
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    soup.segments.push_back({point(mesh.edges[e][0]), point(mesh.edges[e][1]), mesh.edge_tag[e]});
  soup.tag_names = mesh.names;
  soup.named_regions = points_in_regions(mesh);
  return soup;
}

bool is_mesh_surface_format(const std::string& path, std::string_view format) {
  return find_format(mesh_formats, path, format) != nullptr;
}

}  // namespace collarmesh::io
