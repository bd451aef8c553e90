#pragma once

#include <vector>

#include "collarmesh/progress.h"
#include "shells/shape_repair.h"
#include "shells/surface_editor.h"

namespace collarmesh::shells {

/// The removal of vertices that neither sizes, distances nor angles need. Such vertices remain where edge
/// lengths grow only slowly away from short curves and narrow places.
class VertexRemoval {
 public:
  /// Keeps references to all arguments.
  VertexRemoval(const SurfaceComplex& complex, SurfaceEditor& editor, ShapeRepair& repair,
                const Execution& execution);

  /// Tries to remove each vertex once, those with the shortest edges first. Returns the number of removed
  /// vertices. A later call tries only vertices whose triangles have changed since.
  std::size_t run();

 private:
  std::vector<Index> candidates();
  double least_shape_beside(Index vertex) const;
  bool remove(Index vertex);
  bool remove_and_move(Index vertex, const SurfaceEditor::Filling& filling, double least_shape);
  bool acceptable(const SurfaceEditor::Surroundings& before, double least_shape) const;

  const SurfaceComplex& complex_;
  SurfaceEditor& editor_;
  ShapeRepair& repair_;
  const Execution& execution_;
  std::vector<Index> tried_;  // by vertex: its number of changes, plus 1, when it last had to stay
};

}  // namespace collarmesh::shells
