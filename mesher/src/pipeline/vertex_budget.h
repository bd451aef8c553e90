#pragma once

#include <cstddef>

#include "collarmesh/mesher.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/plc.h"

namespace collarmesh::pipeline {

/// Whether anything else is tried where a refinement explodes.
enum class Ways { others, none };

/// The number of vertices at which a refinement ends that takes far more than its sizes ask for.
class VertexBudget {
 public:
  /// Keeps the options by reference.
  explicit VertexBudget(const PipelineOptions& given) : given_(given) {}

  /// The next refinement, and those after it, end beyond far more vertices than the sizes ask for: soon while
  /// there are other ways, later where there are none. Their number is found when it is needed.
  void bound(Ways ways);

  /// Finds the number for a complex, with the options for it, unless it is known.
  void find(const Plc& plc, const PipelineOptions& options);

  /// Returns the number; 0: none but the one that was given.
  std::size_t most() const { return most_; }
  void set_most(std::size_t vertices) { most_ = vertices; }

  /// Returns whether a refinement ended at that bound, and not for lack of time or memory.
  bool hit(const MeshResult& result, bool out_of_time) const;

 private:
  const PipelineOptions& given_;
  Ways ways_ = Ways::none;  // that are left
  bool is_known_ = false;
  std::size_t most_ = 0;
};

}  // namespace collarmesh::pipeline
