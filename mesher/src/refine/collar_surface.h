#pragma once

#include <optional>
#include <vector>

#include "common/growing_array.h"
#include "refine/candidate.h"
#include "refine/collar_creator.h"
#include "refine/collar_triangles.h"

namespace collarmesh {

/// The collar surface as a restricted Delaunay triangulation (paper, section 4): the triangles between cells
/// inside and outside the collars. Decides whether they represent the surface well enough to be stitched to
/// the balls' centres; if not, finds the points that repair it, points of lower dimension first.
/// State: the faces whose dual edges are known to meet no ball. CollarReview decides when to ask which
/// triangles are poor; RipAndStitch takes all triangles. The loop reports insertions.
class CollarSurface {
 public:
  /// Keeps all by reference.
  CollarSurface(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes,
                const CollarSystem& collars, const CollarCells& cells, const RestrictedSurface& surface,
                const CollarCreator& creator)
      : domain_(domain),
        mesh_(mesh),
        nodes_(nodes),
        collars_(collars),
        cells_(cells),
        surface_(surface),
        creator_(creator) {}

  std::vector<CollarTriangle> triangles();
  /// Returns the collar triangle of a face seen from a cell outside the collars, if its dual edge meets the
  /// collar surface.
  std::optional<CollarTriangle> triangle(FaceId outer);
  /// Returns whether the dual edge of a face is known to meet no ball.
  bool is_off(FaceId outer) const {
    return cell_of(outer) < off_.size() && (off_[cell_of(outer)] >> corner_of(outer) & 1U) != 0;
  }

  /// Returns whether a triangle is poor regardless of its neighbours. Records where it bends.
  bool poor_alone(CollarTriangle& t) { return poorly_represented(t) || bends(t); }
  /// Returns whether two triangles of consecutive balls lie in different regions, or whether the book tet
  /// between them would be inverted or have too large a dihedral angle. Always false in the exterior.
  bool poor_book(const CollarTriangle& t, const CollarTriangle& u, const std::array<Index, 2>& edge) const;
  /// Returns whether an edge leads from one sheet of a smooth patch to another. Always false if
  /// `largest_sagitta` times the edge's length reaches the distance tolerance. Precondition: the edge and the
  /// ball's centre form a face between two regions.
  bool spans_sheets(const CollarBall& ball, Index a, Index b) const;
  /// Returns the point that repairs a triangle: its representation point, or the nearest point of an arc
  /// where a patch through the ball's centre meets the sphere. Returns nothing if there is no such point, or
  /// if it is close to a mesh vertex already; so the number of repairs of a ball is bounded (theory.md).
  std::optional<Candidate> repair(const CollarTriangle& t) const;

  /// Returns whether a mesh vertex lies on a crease.
  bool on_crease(Index vertex) const;

  void cells_made(const ConflictZone& zone);

 private:
  bool poorly_represented(const CollarTriangle& t);
  bool bends(CollarTriangle& t) const;
  bool far_from_patch(Index patch, const Point& p) const;
  bool at_fold(std::span<const Index> corners) const;
  std::optional<Point> arc_point(const CollarBall& ball, Index patch, const Point& near) const;
  bool crosses_patch(const CollarBall& ball, Index a, Index b);
  bool on_another_sheet(const CollarBall& ball, const Point& p, Index triangle) const;
  std::span<const Index> patches_through(const CollarBall& ball) const;

  const Domain& domain_;
  const RefinedMesh& mesh_;
  const SurfaceNodes& nodes_;
  const CollarSystem& collars_;
  const CollarCells& cells_;
  const RestrictedSurface& surface_;
  const CollarCreator& creator_;
  GrowingArray<std::uint8_t> off_;  // by cell: bit i for the face opposite corner i; grows on demand
  std::vector<Index> balls_;        // scratch
  std::vector<TriangleHierarchy::Crossing> crossings_;  // scratch
};

}  // namespace collarmesh
