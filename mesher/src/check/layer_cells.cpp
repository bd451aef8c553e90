// The certificate of meshes with boundary layers: their prisms, pyramids and tets.
#include "check/layer_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "check/findings.h"
#include "collarmesh/curved_tet.h"
#include "collarmesh/plc_builder.h"
#include "common/cell_shapes.h"
#include "common/layer_jacobians.h"
#include "common/shared_bounds.h"
#include "common/sort_uniquely.h"
#include "common/tet_sides.h"
#include "tolerance/forced_edges.h"

namespace collarmesh::checks {

namespace {

enum class Kind : std::uint8_t { tet, prism, pyramid, face, quad };

constexpr std::string_view name_of(Kind kind) {
  constexpr std::array<std::string_view, 5> names{"tet", "prism", "pyramid", "face", "quadrangle"};
  return names[static_cast<unsigned>(kind)];
}

/// A side of a cell, or a listed face or quadrangle. The corners begin with the smallest one, then comes the
/// smaller of the two next to it; the fourth is `none` for a triangle.
struct CellSide {
  std::array<Index, 4> corners;
  Index cell;
  Kind kind;
  bool turned;  // the normal, with the corners in this order, points into the cell; for a listed face or
                // quadrangle: into its regions[0]

  bool listed() const { return kind == Kind::face || kind == Kind::quad; }
};

/// Returns a side of a cell. `corners`: counterclockwise for a viewer outside the cell.
CellSide side_of(std::array<Index, 3> corners, Index cell, Kind kind) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  const bool turned = corners[1] > corners[2];
  if (turned) std::swap(corners[1], corners[2]);
  return {{corners[0], corners[1], corners[2], none}, cell, kind, turned};
}

CellSide side_of(std::array<Index, 4> corners, Index cell, Kind kind) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  const bool turned = corners[1] > corners[3];
  if (turned) std::swap(corners[1], corners[3]);
  return {corners, cell, kind, turned};
}

constexpr std::array<EdgePlaces, 3> triangle_edges{{{0, 1}, {1, 2}, {2, 0}}};

class LayerCheck {
 public:
  LayerCheck(const TetMesh& mesh, Findings& findings)
      : mesh_(mesh), layers_(mesh.layers), findings_(findings) {}

  void run() {
    if (!check_arrays()) return;
    check_jacobians();
    check_sides();
    if (mesh_.order() == 2) check_mid_nodes();
  }

 private:
  const Point& at(Index node) const { return mesh_.points[node]; }
  template <std::size_t n, std::size_t m>
  std::array<Point, n + m> points_of(const std::array<Index, n>& first, const std::array<Index, m>& then) {
    std::array<Point, n + m> found;
    for (std::size_t i = 0; i < n; ++i) found[i] = at(first[i]);
    for (std::size_t i = 0; i < m; ++i) found[n + i] = at(then[i]);
    return found;
  }
  template <std::size_t n>
  std::array<Point, n> points_of(const std::array<Index, n>& nodes) {
    return points_of(nodes, std::array<Index, 0>{});
  }

  // Arrays

  bool check_arrays() {
    bool fit = true;
    const auto require = [&](bool holds, std::string_view array, std::size_t size, std::size_t wanted) {
      if (holds) return;
      fit = false;
      findings_.add(guarantee::layer_arrays, {}, {}, "The array {} of the layers has {} entries, not {}.",
                    array, size, wanted);
    };
    const auto same = [&](std::size_t size, std::size_t wanted, std::string_view array) {
      require(size == wanted, array, size, wanted);
    };
    const auto same_or_none = [&](std::size_t size, std::size_t wanted, std::string_view array) {
      require(size == wanted || size == 0, array, size, wanted);
    };
    same(layers_.prism_region.size(), layers_.prisms.size(), "prism_region");
    same(layers_.prism_tag.size(), layers_.prisms.size(), "prism_tag");
    same(layers_.prism_layer.size(), layers_.prisms.size(), "prism_layer");
    same(layers_.pyramid_region.size(), layers_.pyramids.size(), "pyramid_region");
    same(layers_.pyramid_tag.size(), layers_.pyramids.size(), "pyramid_tag");
    same(layers_.pyramid_layer.size(), layers_.pyramids.size(), "pyramid_layer");
    same(layers_.quad_regions.size(), layers_.quads.size(), "quad_regions");
    same(layers_.quad_patch.size(), layers_.quads.size(), "quad_patch");
    same(layers_.quad_tag.size(), layers_.quads.size(), "quad_tag");
    same_or_none(layers_.tet_layer.size(), mesh_.tets.size(), "tet_layer");
    const bool second = mesh_.order() == 2;
    same(layers_.prism_mid_nodes.size(), second ? layers_.prisms.size() : 0, "prism_mid_nodes");
    same(layers_.pyramid_mid_nodes.size(), second ? layers_.pyramids.size() : 0, "pyramid_mid_nodes");
    same(layers_.quad_mid_nodes.size(), second ? layers_.quads.size() : 0, "quad_mid_nodes");
    return require_indices(layers_.prisms, Kind::prism) && require_indices(layers_.pyramids, Kind::pyramid) &&
           require_indices(layers_.quads, Kind::quad) &&
           require_indices(layers_.prism_mid_nodes, Kind::prism) &&
           require_indices(layers_.pyramid_mid_nodes, Kind::pyramid) &&
           require_indices(layers_.quad_mid_nodes, Kind::quad) && fit;
  }

  template <std::size_t n>
  bool require_indices(const std::vector<std::array<Index, n>>& cells, Kind kind) {
    for (Index c = 0; c < cells.size(); ++c) {
      std::array<Index, n> nodes = cells[c];
      std::sort(nodes.begin(), nodes.end());
      if (nodes.back() < mesh_.points.size() && std::adjacent_find(nodes.begin(), nodes.end()) == nodes.end())
        continue;
      findings_.add(guarantee::layer_arrays, {}, {c}, "The nodes of {} {} are not {} different points.",
                    name_of(kind), c, n);
      return false;
    }
    return true;
  }

  // Jacobians

  void check_jacobians() {
    const bool second = mesh_.order() == 2;
    for (Index c = 0; c < layers_.prisms.size(); ++c) {
      const PrismCorners p = points_of(layers_.prisms[c]);
      require_positive(
          second ? least_jacobian_at_points(p, points_of(layers_.prism_mid_nodes[c])) : least_jacobian(p),
          p[0], c, Kind::prism);
    }
    for (Index c = 0; c < layers_.pyramids.size(); ++c) {
      const PyramidCorners p = points_of(layers_.pyramids[c]);
      require_positive(
          second ? least_jacobian_at_points(p, points_of(layers_.pyramid_mid_nodes[c])) : least_jacobian(p),
          p[0], c, Kind::pyramid);
    }
    check_tets();
  }

  void require_positive(double jacobian, const Point& where, Index cell, Kind kind) {
    if (jacobian > 0) return;
    findings_.add(guarantee::layer_jacobian, where, {cell},
                  "The Jacobian of {} {} at {} is {:.3g}; it has to be positive.", name_of(kind), cell,
                  At{where}, jacobian);
  }

  void check_tets() {
    for (Index t = 0; t < mesh_.tets.size(); ++t) {
      const auto p = points_of(mesh_.tets[t]);
      if (mesh_.order() == 1)
        require_positive(six_volume(p[0], p[1], p[2], p[3]), p[0], t, Kind::tet);
      else if (!jacobian_exceeds(curved_tet(mesh_, t)))
        findings_.add(guarantee::layer_jacobian, p[0], {t},
                      "The Jacobian of the curved tet {} at {} is not positive everywhere.", t, At{p[0]});
    }
  }

  // Sides

  Index region_of(const CellSide& side) const {
    switch (side.kind) {
      case Kind::tet: return mesh_.tet_region[side.cell];
      case Kind::prism: return layers_.prism_region[side.cell];
      case Kind::pyramid: return layers_.pyramid_region[side.cell];
      default: return none;
    }
  }
  const std::array<Index, 2>& regions_of(const CellSide& side) const {
    return side.kind == Kind::face ? mesh_.face_regions[side.cell] : layers_.quad_regions[side.cell];
  }

  void check_sides() {
    const std::vector<CellSide> sides = all_sides();
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
      for (last = first; last < sides.size() && sides[last].corners == sides[first].corners;) ++last;
      check_side(&sides[first], &sides[last - 1] + 1);
    }
  }

  std::vector<CellSide> all_sides() const {
    std::vector<CellSide> sides;
    sides.reserve(4 * mesh_.tets.size() + 5 * (layers_.prisms.size() + layers_.pyramids.size()) +
                  mesh_.faces.size() + layers_.quads.size());
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      for (unsigned corner = 0; corner < 4; ++corner)
        sides.push_back(side_of(side_corners(mesh_.tets[t], corner), t, Kind::tet));
    for (Index c = 0; c < layers_.prisms.size(); ++c) add_sides_of_prism(c, sides);
    for (Index c = 0; c < layers_.pyramids.size(); ++c) add_sides_of_pyramid(c, sides);
    for (Index f = 0; f < mesh_.faces.size(); ++f) sides.push_back(side_of(mesh_.faces[f], f, Kind::face));
    for (Index q = 0; q < layers_.quads.size(); ++q)
      sides.push_back(side_of(layers_.quads[q], q, Kind::quad));
    std::sort(sides.begin(), sides.end(), [](const CellSide& a, const CellSide& b) {
      return std::tie(a.corners, a.kind, a.cell) < std::tie(b.corners, b.kind, b.cell);
    });
    return sides;
  }

  void add_sides_of_prism(Index prism, std::vector<CellSide>& sides) const {
    const auto& [a, b, c, d, e, f] = layers_.prisms[prism];
    for (const std::array<Index, 3>& triangle : {std::array{a, c, b}, std::array{d, e, f}})
      sides.push_back(side_of(triangle, prism, Kind::prism));
    for (const std::array<Index, 4>& quad :
         {std::array{a, b, e, d}, std::array{b, c, f, e}, std::array{c, a, d, f}})
      sides.push_back(side_of(quad, prism, Kind::prism));
  }

  void add_sides_of_pyramid(Index pyramid, std::vector<CellSide>& sides) const {
    const auto& [a, b, c, d, e] = layers_.pyramids[pyramid];
    for (const std::array<Index, 3>& triangle :
         {std::array{a, b, e}, std::array{b, c, e}, std::array{c, d, e}, std::array{d, a, e}})
      sides.push_back(side_of(triangle, pyramid, Kind::pyramid));
    sides.push_back(side_of(std::array{a, d, c, b}, pyramid, Kind::pyramid));
  }

  /// Checks the cells and listed faces at one side, [first, last); cells come first.
  void check_side(const CellSide* first, const CellSide* last) {
    const CellSide* const cells_end = std::find_if(first, last, [](const CellSide& s) { return s.listed(); });
    const auto cells = cells_end - first, lists = last - cells_end;
    const Point& where = at(first->corners[0]);
    if (cells == 0 || cells > 2 || (cells == 2 && first[0].turned == first[1].turned)) {
      findings_.add(guarantee::layer_conforming, where, {first->cell},
                    "A side of {} {} at {} has {} cells; it must have one, or two on opposite sides.",
                    name_of(first->kind), first->cell, At{where}, cells);
      return;
    }
    const bool inside = cells == 2 && region_of(first[0]) == region_of(first[1]);
    if (lists > 1 || (lists == 0 && !inside)) {
      findings_.add(guarantee::layer_sides, where, {first->cell},
                    "A side of {} {} at {} is listed {} times as a face; {}.", name_of(first->kind),
                    first->cell, At{where}, lists,
                    cells == 1 ? "no other cell has this side, so either it is on the boundary and must be "
                                 "listed once, or the cells do not conform"
                               : "it must be listed once");
      return;
    }
    if (lists == 1) check_regions(*cells_end, first, cells == 2 ? first + 1 : nullptr);
  }

  void check_regions(const CellSide& listed, const CellSide* one, const CellSide* other) {
    std::array<Index, 2> wanted{};  // regions behind and in front of the listed side
    for (const CellSide* side : {one, other})
      if (side != nullptr) wanted[side->turned ? 1 : 0] = region_of(*side);
    if (listed.turned) std::swap(wanted[0], wanted[1]);
    if (regions_of(listed) == wanted) return;
    findings_.add(guarantee::layer_sides, at(listed.corners[0]), {listed.cell},
                  "The regions of {} {} at {} are {} and {}, but those of its cells are {} and {}.",
                  name_of(listed.kind), listed.cell, At{at(listed.corners[0])}, regions_of(listed)[0],
                  regions_of(listed)[1], wanted[0], wanted[1]);
  }

  // Nodes of second order

  struct MidNode {
    std::array<Index, 2> ends;
    Index node;
  };

  void check_mid_nodes() {
    std::vector<MidNode> all;
    const auto add = [&all](const auto& cells, const auto& nodes, const auto& edges) {
      for (std::size_t c = 0; c < cells.size(); ++c)
        for (std::size_t k = 0; k < edges.size(); ++k) {
          const Index a = cells[c][edges[k][0]], b = cells[c][edges[k][1]];
          all.push_back({{std::min(a, b), std::max(a, b)}, nodes[c][k]});
        }
    };
    add(mesh_.tets, mesh_.tet_mid_nodes, cell_shapes::tet_edges);
    add(mesh_.faces, mesh_.face_mid_nodes, triangle_edges);
    add(layers_.prisms, layers_.prism_mid_nodes, cell_shapes::prism_edges);
    add(layers_.pyramids, layers_.pyramid_mid_nodes, cell_shapes::pyramid_edges);
    add(layers_.quads, layers_.quad_mid_nodes, cell_shapes::quadrangle_edges);
    sort_uniquely(all, [](const MidNode& each) { return std::tie(each.ends, each.node); });
    for (std::size_t k = 1; k < all.size(); ++k)
      if (all[k].ends == all[k - 1].ends)
        findings_.add(guarantee::layer_mid_nodes, at(all[k].node), {all[k - 1].node, all[k].node},
                      "The edge of nodes {} and {} at {} has two mid-edge nodes, {} and {}.", all[k].ends[0],
                      all[k].ends[1], At{at(all[k].ends[0])}, all[k - 1].node, all[k].node);
    std::sort(all.begin(), all.end(), [](const MidNode& a, const MidNode& b) { return a.node < b.node; });
    for (std::size_t k = 1; k < all.size(); ++k)
      if (all[k].node == all[k - 1].node)
        findings_.add(guarantee::layer_mid_nodes, at(all[k].node), {all[k].node},
                      "Node {} at {} is the mid-edge node of two edges.", all[k].node, At{at(all[k].node)});
  }

  const TetMesh& mesh_;
  const LayerCells& layers_;
  Findings& findings_;
};

}  // namespace

void check_layer_cells(const TetMesh& mesh, CheckReport& report, std::size_t findings_per_guarantee) {
  Findings findings(report, findings_per_guarantee);
  LayerCheck(mesh, findings).run();
}

namespace {

/// The bounds on the angles of the core, the tets outside layers. A node that layers pushed away from its
/// wall counts as a node on the wall's features.
class CoreAngles {
 public:
  CoreAngles(const TetMesh& mesh, const std::vector<Index>& walls, const Plc& plc, const Bounds& bounds)
      : mesh_(mesh), walls_(walls), bounds_(bounds), features_(mesh.features) {
    for (Index v = 0; v < features_.size(); ++v)
      if (v < walls.size() && walls[v] != none) features_[v] = mesh.features[walls[v]];
    find_surface();
    if (bounds.lower_where_forced)
      forced_.emplace(plc, features_, mesh.points, faces_, patches_, ForcedEdges::least_cosine_of_sides);
    find_creases_at_points(plc);
  }

  double smallest(Index tet) const {
    const auto& corners = mesh_.tets[tet];
    double least = bounds_.thin_angle;
    if (!at_point_.empty())
      for (const Index v : corners) least = std::min(least, at_point_[v]);
    if (!forced_) return least;
    const auto& p = mesh_.points;
    const std::array<Point, 4> places{p[corners[0]], p[corners[1]], p[corners[2]], p[corners[3]]};
    return std::min(
        least, ForcedEdges::smallest_angle(forced_->narrowness(places, corners)) / bounds_.tets_across());
  }

 private:
  Index wall_of(Index v) const { return v < walls_.size() && walls_[v] != none ? walls_[v] : v; }

  /// Finds the sides of tets that bound the core or lie on patches, each with its patch. A side above layers
  /// counts as lying on the wall below them.
  void find_surface() {
    std::vector<CellSide> sides;
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      if (mesh_.layers.tet_layer.empty() || mesh_.layers.tet_layer[t] == 0)
        for (unsigned corner = 0; corner < 4; ++corner)
          sides.push_back(side_of(side_corners(mesh_.tets[t], corner), t, Kind::tet));
    std::sort(sides.begin(), sides.end(),
              [](const CellSide& a, const CellSide& b) { return a.corners < b.corners; });
    std::vector<std::pair<std::array<Index, 4>, Index>> patches;
    for (Index f = 0; f < mesh_.faces.size(); ++f)
      patches.emplace_back(side_of(mesh_.faces[f], f, Kind::face).corners, mesh_.face_patch[f]);
    std::sort(patches.begin(), patches.end());
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
      const auto& corners = sides[first].corners;
      for (last = first; last < sides.size() && sides[last].corners == corners;) ++last;
      const std::array<Index, 3> below{wall_of(corners[0]), wall_of(corners[1]), wall_of(corners[2])};
      const auto key = side_of(below, 0, Kind::face).corners;
      const auto found = std::lower_bound(patches.begin(), patches.end(), std::pair(key, Index{0}));
      const bool listed = found != patches.end() && found->first == key;
      if (last - first > 1 && !listed) continue;
      std::array<Index, 3> face{corners[0], corners[1], corners[2]};
      if (sides[first].turned) std::swap(face[1], face[2]);
      faces_.push_back(face);
      patches_.push_back(listed ? found->second : none);
    }
  }

  void find_creases_at_points(const Plc& plc) {
    std::vector<double> of_curve(plc.curves.size(), bounds_.thin_angle),
        of_vertex(plc.vertices.size(), bounds_.thin_angle);
    bool any = false;
    for (const Crease& crease : find_creases(plc, 2 * bounds_.tets_across() * bounds_.thin_angle)) {
      any = true;
      const double bound = 0.5 * crease.angle / bounds_.tets_across();
      const auto lower = [bound](double& least) { least = std::min(least, bound); };
      if (crease.vertex != none) lower(of_vertex[crease.vertex]);
      if (crease.curve == none) continue;
      lower(of_curve[crease.curve]);
      for (const Index end : plc.curves[crease.curve].ends)
        if (end != none) lower(of_vertex[end]);
    }
    if (!any) return;
    at_point_.assign(mesh_.points.size(), bounds_.thin_angle);
    for (Index v = 0; v < features_.size(); ++v) {
      const auto& [dimension, feature] = features_[v];
      if (feature == none || dimension > 1) continue;
      at_point_[v] = dimension == 1 ? of_curve[feature] : of_vertex[feature];
    }
  }

  const TetMesh& mesh_;
  const std::vector<Index>& walls_;
  const Bounds& bounds_;
  std::vector<TetMesh::VertexFeature> features_;
  std::vector<std::array<Index, 3>> faces_;
  std::vector<Index> patches_;
  std::optional<ForcedEdges> forced_;
  std::vector<double> at_point_;  // by point: lower bound on angles, smaller at sharp creases; empty if no
                                  // crease is sharp
};

}  // namespace

void check_core_angles(const TetMesh& mesh, const std::vector<Index>& walls, const Plc& plc,
                       const Bounds& bounds, CheckReport& report) {
  constexpr std::size_t listed = 20;
  constexpr double largest = largest_angle_of_thin_tets, slack = 1e-9;
  Findings findings(report, listed);
  const CoreAngles angles(mesh, walls, plc, bounds);
  report.tets = mesh.tets.size(), report.points = mesh.points.size();
  report.faces = mesh.faces.size(), report.edges = mesh.edges.size();
  report.min_dihedral = 180, report.max_dihedral = 0;
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    if (!mesh.layers.tet_layer.empty() && mesh.layers.tet_layer[t] != 0) continue;
    const auto& [a, b, c, d] = mesh.tets[t];
    const auto& p = mesh.points;
    const TetQuality quality = measure(p[a], p[b], p[c], p[d]);
    report.min_dihedral = std::min(report.min_dihedral, quality.min_dihedral);
    report.max_dihedral = std::max(report.max_dihedral, quality.max_dihedral);
    if (quality.radius_edge <= bounds.radius_edge * (1 + slack)) continue;
    const double widest = std::max(quality.max_dihedral, largest_face_angle(p[a], p[b], p[c], p[d]));
    if (widest <= largest * (1 + slack) && quality.min_dihedral >= bounds.thin_angle) continue;
    const double least = angles.smallest(t);
    if (widest <= largest * (1 + slack) && quality.min_dihedral >= least * (1 - slack)) continue;
    findings.add(
        guarantee::core_angles, p[a], {t},
        "Tet {} beside the layers at {} has dihedral angles from {:.4g} to {:.4g} degrees and face angles up "
        "to {:.4g}; {:.4g} to {} degrees are allowed, because circumradius / shortest edge is {:.4g}, above "
        "{:.4g}.",
        t, At{p[a]}, quality.min_dihedral, quality.max_dihedral, largest_face_angle(p[a], p[b], p[c], p[d]),
        least, largest, quality.radius_edge, bounds.radius_edge);
  }
}

std::map<Index, double> volumes_with_layers(const TetMesh& mesh) {
  std::map<Index, double> volumes;
  const auto& p = mesh.points;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    volumes[mesh.tet_region[t]] += six_volume(p[a], p[b], p[c], p[d]) / 6;
  }
  const LayerCells& layers = mesh.layers;
  for (std::size_t i = 0; i < layers.prisms.size(); ++i) {
    const auto& [a, b, c, d, e, f] = layers.prisms[i];
    volumes[layers.prism_region[i]] += volume_of(PrismCorners{p[a], p[b], p[c], p[d], p[e], p[f]});
  }
  for (std::size_t i = 0; i < layers.pyramids.size(); ++i) {
    const auto& [a, b, c, d, e] = layers.pyramids[i];
    volumes[layers.pyramid_region[i]] += volume_of(PyramidCorners{p[a], p[b], p[c], p[d], p[e]});
  }
  return volumes;
}

void check_layer_volumes(const std::map<Index, double>& before, const TetMesh& mesh,
                         const std::map<Index, double>& allowed, CheckReport& report) {
  constexpr std::size_t listed = 20;
  // A volume is a sum over cells; rounding changes each term by a few units in the last place.
  constexpr double rounding = 1e-9;
  Findings findings(report, listed);
  const auto now = volumes_with_layers(mesh);
  for (const auto& [region, volume] : before) {
    const auto found = now.find(region);
    const double reached = found == now.end() ? 0 : found->second;
    const auto more = allowed.find(region);
    const double most = rounding * std::fabs(volume) + (more == allowed.end() ? 0 : more->second);
    if (std::fabs(reached - volume) <= most) continue;
    findings.add(guarantee::layer_volume, {}, {region},
                 "The volume of region {} was {:.12g} before the layers and is {:.12g}; allowed is a "
                 "difference of {:.3g}.",
                 region, volume, reached, most);
  }
}

}  // namespace collarmesh::checks
