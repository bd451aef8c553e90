#pragma once

#include <functional>
#include <unordered_map>
#include <vector>

#include "refine/collar_surface.h"
#include "refine/outcome.h"

namespace collarmesh {

/// Looks at the collar surface in rounds when everything else is done (paper, section 4): what is poorly
/// represented is mended, then looked at again.
///
/// State: what is known of the collar surface since the last round. Invariant, once started: every cell near
/// collars that was created since then, or whose vertices lie on other features, is touched; so a round
/// judges the triangles around those alone, and all rounds together cost what was created. The loop asks for
/// rounds and tells of insertions.
class CollarReview {
 public:
  /// Inserts a point, unless that is impossible: then what stays poor is for the certificate to tell.
  using Insert = std::function<bool(const CollarPoint&)>;

  /// All are kept by reference. `stopped` is asked now and then. The first round tells the collars that no
  /// more balls will come.
  CollarReview(const RefinedMesh& mesh, CollarSystem& collars, CollarCells& cells,
               const RestrictedSurface& surface, const CollarCreator& creator, CollarSurface& collar_surface,
               Outcome& outcome, std::function<bool()> stopped);

  /// A round. False when nothing was inserted.
  bool check(const Insert& insert);

  void cells_made(const ConflictZone& zone);
  /// A vertex was found to lie on another feature.
  void feature_changed(Index vertex);

  std::size_t bytes() const { return triangles_.bytes() + touched_.bytes(); }

 private:
  void start();
  void touch(Index cell);
  std::vector<Index> take_touched();
  void take_in_flat_cells(std::vector<Index>& cells);
  Index ball_to_take_in(Index cell);
  bool judge_changed_triangles(const std::vector<Index>& cells);
  const CollarTriangle* known_triangle(FaceId face) const;
  bool poor_edge(const CollarTriangle& t, Index a, Index b) const;
  void find_exposed_centres(const std::vector<Index>& cells);
  bool mend(const CollarTriangle& t, const Insert& insert);
  bool surround_centres(const Insert& insert);
  bool mend_poor_triangles(const Insert& insert);

  const RefinedMesh& mesh_;
  CollarSystem& collars_;
  CollarCells& cells_;
  const RestrictedSurface& surface_;
  const CollarCreator& creator_;
  CollarSurface& collar_surface_;
  Outcome& outcome_;
  std::function<bool()> stopped_;

  bool started_ = false;
  unsigned rounds_ = 0;
  GrowingArray<std::uint8_t> touched_;  // by cell: a flag
  std::vector<Index> touched_cells_;    // each of them, and some that are gone or not touched any more
  CollarTriangles triangles_;
  std::vector<FaceId> poor_;                  // those inside regions
  std::unordered_map<Index, Index> ball_at_;  // by the mesh vertices on creases
  std::vector<Index> exposed_;                // of these vertices, which may have cells outside around them
  std::vector<Index> scratch_;
};

}  // namespace collarmesh
