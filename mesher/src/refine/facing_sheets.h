#pragma once

#include <optional>
#include <unordered_set>

#include "refine/candidate.h"
#include "refine/restricted_surface.h"
#include "refine/subsegment.h"
#include "tolerance/feature_contacts.h"

namespace collarmesh {

/// Sheets of the surface that face each other across a gap narrower than the elements around it. If each were
/// sampled alone, each sample would encroach the other sheet until the distances between samples on both are
/// about the width of the gap. So a triangle or subsegment that a vertex encroaches from across a gap is
/// split beneath that vertex. Where samples face each other in pairs, the balls of triangles and subsegments
/// contain no samples of the other sheet, however large these balls are; only the quality of cells in a thin
/// part of the domain requires smaller balls. Cells outside the regions need no quality, so there the edge
/// between the vertices of a pair counts in no radius-edge ratio. In the paper's profile there are no pairs.
///
/// State: the pairs. TriangleQuality and CurveChains query them for their triangles and subsegments,
/// CellQuality for cells that may stay; the loop records pairs.
class FacingSheets {
 public:
  /// Keeps all by reference.
  FacingSheets(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes,
               const CollarSystem& collars, const RestrictedSurface& surface)
      : domain_(domain),
        mesh_(mesh),
        nodes_(nodes),
        collars_(collars),
        surface_(surface),
        contacts_(domain.plc) {}

  /// Returns the point of a restricted triangle's patch beneath a vertex of the triangle that lies on another
  /// sheet. Returns nothing if no vertex faces the patch across a narrow gap, or if other vertices are too
  /// close to the point.
  std::optional<Candidate> candidate_across(FaceId face);
  /// Returns the parameter of a subsegment's place nearest to a vertex that encroaches the subsegment from
  /// across a gap; nothing if there is no narrow gap between them, or if the place is near an end of the
  /// subsegment. `along` is the direction of the subsegment.
  /// Precondition: the vertex is none of its ends.
  std::optional<double> parameter_across(const Subsegment& s, const Vector& along, Index vertex) const;

  /// Records that these vertices face each other; the second one exists or is inserted next.
  void note_pair(Index a, Index b);
  /// Returns whether a cell is within the radius-edge bound if edges between vertices of a pair do not count;
  /// always false while there are no pairs. Several threads may call it at once, but not while `note_pair`
  /// runs.
  bool is_within(Index cell, double bound) const;
  /// Returns the width of the gap that a flat cell spans if all its corners lie on features: between vertices
  /// of pairs, or of features that have no point in common. Infinite if it spans no gap. Several threads may
  /// call it at once, but not while `note_pair` runs.
  double gap_across(Index cell) const;

  std::size_t bytes() const;

 private:
  bool faces(Index vertex, Index patch, const Vector& normal) const;
  /// Returns whether two features have no point in common.
  bool are_apart(const Feature& a, const Feature& b) const;
  bool is_pair(Index a, Index b) const;

  const Domain& domain_;
  const RefinedMesh& mesh_;
  const SurfaceNodes& nodes_;
  const CollarSystem& collars_;
  const RestrictedSurface& surface_;
  const FeatureContacts contacts_;
  std::unordered_set<std::uint64_t> pairs_;  // edges between mesh vertices
  ConflictZone zone_;                        // scratch
};

}  // namespace collarmesh
