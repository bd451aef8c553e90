#pragma once

#include <algorithm>
#include <span>

#include "common/growing_array.h"
#include "refine/domain.h"
#include "refine/refined_mesh.h"
#include "refine/restricted_surface.h"
#include "refine/sizing.h"

namespace collarmesh {

/// Target edge lengths: those asked for (Sizing) and, with gradation, one at every mesh vertex. The lengths
/// at vertices grow by at most `gradation` per unit of distance from places where they are small.
/// A new vertex gets the smallest size that its neighbours, its feature and its regions impose; sizes that
/// decrease later are spread over the mesh when the queue is empty. The parts that judge cells, triangles and
/// subsegments query sizes; TriangleQuality imposes sizes found on the surface; the loop reports insertions
/// and spreads sizes.
class GradedSizes {
 public:
  /// Keeps all by reference.
  GradedSizes(const Domain& domain, const RefinedMesh& mesh, const RestrictedSurface& surface);

  const Sizing& asked() const { return sizing_; }
  /// Returns whether sizes are kept at mesh vertices, as gradation requires.
  bool any_at_vertices() const { return at_vertex_.size() > 0; }
  /// Returns the target edge length that gradation imposes on a simplex with these corners, whose ball has
  /// this radius; infinite without gradation.
  double graded(std::span<const Index> corners, double reach) const {
    if (at_vertex_.size() == 0) return INFINITY;
    double size = INFINITY;
    for (const Index v : corners) size = std::min(size, at_vertex_[v]);
    return size + gradation_ * reach;
  }
  /// Imposes a target edge length at a place at this distance from the vertices.
  void impose(std::span<const Index> vertices, double size, double distance);

  /// Sets the size of a new vertex. Precondition: the surface has labelled the new cells.
  void cells_made(const ConflictZone& zone, Index vertex);

  /// Spreads sizes over the whole mesh by Dijkstra's algorithm. Returns false without gradation, and after
  /// too many calls.
  bool spread();

 private:
  const Domain& domain_;
  const RefinedMesh& mesh_;
  const RestrictedSurface& surface_;
  const Sizing sizing_;
  const double gradation_;
  GrowingArray<double> at_vertex_;  // empty without gradation
  unsigned rounds_ = 0;
};

}  // namespace collarmesh
