#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"
#include "collarmesh/tet_mesh.h"
#include "common/distance_tree.h"
#include "common/edge_key.h"
#include "common/flat_table.h"

namespace collarmesh {

/// A measurement, by samples, of the distance between a smooth patch and the mesh's faces on it. The
/// certificate and the stages that keep the tolerance use the same samples.
class PatchDistance {
 public:
  /// A sample point on the faces or on the patch, compared with the nearest place on the other of the two.
  struct Sample {
    const Point& place;
    Index face;        ///< face that the sample lies on; for a sample on the patch, the nearest face found
    double distance;   ///< exact if above `enough` (see `visit`), else an upper bound
    double tolerance;  ///< tolerance at the sample
  };

  /// Keeps references to all arguments, and to the contents of the spans. `patch_points`: the points of the
  /// patch, as in PatchPoints.
  PatchDistance(const TetMesh& mesh, const Plc& plc, const SurfaceTolerance& tolerance, Index patch,
                std::span<const Index> faces, std::span<const Index> patch_points)
      : mesh_(mesh),
        plc_(plc),
        tolerance_(tolerance),
        patch_(plc.patches[patch]),
        faces_(faces),
        patch_points_(patch_points) {}

  /// Visits the samples: the corners and centres of the faces, two points on each of their sides, and the
  /// corners and centres of the patch's triangles. `enough()` returns the distance above which a sample's
  /// distance must be exact. Calls `look(sample, on_face)` for each.
  void visit(const auto& enough, const auto& look) const {
    visit_faces(enough, look);
    visit_patch(enough, look);
  }

 private:
  // A cache of the sides and corners (sides with equal ends) of faces seen so far. New entries replace old
  // ones.
  class SeenSides {
   public:
    explicit SeenSides(std::size_t faces) : places_(std::bit_ceil(2 * faces + 1), {none, none}) {}

    /// Records a side; returns false if the cache had it already.
    bool add(Index a, Index b) {
      const std::array<Index, 2> side{std::min(a, b), std::max(a, b)};
      auto& place = places_[spread(edge_key(a, b)) & (places_.size() - 1)];
      return std::exchange(place, side) != side;
    }

   private:
    std::vector<std::array<Index, 2>> places_;
  };

  DistanceTree::Triangle corners(Index face) const {
    const auto& f = mesh_.faces[face];
    return {mesh_.points[f[0]], mesh_.points[f[1]], mesh_.points[f[2]]};
  }
  DistanceTree::Triangle triangle(Index i) const {
    const auto& t = plc_.triangles[patch_.first_triangle + i].points;
    return {plc_.points[t[0]], plc_.points[t[1]], plc_.points[t[2]]};
  }
  static Point centre(const DistanceTree::Triangle& t) { return (t[0] + t[1] + t[2]) / 3; }

  void visit_faces(const auto& enough, const auto& look) const {
    std::vector<DistanceTree::Triangle> triangles;
    triangles.reserve(patch_.triangle_count);
    for (Index i = 0; i < patch_.triangle_count; ++i) triangles.push_back(triangle(i));
    const DistanceTree tree(std::move(triangles));
    Index hint = none;
    const auto look_at = [&](Index face, const Point& place) {
      const auto nearest = tree.nearest(place, enough(), hint);
      hint = nearest.triangle;
      look(Sample{place, face, nearest.distance, tolerance_.at_triangle(patch_.first_triangle + hint)}, true);
    };
    SeenSides seen(faces_.size());
    for (const Index face : faces_) {
      const auto& f = mesh_.faces[face];
      look_at(face, centre(corners(face)));
      for (unsigned k = 0; k < 3; ++k) {
        const Index v = f[k], w = f[(k + 1) % 3];
        const Point &a = mesh_.points[v], &b = mesh_.points[w];
        if (seen.add(v, v)) look_at(face, a);
        if (!seen.add(v, w)) continue;
        look_at(face, (2 * a + b) / 3);
        look_at(face, (a + 2 * b) / 3);
      }
    }
  }

  void visit_patch(const auto& enough, const auto& look) const {
    std::vector<DistanceTree::Triangle> triangles;
    triangles.reserve(faces_.size());
    for (const Index face : faces_) triangles.push_back(corners(face));
    const DistanceTree tree(std::move(triangles));
    Index hint = none;
    const auto look_at = [&](const Point& place, double tolerance) {
      const auto nearest = tree.nearest(place, enough(), hint);
      hint = nearest.triangle;
      look(Sample{place, faces_[hint], nearest.distance, tolerance}, false);
    };
    for (const Index point : patch_points_) look_at(plc_.points[point], tolerance_.at_point(point));
    for (Index i = 0; i < patch_.triangle_count; ++i)
      look_at(centre(triangle(i)), tolerance_.at_triangle(patch_.first_triangle + i));
  }

  const TetMesh& mesh_;
  const Plc& plc_;
  const SurfaceTolerance& tolerance_;
  const Plc::Patch& patch_;
  std::span<const Index> faces_, patch_points_;
};

}  // namespace collarmesh
