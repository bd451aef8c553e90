#pragma once

#include <string_view>

#include "collarmesh/pipeline.h"
#include "common/known_neighbours.h"
#include "pipeline/run_control.h"
#include "pipeline/vertex_budget.h"

namespace collarmesh::pipeline {

/// The mesh that is being made. Each stage reads what those before it left here, and writes `made`.
struct MeshJob {
  MeshJob(const PipelineOptions& asked_for, const Execution& execution)
      : given(with_profile(asked_for)), start(given.start), control(given, execution, made), budget(given) {}

  bool exact() const { return static_cast<bool>(options.exact); }
  const Execution& execution() const { return control.execution(); }

  /// Returns the bounds of the finished mesh.
  Bounds bounds() const;

  /// Returns whether the refinement ended at the bound on vertices.
  bool hit_bound() const { return budget.hit(made.result, control.out_of_time()); }

  /// Adds a mesh to the trace, if there is to be one.
  void trace(std::string_view stage, const TetMesh& mesh);

  const PipelineOptions given;
  Start start;  ///< of this mesh
  PipelineResult made;
  RunControl control;
  VertexBudget budget;

  const Plc* plc = nullptr;
  PipelineOptions options;  ///< for this complex
  /// The sizes and bounds of the refinement, of coarsening and of improvement: tighter than those of the
  /// finished mesh where vertices are to move onto exact geometry.
  MeshOptions refined_with;
  TetMesh refined;             ///< as it was before it was coarsened, for periodic faces
  KnownNeighbours neighbours;  ///< of the mesh as it was refined
};

}  // namespace collarmesh::pipeline
