#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::testing {

/// Prisms, pyramids and tets that conform. At z = 0 there are four quadrangles around one inner node. Below
/// them lie six prisms, of region 1; above them four pyramids, four tets between these, and a pyramid upside
/// down, of region 2. The quadrangles at z = 0 are the interface (tag 7); the boundary has the tag -5 below
/// and 6 above; four edges at z = 0 have the tag 11. `make_prisms` makes another mesh: eight prisms on a
/// square with a tet on each, without pyramids.
class LayerMesh {
 public:
  static constexpr double volume_below = 3, volume_above = 49.0 / 30;

  TetMesh make() {
    add_points();
    add_cells();
    list_sides();
    for (Index i = 0; i < 2; ++i)
      for (const Index j : {0U, 2U}) {
        mesh_.edges.push_back({ground(i, j), ground(i + 1, j)});
        mesh_.edge_curve.push_back(0);
        mesh_.edge_tag.push_back(11);
      }
    return mesh_;
  }

  TetMesh make_prisms() {
    for (const double z : {-1.0, -0.4})
      for (Index j = 0; j < 3; ++j)
        for (Index i = 0; i < 3; ++i) {
          const bool inner = z > -0.5 && i == 1 && j == 1;
          mesh_.points.push_back({i - 1.0 + (inner ? 0.1 : 0), j - 1.0 - (inner ? 0.07 : 0), z});
        }
    mesh_.points.push_back({0.2, 0.1, 1});
    constexpr Index above = 9, apex = 18;
    for (Index j = 0; j < 2; ++j)
      for (Index i = 0; i < 2; ++i) {
        const Index a = ground(i, j), b = ground(i + 1, j), c = ground(i + 1, j + 1), d = ground(i, j + 1);
        for (const std::array<Index, 3>& t : {std::array{a, b, c}, std::array{a, c, d}}) {
          add_prism({t[0], t[1], t[2], t[0] + above, t[1] + above, t[2] + above});
          add_tet({t[0] + above, t[1] + above, t[2] + above, apex}, 0);
        }
      }
    mesh_.tet_region.assign(mesh_.tets.size(), 1);
    mesh_.tet_tag.assign(mesh_.tets.size(), tag_of_region(1));
    for (auto& [key, sides] : sides_)
      for (Side& side : sides) side.region = 1;
    list_sides();
    return mesh_;
  }

  static constexpr Tag tag_of_region(Index region) { return region == 1 ? 20 : -4; }

 private:
  static Index ground(Index i, Index j) { return i + 3 * j; }
  static Index ridge(Index i, Index j) { return 9 + i + 2 * j; }
  static Index top(Index i, Index j) { return 15 + i + 2 * j; }

  void add_points() {
    for (Index j = 0; j < 3; ++j)
      for (Index i = 0; i < 3; ++i) {
        const bool inner = i == 1 && j == 1;
        mesh_.points.push_back({i - 1.0 + (inner ? 0.1 : 0), j - 1.0 - (inner ? 0.07 : 0), 0});
      }
    for (Index j = 0; j < 3; ++j)
      for (Index i = 0; i < 2; ++i) mesh_.points.push_back({i - 0.5, j - 1.0, -1});
    for (Index j = 0; j < 2; ++j)
      for (Index i = 0; i < 2; ++i) mesh_.points.push_back({i - 0.5, j - 0.5, 0.7});
  }

  void add_cells() {
    for (Index j = 0; j < 2; ++j) {
      for (Index i = 0; i < 2; ++i)
        add_prism({ground(i, j), ground(i + 1, j), ridge(i, j), ground(i, j + 1), ground(i + 1, j + 1),
                   ridge(i, j + 1)});
      add_prism({ground(1, j), ridge(1, j), ridge(0, j), ground(1, j + 1), ridge(1, j + 1), ridge(0, j + 1)});
    }
    for (Index j = 0; j < 2; ++j)
      for (Index i = 0; i < 2; ++i)
        add_pyramid({ground(i, j), ground(i + 1, j), ground(i + 1, j + 1), ground(i, j + 1), top(i, j)}, 2);
    add_pyramid({top(0, 0), top(0, 1), top(1, 1), top(1, 0), ground(1, 1)}, 3);
    add_tet({ground(1, 0), ground(1, 1), top(0, 0), top(1, 0)}, 2);
    add_tet({ground(1, 1), ground(1, 2), top(0, 1), top(1, 1)}, 2);
    add_tet({ground(0, 1), ground(1, 1), top(0, 0), top(0, 1)}, 0);
    add_tet({ground(1, 1), ground(2, 1), top(1, 0), top(1, 1)}, 0);
  }

  double volume_of(Index a, Index b, Index c, Index d) const {
    return six_volume(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]);
  }

  void add_tet(std::array<Index, 4> t, std::uint16_t layer) {
    if (volume_of(t[0], t[1], t[2], t[3]) < 0) std::swap(t[2], t[3]);
    mesh_.tets.push_back(t);
    mesh_.tet_region.push_back(2);
    mesh_.tet_tag.push_back(tag_of_region(2));
    mesh_.tet_collar.push_back(0);
    mesh_.tet_crease.push_back(0);
    mesh_.layers.tet_layer.push_back(layer);
    add_sides(t, {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}, 2);
  }
  void add_prism(std::array<Index, 6> p) {
    if (volume_of(p[0], p[1], p[2], p[3]) < 0) {
      std::swap(p[1], p[2]);
      std::swap(p[4], p[5]);
    }
    mesh_.layers.prisms.push_back(p);
    mesh_.layers.prism_region.push_back(1);
    mesh_.layers.prism_tag.push_back(tag_of_region(1));
    mesh_.layers.prism_layer.push_back(1);
    add_sides(p, {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}, 1);
  }
  void add_pyramid(std::array<Index, 5> p, std::uint16_t layer) {
    if (volume_of(p[0], p[1], p[2], p[4]) < 0) std::swap(p[1], p[3]);
    mesh_.layers.pyramids.push_back(p);
    mesh_.layers.pyramid_region.push_back(2);
    mesh_.layers.pyramid_tag.push_back(tag_of_region(2));
    mesh_.layers.pyramid_layer.push_back(layer);
    add_sides(p, {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}, 2);
  }

  struct Side {
    std::vector<Index> corners;
    Index region;
  };

  template <class Cell>
  void add_sides(const Cell& cell, const std::vector<std::vector<std::size_t>>& places, Index region) {
    for (const auto& of_side : places) {
      Side side{{}, region};
      for (const std::size_t place : of_side) side.corners.push_back(cell[place]);
      std::vector<Index> key = side.corners;
      std::sort(key.begin(), key.end());
      sides_[key].push_back(side);
    }
  }

  /// Lists the sides that only one cell has, and the sides between the regions.
  void list_sides() {
    for (const auto& [key, sides] : sides_) {
      if (sides.size() == 2 && sides[0].region == sides[1].region) continue;
      const Index region = sides[0].region, other = sides.size() == 2 ? sides[1].region : 0;
      const Index patch = other != 0 ? 2 : region - 1;
      constexpr std::array<Tag, 3> tags{-5, 6, 7};
      const auto& c = sides[0].corners;
      if (c.size() == 3) {
        mesh_.faces.push_back({c[0], c[1], c[2]});
        mesh_.face_regions.push_back({region, other});
        mesh_.face_patch.push_back(patch);
        mesh_.face_tag.push_back(tags[patch]);
      } else {
        mesh_.layers.quads.push_back({c[0], c[1], c[2], c[3]});
        mesh_.layers.quad_regions.push_back({region, other});
        mesh_.layers.quad_patch.push_back(patch);
        mesh_.layers.quad_tag.push_back(tags[patch]);
      }
    }
  }

  TetMesh mesh_;
  std::map<std::vector<Index>, std::vector<Side>> sides_;
};

inline TetMesh layer_mesh() { return LayerMesh().make(); }
inline TetMesh mesh_of_prisms() { return LayerMesh().make_prisms(); }

}  // namespace collarmesh::testing
