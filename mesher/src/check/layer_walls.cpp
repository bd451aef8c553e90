// Checks that cells of layers and triangles of walls fit together: the wall's nodes below a cell tell on
// which triangle the cell lies.
#include "check/layer_walls.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string_view>
#include <tuple>

#include "check/findings.h"
#include "common/edge_key.h"
#include "common/sort_uniquely.h"

namespace collarmesh::checks {

namespace {

bool is_lower(const Point& a, const Point& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

template <std::size_t n>
bool are_lower(const std::array<Point, n>& a, const std::array<Point, n>& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), is_lower);
}

bool comes_before(const WallGeometry::Triangle& a, const WallGeometry::Triangle& b) {
  return a.patch != b.patch ? a.patch < b.patch : are_lower(a.corners, b.corners);
}

bool comes_before(const WallGeometry::MidNode& a, const WallGeometry::MidNode& b) {
  return are_lower(a.ends, b.ends);
}

bool comes_before(const WallGeometry::Edge& a, const WallGeometry::Edge& b) {
  return a.curve != b.curve ? a.curve < b.curve : are_lower(a.ends, b.ends);
}

constexpr unsigned weight_of_prism = 3, weight_of_pyramid = 2;

/// A cell of a layer. Its weight is the number of tets into which it can be divided.
struct LayerCell {
  std::array<Index, 3> below{};  // the wall's nodes below the cell, sorted
  Index region = none, layer = 0;
  unsigned weight = 0;
  Index cell = none;
  bool has_base = false;  // whether the nodes of the wall are corners of the cell
  Point middle;
};

/// One of the two sides of a wall's triangle.
struct WallSide {
  std::array<Index, 3> corners{};  // sorted
  Index region = none, face = none;
  bool in_front = false;  // whether this is the side to which the triangle's normal points
  unsigned count = 0;
};

bool lies_below(const LayerCell& a, const LayerCell& b) {
  return std::tie(a.below, a.region, a.layer, a.weight, a.cell) <
         std::tie(b.below, b.region, b.layer, b.weight, b.cell);
}

class WallCheck {
 public:
  WallCheck(const AskedWalls& walls, const TetMesh& mesh, const LayersReport& layers, Findings& findings)
      : walls_(walls), mesh_(mesh), layers_(layers), findings_(findings) {}

  void check_geometry(const WallGeometry& before) {
    const WallGeometry now(mesh_, walls_);
    report_difference(before.triangles, now.triangles, "triangle",
                      [](const auto& triangle) { return triangle.corners[0]; });
    report_difference(before.edges, now.edges, "edge", [](const auto& edge) { return edge.ends[0]; });
  }

  /// Checks that mid-edge nodes of walls stay. `straightened`: nodes that may have moved.
  void check_mid_nodes(const WallGeometry& before,
                       std::span<const SecondOrderReport::Straightened> straightened) {
    constexpr double rounding = 1e-9;
    std::vector<std::uint64_t> allowed;
    for (const auto& node : straightened) allowed.push_back(edge_key(node.edge[0], node.edge[1]));
    std::sort(allowed.begin(), allowed.end());
    const WallGeometry now(mesh_, walls_);
    auto then = before.mid_nodes.begin();
    for (const WallGeometry::MidNode& node : now.mid_nodes) {
      then = std::find_if(then, before.mid_nodes.end(),
                          [&node](const auto& other) { return !comes_before(other, node); });
      if (then == before.mid_nodes.end()) return;  // the walls differ, which is reported elsewhere
      const double off = distance(then->place, node.place);
      if (then->ends != node.ends || off <= rounding * distance(node.ends[0], node.ends[1]) ||
          std::binary_search(allowed.begin(), allowed.end(), edge_key(node.edge[0], node.edge[1])))
        continue;
      findings_.add(guarantee::layer_walls, node.place, {node.edge[0], node.edge[1]},
                    "The mid-edge node of the wall's edge from point {} to {}, at {}, moved by {:.3g} when "
                    "the layers were made.",
                    node.edge[0], node.edge[1], At{node.place}, off);
    }
  }

  void check_cells() {
    collect_cells();
    collect_sides();
    std::size_t next = 0;
    for (std::size_t first = 0, last = 0; first < sides_.size(); first = last) {
      const WallSide& side = sides_[first];
      for (last = first; last < sides_.size() && is_same(sides_[last], side);) ++last;
      const auto is_past = [&side](const LayerCell& cell) {
        return std::tie(cell.below, cell.region) > std::tie(side.corners, side.region);
      };
      for (; next < cells_.size() &&
             std::tie(cells_[next].below, cells_[next].region) < std::tie(side.corners, side.region);
           ++next)
        report_no_wall(cells_[next]);
      std::size_t end = next;
      while (end < cells_.size() && !is_past(cells_[end])) ++end;
      check_stack({&side, last - first}, {cells_.data() + next, end - next});
      next = end;
    }
    for (; next < cells_.size(); ++next) report_no_wall(cells_[next]);
  }

  void check_areas() {
    for (const LayersReport::Patch& patch : layers_.patches) {
      const Areas of = areas_[patch.tag];
      constexpr double rounding = 1e-9;
      if (std::fabs(of.all - patch.area) <= rounding * of.all &&
          std::fabs(of.covered - patch.covered) <= rounding * of.all)
        continue;
      findings_.add(
          guarantee::layer_walls, {}, {},
          "Layers cover {:.9g} of the area {:.9g} of patch {}, but the report says {:.9g} of {:.9g}.",
          of.covered, of.all, patch.tag, patch.covered, patch.area);
    }
  }

 private:
  struct Areas {
    double all = 0, covered = 0;
  };

  static bool is_same(const WallSide& a, const WallSide& b) {
    return a.corners == b.corners && a.region == b.region;
  }

  /// Reports the first entry of each list that the other list lacks.
  template <class Entry, class Place>
  void report_difference(const std::vector<Entry>& before, const std::vector<Entry>& now,
                         std::string_view kind, const Place& place) {
    const auto report = [&](const std::vector<Entry>& some, const std::vector<Entry>& others,
                            std::string_view what) {
      for (std::size_t i = 0, k = 0; i < some.size(); ++i) {
        while (k < others.size() && comes_before(others[k], some[i])) ++k;
        if (k < others.size() && !comes_before(some[i], others[k])) continue;
        findings_.add(guarantee::layer_walls, place(some[i]), {}, "The {} of a wall at {} {}.", kind,
                      At{place(some[i])}, what);
        return;
      }
    };
    report(before, now, "is no longer there");
    report(now, before, "was not there before the layers");
  }

  Index below(Index node) const { return node < layers_.walls.size() ? layers_.walls[node] : none; }

  template <std::size_t n>
  void collect(const std::array<Index, n>& corners, Index region, Index layer, unsigned weight, Index cell) {
    LayerCell found;
    std::vector<Index> nodes, base;
    for (const Index v : corners) {
      found.middle = found.middle + mesh_.points[v] / static_cast<double>(n);
      nodes.push_back(below(v));
      if (nodes.back() == v) base.push_back(v);
    }
    sort_uniquely(nodes);
    found.region = region, found.layer = layer, found.weight = weight, found.cell = cell;
    if (nodes.size() == 3 && nodes.back() != none) {
      std::copy(nodes.begin(), nodes.end(), found.below.begin());
      found.has_base = base.size() == 3;
      cells_.push_back(found);
    } else {
      report_no_wall(found);
    }
  }

  void collect_cells() {
    const LayerCells& cells = mesh_.layers;
    for (Index c = 0; c < cells.prisms.size(); ++c)
      collect(cells.prisms[c], cells.prism_region[c], cells.prism_layer[c], weight_of_prism, c);
    for (Index c = 0; c < cells.pyramids.size(); ++c)
      collect(cells.pyramids[c], cells.pyramid_region[c], cells.pyramid_layer[c], weight_of_pyramid, c);
    for (Index t = 0; t < cells.tet_layer.size(); ++t)
      if (cells.tet_layer[t] > 0) collect(mesh_.tets[t], mesh_.tet_region[t], cells.tet_layer[t], 1, t);
    std::sort(cells_.begin(), cells_.end(), lies_below);
  }

  void collect_sides() {
    for (Index f = 0; f < mesh_.faces.size(); ++f)
      for (unsigned k = 0; k < 2; ++k)
        if (const auto wall = walls_.find({mesh_.face_patch[f], mesh_.face_regions[f][k]});
            wall != walls_.end()) {
          WallSide side{mesh_.faces[f], wall->first.second, f, k == 1, wall->second};
          std::sort(side.corners.begin(), side.corners.end());
          sides_.push_back(side);
          areas_[mesh_.face_tag[f]].all += area(f);
        }
    std::sort(sides_.begin(), sides_.end(), [](const WallSide& a, const WallSide& b) {
      return std::tie(a.corners, a.region, a.in_front) < std::tie(b.corners, b.region, b.in_front);
    });
  }

  Vector normal(Index face) const {
    const auto& [a, b, c] = mesh_.faces[face];
    return cross(mesh_.points[b] - mesh_.points[a], mesh_.points[c] - mesh_.points[a]);
  }
  double area(Index face) const { return 0.5 * norm(normal(face)); }

  /// Checks the cells in one region above one triangle: above one side of the triangle or, if the triangle
  /// lies inside the region, above both.
  void check_stack(std::span<const WallSide> sides, std::span<const LayerCell> cells) {
    std::vector<unsigned> weights(sides[0].count + std::size_t{1}, 0);  // by layer
    std::array<unsigned, 2> first{};                                    // weights in the first layer, by side
    unsigned bases = 0;
    for (const LayerCell& cell : cells) {
      if (cell.layer > sides[0].count) {
        report(sides[0], "has a cell in a layer that was not asked for");
        return;
      }
      weights[cell.layer] += cell.weight;
      if (cell.layer != 1) continue;
      const Vector to_cell = cell.middle - mesh_.points[mesh_.faces[sides[0].face][0]];
      const bool in_front = dot(to_cell, normal(sides[0].face)) > 0;
      first[in_front ? 1 : 0] += cell.weight;
      if (cell.has_base) ++bases;
    }
    for (std::size_t layer = 2; layer < weights.size(); ++layer)
      if (weights[layer] != weights[1]) {
        report(sides[0], "has cells in one layer that differ from those in the first layer");
        return;
      }
    unsigned expected_bases = 0;
    for (const WallSide& side : sides) {
      unsigned& weight = first[side.in_front ? 1 : 0];
      if (weight > 0) ++expected_bases;
      if (weight > weight_of_prism) report(side, "has more cells in a layer than a prism is divided into");
      if (weight == weight_of_prism) areas_[mesh_.face_tag[side.face]].covered += area(side.face);
      weight = 0;
    }
    if (first != std::array<unsigned, 2>{}) report(sides[0], "has cells on the wrong side");
    if (bases != expected_bases)
      report(sides[0], "must be the base of exactly one cell on each side that has layers");
  }

  void report(const WallSide& side, std::string_view what) {
    const Point& where = mesh_.points[side.corners[0]];
    findings_.add(guarantee::layer_walls, where, {side.face}, "The wall's triangle {} at {} {}.", side.face,
                  At{where}, what);
  }

  void report_no_wall(const LayerCell& cell) {
    constexpr std::array<std::string_view, 4> names{"", "tet", "pyramid", "prism"};
    findings_.add(guarantee::layer_walls, cell.middle, {cell.cell},
                  "The {} {} of layer {} at {} lies on no triangle on which layers were asked for.",
                  names[cell.weight], cell.cell, cell.layer, At{cell.middle});
  }

  const AskedWalls& walls_;
  const TetMesh& mesh_;
  const LayersReport& layers_;
  Findings& findings_;
  std::vector<LayerCell> cells_;
  std::vector<WallSide> sides_;
  std::map<Tag, Areas> areas_;
};

}  // namespace

WallGeometry::WallGeometry(const TetMesh& mesh, const AskedWalls& walls) {
  std::vector<std::uint64_t> sides;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const Index patch = mesh.face_patch[f];
    const auto wall = walls.lower_bound({patch, 0});
    if (wall == walls.end() || wall->first.first != patch) continue;
    const auto& [a, b, c] = mesh.faces[f];
    for (const std::uint64_t side : {edge_key(a, b), edge_key(b, c), edge_key(c, a)}) sides.push_back(side);
    Triangle triangle{{mesh.points[a], mesh.points[b], mesh.points[c]}, patch, f};
    std::rotate(triangle.corners.begin(),
                std::min_element(triangle.corners.begin(), triangle.corners.end(), is_lower),
                triangle.corners.end());
    triangles.push_back(triangle);
    for (unsigned k = 0; k < 3 && f < mesh.face_mid_nodes.size(); ++k) {
      std::array<Index, 2> edge{mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]};
      if (is_lower(mesh.points[edge[1]], mesh.points[edge[0]])) std::swap(edge[0], edge[1]);
      mid_nodes.push_back({{mesh.points[edge[0]], mesh.points[edge[1]]},
                           mesh.points[mesh.face_mid_nodes[f][k]],
                           edge,
                           mesh.face_mid_nodes[f][k]});
    }
  }
  std::sort(sides.begin(), sides.end());
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    const auto& [a, b] = mesh.edges[e];
    if (!std::binary_search(sides.begin(), sides.end(), edge_key(a, b))) continue;
    Edge edge{{mesh.points[a], mesh.points[b]}, mesh.edge_curve[e], e};
    if (is_lower(edge.ends[1], edge.ends[0])) std::swap(edge.ends[0], edge.ends[1]);
    edges.push_back(edge);
  }
  const auto order = [](const auto& a, const auto& b) { return comes_before(a, b); };
  std::sort(triangles.begin(), triangles.end(), order);
  std::sort(edges.begin(), edges.end(), order);
  std::sort(mid_nodes.begin(), mid_nodes.end(), order);
}

void check_layer_walls(const AskedWalls& walls, const WallGeometry& before, const TetMesh& mesh,
                       const LayersReport& layers, CheckReport& report,
                       std::span<const SecondOrderReport::Straightened> straightened) {
  constexpr std::size_t listed = 20;
  Findings findings(report, listed);
  WallCheck check(walls, mesh, layers, findings);
  check.check_geometry(before);
  check.check_mid_nodes(before, straightened);
  check.check_cells();
  check.check_areas();
}

}  // namespace collarmesh::checks
