#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "coarsen/coarsening_rule.h"
#include "collarmesh/mesher.h"
#include "collarmesh/progress.h"
#include "remesh/cell_bounds.h"
#include "remesh/editable_mesh.h"
#include "remesh/metric.h"
#include "remesh/operations.h"
#include "remesh/ordered_speculation.h"

namespace collarmesh::remeshing::adapting {

/// A relaxation that brings a mesh with any shapes and lengths close to its sizes, so that coarsening and
/// improvement, which keep bounds, can do the rest.
/// No operation may reduce the quality of the worst tet around below a share of its former value, unless all
/// new tets are good.
class Relaxation {
 public:
  /// Keeps the mesh and the execution by reference; `sizes` are targets at the vertices.
  Relaxation(EditableMesh& edited, const MeshOptions& options, std::vector<double> sizes,
             const Execution& execution);

  /// Collapses edges shorter than a share of the target and improves tets; repeats this with larger shares.
  void collapse();
  /// Collapses edges shorter than this share of the target, without any improvement.
  void collapse_short(double below);
  /// Improves tets, collapses short edges, and improves tets again.
  void improve();

  /// Returns the number of changes.
  std::size_t changes() const { return collapses_ + others_; }

 private:
  struct Near {
    double length;  ///< in the metric
    Index vertex;
  };
  /// The means of improvement in addition to removing edges.
  enum class Means { edges, moves, vertices };
  static constexpr unsigned kinds_of_means = 3;
  struct Proposal {
    Change change;  ///< may be none
    /// The change depends on the tets at these vertices. Empty: the tet had changed or was gone. Then a
    /// change is proposed again, because the tet's index may have been reused.
    std::vector<Index> read;
  };
  struct Neighbours {
    std::vector<Index> all;
    std::vector<Near> near;  ///< neighbours onto which the vertex may be collapsed, by length
    double longest = 0;      ///< length of the longest edge
  };

  const TetComplex& complex() const { return edited_.complex; }
  const TetMesh& mesh() const { return edited_.complex.mesh(); }
  double quality(Index tet) const { return rule_.quality(complex().corners(tet), complex()[tet].corners); }
  double length(Index a, Index b) const { return metric_.length(a, b, complex().edge(a, b)); }
  void collapse_again(double below);
  bool collapse_shorter_than(double below);
  template <class Item, class Propose, class Use>
  bool change_each(const std::vector<Item>& items, const Propose& propose, const Use& use);
  void propose_collapse(Operations& operations, Index vertex, double below, Proposal& found) const;
  Neighbours neighbours_of(Index vertex, const std::vector<Index>& star, double below) const;
  void improve_tets(double enough, Means later);
  bool improve_below(double enough, Means means);
  void propose_improvement(Operations& operations, Index tet, double enough, Means means,
                           Proposal& found) const;
  bool apply(Proposal& found);
  bool was_tried(Index tet, Means means) const;
  bool stopped();

  EditableMesh& edited_;
  Metric metric_;
  TetBounds bounds_;
  coarsening::CoarseningRule rule_;
  const Execution& execution_;
  std::size_t collapses_ = 0, others_ = 0, steps_ = 0;
  ChangeTimes changes_{mesh().points.size()};   // when tets at a vertex were removed, made or changed
  ChangeTimes renewals_{mesh().points.size()};  // when tets at a vertex were made or changed
  OrderedSpeculation<Operations> speculation_{[this] { return Operations(edited_, rule_); }};
  // Times at which the collapse of a vertex, or the improvement of a tet by each means, last failed. Either
  // is tried again only after a renewal there.
  std::vector<std::uint32_t> kept_ = std::vector<std::uint32_t>(mesh().points.size());  // by vertex
  std::array<std::vector<std::uint32_t>, kinds_of_means> not_better_;                   // by tet
};

}  // namespace collarmesh::remeshing::adapting
