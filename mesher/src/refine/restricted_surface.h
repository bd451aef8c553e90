#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/growing_array.h"
#include "location/segment_bundle.h"
#include "refine/collar_cells.h"
#include "refine/domain.h"
#include "refine/refined_mesh.h"
#include "refine/surface_nodes.h"

namespace collarmesh {

/// A Delaunay triangle whose dual edge crosses a patch at x, with its surface gap ball B(x, r).
struct RestrictedTriangle {
  Point x;
  double squared_radius;
  Index triangle;          ///< of the complex, crossed at x; of several the one with the largest ball
  bool resolved_vertices;  ///< all three vertices lie on the patch
  bool several_sheets;     ///< the dual edge crosses the surface more than once
  bool in_collar;          ///< x lies in a collar ball: none of refinement's business
};

/// What is known of a restricted triangle to those who judge it, for as long as its record lasts. A new
/// record knows nothing.
struct TriangleNotes {
  bool judged = false;            ///< since its cells last changed (TriangleQuality)
  bool given_up = false;          ///< nothing could be inserted to destroy it (TriangleQuality)
  bool surface_needs_it = false;  ///< it is split although x may lie in a collar ball (TriangleQuality)
  bool known_near = false;  ///< no sample of it is farther from its patch than the tolerance (SurfaceCheck)
};

/// The restricted Delaunay triangulation of the mesh to the patches, and the regions of the cells.
///
/// Invariants, between insertions and until `give_outside`: a cell has the region that its circumcentre lies
/// in, as far as its coordinates are not rounded across the surface; a face is marked, from both of its
/// cells, when its dual edge crosses a patch, and then it has a record. The loop tells of insertions,
/// BlockRefinement of those into blocks; the parts that judge triangles read records and write notes;
/// CollarCreator tells of new balls; at the very end SurfaceCheck gives flat cells to the outside.
class RestrictedSurface {
 public:
  /// All are kept by reference. Labels the cells that the mesh has.
  RestrictedSurface(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes,
                    const CollarCells& collar_cells);

  Index region(Index cell) const { return labels_[cell].region; }
  /// Bit i: the face opposite corner i of the cell is marked.
  unsigned marked(Index cell) const { return labels_[cell].marked; }
  bool is_marked(FaceId face) const { return labels_[cell_of(face)].marked >> corner_of(face) & 1U; }
  /// All marked faces, each from the cell with the smaller number, in their order; by all threads.
  std::vector<FaceId> marked_faces() const;
  /// Visits the marked faces of a cell, seen from it.
  template <class Visit>
  void visit_marked(Index cell, const Visit& visit) const {
    for (unsigned corner = 0, marked = labels_[cell].marked; marked != 0; ++corner, marked >>= 1)
      if (marked & 1U) visit(face_id(cell, corner));
  }

  // Of marked faces:
  const RestrictedTriangle& triangle(FaceId face) const { return record(face).triangle; }
  Index patch(FaceId face) const { return patch_of(triangle(face)); }
  const TriangleNotes& notes(FaceId face) const { return record(face).notes; }
  TriangleNotes& notes(FaceId face) { return records_[record_of(face)].notes; }

  /// The circumcentre of a face's triangle; of a degenerate one, which must be marked, where its dual edge
  /// crosses the patch.
  Point circumcentre(FaceId face) const;

  /// The zone's cells are about to go: the triangles between them go, too. Precondition: the mesh still has
  /// them; RefinedMesh::insert with the same zone comes next.
  void cells_vanish(const ConflictZone& zone) { cells_vanish(zone, workspace_); }
  /// Label the new cells; find restricted triangles between them, and look again at those on the border.
  /// Precondition: `cells_vanish` had the same zone; SurfaceNodes and CollarCells know the new vertex.
  void cells_made(const ConflictZone& zone, Index vertex);

  /// What an insertion needs for itself, and the records that are free for it.
  class Workspace {
    friend class RestrictedSurface;
    /// A face between new cells whose dual edge crosses patches: dual_crossings_[first, end).
    struct CrossedFace {
      FaceId face;
      std::size_t first, end;
    };
    std::vector<Index> free_records_;
    std::vector<TriangleHierarchy::Crossing> crossings_;
    SegmentBundle dual_edges_;
    std::vector<TriangleHierarchy::BundleCrossing> dual_crossings_;
    std::vector<CrossedFace> crossed_faces_;
    std::vector<FaceId> faces_;
    std::vector<Index> cells_;
  };
  /// Before cells are made in blocks: room for all of them, and for so many records in each block's
  /// workspace.
  void divide(std::span<const std::size_t> records, std::span<Workspace> of_blocks);
  /// Blocks were joined.
  void join(std::span<Workspace> of_blocks);
  // For several threads, each with a block of its own and the block's workspace:
  /// Does a block have enough records for an insertion with this zone?
  bool has_room(const ConflictZone& zone, const Workspace& workspace) const;
  /// As above. Precondition: `divide` gave the workspace, the zone lies in its block, and it has room;
  /// without room a record would be added to those that all threads share.
  void cells_vanish(const ConflictZone& zone, Workspace& workspace);
  void cells_made(const ConflictZone& zone, Index vertex, Workspace& workspace);
  /// In place of these three, for a cell of a zone from whose vertices nothing of the complex is found: its
  /// region is that of the cells that it replaces.
  void quiet_cell_made(Index cell, Index region) { labels_[cell] = {.region = region}; }

  /// A ball has come: does it hold the places of this cell's triangles?
  void note_ball(Index cell, const CollarBall& ball);
  /// A flat cell at the boundary, with a triangle there, is given to the outside. Each of its faces is marked
  /// if it was not, and the reverse. Precondition: nothing is inserted any more.
  void give_outside(Index cell);

  std::size_t bytes() const { return labels_.bytes() + marks_.bytes() + records_.bytes(); }

 private:
  struct Label {
    Index region = 0;
    std::uint8_t marked = 0;
  };
  struct Record {
    RestrictedTriangle triangle;
    TriangleNotes notes;
  };
  Index record_of(FaceId face) const { return marks_[cell_of(face)][corner_of(face)]; }
  const Record& record(FaceId face) const { return records_[record_of(face)]; }
  Index patch_of(const RestrictedTriangle& t) const { return domain_.plc.triangles[t.triangle].patch; }

  void fit_mesh();
  void label_from_outside(Index cell, Workspace& w);
  std::size_t first_label(const ConflictZone& zone, Workspace& w);
  Index region_beyond(Index region, const Workspace& w) const;
  void label_created_cells(const ConflictZone& zone, Index vertex, Workspace& w);
  void restrict_created_faces(const ConflictZone& zone, Index vertex, Workspace& w);
  void recall_crossings(FaceId face, Workspace& w) const;
  void mark_border_faces(const ConflictZone& zone, Index vertex, Workspace& w);
  bool crosses_as_before(FaceId outer, FaceId face, Index vertex, Workspace& w) const;
  bool crosses_no_more(FaceId outer, FaceId face) const;
  Index new_record(Workspace& w);
  void mark(FaceId face, Index record);
  void unmark(FaceId face, Workspace& w);
  void restrict_face(FaceId face, Workspace& w);
  Point crossing_point(FaceId face, Index triangle) const;

  const Domain& domain_;
  const RefinedMesh& mesh_;
  const SurfaceNodes& nodes_;
  const CollarCells& collar_cells_;
  GrowingArray<Label> labels_;                // by cell
  GrowingArray<std::array<Index, 4>> marks_;  // by cell and corner: records of marked faces
  GrowingArray<Record> records_;
  Workspace workspace_;  // of the loop
};

}  // namespace collarmesh
