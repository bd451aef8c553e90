#include "io/complete_mesh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>

#include "collarmesh/error.h"
#include "common/edge_key.h"
#include "common/sort_uniquely.h"
#include "io/cell_nodes.h"
#include "io/cell_orientation.h"
#include "io/sides_of_faces.h"

namespace collarmesh::io {

namespace {

constexpr std::array<CellKind, 3> volume_kinds{CellKind::tet, CellKind::prism, CellKind::pyramid};
constexpr std::array<CellKind, 2> surface_kinds{CellKind::triangle, CellKind::quadrangle};

void turn_cell(TetMesh& mesh, CellKind kind, std::size_t i) {
  set_cell(kind, i, turned(kind, nodes_of(kind)(mesh, i)), mesh);
}

/// Reverses all cells of a kind if most have negative volume, because programs differ in the order of
/// corners. Cells whose volume is negative after this are really inverted, and stay so.
void orient(TetMesh& mesh, CellKind kind) {
  const std::size_t count = count_of(mesh, kind);
  std::size_t negative = 0, positive = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double volume = six_volume_of(mesh, kind, i);
    if (volume < 0) ++negative;
    if (volume > 0) ++positive;
  }
  if (negative <= positive) return;
  for (std::size_t i = 0; i < count; ++i) turn_cell(mesh, kind, i);
}

/// The mid-edge nodes of cells with volume, by the two ends of their edges.
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

/// Rejects a mix of first and second order. All cells with volume must have one order. All triangles must
/// have this order, or all must have no mid-edge nodes; the same holds for quadrangles and for edges.
void require_one_order(const std::string& path, const TetMesh& mesh) {
  for (const CellKind kind : all_cell_kinds) {
    const bool in_layers = kind == CellKind::prism || kind == CellKind::pyramid;
    const bool fits = with_cells(mesh, kind, [&](const auto& cells, const auto& middle) {
      return middle.size() == (mesh.order() == 2 ? cells.size() : 0) || (middle.empty() && !in_layers);
    });
    if (!fits)
      throw ReadError(path + ": cells of first and second order are mixed; save them with one order");
  }
}

void complete_mid_nodes(const std::string& path, TetMesh& mesh) {
  require_one_order(path, mesh);
  if (mesh.order() == 1) return;
  std::optional<MidNodes> nodes;
  for (const CellKind kind : {CellKind::triangle, CellKind::quadrangle, CellKind::edge})
    with_cells(mesh, kind, [&](const auto& cells, auto& middle) {
      if (middle.size() == cells.size()) return;
      if (!nodes) nodes.emplace(path, mesh);
      for (const auto& cell : cells) {
        const auto mid_nodes = as_span(middle.emplace_back());
        for (std::size_t e = 0; e < mid_nodes.size(); ++e)
          mid_nodes[e] = nodes->find(cell[e], cell[(e + 1) % cell.size()]);
      }
    });
}

void number_regions(TetMesh& mesh) {
  std::vector<Tag> tags = all_tags(mesh, 3);
  sort_uniquely(tags);
  for (const CellKind kind : volume_kinds) {
    features_of(mesh, kind).clear();
    for (const Tag tag : tags_of(mesh, kind))
      features_of(mesh, kind)
          .push_back(static_cast<Index>(std::lower_bound(tags.begin(), tags.end(), tag) - tags.begin() + 1));
  }
  for (const CellKind kind : surface_kinds) regions_beside(mesh, kind).clear();
}

/// Returns whether each cell with volume has the number of its region, from 1 to 999 999 999: every format
/// can store such numbers.
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
      turn_cell(mesh, kind, f);
    }
}

/// Fills in missing numbers of layers with 0. Empties the tets' array if it is incomplete or no tet is in a
/// layer.
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
  assert(std::ranges::all_of(all_cell_kinds, [&](CellKind kind) {
    return tags_of(mesh, kind).empty() || tags_of(mesh, kind).size() == count_of(mesh, kind);
  }));
  complete_mid_nodes(path, mesh);
  for (const CellKind kind : volume_kinds) orient(mesh, kind);
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
    if (mesh.tets.empty())  // without tets faces have no regions and keep their orientation
      regions_beside(mesh, kind).assign(count_of(mesh, kind), {0, 0});
    else if (regions_beside(mesh, kind).empty())
      find_face_regions(mesh, kind);
}

}  // namespace collarmesh::io
