#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "common/edge_key.h"
#include "common/flat_table.h"
#include "common/groups.h"
#include "common/tet_sides.h"

namespace collarmesh {

/// Returns whether no corner of a tet occurs twice.
inline bool all_differ(const std::array<Index, 4>& t) {
  return t[0] != t[1] && t[0] != t[2] && t[0] != t[3] && t[1] != t[2] && t[1] != t[3] && t[2] != t[3];
}

/// Calls `use(vertex, cells)` for the vertices of a mesh, from several threads at once and in no particular
/// order. `cells` are first the tets that have the vertex and a corner with a larger number, then the listed
/// faces in which the vertex has the smallest number; both in the order of the mesh. Faces are numbered after
/// all tets. Precondition: corners are points of the mesh. Cost: linear; 24 bytes per tet.
template <class Use>
void for_each_vertex_with_cells(const TetMesh& mesh, const Use& use) {
  const std::size_t tets = mesh.tets.size();
  assert(tets + mesh.faces.size() < none);
  const auto visit = [&](std::size_t i, const auto& give) {
    if (i >= tets) {
      const auto& face = mesh.faces[i - tets];
      give(std::min({face[0], face[1], face[2]}), static_cast<Index>(i));
      return;
    }
    const auto& tet = mesh.tets[i];
    const Index largest = std::max({tet[0], tet[1], tet[2], tet[3]});
    assert(largest < mesh.points.size());
    for (const Index v : tet)
      if (v != largest) give(v, static_cast<Index>(i));
  };
  for_each_group<Index>(mesh.points.size(), tets + mesh.faces.size(), visit, use);
}

/// The edges from a vertex to vertices with larger numbers.
class EdgesAtVertex {
 public:
  /// Finds the edges. `cells` as from `for_each_vertex_with_cells`.
  void find(const TetMesh& mesh, Index vertex, std::span<const Index> cells) {
    clear(cells.size());
    for (const Index cell : cells)
      if (cell < mesh.tets.size())
        for (const Index v : mesh.tets[cell])
          if (v > vertex) number_of(v);
  }

  /// Returns the other ends of the edges, each once.
  std::span<const Index> ends() const { return ends_; }

 protected:
  void clear(std::size_t cells) {
    ends_.clear();
    table_.assign(std::bit_ceil(std::max(least_slots, 4 * cells)), none);
  }

  /// Returns the number of an end; a new end gets the next number.
  Index number_of(Index end) {
    Index& number = find_slot(table_, spread(end), [&](Index n) { return ends_[n] == end; });
    if (number == none) {
      number = static_cast<Index>(ends_.size());
      ends_.push_back(end);
    }
    return number;
  }

 private:
  static constexpr std::size_t least_slots = 64;

  std::vector<Index> ends_;
  std::vector<Index> table_;  // hash table of the numbers of ends
};

/// The edges from a vertex to vertices with larger numbers, and whether the tets at the vertex fit together.
class FittingTetsAtVertex : public EdgesAtVertex {
 public:
  /// Finds the edges and checks the tets. `cells` as from `for_each_vertex_with_cells`. Precondition: no tet
  /// has a corner twice.
  void find(const TetMesh& mesh, Index vertex, std::span<const Index> cells) {
    clear(cells.size());
    fit_ = cells.size() < counterclockwise;
    for (const Index cell : cells) {
      if (cell >= mesh.tets.size()) {
        fit_ = false;
        continue;
      }
      assert(all_differ(mesh.tets[cell]));
      fit_ &= mesh.tet_region[cell] == mesh.tet_region[cells[0]];
      add_tet(mesh.tets[cell], vertex);
    }
    fit_ &= ends().size() <= most_counted;
    fit_ &= take_counts();
  }

  /// Returns whether each triangle in which the vertex has the smallest number is a side of two tets of one
  /// region, one on either side, and is not a listed face. Also returns false if more than 32 edges, or 256
  /// cells or more, were found: these are too many to count.
  bool fit() const { return fit_; }

 private:
  static constexpr std::size_t most_counted = 32;
  static constexpr std::uint16_t clockwise = 1, counterclockwise = 1 << 8U;

  void add_tet(const std::array<Index, 4>& tet, Index vertex) {
    std::array<Index, 3> number{};
    const auto others = side_corners(tet, place_of(vertex, tet));
    for (unsigned i = 0; i < 3; ++i) number[i] = others[i] > vertex ? number_of(others[i]) : none;
    // The vertex, a and b are clockwise as seen from outside the tet.
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = number[i], b = number[(i + 1) % 3];
      if (std::max(a, b) >= most_counted) continue;
      counts_[std::min(a, b)][std::max(a, b)] += a < b ? clockwise : counterclockwise;
    }
  }

  // Returns whether each triangle has a tet on either side. Resets all counts to zero.
  bool take_counts() {
    unsigned amiss = 0;
    for (std::size_t row = 0; row < std::min(ends().size(), most_counted); ++row)
      for (std::uint16_t& count : counts_[row]) {
        amiss |= (count != 0) & (count != (clockwise | counterclockwise));
        count = 0;
      }
    return amiss == 0;
  }

  std::array<std::array<std::uint16_t, most_counted>, most_counted> counts_{};  // by numbers of ends
  bool fit_ = false;
};

/// The use of a triangle by a cell: as a side of a tet, or as a listed face.
struct TriangleUse {
  static constexpr std::uint8_t listed_face = 4;

  std::uint64_t larger_corners;  ///< upper 32 bits: the middle corner; lower ones: the largest corner
  Index cell;                    ///< the tet, or the face
  std::uint8_t corner;           ///< the tet's corner opposite the side, or listed_face
  bool odd;  ///< whether the order from smallest to largest is an odd permutation of the counterclockwise
             ///< order, as seen from outside the tet or from where the face's normal points

  bool listed() const { return corner == listed_face; }
  Index middle() const { return static_cast<Index>(larger_corners >> 32U); }
  Index largest() const { return static_cast<Index>(larger_corners); }
};

/// Returns the corner with the smallest number, and the use of the triangle by `cell`. Precondition: the
/// corners `c` are counterclockwise as seen from outside the tet or from where the face's normal points.
inline std::pair<Index, TriangleUse> triangle_use(std::array<Index, 3> c, Index cell, std::uint8_t corner) {
  bool odd = false;
  const auto sort_pair = [&](unsigned i, unsigned j) {
    if (c[i] <= c[j]) return;
    std::swap(c[i], c[j]);
    odd = !odd;
  };
  sort_pair(0, 1), sort_pair(1, 2), sort_pair(0, 1);
  return {c[0], {pair_key(c[1], c[2]), cell, corner, odd}};
}

/// The triangles in which a given vertex has the smallest number; each with the tets and listed faces that
/// use the triangle.
class TrianglesAtVertex {
 public:
  /// Finds the triangles. `cells` as from `for_each_vertex_with_cells`. Precondition: no tet has a corner
  /// twice.
  void find(const TetMesh& mesh, Index vertex, std::span<const Index> cells) {
    clear(3 * cells.size());
    for (const Index cell : cells) {
      if (cell < mesh.tets.size()) {
        assert(all_differ(mesh.tets[cell]));
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

  /// Calls `visit(uses)` for each triangle; its uses are in the order in which they were given.
  template <class Visit>
  void for_each(const Visit& visit) {
    for (const Listed& list : lists_) {
      together_.clear();
      for (Index i = list.first; i != none; i = uses_[i].next) together_.push_back(uses_[i].use);
      visit(std::span<const TriangleUse>(together_));
    }
  }

 private:
  static constexpr std::size_t least_slots = 64;
  struct Linked {
    TriangleUse use;
    Index next;  // next use of the same triangle
  };
  struct Listed {  // uses of one triangle
    Index first, last;
  };

  void clear(std::size_t most_uses) {
    uses_.clear();
    lists_.clear();
    table_.assign(std::bit_ceil(std::max(least_slots, 2 * most_uses)), none);
  }

  // As few branches as possible depend on the order of the corners, which processors cannot predict.
  void add_sides(const std::array<Index, 4>& tet, Index cell, Index vertex) {
    const auto& places = opposite_places[place_of(vertex, tet)];
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = tet[places[i]], b = tet[places[(i + 1) % 3]];
      const Index middle = std::min(a, b), largest = std::max(a, b);
      if (middle < vertex) continue;
      // The vertex, a and b are clockwise as seen from outside the tet.
      add({pair_key(middle, largest), cell, places[(i + 2) % 3], a < b});
    }
  }

  void add(const TriangleUse& use) {
    const auto added = static_cast<Index>(uses_.size());
    uses_.push_back({use, none});
    Index& number = find_slot(table_, spread(use.larger_corners), [&](Index n) {
      return uses_[lists_[n].first].use.larger_corners == use.larger_corners;
    });
    if (number == none) {
      number = static_cast<Index>(lists_.size());
      lists_.push_back({added, added});
      return;
    }
    Listed& list = lists_[number];
    uses_[list.last].next = added;
    list.last = added;
  }

  std::vector<Linked> uses_;
  std::vector<Listed> lists_;
  std::vector<Index> table_;  // hash table of the numbers of lists
  std::vector<TriangleUse> together_;
};

}  // namespace collarmesh
