#pragma once

#include <cstdint>
#include <vector>

#include "coarsen/coarsening_rule.h"
#include "remesh/change_times.h"
#include "remesh/metric.h"
#include "remesh/operations.h"

namespace collarmesh::remeshing::coarsening {

/// The collapses of one vertex that the lengths of edges allow in the current mesh.
struct VertexProposal {
  Change change;  ///< the collapse onto the nearest neighbour for which the shapes of the new tets
                  ///< are allowed, too; or none
  std::vector<Change> to_repair;  ///< collapses, at most one onto each neighbour, that leave tets to improve
  bool with_repairs = false;      ///< whether collapses that need repairs were looked for
  double floor = 0;               ///< the lowest quality that changed tets may have after repairs
  /// The proposal depends on the tets at the vertex and at these vertices. New trials for a vertex inside a
  /// region read no other vertices, because there the link condition is not checked.
  std::vector<Index> read;
};

/// A finder of possible changes. It only reads the mesh. Each thread has its own.
class Proposer {
 public:
  using Mode = CoarseningRule::Mode;

  /// Keeps references to all arguments but `radius_edge`.
  Proposer(const EditableMesh& edited, const TetBounds& bounds, double radius_edge, const Metric& metric,
           const ChangeTimes& changes)
      : edited_(edited),
        changes_(changes),
        metric_(metric),
        rule_(bounds, radius_edge, metric),
        operations_(edited, rule_),
        stamps_(edited.complex.mesh().points.size(), 0),
        stayed_(stamps_) {}
  Proposer(const Proposer&) = delete;
  Proposer& operator=(const Proposer&) = delete;

  /// Finds a collapse of a vertex. If none is allowed and `repairs` is set, finds collapses that need
  /// repairs.
  void collapses(Index vertex, bool repairs, VertexProposal& found);
  /// Returns a change that makes a tet better: the removal of its longest edge whose removal leaves good
  /// enough tets; or else the best removal of an edge; or, if no removal helps, a move of a corner.
  Change improvement_of(Index tet, Mode mode);

 private:
  struct Neighbour {
    double squared_length;  // in the metric
    Vector edge;
    Index vertex;
  };

  const TetComplex& complex() const { return edited_.complex; }
  void find_neighbours(Index vertex);
  bool lengths_fit(Index onto) const;
  bool are_joined_here(Index a, Index b) const;
  bool is_new(Index vertex);
  bool stays(Index vertex) const { return stayed_[vertex] != 0 && stayed_[vertex] >= changes_.at(vertex); }

  const EditableMesh& edited_;
  const ChangeTimes& changes_;
  const Metric& metric_;
  CoarseningRule rule_;
  Operations operations_;
  std::vector<Index> star_;            // tets at the current vertex
  std::vector<Neighbour> neighbours_;  // neighbours of that vertex, the nearest in the metric first
  std::vector<Index> targets_;         // neighbours onto which edge lengths allow a collapse
  double squared_shortest_ = 0;        // squared length of the vertex's shortest edge; absolute
  std::vector<std::uint32_t> stamps_;  // by vertex
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> stayed_;  // by vertex: the last time when no move of it was an improvement; 0:
                                       // there was no such time
};

/// Tets below this quality are improved between the passes of collapses.
constexpr double improved_below = 1.3;

/// Edges shorter than this share of the target length are collapsed where possible.
constexpr double collapsed_below = 0.8;
constexpr bool is_short(double squared_length) { return squared_length < collapsed_below * collapsed_below; }

}  // namespace collarmesh::remeshing::coarsening
