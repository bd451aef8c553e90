#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"
#include "collarmesh/tet_mesh.h"
#include "common/patch_points.h"
#include "location/triangle_hierarchy.h"
#include "remesh/undo_log.h"

namespace collarmesh::remeshing {

/// The smooth patches of a complex and the mesh faces on them. Decides whether new faces may replace others.
/// A patch and its faces stay within the tolerance of each other, judged by samples: centres and edges of the
/// faces are near the patch, and each sample point of the patch is assigned to a face near it. Several
/// threads may query it at once.
class SmoothSurfaces {
 public:
  using Triangle = std::array<Point, 3>;

  /// Keeps the complex and the mesh by reference.
  SmoothSurfaces(const Plc& plc, const TetMesh& mesh, SurfaceTolerance tolerance)
      : plc_(plc),
        mesh_(mesh),
        patch_points_(plc),
        tolerance_(std::move(tolerance)),
        surfaces_(plc.patches.size()),
        first_sample_(mesh.faces.size(), none) {}

  struct Nearest {
    Point point;
    Vector normal;  ///< normal of the patch's triangle there; of any length
  };
  /// Returns the point of a smooth patch that is nearest to p. Searches within the distance `near` first,
  /// which is faster if the patch is that near.
  Nearest nearest(Index patch, const Point& p, double near = INFINITY) const;
  /// Accepts from now on also new faces beyond the tolerance, for meshes that were not made within it. They
  /// may be as far from the patch as the faces that they replace or, if these are beyond the tolerance, too,
  /// up to `ratio` times as far. 0: accepts no such faces.
  void accept_distant(double ratio) { accepted_ratio_ = ratio; }
  /// Returns whether an edge is within the tolerance of a smooth patch, judged by samples.
  bool edge_is_near(Index patch, const Point& a, const Point& b) const {
    return edge_near(patch, a, b, none);
  }
  /// Returns whether the centre of a triangle is within the tolerance of a smooth patch.
  bool centre_is_near(Index patch, const Triangle& t) const {
    return triangle_near(patch, (t[0] + t[1] + t[2]) / 3) != none;
  }
  struct Face {
    Triangle corners;
    Index patch;
  };
  /// Returns whether the created faces can replace the mesh's faces `old`: they must stay within the
  /// tolerance, and agree with the orientation of the patch well enough or at least as well as the old ones.
  /// Faces on planar patches always fit. `agreement_of_old`: NaN in the first query about the same old faces;
  /// computed if it is needed, and kept by the caller for the next query.
  bool fit(std::span<const Index> old, std::span<const Face> created, double& agreement_of_old) const;
  bool fit(std::span<const Index> old, std::span<const Face> created) const {
    double agreement_of_old = NAN;
    return fit(old, created, agreement_of_old);
  }
  /// Takes the patches' sample points away from these mesh faces. Call it before the faces are replaced or
  /// moved.
  void take_samples(std::span<const Index> faces);
  /// Gives the sample points that were taken away to these faces, which replace the old ones or have moved.
  /// Precondition: these faces `fit`.
  void give_samples(std::span<const Index> faces);

  /// Assigns all sample points to faces now instead of at the first query.
  void prepare() const;
  /// Begins a trial: later changes can be undone until `keep`.
  void begin_trial();
  void keep() { old_first_samples_.keep(), on_trial_ = false; }
  void undo();

 private:
  /// The data of a patch; built on first use, by any thread.
  struct Surface {
    std::once_flag once;
    std::unique_ptr<TriangleHierarchy> triangles;
    std::vector<Point> samples;
    std::vector<Index> next_sample;          // by sample: the next sample of the same face, or none
    std::vector<double> squared_tolerances;  // by sample; empty if the tolerance does not vary
  };

  const TriangleHierarchy& triangles(Index patch) const { return *surface(patch).triangles; }
  Surface& surface(Index patch) const;
  void share_out(Index patch, Surface& surface) const;
  double squared_tolerance(const Surface& surface, Index sample) const {
    return tolerance_.varies() ? surface.squared_tolerances[sample]
                               : tolerance_.largest() * tolerance_.largest();
  }
  bool smooth(Index face) const;
  Index triangle_near(Index patch, const Point& p, Index hint = none) const;
  bool edge_near(Index patch, const Point& a, const Point& b, Index hint) const;
  bool edges_near(std::span<const Index> old, std::span<const Face> created, std::size_t i, Index hint) const;
  double squared_distance(Index patch, const Triangle& t) const;
  bool is_smooth(Index patch) const { return patch != none && !plc_.patches[patch].planar; }
  bool centres_agree(std::span<const Index> old, std::span<const Face> created, double& agreement_of_old,
                     std::vector<Index>& near) const;
  bool fit_within(std::span<const Index> old, std::span<const Face> created,
                  const std::vector<Index>& near) const;
  bool samples_are_near(std::span<const Index> old, std::span<const Face> created,
                        double least_squared_bound) const;
  bool are_excused(std::span<const Index> old, std::span<const Face> created, bool agree) const;
  /// Returns the cosine of the angle between the normals of a face and of a triangle of the patch. It is
  /// negative if they are oriented oppositely; faces should be oriented like the triangles of their patch.
  double agreement(Index patch, const Triangle& t, Index triangle) const;
  double worst_agreement(std::span<const Index> faces) const;
  Triangle corners(Index face) const;

  const Plc& plc_;
  const TetMesh& mesh_;
  PatchPoints patch_points_;
  SurfaceTolerance tolerance_;
  mutable std::vector<Surface> surfaces_;
  mutable std::vector<Index> first_sample_;   // by face: its first sample, or none
  std::vector<std::array<Index, 2>> moving_;  // patch and sample of points that no face has yet
  double accepted_ratio_ = 0;
  bool on_trial_ = false;
  UndoLog<std::vector<Index>> old_first_samples_{first_sample_};
  std::vector<std::pair<Index*, Index>> old_links_;  // entries of next_sample, with their former values
};

}  // namespace collarmesh::remeshing
