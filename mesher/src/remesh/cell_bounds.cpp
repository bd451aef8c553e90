#include "remesh/cell_bounds.h"

#include <algorithm>
#include <utility>

#include "collarmesh/plc_builder.h"
#include "common/parallel_for.h"
#include "common/sorted.h"

namespace collarmesh::remeshing {

namespace {

// The largest width of narrow places is that of the certificate times this factor, because vertices move
// afterwards. If they will move onto exact geometry, the reserve reduces this width further.
constexpr double narrower = 0.98;
constexpr std::uint8_t star = 1, book = 2;

double signed_square_of_cosine(double degrees) {
  return signed_square(std::cos(degrees * std::numbers::pi / 180));
}

std::optional<NarrowPlaces> narrow_places(const Plc& plc, const TetMesh& mesh, const Bounds& bounds) {
  if (!bounds.thin_in_narrow_places_only || mesh.features.size() != mesh.points.size()) return std::nullopt;
  return NarrowPlaces(plc, mesh.features, *forced_edges_of(plc, mesh, true), bounds.crease_angle,
                      narrower / (bounds.radius_edge * (1 + bounds.reserve)));
}

Tag tag_of(const Plc& plc, const TetMesh::VertexFeature& feature) {
  return feature.dimension == 0 ? plc.vertices[feature.feature].tag : plc.curves[feature.feature].tag;
}

/// The mesh edges on creases.
class CreaseEdges {
 public:
  CreaseEdges(const TetMesh& mesh, const CreaseCells& creases) {
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
      if (creases.is_crease(mesh.edge_curve[e]))
        edges_.emplace_back(sorted(mesh.edges[e][0], mesh.edges[e][1]), mesh.edge_tag[e]);
    std::ranges::sort(edges_);
  }

  /// Returns the tag of a crease on which an edge of the tet lies; null if no edge lies on a crease.
  const Tag* tag_in(const std::array<Index, 4>& corners) const {
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = 0; j < i; ++j) {
        const std::array<Index, 2> ends = sorted(corners[i], corners[j]);
        const auto edge = std::ranges::lower_bound(edges_, ends, {}, &Edge::first);
        if (edge != edges_.end() && edge->first == ends) return &edge->second;
      }
    return nullptr;
  }

 private:
  using Edge = std::pair<std::array<Index, 2>, Tag>;  // its ends, and the tag of its curve

  std::vector<Edge> edges_;  // sorted
};

}  // namespace

CreaseCells::CreaseCells(const Plc& plc, const std::vector<TetMesh::VertexFeature>& features,
                         double crease_angle)
    : is_crease_(plc.curves.size(), false) {
  std::vector<bool> is_crease_vertex(plc.vertices.size(), false);
  for (const Crease& crease : find_creases(plc, crease_angle)) {
    any_ = true;
    if (crease.vertex != none) is_crease_vertex[crease.vertex] = true;
    if (crease.curve == none) continue;
    is_crease_[crease.curve] = true;
    for (const Index end : plc.curves[crease.curve].ends)
      if (end != none) is_crease_vertex[end] = true;
  }
  if (!any_) return;
  on_crease_.assign(features.size(), 0);
  for (Index v = 0; v < features.size(); ++v) {
    const auto& [dimension, feature] = features[v];
    if (feature == none) continue;
    if (dimension == 0) on_crease_[v] = is_crease_vertex[feature] ? 1 : 0;
    if (dimension == 1) on_crease_[v] = is_crease_[feature] ? 1 : 0;
  }
}

CellBounds::CellBounds(const Plc& plc, const TetMesh& mesh, const Bounds& bounds)
    : creases_(plc, mesh.features, bounds.crease_angle),
      cosine_(signed_square_of_cosine(180 - (180 - bounds.collar_angle) * (1 + bounds.reserve) -
                                      2 * ThinShape::rounding)),
      tight_(bounds.collar_angle < ThinShape::largest_angle && creases_.any()),
      squared_ratio_(bounds.radius_edge * bounds.radius_edge),
      narrow_(narrow_places(plc, mesh, bounds)) {
  if (!bounds.interior_node) return;
  mesh_ = &mesh;
  for (const Plc::Curve& curve : plc.curves) curve_on_surface_.push_back(!curve.patches.empty());
  for (const Plc::Vertex& vertex : plc.vertices) vertex_on_surface_.push_back(!vertex.patches.empty());
}

namespace {

void mark_collar_cells(TetMesh& mesh, const Plc& plc, double crease_angle) {
  if (!mesh.collar_balls.empty() || mesh.features.size() != mesh.points.size()) return;
  const CreaseCells creases(plc, mesh.features, crease_angle);
  mesh.tet_collar.assign(mesh.tets.size(), 0);
  mesh.tet_crease.assign(mesh.tets.size(), 0);
  if (!creases.any()) return;
  const CreaseEdges edges(mesh, creases);
  parallel_for_in_chunks(mesh.tets.size(), [&](std::size_t t) {
    const auto& corners = mesh.tets[t];
    const auto on_crease = std::ranges::find_if(corners, [&](Index v) { return creases.at(v); });
    if (on_crease == corners.end()) return;
    const Tag* const tag = edges.tag_in(corners);
    mesh.tet_collar[t] = tag != nullptr ? book : star;
    mesh.tet_crease[t] = tag != nullptr ? *tag : tag_of(plc, mesh.features[*on_crease]);
  });
}

}  // namespace

void mark_cells(TetMesh& mesh, const Plc& plc, const Bounds& bounds) {
  mark_collar_cells(mesh, plc, bounds.crease_angle);
  mark_thin_tets(mesh, bounds.radius_edge);
}

}  // namespace collarmesh::remeshing
