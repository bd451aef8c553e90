#pragma once

#include <cstddef>

#include "collarmesh/mesher.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/plc.h"

namespace collarmesh::pipeline {

/// The ways that are left to make a mesh if a refinement explodes, that is, takes far too many vertices:
/// further repairs and starts, only constrained tetrahedra of any quality, or none.
enum class Ways { others, constrained, none };

/// The number of vertices at which a refinement is stopped because it takes far more than its sizes ask for.
class VertexBudget {
 public:
  /// Keeps a reference to the options.
  explicit VertexBudget(const PipelineOptions& given) : given_(given) {}

  /// Bounds the number of vertices of further refinements, less tightly if there are fewer other ways to make
  /// a mesh. The bound is computed when it is needed. Undoes `tighten` and `compare_with`.
  void bound(Ways ways);

  /// Lowers the bound for further refinements, because one has exploded. Has no effect without Ways::others.
  void tighten();

  /// Also bounds further refinements to many times the vertices of a mesh that was made from constrained
  /// tetrahedra (0: there is none). Coarsening a finer mesh would take long and leave poor tets.
  void compare_with(std::size_t constrained_vertices);

  /// Computes the bound for a complex with these options, unless it is known already.
  void find(const Plc& plc, const PipelineOptions& options);

  /// Returns the bound on the number of vertices; 0: there is none, except one that the options may give.
  std::size_t most() const { return most_; }
  void set_most(std::size_t vertices) { most_ = vertices; }

  /// Returns whether a refinement ended at a number of vertices, and not because time or memory ran out.
  bool ended_at_vertices(const MeshResult& result, bool out_of_time) const;
  /// Returns whether a refinement ended at this budget's number of vertices.
  bool hit(const MeshResult& result, bool out_of_time) const;

 private:
  const PipelineOptions& given_;
  Ways ways_ = Ways::none;
  bool is_known_ = false, is_tight_ = false;
  std::size_t most_ = 0, compared_with_ = 0;
};

}  // namespace collarmesh::pipeline
