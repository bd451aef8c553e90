#pragma once

#include <optional>
#include <unordered_set>

#include "refine/candidate.h"
#include "refine/restricted_surface.h"
#include "refine/subsegment.h"
#include "tolerance/feature_contacts.h"

namespace collarmesh {

/// Sheets of the surface that face each other across a gap narrower than the elements around it. With samples
/// of its own each of them would encroach the other one until both are sampled as densely as the gap is
/// narrow. So what a vertex encroaches from across a gap is split beneath that vertex. Samples in such pairs
/// leave the balls of the other sheet's triangles and subsegments empty, whatever their size: what makes them
/// smaller is the quality of cells in a thin part. Outside the regions nobody wants that, so there the edge
/// between the vertices of a pair counts in no radius-edge ratio. The paper knows none of this: in its
/// profile there are no pairs.
///
/// State: the pairs. TriangleQuality and CurveChains ask what faces theirs, CellQuality whether a cell is to
/// be spared; the loop notes pairs.
class FacingSheets {
 public:
  /// All are kept by reference.
  FacingSheets(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes,
               const CollarSystem& collars, const RestrictedSurface& surface)
      : domain_(domain),
        mesh_(mesh),
        nodes_(nodes),
        collars_(collars),
        surface_(surface),
        contacts_(domain.plc) {}

  /// For a restricted triangle with a vertex on another sheet: the point of its patch beneath that vertex.
  std::optional<Candidate> candidate_across(FaceId face);
  /// Where on a subsegment, which goes this way, the vertex is nearest that encroaches it from across a gap,
  /// if it does. Precondition: it is none of its ends.
  std::optional<double> parameter_across(const Subsegment& s, const Vector& along, Index vertex) const;

  /// These vertices face each other; the second one may be about to come.
  void note_pair(Index a, Index b);
  /// Is a cell within the radius-edge bound but for the edges between vertices of a pair? Several threads may
  /// ask at once, while nobody notes pairs.
  bool is_within(Index cell, double bound) const;
  /// How wide the gap is that a flat cell with corners on features alone spans: between vertices of pairs, or
  /// of features that have no point in common; infinite if it spans none. The same for threads.
  double gap_across(Index cell) const;

  std::size_t bytes() const;

 private:
  bool faces(Index vertex, Index patch, const Vector& normal) const;
  /// Do two features have no point in common?
  bool are_apart(const Feature& a, const Feature& b) const;
  bool is_pair(Index a, Index b) const;

  const Domain& domain_;
  const RefinedMesh& mesh_;
  const SurfaceNodes& nodes_;
  const CollarSystem& collars_;
  const RestrictedSurface& surface_;
  const FeatureContacts contacts_;
  std::unordered_set<std::uint64_t> pairs_;  // of mesh vertices, as edges
  ConflictZone zone_;                        // scratch
};

}  // namespace collarmesh
