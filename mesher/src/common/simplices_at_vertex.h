#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "common/groups.h"

namespace collarmesh {

/// Calls `use(vertex, cells)` for the vertices of a mesh, by several threads at once and in no particular
/// order. `cells` are the tets of which the vertex is a corner but the largest one, by number, and the listed
/// faces of which it is the smallest, each in their order; faces are numbered after all tets.
/// Cost: linear; 24 bytes a tet.
template <class Use>
void for_each_vertex_with_cells(const TetMesh& mesh, const Use& use) {
  const std::size_t tets = mesh.tets.size();
  const auto visit = [&](std::size_t i, const auto& give) {
    if (i >= tets) {
      const auto& face = mesh.faces[i - tets];
      give(std::min({face[0], face[1], face[2]}), static_cast<Index>(i));
      return;
    }
    const auto& tet = mesh.tets[i];
    const Index largest = std::max({tet[0], tet[1], tet[2], tet[3]});
    for (const Index v : tet)
      if (v != largest) give(v, static_cast<Index>(i));
  };
  for_each_group<Index>(mesh.points.size(), tets + mesh.faces.size(), visit, use);
}

/// A side of a tet, or a listed face, by the numbers of its corners.
struct TriangleUse {
  static constexpr std::uint8_t listed_face = 4;

  std::uint64_t larger_corners;  ///< the middle one above 32 bits, and the largest
  Index cell;                    ///< the tet, or the face
  std::uint8_t corner;           ///< of the tet, opposite the side; or listed_face
  bool odd;  ///< is the order from smallest to largest an odd permutation of counterclockwise, seen from
             ///< outside the tet or from where the face's normal points?

  bool listed() const { return corner == listed_face; }
  Index middle() const { return static_cast<Index>(larger_corners >> 32U); }
  Index largest() const { return static_cast<Index>(larger_corners); }
};

/// The smallest corner, and the use of the triangle by `cell`. Corners: counterclockwise seen from outside the
/// tet or from where the face's normal points.
inline std::pair<Index, TriangleUse> triangle_use(std::array<Index, 3> c, Index cell, std::uint8_t corner) {
  bool odd = false;
  const auto sort_pair = [&](unsigned i, unsigned j) {
    if (c[i] <= c[j]) return;
    std::swap(c[i], c[j]);
    odd = !odd;
  };
  sort_pair(0, 1), sort_pair(1, 2), sort_pair(0, 1);
  return {c[0], {std::uint64_t{c[1]} << 32U | c[2], cell, corner, odd}};
}

/// The triangles of points of which a vertex is the smallest, each with the tets and listed faces that use it.
class TrianglesAtVertex {
 public:
  /// `cells` as `for_each_vertex_with_cells` gives them.
  void find(const TetMesh& mesh, Index vertex, std::span<const Index> cells) {
    clear(3 * cells.size());
    for (const Index cell : cells) {
      if (cell < mesh.tets.size()) {
        add_sides(mesh.tets[cell], cell, vertex);
        continue;
      }
      const auto face = static_cast<Index>(cell - mesh.tets.size());
      add(triangle_use(mesh.faces[face], face, TriangleUse::listed_face).second);
    }
  }
  void find(std::span<const TriangleUse> uses) {
    clear(uses.size());
    for (const TriangleUse& use : uses) add(use);
  }

  /// Calls `visit(uses)` for each; uses of one triangle are in the order in which they were given.
  template <class Visit>
  void for_each(const Visit& visit) {
    for (const Index first : first_) {
      together_.clear();
      for (Index i = first; i != none; i = uses_[i].next) together_.push_back(uses_[i].use);
      visit(std::span<const TriangleUse>(together_));
    }
  }

 private:
  static constexpr std::size_t least_slots = 64;
  struct Linked {
    TriangleUse use;
    Index next;  // of the same triangle
  };

  void clear(std::size_t most_uses) {
    uses_.clear();
    first_.clear();
    table_.assign(std::bit_ceil(std::max(least_slots, 2 * most_uses)), none);
  }

  // How corners compare cannot be foreseen: as few branches as possible depend on it.
  void add_sides(const std::array<Index, 4>& tet, Index cell, Index vertex) {
    // The places of the corners opposite each corner, counterclockwise from outside.
    constexpr std::array<std::array<std::uint8_t, 3>, 4> opposite{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
    const unsigned place = (tet[1] == vertex ? 1U : 0U) + (tet[2] == vertex ? 2U : 0U) + (tet[3] == vertex ? 3U : 0U);
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = tet[opposite[place][i]], b = tet[opposite[place][(i + 1) % 3]];
      const Index middle = std::min(a, b), largest = std::max(a, b);
      if (middle < vertex) continue;
      // Seen from outside the tet the vertex, a and b are clockwise.
      add({std::uint64_t{middle} << 32U | largest, cell, opposite[place][(i + 2) % 3], a < b});
    }
  }

  void add(const TriangleUse& use) {
    const auto added = static_cast<Index>(uses_.size());
    uses_.push_back({use, none});
    for (std::size_t slot = use.larger_corners * 0x9e3779b97f4a7c15U >> 32U;; ++slot) {
      Index& first = table_[slot & (table_.size() - 1)];
      if (first == none) {
        first = added;
        first_.push_back(added);
        return;
      }
      if (uses_[first].use.larger_corners != use.larger_corners) continue;
      Index last = first;
      while (uses_[last].next != none) last = uses_[last].next;
      uses_[last].next = added;
      return;
    }
  }

  std::vector<Linked> uses_;
  std::vector<Index> first_;  // of each triangle
  std::vector<Index> table_;  // the same by hash
  std::vector<TriangleUse> together_;
};

/// The edges from a vertex to larger ones.
class EdgesAtVertex {
 public:
  /// The other ends, each once, until the next call. `cells` as `for_each_vertex_with_cells` gives them.
  std::span<const Index> find(const TetMesh& mesh, Index vertex, std::span<const Index> cells) {
    ends_.clear();
    table_.assign(std::bit_ceil(std::max(least_slots, 4 * cells.size())), none);
    for (const Index cell : cells)
      if (cell < mesh.tets.size())
        for (const Index v : mesh.tets[cell])
          if (v > vertex) add(v);
    return ends_;
  }

 private:
  static constexpr std::size_t least_slots = 64;

  void add(Index v) {
    for (std::size_t slot = v * 0x9e3779b1U >> 8U;; ++slot) {
      Index& end = table_[slot & (table_.size() - 1)];
      if (end == v) return;
      if (end != none) continue;
      end = v;
      ends_.push_back(v);
      return;
    }
  }

  std::vector<Index> ends_, table_;
};

}  // namespace collarmesh
