#include "report/mesh_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/label_names.h"
#include "io/node_groups.h"
#include "report/listed.h"

namespace collarmesh::report {

namespace {

class Groups {
 public:
  Groups(const TetMesh& mesh, std::size_t dimension) : mesh_(mesh), dimension_(dimension) {}

  void add(Tag tag, double measure, const Point& centre, bool quad = false) {
    MeshGroup& group = groups_[tag];
    double& largest = largest_[tag];
    if (group.cells + group.quads == 0 || measure > largest) {
      largest = measure;
      group.where = centre;
    }
    ++(quad ? group.quads : group.cells);
    group.measure += measure;
  }

  std::vector<MeshGroup> take() {
    std::vector<MeshGroup> all;
    for (auto& [tag, group] : groups_) {
      group.tag = tag;
      group.name = name_of(mesh_.names, mesh_.group_names, dimension_, tag);
      all.push_back(std::move(group));
    }
    return all;
  }

 private:
  const TetMesh& mesh_;
  std::size_t dimension_;
  std::map<Tag, MeshGroup> groups_;
  std::map<Tag, double> largest_;
};

void append(std::string& text, const std::vector<MeshGroup>& groups, const char* kind, const char* plural,
            const char* cells, const char* measure) {
  for (std::size_t k = 0; k < std::min(groups.size(), listed); ++k) {
    const MeshGroup& g = groups[k];
    text += fmt::format("  {} {}{}: {} {},{} {} {:.6g}, at ({:.6g}, {:.6g}, {:.6g})\n", kind, g.tag,
                        g.name.empty() ? "" : fmt::format(" ({})", g.name), g.cells, cells,
                        g.quads > 0 ? fmt::format(" {} quadrangles,", g.quads) : "", measure, g.measure,
                        g.where.x, g.where.y, g.where.z);
  }
  if (groups.size() > listed)
    text += fmt::format("  ... and {} more {} (--json lists all)\n", groups.size() - listed, plural);
}

}  // namespace

std::vector<MeshGroup> patches_of(const TetMesh& mesh) {
  Groups groups(mesh, 2);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Point &a = mesh.points[mesh.faces[f][0]], &b = mesh.points[mesh.faces[f][1]],
                &c = mesh.points[mesh.faces[f][2]];
    groups.add(mesh.face_tag[f], 0.5 * norm(cross(b - a, c - a)), (a + b + c) / 3);
  }
  const LayerCells& layers = mesh.layers;
  for (std::size_t q = 0; q < layers.quads.size(); ++q) {
    const auto& [a, b, c, d] = layers.quads[q];
    const auto& p = mesh.points;
    const double area = 0.5 * (norm(cross(p[b] - p[a], p[c] - p[a])) + norm(cross(p[c] - p[a], p[d] - p[a])));
    groups.add(layers.quad_tag[q], area, 0.25 * (p[a] + p[b] + p[c] + p[d]), true);
  }
  return groups.take();
}

std::vector<MeshGroup> curves_of(const TetMesh& mesh) {
  Groups groups(mesh, 1);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    const Point &a = mesh.points[mesh.edges[e][0]], &b = mesh.points[mesh.edges[e][1]];
    groups.add(mesh.edge_tag[e], distance(a, b), 0.5 * (a + b));
  }
  return groups.take();
}

std::string name_of(const TagNames& given, GroupNames names, std::size_t dimension, Tag tag) {
  if (const std::string* name = given.find(dimension, tag)) return *name;
  return names == GroupNames::cad ? group_name(names, dimension, tag) : std::string();
}

std::map<Index, std::string> names_of_regions(const TetMesh& mesh) {
  std::map<Index, std::string> names;
  for (const auto& [region, tag] : io::tags_of_regions(mesh))
    if (std::string name = name_of(mesh.names, mesh.group_names, 3, tag); !name.empty())
      names.emplace(region, std::move(name));
  return names;
}

std::string groups_text(const TetMesh& mesh) {
  std::string text;
  append(text, patches_of(mesh), "patch", "patches", "triangles", "area");
  append(text, curves_of(mesh), "curve", "curves", "edges", "length");
  return text;
}

using Json = nlohmann::ordered_json;

Json groups_json(const std::vector<MeshGroup>& groups, const char* cells, const char* measure) {
  Json list = Json::array();
  for (const MeshGroup& g : groups) {
    list.push_back({{"tag", g.tag},
                    {"name", g.name.empty() ? Json(nullptr) : Json(g.name)},
                    {cells, g.cells},
                    {measure, g.measure},
                    {"where", {g.where.x, g.where.y, g.where.z}}});
    if (g.quads > 0) list.back()["quads"] = g.quads;
  }
  return list;
}

}  // namespace collarmesh::report
