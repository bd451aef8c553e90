#include "io/msh_periodic.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "common/face_finder.h"
#include "common/sorted.h"
#include "io/cell_nodes.h"

namespace collarmesh::io {

namespace {

bool contains(const std::vector<Tag>& tags, Tag tag) {
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

/// The links of one pair of groups of periodic faces.
class PairLinks {
 public:
  PairLinks(const TetMesh& mesh, const MshEntities& entities, const TetMesh::PeriodicFaces& pair)
      : mesh_(mesh), entities_(entities), pair_(pair) {
    for (const auto& [node, image] : pair.nodes) image_of_.emplace(node, image);
  }

  /// Finds the links of each dimension.
  std::array<std::vector<MshLink>, 3> find() {
    find_surfaces();
    find_curves();
    find_points();
    std::array<std::vector<MshLink>, 3> all;
    for (const auto& [key, nodes] : nodes_) {
      const auto& [dimension, entity, master] = key;
      MshLink link{dimension, number(dimension, entity), number(dimension, master), pair_.motion, {}};
      for (const auto& [node, image] : nodes) link.nodes.push_back({image, node});
      all[dimension].push_back(std::move(link));
    }
    return all;
  }

 private:
  int number(std::size_t dimension, Index entity) const {
    return entities_.of_dimension[dimension][entity].number;
  }
  Index image_of(Index node) const {
    const auto found = image_of_.find(node);
    return found == image_of_.end() ? none : found->second;
  }

  void add(std::size_t dimension, Index entity, Index master, const CellNodes& nodes) {
    if (entity == master) return;  // it lies on the axis of rotation
    auto& listed = nodes_[{dimension, entity, master}];
    for (const Index node : nodes)
      if (image_of(node) != none) listed.emplace(node, image_of(node));
  }

  void find_surfaces() {
    FaceFinder finder(mesh_.faces);
    const std::vector<Index>& surfaces = entities_.of_cell[CellKind::triangle];
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (!contains(pair_.first, mesh_.face_tag[f])) continue;
      const auto& [a, b, c] = mesh_.faces[f];
      for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
        sides_.insert(sorted(p, q));
      const Index g = finder.find({image_of(a), image_of(b), image_of(c)});
      if (g != none) add(2, surfaces[g], surfaces[f], nodes_of_face(mesh_, f));
    }
  }

  void find_curves() {
    std::map<std::array<Index, 2>, Index> edges;
    const std::vector<Index>& curves = entities_.of_cell[CellKind::edge];
    for (Index e = 0; e < mesh_.edges.size(); ++e)
      edges.emplace(sorted(mesh_.edges[e][0], mesh_.edges[e][1]), e);
    for (Index e = 0; e < mesh_.edges.size(); ++e) {
      const auto& [a, b] = mesh_.edges[e];
      if (!sides_.contains(sorted(a, b))) continue;
      const auto found = edges.find(sorted(image_of(a), image_of(b)));
      if (found != edges.end()) add(1, curves[found->second], curves[e], nodes_of_edge(mesh_, e));
    }
  }

  void find_points() {
    for (const auto& [node, image] : pair_.nodes) {
      const MshEntities::Place &place = entities_.of_point[node], &other = entities_.of_point[image];
      if (place.dimension != 0 || other.dimension != 0) continue;
      CellNodes single;
      single.add(node);
      add(0, other.entity, place.entity, single);
    }
  }

  const TetMesh& mesh_;
  const MshEntities& entities_;
  const TetMesh::PeriodicFaces& pair_;
  std::unordered_map<Index, Index> image_of_;
  std::set<std::array<Index, 2>> sides_;  // sides of triangles of the first group
  // The nodes of links, each with its image; by dimension, entity and master of the link.
  std::map<std::tuple<std::size_t, Index, Index>, std::map<Index, Index>> nodes_;
};

/// The master of each entity that has one so far.
class Masters {
 public:
  /// Adds a link, unless its entity has a master already or the masters would form a cycle. Returns whether
  /// it was added.
  bool add(const MshLink& link) {
    std::map<int, int>& masters = of_[link.dimension];
    for (int at = link.master;;) {
      if (at == link.entity) return false;
      const auto next = masters.find(at);
      if (next == masters.end()) break;
      at = next->second;
    }
    return masters.emplace(link.entity, link.master).second;
  }

 private:
  std::array<std::map<int, int>, 3> of_;
};

}  // namespace

std::vector<MshLink> find_msh_links(const TetMesh& mesh, const MshEntities& entities) {
  std::array<std::vector<MshLink>, 3> found;
  Masters masters;
  for (const TetMesh::PeriodicFaces& pair : mesh.periodic) {
    std::array<std::vector<MshLink>, 3> of_pair = PairLinks(mesh, entities, pair).find();
    for (std::size_t d = 0; d < 3; ++d)
      for (MshLink& link : of_pair[d])
        if (masters.add(link)) found[d].push_back(std::move(link));
  }
  std::vector<MshLink> links;
  for (std::vector<MshLink>& of_dimension : found)
    std::move(of_dimension.begin(), of_dimension.end(), std::back_inserter(links));
  return links;
}

void write_msh_links(FileWriter& out, const std::vector<MshLink>& links, int version) {
  if (links.empty()) return;
  out << "$Periodic\n" << links.size() << '\n';
  for (const MshLink& link : links) {
    out << link.dimension << ' ' << link.entity << ' ' << link.master << '\n';
    out << (version < 4 ? "Affine" : "16");
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) out << ' ' << link.motion.rows[row][column];
      out << ' ' << link.motion.shift[row];
    }
    out << " 0 0 0 1\n" << link.nodes.size() << '\n';
    for (const auto& [node, master] : link.nodes)
      out << std::size_t{node} + 1 << ' ' << std::size_t{master} + 1 << '\n';
  }
  out << "$EndPeriodic\n";
}

}  // namespace collarmesh::io
