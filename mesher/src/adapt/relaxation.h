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
#include "remesh/operations.h"

namespace collarmesh::remeshing::adapting {

/// Brings a mesh with any shapes and lengths close to its sizes, so that coarsening and improvement, which
/// keep bounds, can do the rest.
/// No operation may reduce the quality of the worst tet around below a share of it, unless all new tets are
/// good. Collapses short edges first, shortest first, and improves tets in between; then divides long edges.
class Relaxation {
 public:
  /// Keeps the mesh and the execution by reference; `sizes` are targets at the vertices.
  Relaxation(EditableMesh& edited, const MeshOptions& options, const std::vector<double>& sizes,
             const Execution& execution);

  /// Collapses short edges and improves tets, for lengths that grow up to the target.
  void contract();
  /// Collapses edges shorter than this share of the target, without any improvement.
  void contract_short(double below);
  /// Improves tets and collapses edges where that has become possible.
  void improve();

  /// Returns the number of changes.
  std::size_t changes() const { return contractions_ + others_; }

 private:
  struct Near {
    double relative_length;
    Index vertex;
  };
  /// The means of improvement in addition to removing edges.
  enum class Means { edges, moves, vertices };
  static constexpr unsigned kinds_of_means = 3;

  const TetComplex& complex() const { return edited_.complex; }
  const TetMesh& mesh() const { return edited_.complex.mesh(); }
  double quality(Index tet) const { return rule_.quality(complex().corners(tet), complex()[tet].corners); }
  double relative_length(Index a, Index b) const;
  void contract_again(double below);
  bool contract_shorter_than(double below);
  bool contract_at(Index vertex, double below);
  void find_neighbours(Index vertex, double below);
  bool may_share_feature(Index vertex, Index onto) const;
  void improve_tets(double enough, Means later);
  bool improve_below(double enough, Means means);
  Change improvement_of(Index tet, double enough, Means means);
  void apply(Change change);
  bool has_changed_since(Index tet, std::uint32_t when) const;
  bool was_tried(Index tet, Means means) const;
  bool stopped();

  EditableMesh& edited_;
  std::vector<double> sizes_;  // by vertex
  TetBounds bounds_;
  coarsening::CoarseningRule rule_;
  Operations operations_;
  const Execution& execution_;
  std::vector<Index> star_, neighbours_;
  std::vector<Near> near_;  // neighbours of the last vertex, by length
  double longest_ = 0;      // longest edge there, relative to the target
  std::size_t contractions_ = 0, others_ = 0, steps_ = 0;
  // Times at which tets at a vertex last changed, and at which an attempt last failed. An attempt is repeated
  // only after a change.
  std::uint32_t now_ = 1;
  std::vector<std::uint32_t> changed_, kept_;                          // by vertex
  std::array<std::vector<std::uint32_t>, kinds_of_means> not_better_;  // by tet
};

}  // namespace collarmesh::remeshing::adapting
