#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "coarsen/coarsening_rule.h"
#include "improve/operations.h"

namespace collarmesh::coarsening {

/// The contractions of one vertex that the lengths of edges allow, as the mesh is.
struct VertexProposal {
  improvement::Change change;  ///< onto the nearest by the size that shapes allow, too; else none
  std::vector<improvement::Change> to_repair;  ///< onto each one, with tets that have to be improved
  double floor = 0;                            ///< no tet may get worse than this by repairs
  /// The tets at the vertex and at these are all that this depends on. None inside regions, where no link
  /// condition is asked about.
  std::vector<Index> read;
};

/// When vertices, or tets at them, were changed.
struct Changes {
  std::uint32_t now = 0;
  std::vector<std::uint32_t> at_vertex;
};

/// Finds what can be done, and does nothing. Each thread has its own.
class Proposer {
 public:
  using Mode = CoarseningRule::Mode;

  /// All but the number are kept by reference; those between are the rule's.
  Proposer(const improvement::Workpiece& workpiece, const improvement::ThinShape& thin,
           const improvement::CellBounds& cells, double radius_edge, std::span<const double> sizes,
           const Changes& changes);
  Proposer(const Proposer&) = delete;
  Proposer& operator=(const Proposer&) = delete;

  /// Contractions of a vertex; those to repair, too, where there is no other.
  void contractions(Index vertex, bool repairs, VertexProposal& found);
  /// What makes a tet better: an edge removed (the longest that makes it good enough, else the best), or a
  /// corner moved.
  improvement::Change improvement_of(Index tet, Mode mode);

 private:
  struct Neighbour {
    double squared_relative_length, squared_length;
    Index vertex;

    friend bool operator<(const Neighbour& x, const Neighbour& y) {
      return x.squared_relative_length != y.squared_relative_length
                 ? x.squared_relative_length < y.squared_relative_length
                 : x.vertex < y.vertex;
    }
  };

  const improvement::TetComplex& complex() const { return workpiece_.complex; }
  const std::vector<Point>& points() const { return complex().mesh().points; }
  void find_neighbours(Index vertex);
  bool may_share_feature(Index vertex, Index onto) const;
  bool lengths_fit(Index onto) const;
  bool are_joined_here(Index a, Index b) const;
  bool is_new(Index vertex);
  bool stays(Index vertex) const {
    return stayed_[vertex] != 0 && stayed_[vertex] >= changes_.at_vertex[vertex];
  }

  const improvement::Workpiece& workpiece_;
  const Changes& changes_;
  CoarseningRule rule_;
  improvement::Operations operations_;
  std::vector<Index> star_;            // tets at the vertex asked about last
  std::vector<Neighbour> neighbours_;  // of that vertex, the nearest by the size first
  std::vector<Index> targets_;         // those onto which lengths allow a contraction
  double squared_shortest_ = 0;        // edge there
  std::vector<std::uint32_t> stamps_;  // by vertex
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> stayed_;  // by vertex: when no move of it was an improvement; 0: not asked yet
};

/// Tets below this quality are improved between the passes, and improved enough above it.
constexpr double improved_below = 1.3;

/// Edges below this times the target length are contracted.
constexpr double contracted_below = 0.8;
constexpr bool is_short(double squared_relative_length) {
  return squared_relative_length < contracted_below * contracted_below;
}

}  // namespace collarmesh::coarsening
