// Adds mid-edge nodes to meshes with layers: first to the core, then to the cells of layers. Edges of layers
// bulge like the wall's edges below, but less and less towards the core, where they are straight.
#include "layers/curving.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <unordered_map>

#include "collarmesh/curved_tet.h"
#include "common/cell_shapes.h"
#include "common/edge_key.h"
#include "common/layer_jacobians.h"
#include "common/sort_uniquely.h"
#include "common/sorted.h"
#include "common/tet_sides.h"

namespace collarmesh::layering {

namespace {

constexpr std::array<EdgePlaces, 3> triangle_edges{{{0, 1}, {1, 2}, {2, 0}}};

// Where cells fold, bulges shrink by this factor, at most this many times, and are then left out.
constexpr double shrinking = 0.5;
constexpr unsigned most_shrinkings = 5;

/// The placement of mid-edge nodes in layers and on the walls below them.
class LayerCurving {
 public:
  LayerCurving(TetMesh& mesh, const Plc& plc, const Bulges& bulges, const PlacesInLayers& places,
               const SecondOrderOptions& options, const Execution& execution)
      : mesh_(mesh), plc_(plc), bulges_(bulges), places_(places), options_(options), execution_(execution) {}

  CurvedLayers run(bool may_move_walls) {
    if (!curve_core()) return std::move(made_);
    give_nodes();
    std::vector<Edge> folded = straighten_while_folded(left_above_);
    if (!folded.empty() && may_move_walls) folded = straighten_while_folded(left_on_walls_);
    for (const auto& edge : folded)
      for (const Index end : edge) made_.folded.push_back(places_.given[end]);
    describe();
    return std::move(made_);
  }

 private:
  using Edge = std::array<Index, 2>;
  using Shares =
      std::unordered_map<std::uint64_t, double>;  // remaining shares of bulges, by key of the wall's edge

  bool in_core(Index tet) const { return mesh_.layers.tet_layer[tet] == 0; }

  /// Gives the core (the tets outside the layers) mid-edge nodes, as a mesh by itself. Its tets stay the
  /// same. Returns false if cancelled.
  bool curve_core() {
    TetMesh core;
    core.points = mesh_.points;
    core.features = mesh_.features;
    std::vector<std::array<Index, 3>> sides;
    std::vector<std::uint64_t> edges;
    for (Index t = 0; t < mesh_.tets.size(); ++t) {
      if (!in_core(t)) continue;
      core.tets.push_back(mesh_.tets[t]);
      core.tet_region.push_back(mesh_.tet_region[t]);
      core.tet_tag.push_back(mesh_.tet_tag[t]);
      for (unsigned corner = 0; corner < 4; ++corner)
        sides.push_back(sorted(side_corners(mesh_.tets[t], corner)));
    }
    std::sort(sides.begin(), sides.end());
    for (const auto& [a, b, c] : sides)
      for (const std::uint64_t key : {edge_key(a, b), edge_key(b, c), edge_key(a, c)}) edges.push_back(key);
    std::sort(edges.begin(), edges.end());
    keep_front_straight(sides, core);
    core.tet_collar.assign(core.tets.size(), 0);
    core.tet_crease.assign(core.tets.size(), 0);
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (!std::binary_search(sides.begin(), sides.end(), sorted(mesh_.faces[f]))) continue;
      core.faces.push_back(mesh_.faces[f]);
      core.face_regions.push_back(mesh_.face_regions[f]);
      core.face_patch.push_back(mesh_.face_patch[f]);
      core.face_tag.push_back(mesh_.face_tag[f]);
    }
    for (Index e = 0; e < mesh_.edges.size(); ++e) {
      if (!std::binary_search(edges.begin(), edges.end(), edge_key(mesh_.edges[e][0], mesh_.edges[e][1])))
        continue;
      core.edges.push_back(mesh_.edges[e]);
      core.edge_curve.push_back(mesh_.edge_curve[e]);
      core.edge_tag.push_back(mesh_.edge_tag[e]);
    }
    SecondOrderOptions options = options_;
    options.bounds.thin_angle = 0;  // the tets stay, because layers share their sides
    made_.report = make_second_order(core, plc_, options, execution_);
    if (made_.report.cancelled) return false;
    first_node_ = static_cast<Index>(mesh_.points.size());
    mesh_.points = std::move(core.points);
    mesh_.features = std::move(core.features);
    for (TetMesh::VertexFeature& feature : mesh_.features)
      if (feature.dimension == 2 && feature.feature == none) feature = {};
    core_nodes_ = std::move(core.tet_mid_nodes);
    for (std::size_t t = 0; t < core.tets.size(); ++t)
      for (unsigned k = 0; k < 6; ++k)
        nodes_.emplace(
            edge_key(core.tets[t][cell_shapes::tet_edges[k][0]], core.tets[t][cell_shapes::tet_edges[k][1]]),
            core_nodes_[t][k]);
    first_of_layers_ = static_cast<Index>(mesh_.points.size());
    return true;
  }

  /// Adds the sides between the core and the layers to the core's faces, with no patch. Mid-edge nodes inside
  /// regions may move to make curved tets valid, but those on such faces stay in the middle of their edges,
  /// as the cells of layers need. `sides`: the sides of all tets of the core, sorted. Call it before other
  /// faces are added: where faces share an edge, the last one decides on which patch the edge's node lies.
  void keep_front_straight(const std::vector<std::array<Index, 3>>& sides, TetMesh& core) const {
    std::vector<std::array<Index, 3>> listed;
    for (const auto& face : mesh_.faces) listed.push_back(sorted(face));
    std::sort(listed.begin(), listed.end());
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
      while (last < sides.size() && sides[last] == sides[first]) ++last;
      if (last - first > 1 || std::binary_search(listed.begin(), listed.end(), sides[first])) continue;
      core.faces.push_back(sides[first]);
      core.face_regions.push_back({0, 0});
      core.face_patch.push_back(none);
      core.face_tag.push_back(0);
    }
  }

  Index node_of(Index a, Index b) {
    const auto [at, is_new] = nodes_.emplace(edge_key(a, b), static_cast<Index>(mesh_.points.size()));
    if (is_new) {
      mesh_.points.push_back(0.5 * (mesh_.points[a] + mesh_.points[b]));
      mesh_.features.push_back({});
      ends_.push_back({std::min(a, b), std::max(a, b)});
    }
    return at->second;
  }

  template <class Cells, class Nodes, class Edges>
  void give(const Cells& cells, Nodes& nodes, const Edges& edges) {
    nodes.resize(cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c)
      for (std::size_t k = 0; k < edges.size(); ++k)
        nodes[c][k] = node_of(cells[c][edges[k][0]], cells[c][edges[k][1]]);
  }

  void give_nodes() {
    LayerCells& layers = mesh_.layers;
    give(mesh_.tets, mesh_.tet_mid_nodes, cell_shapes::tet_edges);
    give(layers.prisms, layers.prism_mid_nodes, cell_shapes::prism_edges);
    give(layers.pyramids, layers.pyramid_mid_nodes, cell_shapes::pyramid_edges);
    give(mesh_.faces, mesh_.face_mid_nodes, triangle_edges);
    give(layers.quads, layers.quad_mid_nodes, cell_shapes::quadrangle_edges);
    mesh_.edge_mid_nodes.clear();
    for (Index e = 0; e < mesh_.edges.size(); ++e) {
      const Index node = node_of(mesh_.edges[e][0], mesh_.edges[e][1]);
      mesh_.edge_mid_nodes.push_back(node);
      if (node >= first_of_layers_) mesh_.features[node] = {1, mesh_.edge_curve[e]};
    }
    find_wall_nodes_of_core();
    note_patches(mesh_.face_mid_nodes, mesh_.face_patch);
    note_patches(layers.quad_mid_nodes, layers.quad_patch);
  }

  /// Finds the core's mid-edge nodes on walls: those of edges between two points without layers. `curve_core`
  /// left these edges straight below triangles of the front; elsewhere it may have moved their nodes.
  void find_wall_nodes_of_core() {
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f)
      for (unsigned k = 0; k < 3; ++k) {
        const Index node = mesh_.face_mid_nodes[f][k];
        if (node >= first_of_layers_) continue;
        const Index a = mesh_.faces[f][k], b = mesh_.faces[f][(k + 1) % 3];
        const bool is_new = mesh_.features[node].dimension == 3;
        if (is_new) mesh_.features[node] = {2, mesh_.face_patch[f]};
        if (is_new || (is_on_wall(a, b) && bulges_.knows(places_.given[a], places_.given[b])))
          wall_nodes_.push_back({node, std::min(a, b), std::max(a, b), is_new});
      }
    std::sort(wall_nodes_.begin(), wall_nodes_.end(), [](const WallNode& x, const WallNode& y) {
      return std::tie(x.node, y.is_new) < std::tie(y.node, x.is_new);
    });
    wall_nodes_.erase(std::unique(wall_nodes_.begin(), wall_nodes_.end(),
                                  [](const WallNode& x, const WallNode& y) { return x.node == y.node; }),
                      wall_nodes_.end());
    std::erase_if(made_.report.straightened, [this](const SecondOrderReport::Straightened& of) {
      return std::any_of(wall_nodes_.begin(), wall_nodes_.end(),
                         [&of](const WallNode& at) { return at.node == of.point; });
    });
    std::vector<bool> on_wall(mesh_.points.size(), false);
    for (const WallNode& at : wall_nodes_) on_wall[at.node] = true;
    for (Index t = 0; t < mesh_.tets.size(); ++t) {
      const auto& nodes = mesh_.tet_mid_nodes[t];
      if (in_core(t) && std::any_of(nodes.begin(), nodes.end(), [&](Index node) { return on_wall[node]; }))
        tets_at_wall_.push_back(t);
    }
  }

  /// Notes the patches on which nodes of layers lie.
  template <class Nodes>
  void note_patches(const std::vector<Nodes>& nodes, const std::vector<Index>& patches) {
    for (std::size_t f = 0; f < nodes.size(); ++f)
      for (const Index node : nodes[f])
        if (node >= first_of_layers_ && mesh_.features[node].dimension == 3)
          mesh_.features[node] = {2, patches[f]};
  }

  /// Places the nodes of layers: in the middle of the straight edge, plus the wall's bulge, which fades
  /// towards the core.
  void place_nodes() {
    for (const auto& [node, a, b, is_new] : wall_nodes_)
      mesh_.points[node] = 0.5 * (mesh_.points[a] + mesh_.points[b]) + bulge_between(a, b);
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      const auto [a, b] = ends_[i];
      mesh_.points[first_of_layers_ + i] = 0.5 * (mesh_.points[a] + mesh_.points[b]) + bulge_between(a, b);
    }
  }

  Vector bulge_between(Index a, Index b) const {
    const Index at = places_.wall[a], bt = places_.wall[b];
    if (at == none || bt == none || at == bt) return {};
    const bool raised = places_.is_raised[at], other_raised = places_.is_raised[bt];
    const double share = raised && other_raised ? 0.5 * (places_.share[a] + places_.share[b])
                         : raised               ? places_.share[a]
                                                : places_.share[b];
    const double left = share_left(is_on_wall(a, b) ? left_on_walls_ : left_above_, at, bt);
    return ((1 - share) * left) * bulges_(places_.given[a], places_.given[b]);
  }

  bool is_on_wall(Index a, Index b) const { return places_.wall[a] == a && places_.wall[b] == b; }

  static double share_left(const Shares& shares, Index a, Index b) {
    const auto found = shares.find(edge_key(a, b));
    return found == shares.end() ? 1 : found->second;
  }

  /// Places the nodes of layers, and shrinks the bulges of cells that fold until none folds or the bulges are
  /// zero. Returns the wall edges of cells that still fold.
  std::vector<Edge> straighten_while_folded(Shares& left) {
    for (unsigned pass = 0;; ++pass) {
      place_nodes();
      std::vector<Edge> folded = find_folded();
      if (folded.empty() || pass > most_shrinkings) return folded;
      for (const auto& [a, b] : folded) {
        double& share = left.emplace(edge_key(a, b), 1.0).first->second;
        share = pass == most_shrinkings ? 0 : shrinking * share;
      }
    }
  }

  /// Finds the edges of walls below the cells that fold.
  std::vector<Edge> find_folded() const {
    std::vector<Edge> at;
    const auto note = [&](const auto& corners, const auto& edges) {
      for (const auto& [i, j] : edges) {
        const Index a = places_.wall[corners[i]], b = places_.wall[corners[j]];
        if (a != none && b != none && a != b) at.push_back({std::min(a, b), std::max(a, b)});
      }
    };
    const LayerCells& layers = mesh_.layers;
    for (Index c = 0; c < layers.prisms.size(); ++c)
      if (!(least_jacobian_at_points(points_of(layers.prisms[c]), points_of(layers.prism_mid_nodes[c])) > 0))
        note(layers.prisms[c], cell_shapes::prism_edges);
    for (Index c = 0; c < layers.pyramids.size(); ++c)
      if (!(least_jacobian_at_points(points_of(layers.pyramids[c]), points_of(layers.pyramid_mid_nodes[c])) >
            0))
        note(layers.pyramids[c], cell_shapes::pyramid_edges);
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      if (!in_core(t) && !jacobian_exceeds(curved_tet(mesh_, t))) note(mesh_.tets[t], cell_shapes::tet_edges);
    for (const Index t : tets_at_wall_)
      if (!jacobian_exceeds(curved_tet(mesh_, t))) note(mesh_.tets[t], cell_shapes::tet_edges);
    sort_uniquely(at);
    return at;
  }

  /// Adds the nodes of layers to the report.
  void describe() {
    SecondOrderReport& report = made_.report;
    report.nodes = mesh_.points.size() - first_node_;
    for (const WallNode& at : wall_nodes_) describe_node(at.node, at.a, at.b, at.is_new);
    for (Index i = 0; i < ends_.size(); ++i)
      describe_node(first_of_layers_ + i, ends_[i][0], ends_[i][1], true);
    std::sort(report.straightened.begin(), report.straightened.end(),
              [](const auto& x, const auto& y) { return x.point < y.point; });
  }

  void describe_node(Index node, Index a, Index b, bool is_new) {
    const Point &where = mesh_.points[node], middle = 0.5 * (mesh_.points[a] + mesh_.points[b]);
    const TetMesh::VertexFeature& feature = mesh_.features[node];
    if (is_new && where != middle)
      ++(feature.dimension < 3 ? made_.report.curved : made_.report.moved_inside);
    if (!is_on_wall(a, b)) return;
    const double left = share_left(left_on_walls_, a, b);
    if (left == 1) return;
    const double off = (1 - left) * norm(bulges_(places_.given[a], places_.given[b]));
    const Tag tag = feature.feature == none  ? 0
                    : feature.dimension == 1 ? plc_.curves[feature.feature].tag
                                             : plc_.patches[feature.feature].tag;
    if (off > 0) made_.report.straightened.push_back({node, {a, b}, feature, tag, where, off});
  }

  template <std::size_t n>
  std::array<Point, n> points_of(const std::array<Index, n>& nodes) const {
    std::array<Point, n> found;
    for (std::size_t i = 0; i < n; ++i) found[i] = mesh_.points[nodes[i]];
    return found;
  }

  TetMesh& mesh_;
  const Plc& plc_;
  const Bulges& bulges_;
  const PlacesInLayers& places_;
  const SecondOrderOptions& options_;
  const Execution& execution_;
  std::vector<std::array<Index, 6>> core_nodes_;
  std::unordered_map<std::uint64_t, Index> nodes_;  // by edge key
  Shares left_above_, left_on_walls_;               // for edges above walls, and for edges on them
  std::vector<Edge> ends_;                          // by node of layers: its edge
  struct WallNode {
    Index node, a, b;  // the node, and the ends of its edge
    bool is_new;       // `curve_core` put the node on no feature
  };
  std::vector<WallNode> wall_nodes_;  // nodes on walls that belong to the core
  std::vector<Index> tets_at_wall_;   // tets of the core with such nodes
  Index first_node_ = 0, first_of_layers_ = 0;
  CurvedLayers made_;
};

}  // namespace

Bulges::Bulges(const TetMesh& mesh) {
  const auto add = [&](Index a, Index b, Index node) {
    const Vector bulge = mesh.points[node] - 0.5 * (mesh.points[a] + mesh.points[b]);
    bulges_.emplace_back(edge_key(a, b), bulge);
  };
  for (std::size_t f = 0; f < mesh.face_mid_nodes.size(); ++f)
    for (unsigned i = 0; i < 3; ++i)
      add(mesh.faces[f][i], mesh.faces[f][(i + 1) % 3], mesh.face_mid_nodes[f][i]);
  for (std::size_t e = 0; e < mesh.edge_mid_nodes.size(); ++e)
    add(mesh.edges[e][0], mesh.edges[e][1], mesh.edge_mid_nodes[e]);
  const auto before = [](const auto& x, const auto& y) { return x.first < y.first; };
  std::stable_sort(bulges_.begin(), bulges_.end(), before);
  bulges_.erase(std::unique(bulges_.begin(), bulges_.end(),
                            [](const auto& x, const auto& y) { return x.first == y.first; }),
                bulges_.end());
}

bool Bulges::knows(Index a, Index b) const {
  return std::binary_search(bulges_.begin(), bulges_.end(), std::pair(edge_key(a, b), Vector{}),
                            [](const auto& x, const auto& y) { return x.first < y.first; });
}

Vector Bulges::operator()(Index a, Index b) const {
  const std::uint64_t key = edge_key(a, b);
  const auto found = std::lower_bound(bulges_.begin(), bulges_.end(), key,
                                      [](const auto& each, std::uint64_t k) { return each.first < k; });
  return found != bulges_.end() && found->first == key ? found->second : Vector{};
}

void straighten(TetMesh& mesh) {
  Index first = static_cast<Index>(mesh.points.size());
  const auto see = [&first](Index node) { first = std::min(first, node); };
  for (const auto& nodes : mesh.tet_mid_nodes)
    for (const Index node : nodes) see(node);
  mesh.points.resize(first);
  mesh.features.resize(first);
  mesh.tet_mid_nodes.clear(), mesh.face_mid_nodes.clear(), mesh.edge_mid_nodes.clear();
}

CurvedLayers curve(TetMesh& mesh, const Plc& plc, const Bulges& bulges, const PlacesInLayers& places,
                   const SecondOrderOptions& options, const Execution& execution, bool may_move_walls) {
  return LayerCurving(mesh, plc, bulges, places, options, execution).run(may_move_walls);
}

}  // namespace collarmesh::layering
