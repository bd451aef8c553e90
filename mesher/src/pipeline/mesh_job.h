#pragma once

#include <string_view>

#include "collarmesh/pipeline.h"
#include "common/known_neighbours.h"
#include "common/run_control.h"
#include "pipeline/vertex_budget.h"

namespace collarmesh::pipeline {

/// The data of the mesh that is being made. Each stage reads what earlier stages left here, and writes
/// `made`.
struct MeshJob {
  /// Keeps a reference to `execution`.
  MeshJob(const PipelineOptions& asked_for, const Execution& execution)
      : given(with_profile(asked_for)), start(given.start), control(given, execution, made), budget(given) {}
  MeshJob(const PipelineOptions&, const Execution&&) = delete;

  bool exact() const { return static_cast<bool>(options.exact); }
  const Execution& execution() const { return control.execution(); }

  /// Returns the bounds of the finished mesh.
  Bounds bounds() const;

  /// Returns whether the refinement ended at the bound on vertices.
  bool hit_bound() const { return budget.hit(made.result, control.out_of_time()); }

  /// Adds the mesh to the trace, if the options ask for a trace.
  void trace(std::string_view stage, const TetMesh& mesh);

  const PipelineOptions given;
  Start start;  ///< how this mesh begins
  PipelineResult made;
  RunControl control;
  VertexBudget budget;

  const Plc* plc = nullptr;
  PipelineOptions options;  ///< the options for this complex
  /// Sizes and bounds of refinement, coarsening and improvement. They are tighter than those of the finished
  /// mesh if vertices will move onto exact geometry.
  MeshOptions refined_with;
  Bounds promised;             ///< the bounds that the finished mesh was judged by
  TetMesh refined;             ///< the mesh before coarsening, for periodic faces
  KnownNeighbours neighbours;  ///< neighbours in the refined mesh
};

}  // namespace collarmesh::pipeline
