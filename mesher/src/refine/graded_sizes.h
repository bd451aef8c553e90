#pragma once

#include <algorithm>
#include <span>

#include "common/growing_array.h"
#include "refine/domain.h"
#include "refine/refined_mesh.h"
#include "refine/restricted_surface.h"
#include "refine/sizing.h"

namespace collarmesh {

/// Target edge lengths: what is asked for (Sizing) and, with gradation, one at every mesh vertex, which grow
/// by at most `gradation` per unit length from where they are small.
///
/// A vertex takes the smallest size that its neighbours allow when it is inserted; what becomes smaller
/// later is spread over the mesh when the queue has run empty. The parts that judge cells, triangles and
/// subsegments ask; TriangleQuality imposes what it finds on the surface; the loop tells of insertions and
/// spreads.
class GradedSizes {
 public:
  /// All are kept by reference.
  GradedSizes(const Domain& domain, const RefinedMesh& mesh, const RestrictedSurface& surface);

  const Sizing& asked() const { return sizing_; }
  /// Do sizes depend on those at vertices?
  bool any_at_vertices() const { return at_vertex_.size() > 0; }
  /// The target edge length that gradation imposes on a simplex with these corners, whose ball has this
  /// radius; infinite without gradation.
  double graded(std::span<const Index> corners, double reach) const {
    if (at_vertex_.size() == 0) return INFINITY;
    double size = INFINITY;
    for (const Index v : corners) size = std::min(size, at_vertex_[v]);
    return size + gradation_ * reach;
  }
  /// The target edge length is this at such a distance from the vertices.
  void impose(std::span<const Index> vertices, double size, double distance);

  /// Precondition: the surface knows the regions of the new cells.
  void cells_made(const ConflictZone& zone, Index vertex);

  /// Spreads sizes over the whole mesh: Dijkstra's algorithm. False without gradation, and after too many
  /// times.
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
