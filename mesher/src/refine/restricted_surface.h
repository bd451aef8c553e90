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
  Index triangle;          ///< triangle of the complex crossed at x; of several crossings, the one with the
                           ///< largest ball
  bool resolved_vertices;  ///< all three vertices lie on the patch
  bool several_sheets;     ///< the dual edge crosses the surface more than once
  bool in_collar;          ///< x lies in a collar ball, so refinement ignores the triangle
};

/// Notes on a restricted triangle by the parts that judge it. They last as long as its record; a new record
/// has none.
struct TriangleNotes {
  bool judged = false;            ///< judged since its cells last changed (TriangleQuality)
  bool given_up = false;          ///< no point could be inserted to destroy it (TriangleQuality)
  bool surface_needs_it = false;  ///< it must be split although x may lie in a collar ball (TriangleQuality)
  bool known_near = false;        ///< no tested point of it is too far from its patch (SurfaceCheck)
};

/// The restricted Delaunay triangulation of the mesh to the patches, and the regions of the cells.
/// Invariants, between insertions and until `give_outside`: a cell has the region that contains its
/// circumcentre, unless rounding moves the circumcentre across the surface; a face is marked in both of its
/// cells if its dual edge crosses a patch, and it then has a record. The loop reports insertions,
/// BlockRefinement reports those into blocks; the parts that judge triangles read records and write notes;
/// CollarCreator reports new balls; at the very end SurfaceCheck gives flat cells to the outside.
class RestrictedSurface {
 public:
  /// Labels the cells that the mesh has. Keeps all by reference.
  RestrictedSurface(const Domain& domain, const RefinedMesh& mesh, const SurfaceNodes& nodes,
                    const CollarCells& collar_cells)
      : domain_(domain), mesh_(mesh), nodes_(nodes), collar_cells_(collar_cells) {
    labels_.resize(mesh_.cell_capacity());
    marks_.resize(mesh_.cell_capacity());
    for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) label_from_outside(cell, workspace_);
  }

  Index region(Index cell) const { return labels_[cell].region; }
  /// Returns the marked faces of a cell. Bit i: the face opposite corner i.
  unsigned marked(Index cell) const { return labels_[cell].marked; }
  bool is_marked(FaceId face) const { return labels_[cell_of(face)].marked >> corner_of(face) & 1U; }
  /// Returns all marked faces in order, each as seen from the cell with the smaller number. Uses all threads.
  std::vector<FaceId> marked_faces() const;
  /// Visits the marked faces of a cell, seen from it.
  template <class Visit>
  void visit_marked(Index cell, const Visit& visit) const {
    for (unsigned corner = 0, marked = labels_[cell].marked; marked != 0; ++corner, marked >>= 1)
      if (marked & 1U) visit(face_id(cell, corner));
  }

  // Data of marked faces:
  const RestrictedTriangle& triangle(FaceId face) const { return record(face).triangle; }
  Index patch(FaceId face) const { return patch_of(triangle(face)); }
  const TriangleNotes& notes(FaceId face) const { return record(face).notes; }
  // Notes of the parts that judge marked faces:
  void note_judged(FaceId face) { own_notes(face).judged = true; }
  void note_given_up(FaceId face) { own_notes(face).given_up = true; }
  void note_needed(FaceId face) { own_notes(face).surface_needs_it = true; }
  void note_known_near(FaceId face) { own_notes(face).known_near = true; }

  /// Returns the circumcentre of a face's triangle; for a degenerate one, which must be marked, the point
  /// where its dual edge crosses the patch.
  Point circumcentre(FaceId face) const;

  /// Removes the triangles between the zone's cells, which will be replaced. Precondition: the mesh still has
  /// the cells; RefinedMesh::insert with the same zone is called next.
  void cells_vanish(const ConflictZone& zone) { cells_vanish(zone, workspace_); }
  /// Labels the new cells; finds restricted triangles between them, and checks those on the border again.
  /// Precondition: `cells_vanish` had the same zone; the new vertex was reported to SurfaceNodes and
  /// CollarCells.
  void cells_made(const ConflictZone& zone, Index vertex);

  /// Scratch data of insertions by one thread, and the records that it may use.
  class Workspace {
    friend class RestrictedSurface;
    /// A face between new cells whose dual edge has the crossings dual_crossings_[first, end).
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
  /// Makes room for all cells before cells are made in blocks, and for this many records in each block's
  /// workspace.
  void divide(std::span<const std::size_t> records, std::span<Workspace> of_blocks);
  /// Takes free records back from the workspaces after blocks were joined.
  void join(std::span<Workspace> of_blocks);
  // Functions for several threads, each with its own block and the block's workspace:
  /// Returns whether a block has enough records for an insertion with this zone.
  bool has_room(const ConflictZone& zone, const Workspace& workspace) const;
  /// Versions of the functions above for a block. Preconditions: `divide` gave the workspace, the zone lies
  /// in its block, and `has_room` is true; otherwise a record would be added to those that all threads share.
  void cells_vanish(const ConflictZone& zone, Workspace& workspace);
  void cells_made(const ConflictZone& zone, Index vertex, Workspace& workspace);
  /// Labels a new cell with the region of the cells that it replaces. Call it instead of cells_vanish and
  /// cells_made if no vertex of the zone has nodes (SurfaceNodes).
  void quiet_cell_made(Index cell, Index region) { labels_[cell] = {.region = region}; }

  /// Reports a new ball: checks whether it contains the points `x` of this cell's triangles.
  void note_ball(Index cell, const CollarBall& ball);
  /// Gives a flat cell to the outside: marks its unmarked faces and unmarks its marked ones. Preconditions:
  /// one of its faces is marked and lies on the outer boundary; no vertex is inserted afterwards.
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
  TriangleNotes& own_notes(FaceId face) { return records_[record_of(face)].notes; }
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
  Workspace workspace_;  // the main loop's own
};

}  // namespace collarmesh
