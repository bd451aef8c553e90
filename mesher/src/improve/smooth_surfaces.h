#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh::improvement {

/// The smooth patches of a complex and the faces that stand for them: whether other faces would, too.
/// A patch and its faces are within the distance tolerance of each other, in samples: points of the faces
/// are near the patch; points of the patch belong to faces that they are near to.
class SmoothSurfaces {
 public:
  using Triangle = std::array<Point, 3>;

  /// All are kept by reference. `distance` is absolute.
  SmoothSurfaces(const Plc& plc, const TetMesh& mesh, double distance)
      : plc_(plc), mesh_(mesh), squared_distance_(distance * distance), surfaces_(plc.patches.size()) {}

  struct Nearest {
    Point point;
    Vector normal;  ///< of the patch's triangle there; of any length
  };
  /// The point of a smooth patch that is nearest to p. Faster when a point of it is known to be near.
  Nearest nearest(Index patch, const Point& p, double near = INFINITY);
  struct Face {
    Triangle corners;
    Index patch;
  };
  /// Could these take the place of the mesh' faces `old`, turned like the patch as far as they are now?
  /// Faces on planar patches count for nothing.
  bool fit(std::span<const Index> old, std::span<const Face> created);
  /// These of the mesh' faces were replaced by those; some may be the same, with other corners.
  void replaced(std::span<const Index> old, std::span<const Index> created);

 private:
  const TriangleHierarchy& surface(Index patch);
  void share_out(Index patch);
  bool smooth(Index face) const;
  Index triangle_near(Index patch, const Point& p, Index hint = none);
  bool edges_near(Index patch, const Triangle& t, Index hint);
  double agreement(Index patch, const Triangle& t, Index triangle);
  double worst_agreement(std::span<const Index> faces);
  Triangle corners(Index face) const;
  Index first_sample(Index face) const { return face < first_sample_.size() ? first_sample_[face] : none; }

  const Plc& plc_;
  const TetMesh& mesh_;
  double squared_distance_;
  std::vector<std::unique_ptr<TriangleHierarchy>> surfaces_;  // made when first asked for
  std::vector<Point> samples_;                                // of the patches looked at so far
  std::vector<Index> sample_patch_;
  std::vector<Index> next_sample_;   // of the same face
  std::vector<Index> first_sample_;  // of every face
  std::vector<Index> moving_;
  std::vector<Index> near_;  // a triangle near the centre of each face that is created
};

}  // namespace collarmesh::improvement
