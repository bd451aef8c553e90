#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::testing {

/// A box of two regions, one above the other, with all data that a mesh can have: 12 n^3 tets, tagged patches
/// (one tag is 0, one negative), curves and vertices with their features, some collar tets, coordinates that
/// need all 53 bits.
class SampleMesh {
 public:
  explicit SampleMesh(Index n) : n_(n) {}

  TetMesh make() {
    add_points();
    for (Index z = 0; z < 2 * n_; ++z)
      for (Index y = 0; y < n_; ++y)
        for (Index x = 0; x < n_; ++x) add_cube({x, y, z});
    for (const auto& [edge, curve] : edges_) {
      mesh_.edges.push_back(edge);
      mesh_.edge_curve.push_back(curve);
      mesh_.edge_tag.push_back(7 + static_cast<Tag>(curve));
    }
    return mesh_;
  }

  static constexpr Tag tag_of_region(Index region) { return region == 1 ? 20 : -4; }
  static constexpr Tag tag_of_patch(Index patch) { return static_cast<Tag>(patch) * 3 - 3; }

 private:
  using Grid = std::array<Index, 3>;

  Index index(const Grid& g) const { return g[0] + (n_ + 1) * (g[1] + (n_ + 1) * g[2]); }
  Grid grid(Index point) const {
    return {point % (n_ + 1), point / (n_ + 1) % (n_ + 1), point / (n_ + 1) / (n_ + 1)};
  }

  /// Returns the planes that a grid point lies on, as bits: x 0 and 1, y 2 and 3, z 4 (bottom), 5
  /// (interface), 6 (top).
  unsigned planes(const Grid& g) const {
    unsigned bits = 0;
    for (unsigned axis = 0; axis < 2; ++axis)
      bits |= (g[axis] == 0 ? 1U : 0U) << 2 * axis | (g[axis] == n_ ? 1U : 0U) << (2 * axis + 1);
    return bits | (g[2] == 0 ? 16U : 0U) | (g[2] == n_ ? 32U : 0U) | (g[2] == 2 * n_ ? 64U : 0U);
  }

  /// Returns the number of the feature on these planes. Upright features are divided into a lower and an
  /// upper half.
  Index feature(unsigned plane_bits, bool upper) {
    const bool upright = (plane_bits & 0x70U) == 0;
    const unsigned key = plane_bits | (upright && upper ? 128U : 0U);
    int dimension = 3;
    for (unsigned bits = plane_bits; bits != 0; bits &= bits - 1) --dimension;
    return features_[dimension]
        .try_emplace(key, static_cast<Index>(features_[dimension].size()))
        .first->second;
  }

  void add_points() {
    for (Index i = 0; i < (n_ + 1) * (n_ + 1) * (2 * n_ + 1); ++i) {
      const Grid g = grid(i);
      mesh_.points.push_back({g[0] / 3.0, g[1] * 0.1 + 1e-17, (g[2] + 1.0 / 7) * 0.3});
      const unsigned bits = planes(g);
      TetMesh::VertexFeature f;
      for (unsigned rest = bits; rest != 0; rest &= rest - 1) --f.dimension;
      if (bits != 0) f.feature = feature(bits, g[2] > n_);
      mesh_.features.push_back(f);
    }
  }

  void add_cube(const Grid& low) {
    std::array<unsigned, 3> axes{0, 1, 2};
    do {
      std::array<Index, 4> tet;
      Grid at = low;
      for (unsigned k = 0; k < 4; ++k) {
        tet[k] = index(at);
        if (k < 3) ++at[axes[k]];
      }
      const auto& p = mesh_.points;
      if (six_volume(p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]]) < 0) std::swap(tet[2], tet[3]);
      add_tet(tet, low[2] < n_ ? 1 : 2);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }

  void add_tet(const std::array<Index, 4>& t, Index region) {
    mesh_.tet_collar.push_back(static_cast<std::uint8_t>(mesh_.tets.size() % 3));
    mesh_.tet_crease.push_back(mesh_.tet_collar.back() == 0 ? 0
                                                            : 7 - static_cast<Tag>(mesh_.tets.size() % 11));
    mesh_.tet_thin.push_back(static_cast<std::uint8_t>(mesh_.tets.size() % 2));
    mesh_.tets.push_back(t);
    mesh_.tet_region.push_back(region);
    mesh_.tet_tag.push_back(tag_of_region(region));
    for (const auto& [a, b, c] :
         {std::array{1, 2, 3}, std::array{0, 3, 2}, std::array{0, 1, 3}, std::array{0, 2, 1}}) {
      const auto k = [&t](int i) { return t[static_cast<std::size_t>(i)]; };
      add_face({k(a), k(b), k(c)}, region);
    }
    for (unsigned i = 0; i < 4; ++i)
      for (unsigned j = 0; j < i; ++j) add_edge(std::min(t[i], t[j]), std::max(t[i], t[j]), region);
  }

  void add_face(const std::array<Index, 3>& face, Index region) {
    unsigned bits = 127;
    for (const Index v : face) bits &= planes(grid(v));
    const bool interface = (bits & 32U) != 0;
    if (bits == 0 || (interface && region == 2)) return;
    mesh_.faces.push_back(face);
    mesh_.face_regions.push_back({region, interface ? 2U : 0U});
    mesh_.face_patch.push_back(feature(bits, region == 2));
    mesh_.face_tag.push_back(tag_of_patch(mesh_.face_patch.back()));
  }

  void add_edge(Index a, Index b, Index region) {
    const unsigned bits = planes(grid(a)) & planes(grid(b));
    if ((bits & (bits - 1)) != 0) edges_.try_emplace({a, b}, feature(bits, region == 2));
  }

  Index n_;
  TetMesh mesh_;
  std::map<unsigned, Index> features_[4];
  std::map<std::array<Index, 2>, Index> edges_;
};

inline TetMesh sample_mesh(Index n = 2) { return SampleMesh(n).make(); }

}  // namespace collarmesh::testing
