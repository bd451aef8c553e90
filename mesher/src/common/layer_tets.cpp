// Cuts prisms and pyramids into tets: J. Dompierre, P. Labbé, M.-G. Vallet and R. Camarero, "How to subdivide
// pyramids, prisms and hexahedra into tetrahedra", 8th International Meshing Roundtable, 1999.
#include "common/layer_tets.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <utility>

#include "collarmesh/error.h"
#include "common/cell_shapes.h"
#include "common/sorted.h"

namespace collarmesh {

namespace {

using Quadrangle = std::array<Index, 4>;

/// The mid-edge nodes by their edge. Nodes of diagonals are made on demand.
class MidNodes {
 public:
  explicit MidNodes(TetMesh& mesh) : mesh_(mesh) {}

  template <class Cell, class Nodes>
  void add(CellKind kind, const Cell& cell, const Nodes& nodes) {
    const CellShape shape = shape_of(kind);
    for (std::size_t e = 0; e < shape.edges.size(); ++e)
      nodes_.emplace(key(cell[shape.edges[e][0]], cell[shape.edges[e][1]]), nodes[e]);
  }
  Index find(Index a, Index b) const { return nodes_.at(key(a, b)); }

  /// Makes the node of the diagonal from the first to the third corner, unless there is one.
  void add_diagonal(const Quadrangle& q) {
    if (nodes_.contains(key(q[0], q[2]))) return;
    Point middle{};
    for (std::size_t k = 0; k < 4; ++k) {
      const Point& mid = mesh_.points[find(q[k], q[(k + 1) % 4])];
      middle = middle + 0.5 * mid - 0.25 * mesh_.points[q[k]];
    }
    nodes_.emplace(key(q[0], q[2]), static_cast<Index>(mesh_.points.size()));
    mesh_.points.push_back(middle);
    if (!mesh_.features.empty()) mesh_.features.push_back({});
  }
  /// Records that the node of a listed quadrangle's diagonal lies on the quadrangle's patch.
  void place_diagonal(const Quadrangle& q, Index patch) {
    if (!mesh_.features.empty()) mesh_.features[find(q[0], q[2])] = {2, patch};
  }

 private:
  static std::pair<Index, Index> key(Index a, Index b) { return std::minmax(a, b); }

  TetMesh& mesh_;
  std::map<std::pair<Index, Index>, Index> nodes_;
};

/// Turns a quadrangle so that its smallest corner comes first.
Quadrangle turned(Quadrangle q) {
  std::rotate(q.begin(), std::ranges::min_element(q), q.end());
  return q;
}

/// Turns a prism so that its smallest corner comes first; its volume keeps its sign.
std::array<Index, 6> turned(const std::array<Index, 6>& prism) {
  constexpr std::array<std::array<std::uint8_t, 6>, 6> turns{{{0, 1, 2, 3, 4, 5},
                                                              {1, 2, 0, 4, 5, 3},
                                                              {2, 0, 1, 5, 3, 4},
                                                              {3, 5, 4, 0, 2, 1},
                                                              {4, 3, 5, 1, 0, 2},
                                                              {5, 4, 3, 2, 1, 0}}};
  const auto first = static_cast<std::size_t>(std::ranges::min_element(prism) - prism.begin());
  std::array<Index, 6> result{};
  for (std::size_t k = 0; k < 6; ++k) result[k] = prism[turns[first][k]];
  return result;
}

std::array<std::array<Index, 4>, 3> tets_of_prism(const std::array<Index, 6>& prism) {
  const auto& [a, b, c, d, e, f] = turned(prism);
  if (std::min(b, f) < std::min(c, e)) return {{{a, b, c, f}, {a, b, f, e}, {a, e, f, d}}};
  return {{{a, b, c, e}, {a, e, c, f}, {a, e, f, d}}};
}

class Cutter {
 public:
  explicit Cutter(const TetMesh& mesh) : mesh_(mesh), layers_(mesh.layers), result_(mesh), nodes_(result_) {
    result_.layers = {};
    result_.layers.tet_layer = layers_.tet_layer;
    result_.layers.tet_layer.resize(mesh.tets.size(), 0);
  }

  TetMesh cut() {
    if (mesh_.order() == 2) find_nodes();
    for (std::size_t i = 0; i < layers_.prisms.size(); ++i)
      for (const auto& tet : tets_of_prism(layers_.prisms[i]))
        add_tet(tet, layers_.prism_region[i], layers_.prism_tag[i], layers_.prism_layer[i]);
    for (std::size_t i = 0; i < layers_.pyramids.size(); ++i) {
      const auto& p = layers_.pyramids[i];
      const auto& [a, b, c, d] = turned(Quadrangle{p[0], p[1], p[2], p[3]});
      for (const std::array<Index, 4>& tet : {std::array{a, b, c, p[4]}, std::array{a, c, d, p[4]}})
        add_tet(tet, layers_.pyramid_region[i], layers_.pyramid_tag[i], layers_.pyramid_layer[i]);
    }
    for (std::size_t i = 0; i < layers_.quads.size(); ++i) add_triangles(i);
    return std::move(result_);
  }

 private:
  void find_nodes() {
    for (std::size_t i = 0; i < mesh_.tets.size(); ++i)
      nodes_.add(CellKind::tet, mesh_.tets[i], mesh_.tet_mid_nodes[i]);
    for (std::size_t i = 0; i < layers_.prisms.size(); ++i)
      nodes_.add(CellKind::prism, layers_.prisms[i], layers_.prism_mid_nodes[i]);
    for (std::size_t i = 0; i < layers_.pyramids.size(); ++i)
      nodes_.add(CellKind::pyramid, layers_.pyramids[i], layers_.pyramid_mid_nodes[i]);
    for (const auto& prism : layers_.prisms) add_diagonals(CellKind::prism, prism);
    for (const auto& pyramid : layers_.pyramids) add_diagonals(CellKind::pyramid, pyramid);
  }

  template <class Cell>
  void add_diagonals(CellKind kind, const Cell& cell) {
    for (const auto& [corners, places] : shape_of(kind).sides)
      if (corners == 4)
        nodes_.add_diagonal(
            turned(Quadrangle{cell[places[0]], cell[places[1]], cell[places[2]], cell[places[3]]}));
  }

  void add_tet(const std::array<Index, 4>& tet, Index region, Tag tag, std::uint16_t layer) {
    const auto& [a, b, c, d] = tet;
    result_.tets.push_back(tet);
    result_.tet_region.push_back(region);
    result_.tet_tag.push_back(tag);
    result_.tet_collar.push_back(0);
    result_.tet_crease.push_back(0);
    if (!mesh_.tet_thin.empty()) result_.tet_thin.push_back(0);
    result_.layers.tet_layer.push_back(std::max<std::uint16_t>(layer, 1));
    if (mesh_.order() == 2)
      result_.tet_mid_nodes.push_back({nodes_.find(a, b), nodes_.find(b, c), nodes_.find(c, a),
                                       nodes_.find(a, d), nodes_.find(b, d), nodes_.find(c, d)});
  }

  void add_triangles(std::size_t quad) {
    const Quadrangle corners = turned(layers_.quads[quad]);
    const auto& [a, b, c, d] = corners;
    for (const std::array<Index, 3>& face : {std::array{a, b, c}, std::array{a, c, d}}) {
      result_.faces.push_back(face);
      result_.face_regions.push_back(layers_.quad_regions[quad]);
      result_.face_patch.push_back(layers_.quad_patch[quad]);
      result_.face_tag.push_back(layers_.quad_tag[quad]);
      if (mesh_.order() == 2)
        result_.face_mid_nodes.push_back(
            {nodes_.find(face[0], face[1]), nodes_.find(face[1], face[2]), nodes_.find(face[2], face[0])});
    }
    if (mesh_.order() == 2) nodes_.place_diagonal(corners, layers_.quad_patch[quad]);
  }

  const TetMesh& mesh_;
  const LayerCells& layers_;
  TetMesh result_;
  MidNodes nodes_;
};

}  // namespace

void require_tets_alone(const TetMesh& mesh, std::string_view what) {
  if (mesh.layers.prisms.empty() && mesh.layers.pyramids.empty()) return;
  throw OptionError(
      fmt::format("{}: the mesh has {} prisms and {} pyramids, for which this is not supported; make layers "
                  "of tetrahedra",
                  what, mesh.layers.prisms.size(), mesh.layers.pyramids.size()));
}

TetMesh tets_of_layers(const TetMesh& mesh) {
  assert(mesh.layers.prisms.size() == mesh.layers.prism_region.size() &&
         mesh.layers.pyramids.size() == mesh.layers.pyramid_region.size());
  return Cutter(mesh).cut();
}

namespace {

/// A search for the wall's point below each point of the layers.
class WallSearch {
 public:
  explicit WallSearch(const TetMesh& mesh) : mesh_(mesh), below_(mesh.points.size(), none) {}

  std::vector<Index> run() {
    for (const auto& prism : mesh_.layers.prisms)
      for (std::size_t k = 0; k < 3; ++k) rise(prism[k], prism[k + 3]);
    for (const auto& pyramid : mesh_.layers.pyramids) {
      rise(pyramid[0], pyramid[3]);
      rise(pyramid[1], pyramid[2]);
    }
    for_each_tet([this](const auto& tet) { rise(tet[0], tet[3]); });
    follow_down();
    keep_those_on_listed_faces();
    return std::move(walls_);
  }

 private:
  void rise(Index from, Index to) { below_[to] = from; }

  template <class Visit>
  void for_each_tet(const Visit& visit) const {
    for (std::size_t t = 0; t < mesh_.layers.tet_layer.size(); ++t)
      if (mesh_.layers.tet_layer[t] > 0) visit(mesh_.tets[t]);
  }

  void follow_down() {
    walls_.assign(below_.size(), none);
    for (Index v = 0; v < below_.size(); ++v) {
      Index wall = below_[v];
      // The limit on steps ends cycles of edges in an invalid mesh, which lead to no wall.
      for (std::size_t steps = 0; wall != none && below_[wall] != none && steps <= below_.size(); ++steps)
        wall = below_[wall];
      walls_[v] = wall;
    }
  }

  /// Forgets the wall points of cells that do not lie above one listed triangle.
  void keep_those_on_listed_faces() {
    for (const auto& face : mesh_.faces) listed_.push_back(sorted(face));
    std::ranges::sort(listed_);
    std::vector<Index> doubtful;
    const auto see = [&](const auto& cell) {
      if (!has_wall(cell)) doubtful.insert(doubtful.end(), cell.begin(), cell.end());
    };
    for (const auto& prism : mesh_.layers.prisms) see(prism);
    for (const auto& pyramid : mesh_.layers.pyramids) see(pyramid);
    for_each_tet(see);
    for (const Index v : doubtful) walls_[v] = none;
  }

  template <std::size_t n>
  bool has_wall(std::array<Index, n> cell) const {
    for (Index& v : cell)
      if (walls_[v] != none) v = walls_[v];
    std::ranges::sort(cell);
    const auto end = std::unique(cell.begin(), cell.end());
    if (end - cell.begin() != 3) return false;
    return std::ranges::binary_search(listed_, std::array{cell[0], cell[1], cell[2]});
  }

  const TetMesh& mesh_;
  std::vector<Index> below_, walls_;          // by point
  std::vector<std::array<Index, 3>> listed_;  // corners of listed faces, sorted
};

}  // namespace

std::vector<Index> walls_below(const TetMesh& mesh) { return WallSearch(mesh).run(); }

}  // namespace collarmesh
