#pragma once

#include <vector>

#include "check/mesh_to_check.h"
#include "common/edge_key.h"

namespace collarmesh::checks {

/// A side of a face of one patch.
struct PatchEdge {
  std::array<Index, 2> ends;  ///< its ends, sorted
  Index place;                ///< index of the face in the patch's list of faces
  Index face;
  /// Whether the edge runs from the smaller to the larger point if the face is oriented like its patch.
  bool ascending;

  friend bool operator<(const PatchEdge& a, const PatchEdge& b) {
    const auto i = edge_key(a.ends[0], a.ends[1]), j = edge_key(b.ends[0], b.ends[1]);
    return i != j ? i < j : a.face < b.face;
  }
};

/// The edges on curves: those of the complex, with how many triangles of a patch meet there, and those of the
/// mesh.
class CurveUses {
 public:
  explicit CurveUses(const MeshToCheck& to_check);

  /// Returns how many triangles of the patch meet at each segment of the curve in the complex.
  std::size_t triangles_at(Index curve, Index patch) const;
  /// Returns the curve of a mesh edge (sorted points), or none.
  Index curve_of(const std::array<Index, 2>& edge) const;
  /// Returns the mesh edges of a curve.
  const Grouping& edges() const { return edges_by_curve_; }

 private:
  struct CurveEdge {
    std::array<Index, 2> ends;
    Index curve;
    friend bool operator<(const CurveEdge& a, const CurveEdge& b) { return a.ends < b.ends; }
  };
  const Plc& plc_;
  // Sorted points and a patch, for each triangle side that may lie on a curve.
  std::vector<std::array<Index, 3>> complex_edges_;
  std::vector<CurveEdge> mesh_edges_;
  Grouping edges_by_curve_;
};

/// Returns whether the face is oriented against its patch: its regions are the patch's in reverse.
inline bool reversed(const MeshToCheck& to_check, Index face) {
  const auto& given = to_check.mesh.face_regions[face];
  const auto& own = to_check.plc.patches[to_check.match.face_patch[face]].regions;
  return own[0] != own[1] && given[0] == own[1] && given[1] == own[0];
}

/// Checks that the faces of a patch form a surface, oriented alike, that ends at the patch's curves.
void check_patch_topology(const MeshToCheck& to_check, Index patch, const std::vector<Index>& faces,
                          const CurveUses& uses, Findings& findings);

}  // namespace collarmesh::checks
