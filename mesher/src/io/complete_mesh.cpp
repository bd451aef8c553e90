#include "io/complete_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "collarmesh/error.h"
#include "common/edge_key.h"
#include "io/cell_nodes.h"
#include "io/cell_orientation.h"
#include "io/sides_of_faces.h"

namespace collarmesh::io {

namespace {

template <std::size_t corners, std::size_t mid_nodes>
void turn_cell(CellKind kind, std::array<Index, corners>& cell,
               std::vector<std::array<Index, mid_nodes>>& middle, std::size_t i) {
  const CellNodes nodes = turned(kind, CellNodes::of(cell, middle, i));
  for (std::size_t k = 0; k < corners; ++k) cell[k] = nodes[k];
  if (!middle.empty())
    for (std::size_t k = 0; k < mid_nodes; ++k) middle[i][k] = nodes[corners + k];
}

template <std::size_t corners, std::size_t mid_nodes>
void orient(CellKind kind, TetMesh& mesh, std::vector<std::array<Index, corners>>& cells,
            std::vector<std::array<Index, mid_nodes>>& middle) {
  std::size_t negative = 0, positive = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double volume = six_volume_of(mesh, kind, i);
    if (volume < 0) ++negative;
    if (volume > 0) ++positive;
  }
  if (negative <= positive) return;
  for (std::size_t i = 0; i < cells.size(); ++i) turn_cell(kind, cells[i], middle, i);
}

/// Reverses all cells of a kind if most are negative, because programs differ in the order of corners. Cells
/// whose orientation differs from the others are inverted, and stay.
void orient_volumes(TetMesh& mesh) {
  orient(CellKind::tet, mesh, mesh.tets, mesh.tet_mid_nodes);
  orient(CellKind::prism, mesh, mesh.layers.prisms, mesh.layers.prism_mid_nodes);
  orient(CellKind::pyramid, mesh, mesh.layers.pyramids, mesh.layers.pyramid_mid_nodes);
}

/// The mid-edge nodes of the cells of volumes by the ends of their edge.
class MidNodes {
 public:
  MidNodes(const std::string& path, const TetMesh& mesh) : path_(path) {
    for_each_kind(mesh, 3, [&](CellKind kind) {
      const CellShape shape = shape_of(kind);
      for (std::size_t i = 0; i < count_of(mesh, kind); ++i) {
        const CellNodes nodes = nodes_of(kind)(mesh, i);
        for (std::size_t e = 0; e < shape.edges.size(); ++e)
          nodes_.emplace(edge_key(nodes[shape.edges[e][0]], nodes[shape.edges[e][1]]),
                         nodes[shape.corners + e]);
      }
    });
  }
  Index find(Index a, Index b) const {
    const auto found = nodes_.find(edge_key(a, b));
    if (found == nodes_.end())
      throw ReadError(
          path_ +
          ": a triangle, quadrangle or line of first order is no face or edge of a cell of second "
          "order; save all cells with one order");
    return found->second;
  }

 private:
  const std::string& path_;
  std::unordered_map<std::uint64_t, Index> nodes_;
};

/// Rejects cells of both orders. Volumes have one order; the triangles, the quadrangles or the edges have it,
/// too, or no mid-edge nodes at all.
void require_one_order(const std::string& path, const TetMesh& mesh) {
  const bool second = mesh.order() == 2;
  const LayerCells& layers = mesh.layers;
  const auto all = [&](const auto& mid_nodes, std::size_t cells) {
    return mid_nodes.size() == (second ? cells : 0);
  };
  const auto all_or_none = [&](const auto& mid_nodes, std::size_t cells) {
    return mid_nodes.empty() || all(mid_nodes, cells);
  };
  if (!all_or_none(mesh.tet_mid_nodes, mesh.tets.size()) ||
      !all(layers.prism_mid_nodes, layers.prisms.size()) ||
      !all(layers.pyramid_mid_nodes, layers.pyramids.size()) ||
      !all_or_none(mesh.face_mid_nodes, mesh.faces.size()) ||
      !all_or_none(layers.quad_mid_nodes, layers.quads.size()) ||
      !all_or_none(mesh.edge_mid_nodes, mesh.edges.size()))
    throw ReadError(path + ": cells of first and second order are mixed; save them with one order");
}

void complete_mid_nodes(const std::string& path, TetMesh& mesh) {
  require_one_order(path, mesh);
  LayerCells& layers = mesh.layers;
  const bool faces = mesh.face_mid_nodes.size() == mesh.faces.size(),
             quads = layers.quad_mid_nodes.size() == layers.quads.size(),
             edges = mesh.edge_mid_nodes.size() == mesh.edges.size();
  if (mesh.order() == 1 || (faces && quads && edges)) return;
  const MidNodes nodes(path, mesh);
  if (!faces)
    for (const auto& [a, b, c] : mesh.faces)
      mesh.face_mid_nodes.push_back({nodes.find(a, b), nodes.find(b, c), nodes.find(c, a)});
  if (!quads)
    for (const auto& [a, b, c, d] : layers.quads)
      layers.quad_mid_nodes.push_back(
          {nodes.find(a, b), nodes.find(b, c), nodes.find(c, d), nodes.find(d, a)});
  if (!edges)
    for (const auto& [a, b] : mesh.edges) mesh.edge_mid_nodes.push_back(nodes.find(a, b));
}

constexpr std::array<CellKind, 3> volume_kinds{CellKind::tet, CellKind::prism, CellKind::pyramid};
constexpr std::array<CellKind, 2> surface_kinds{CellKind::triangle, CellKind::quadrangle};

void number_regions(TetMesh& mesh) {
  std::vector<Tag> tags;
  for (const CellKind kind : volume_kinds)
    tags.insert(tags.end(), tags_of(mesh, kind).begin(), tags_of(mesh, kind).end());
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  for (const CellKind kind : volume_kinds) {
    features_of(mesh, kind).clear();
    for (const Tag tag : tags_of(mesh, kind))
      features_of(mesh, kind)
          .push_back(static_cast<Index>(std::lower_bound(tags.begin(), tags.end(), tag) - tags.begin() + 1));
  }
  for (const CellKind kind : surface_kinds) regions_beside(mesh, kind).clear();
}

/// Returns whether the numbers of regions are from 1 to 999 999 999, for which every format has room.
bool has_region_numbers(const TetMesh& mesh) {
  constexpr Index largest = 999'999'999;
  return !mesh.tet_region.empty() &&
         std::all_of(volume_kinds.begin(), volume_kinds.end(), [&](CellKind kind) {
           const std::vector<Index>& regions = features_of(mesh, kind);
           return regions.size() == count_of(mesh, kind) &&
                  std::all_of(regions.begin(), regions.end(), [](Index r) { return r >= 1 && r <= largest; });
         });
}

void find_face_regions(TetMesh& mesh, CellKind kind) {
  auto& regions = regions_beside(mesh, kind);
  regions.assign(count_of(mesh, kind), {0, 0});
  for_each_listed_side(mesh, kind, [&](const SideOfCell& side, Index face, bool behind) {
    regions[face][behind ? 0 : 1] = features_of(mesh, side.kind)[side.cell];
  });
  for (std::size_t f = 0; f < regions.size(); ++f)
    if (regions[f][0] == 0) {
      std::swap(regions[f][0], regions[f][1]);
      if (kind == CellKind::triangle)
        turn_cell(kind, mesh.faces[f], mesh.face_mid_nodes, f);
      else
        turn_cell(kind, mesh.layers.quads[f], mesh.layers.quad_mid_nodes, f);
    }
}

/// Fills in the numbers of layers. If no tet is in a layer, the tets' array stays empty.
void complete_layers(TetMesh& mesh) {
  LayerCells& layers = mesh.layers;
  layers.prism_layer.resize(layers.prisms.size(), 0);
  layers.pyramid_layer.resize(layers.pyramids.size(), 0);
  if (layers.tet_layer.size() != mesh.tets.size() ||
      std::all_of(layers.tet_layer.begin(), layers.tet_layer.end(), [](auto layer) { return layer == 0; }))
    layers.tet_layer.clear();
}

}  // namespace

void complete_mesh(const std::string& path, TetMesh& mesh) {
  complete_mid_nodes(path, mesh);
  orient_volumes(mesh);
  for (const CellKind kind : all_cell_kinds) {
    tags_of(mesh, kind).resize(count_of(mesh, kind), 0);
    if (shape_of(kind).dimension < 3) features_of(mesh, kind).resize(count_of(mesh, kind), none);
  }
  mesh.tet_collar.resize(mesh.tets.size(), 0);
  mesh.tet_crease.resize(mesh.tets.size(), 0);
  if (mesh.tet_partition.size() != mesh.tets.size()) mesh.tet_partition.clear();
  complete_layers(mesh);
  if (!has_region_numbers(mesh)) number_regions(mesh);
  for (const CellKind kind : surface_kinds)
    if (mesh.tets.empty())  // the mesh of a surface stays as it is
      regions_beside(mesh, kind).assign(count_of(mesh, kind), {0, 0});
    else if (regions_beside(mesh, kind).empty())
      find_face_regions(mesh, kind);
}

}  // namespace collarmesh::io
