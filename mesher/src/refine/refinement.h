#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "collar/collar_placement.h"
#include "collar/collar_system.h"
#include "collarmesh/mesher.h"
#include "common/large_pages.h"
#include "common/patch_points.h"
#include "delaunay/triangulation.h"
#include "location/curve_paths.h"
#include "location/location_objects.h"
#include "location/triangle_hierarchy.h"
#include "location/voronoi_walk.h"
#include "refine/collar_triangles.h"
#include "refine/frame.h"
#include "refine/gap_explorer.h"
#include "refine/sizing.h"
#include "refine/work_queue.h"

namespace collarmesh {

/// Of some points, those that are far from each other: each next one is the farthest from all
/// before. Cost: candidates times count.
std::vector<Index> spread_points(std::span<const Index> candidates, const std::vector<Point>& points,
                                 std::size_t count);

/// Sparse Voronoi Refinement of a complex (paper, Procedures 1 to 3): owns
/// the only mutable Delaunay triangulation and everything that hangs on its vertices and cells.
///
/// refinement.cpp holds the loop, destroy and force_insert; curves.cpp the subsegments;
/// patches.cpp labels and restricted triangles; gradation.cpp target sizes at vertices;
/// facing_sheets.cpp samples in pairs across gaps; surface_check.cpp what is looked at when the queue has run
/// empty, surface_topology.cpp what is looked at in the end; collar_surface.cpp and collar_review.cpp the
/// collars, rip_and_stitch.cpp their tets; extract.cpp turns the result into a TetMesh.
class Refinement {
 public:
  Refinement(const Plc& plc, const MeshOptions& options, const Execution& execution);

  /// Refine until nothing is left to do, a budget is spent or the caller cancels.
  MeshStatus run();
  /// After run() returned complete or guarantee_missed.
  TetMesh extract() const;

  /// For tests: called whenever no skinny cell is left to destroy, before anything else goes in.
  void observe_quality_phases(std::function<void()> observer) { observer_ = std::move(observer); }
  /// For tests: called for every ball that is created in the pass, with the mesh as it is then.
  void observe_collars(std::function<void(const CollarBall&)> observer) {
    collar_observer_ = std::move(observer);
  }
  /// The feature that a mesh vertex lies on; dimension 3: none.
  Feature feature_of(Index vertex) const { return {vertices_[vertex].dimension, vertices_[vertex].feature}; }
  const Triangulation& triangulation() const { return mesh_; }
  bool in_collar(Index cell) const { return labels_[cell].in_collar; }
  /// The gap size as the mesh is now.
  GapExplorer& gap_size();

  const std::string& message() const { return message_; }
  Point where() const { return frame_.outside(where_); }
  MeshStatistics statistics() const;

 private:
  static constexpr const char* advice_at_floor =
      "look for features there that nearly touch or meet at a small angle; a larger crease-angle gives "
      "such a meeting a collar";

  /// What refinement knows of a mesh vertex besides its position.
  struct MeshVertex {
    std::uint8_t dimension = 3;         // containment dimension: of the lowest feature it lies on
    bool near_collar = false;           // B(v, R_v) meets a collar ball
    std::uint16_t insertions_left = 0;  // in its star before its nodes are filtered again
    Index feature = none;               // index of that vertex, curve or patch of the complex
    Index first_node = 0,
          node_count = 0;  // in node_pool_: hierarchy nodes that meet the box of its Voronoi cell
  };
  /// An input point, or a seed, that is not in the mesh yet.
  struct UnresolvedPoint {
    Point point;
    std::uint8_t dimension;
    Index feature;
    Index object = none;              // in objects_, none once it is a mesh vertex
    Index vertex = none;              // the mesh vertex it became
    std::vector<Index> pending = {};  // first subsegments that wait for it
  };
  /// A piece of a curve between two mesh vertices that are consecutive on it, with its protective
  /// ball: centred where the curve meets the bisector plane of the ends.
  struct Subsegment {
    Index curve;
    std::array<Index, 2> ends;         // mesh vertices
    std::array<double, 2> parameters;  // arc length along the curve
    Point centre;
    double centre_parameter;
    double squared_radius;
    Index object;
    std::uint32_t stamp;
    bool alive;
  };
  /// A subsegment of a curve's first chain, waiting for its ends to be inserted.
  struct PendingSubsegment {
    Index curve;
    std::array<Index, 2> points;  // unresolved points
    std::array<double, 2> parameters;
    Index object = none;
    unsigned missing = 2;
  };
  /// A Delaunay triangle whose dual edge crosses a patch at x, with its surface gap ball B(x, r).
  struct RestrictedTriangle {
    Point x;
    double squared_radius;
    Index triangle;          // of the complex, crossed at x
    bool resolved_vertices;  // all three vertices lie on the patch
    bool several_sheets;     // the dual edge crosses the surface more than once
    bool given_up;           // at the floor: no further insertion here
    bool judged;
    bool in_collar;         // x lies in a collar ball: none of refinement's business
    bool surface_needs_it;  // it is split although x may lie in a collar ball
    bool known_near;        // no sample of it is farther from its patch than the tolerance
  };
  /// A point of the complex on a smooth patch, with a triangle of the patch that it was near to.
  struct TessellationPoint {
    Index point;
    FaceId near;
    std::uint32_t generation;  // of the face's cell
  };
  /// A face between new cells whose dual edge crosses patches: dual_crossings_[first, end).
  struct CrossedFace {
    FaceId face;
    std::size_t first, end;
  };
  struct CellLabel {
    Index region = 0;
    std::uint8_t marked = 0;       // bit i: the face opposite corner i is restricted
    bool in_collar : 1 = false;    // its circumcentre lies in a collar ball
    bool touched : 1 = false;      // created near collars since their surface was looked at
    std::uint8_t off_collars = 0;  // bit i: the dual edge of that face is known to meet no ball
  };
  /// A point about to be inserted.
  struct Candidate {
    Point point;
    double squared_radius;  // of the ball that is destroyed
    Point ball_centre;
    std::uint8_t dimension;
    Index feature;
    Index start;          // a cell in conflict with the point
    Index across = none;  // the vertex that it faces across a gap
  };

  // refinement.cpp
  void start();
  /// `near`: a mesh vertex not far away, if one is known.
  Index add_unresolved(const Point& p, std::uint8_t dimension, Index feature, Index near = none);
  Index nearest_vertex(const Point& p, Index near);
  void queue_point(Index point);
  void process(const WorkQueue::Item& item);
  void destroy_cell(const WorkQueue::Item& item);
  void destroy_triangle(const WorkQueue::Item& item);
  void resolve_point(const WorkQueue::Item& item);
  bool insert_point(Index point);
  /// Paper, Procedure 2. False when nothing could be inserted.
  bool destroy(Candidate candidate);
  Index warp_target(const Candidate& candidate) const;
  Index encroached_ball(const Candidate& candidate) const;
  bool destroy_ball(LocationObjects::Object ball, const Point& intruder);
  FaceId encroached_triangle(const Candidate& candidate) const;
  /// Paper, Procedure 3. Precondition: zone_ is the point's.
  Index force_insert(std::uint8_t dimension, Index feature);
  void relocate_objects(Index vertex);
  void inherit_nodes(Index vertex);
  void find_nodes(const std::vector<Index>& cells);
  void refresh_nodes(Index vertex);
  void expect_insertions(Index vertex, std::size_t star);
  void store_nodes(MeshVertex& vertex, const std::vector<Index>& nodes);
  std::span<const Index> nodes_of(Index vertex) const {
    return {node_pool_.data() + vertices_[vertex].first_node, vertices_[vertex].node_count};
  }
  double shortest_squared_edge(Index cell) const;
  void judge_cell(Index cell);
  bool flat(Index cell) const;
  bool uneven_at_vertex(Index cell) const;
  void note_edges(Index vertex);
  std::optional<Candidate> cell_candidate(Index cell);
  std::optional<Candidate> triangle_candidate(FaceId face);
  Vector offset_outside_collars(const Point& from, double length, const Vector& normal);
  Index last_vertex() const { return mesh_.vertex_count() - 1; }
  Point on_plane(Index patch, const Point& p) const;
  bool inside_box(const Point& p) const;
  Vector random_in_cube();
  /// Of several messages the first one is kept. `next`: what the user can do.
  void give_up(const Point& where, const std::string& what, const std::string& next);
  void stop_here(MeshStatus status, const std::string& what, const std::string& next);
  double elapsed() const;
  std::size_t bytes() const;
  bool stopped();
  bool report_progress();

  // curves.cpp
  void prepare_curves();
  void add_curve_chain(Index curve);
  void guard(Index pending, Index near);
  void point_resolved(Index point);
  void hurry_ends(const PendingSubsegment& pending);
  double leaving_parameter(Index curve, const CollarBall& ball, bool at_start) const;
  double bisecting_parameter(Index curve, const Point& a, const Point& b, double from, double to) const;
  Index add_subsegment(Index curve, std::array<Index, 2> ends, std::array<double, 2> parameters,
                       Index nearby);
  void encroach(Index subsegment);
  bool too_coarse(const Subsegment& s) const;
  bool destroy_subsegment(Index subsegment);
  void remove_subsegment(Index subsegment);

  // patches.cpp
  void prepare_patches();
  void label_from_outside(Index cell);
  std::size_t first_label();
  bool on_patch(Index vertex, Index patch) const;
  Index region_beyond(Index region) const;
  std::span<const Index> fewest_nodes(FaceId face) const;
  void find_crossings(FaceId face, std::span<const Index> nodes);
  void restrict_created_faces(Index vertex);
  void recall_crossings(FaceId face);
  void label_created_cells(Index vertex);
  bool crosses_as_before(FaceId outer, FaceId face);
  bool crosses_no_more(FaceId outer, FaceId face) const;
  void mark_border_faces();
  void forget_inner_mark(FaceId face);
  void unmark(FaceId face);
  void restrict_face(FaceId face);
  Point crossing_point(FaceId face, Index triangle) const;
  Point triangle_circumcentre(FaceId face) const;
  void judge_triangle(FaceId face);
  bool too_large(FaceId face, const RestrictedTriangle& t);
  double gap_at(const RestrictedTriangle& t, double widest);
  bool too_far(FaceId face, const RestrictedTriangle& t) const;
  Index patch_of(const RestrictedTriangle& t) const { return plc_.triangles[t.triangle].patch; }
  const RestrictedTriangle& restricted(FaceId face) const {
    return restricted_[marks_[cell_of(face)][corner_of(face)]];
  }
  RestrictedTriangle& restricted(FaceId face) { return restricted_[marks_[cell_of(face)][corner_of(face)]]; }

  // facing_sheets.cpp
  std::optional<Candidate> candidate_across_gap(FaceId face);
  std::optional<double> parameter_across_gap(const Subsegment& s, Index vertex) const;
  Index nearest_triangle(const Point& p, Index patch, double& within_squared) const;
  bool faces(Index vertex, Index patch, const Vector& normal) const;
  bool apart(Index vertex, Index curve) const;
  void note_pair(Index a, Index b);
  bool fills_gap(Index cell, double bound) const;

  // gradation.cpp
  void grade_vertex(Index vertex);
  /// Spread target sizes over the whole mesh; queue what has become too large. False when nothing has.
  bool check_gradation();
  /// The target edge length that gradation imposes on a simplex whose ball has this radius.
  double graded_size(std::span<const Index> corners, double reach) const {
    if (target_size_.size() == 0) return INFINITY;
    double size = INFINITY;
    for (const Index v : corners) size = std::min(size, target_size_[v]);
    return size + gradation_ * reach;
  }

  // surface_check.cpp
  /// Look at the whole restricted surface and queue what is wrong. False when nothing is.
  bool check_surface();
  /// Gives up after too many.
  bool another_surface_round();
  std::vector<bool> vertices_at_collars() const;
  bool check_patch_topology(const std::vector<FaceId>& faces);
  bool refine_distant_triangles(const std::vector<FaceId>& faces);
  void seed_missed_patch(Index patch);
  void prepare_tessellation();
  bool still_near(const TessellationPoint& p, Index patch) const;
  bool resolve_distant_points(const std::vector<FaceId>& faces);
  bool check_flat_cells();
  std::vector<FaceId> marked_faces() const;
  void refine_triangle(FaceId face);
  bool flat_on_patch(Index cell) const;
  /// False when there are none.
  bool relabel_flat_cells();
  void toggle_mark(FaceId face, const RestrictedTriangle& record);

  // surface_topology.cpp
  void count_curve_sides();
  std::size_t sides_at(Index curve, Index patch) const;
  bool check_surface_topology();

  // extract.cpp
  void extract_face(FaceId face, const std::vector<Index>& number, TetMesh& mesh) const;

  // collar_surface.cpp
  /// What is known of the collar surface since it was last looked at: only what has changed is judged again.
  struct CollarReview {
    bool started = false;
    std::vector<Index> touched;  // cells created near collars since
    CollarTriangles triangles;
    std::vector<FaceId> poor;                  // those inside regions
    std::unordered_map<Index, Index> ball_at;  // by the mesh vertices on creases
    std::vector<Index> exposed;                // of these vertices, which may have cells outside around them
  };
  /// A flat cell outside the balls that is given to the collar of one.
  struct TakenIn {
    Index ball;
    std::uint32_t generation;  // of the cell
  };
  /// A crease curve that has no balls yet.
  struct OpenCrease {
    std::vector<std::pair<Index, std::uint32_t>> subsegments;  // all there have been, with their stamps
    std::size_t isolated = 0;               // the first so many of them are, or are there no more
    std::size_t pending = 0;                // first subsegments that still wait
    std::array<Index, 2> ends{none, none};  // unresolved points where it leaves the balls at its ends
    bool touched = false;                   // it is in touched_creases_
  };
  void prepare_collars();
  double collar_size(const Feature& feature, const Point& p) const;
  bool zone_is_near_collar() const;
  bool meets_collar(Index vertex);
  void find_collar_cells(Index vertex);
  std::vector<CollarTriangle> collar_triangles();
  std::optional<CollarTriangle> collar_triangle(FaceId outer);
  bool poorly_represented(const CollarTriangle& t);
  bool bends(CollarTriangle& t) const;
  bool far_from_patch(Index patch, const Point& p) const;
  std::optional<Point> arc_point(const CollarBall& ball, Index patch, const Point& near) const;
  bool crosses_patch(const CollarBall& ball, Index a, Index b);
  bool spans_sheets(const CollarBall& ball, Index a, Index b) const;
  bool on_another_sheet(const CollarBall& ball, const Point& p, Index triangle) const;
  bool spans_patch(std::span<const Index> corners) const;
  bool at_fold(std::span<const Index> corners) const;
  bool on_crease(Index vertex) const;
  bool repair(const CollarTriangle& t);
  bool insert_on_collar(const Point& p, std::uint8_t dimension, Index feature, Index nearby);
  std::span<const Index> patches_through(const CollarBall& ball) const;

  bool poor_book(const CollarTriangle& t, const CollarTriangle& u, const std::array<Index, 2>& edge) const;
  Index ball_vertex(Index ball) const { return unresolved_[ball_points_[ball]].vertex; }

  // create_collars.cpp
  void look_for_isolated_creases(Index vertex);
  void touch_crease(Index curve);
  void create_collar_if_isolated(Index at);
  bool waits_for_ball(Index vertex) const;
  /// Paper, Procedure 4. `near`: the mesh vertex whose cell contains the vertex.
  void create_collar_at_vertex(Index vertex, Index near);
  void clip_curve(Index curve, bool at_start, Index near);
  void create_collars_on_touched_creases();
  bool create_remaining_collars();
  void create_collar_on_curve(Index curve);
  void take_up_balls(Index near, const std::array<Index, 2>& ends);
  void find_inside(const CollarBall& ball, Index near);

  // collar_review.cpp
  /// Look at the collar surface when everything else is done; mend what is poor. False when nothing was.
  bool check_collars();
  void start_review();
  void touch(Index cell);
  std::vector<Index> touched_cells();
  void take_in_flat_cells(std::vector<Index>& cells);
  Index ball_to_take_in(Index cell);
  Index taken_in_by(Index cell) const;
  bool judge_changed_triangles(const std::vector<Index>& cells);
  const CollarTriangle* known_triangle(FaceId face) const;
  bool poor_edge(const CollarTriangle& t, Index a, Index b) const;
  void find_exposed_centres(const std::vector<Index>& cells);
  bool surround_centres();
  bool mend_poor_triangles();

  // rip_and_stitch.cpp
  /// What takes the place of the cells inside the collars, in mesh vertices.
  struct Stitched {
    struct Tet {
      std::array<Index, 4> corners;
      Index region;
      std::uint8_t collar;  // 1 star, 2 book
      Tag crease;           // of the curve or vertex
    };
    struct Face {
      std::array<Index, 3> corners;
      std::array<Index, 2> regions;
      Index patch;
    };
    struct Edge {
      std::array<Index, 2> corners;
      Index curve;
    };
    std::vector<Tet> tets;
    std::vector<Face> faces;
    std::vector<Edge> edges;
    std::vector<Index> open;  ///< mesh vertices of faces between regions that lie on no patch between them
  };
  /// Where a curve that is no crease leaves the ball at its end.
  struct ClippedEnd {
    Index curve, ball;
    Index point;  // unresolved
  };
  void rip_and_stitch();
  Tag crease_tag(Index ball) const;
  void stitch_books(const std::vector<CollarTriangle>& triangles);
  void stitch_faces(const std::vector<CollarTriangle>& triangles);
  Index patch_between(const std::array<Index, 3>& corners, Index a, Index b) const;
  bool lies_on(const std::array<Index, 3>& face, Index patch) const;
  bool against_patch(const std::array<Index, 3>& face, Index patch) const;
  Point centroid(const std::array<Index, 3>& face) const;

  const Plc& plc_;
  const MeshOptions options_;
  const Execution& execution_;
  Frame frame_;
  std::vector<Point> points_;  // of the complex, in the frame
  PatchPoints patch_points_;
  Sizing sizing_;
  double gradation_;
  double diagonal_, distance_, floor_;
  std::size_t planned_balls_ = 0;  // while they are placed: each will be a vertex
  Box box_;

  CurvePaths paths_;

  Triangulation mesh_;
  VoronoiWalk walk_;
  TriangleHierarchy hierarchy_;
  LocationObjects objects_;
  std::unique_ptr<GapExplorer> gap_;  // made when first asked for
  CollarSystem collars_;
  std::unique_ptr<CollarPlacement> placement_;          // while collars are created in the pass
  std::unordered_map<Index, OpenCrease> open_creases_;  // by their curve
  std::vector<Index> touched_creases_;
  std::size_t corners_taken_up_ = 0;
  std::vector<Index> ball_points_;  // unresolved points at the balls' centres
  std::vector<ClippedEnd> clipped_ends_;
  Stitched stitched_;
  std::unordered_map<Index, TakenIn> taken_in_;  // by their cell
  CollarReview collar_review_;
  WorkQueue queue_;
  ConflictZone zone_;

  LargeVector<MeshVertex> vertices_;
  std::unordered_set<std::uint64_t> pairs_;  // of vertices that face each other across gaps, as edges
  GrowingArray<double> target_size_;         // of every vertex, with gradation only
  GrowingArray<double> shortest_edge_;       // at every vertex, with a vertex ratio only
  GrowingArray<CellLabel> labels_;
  GrowingArray<std::array<Index, 4>> marks_;  // restricted triangles of marked faces
  LargeVector<RestrictedTriangle> restricted_;
  std::vector<Index> free_restricted_;
  LargeVector<Index> node_pool_;
  std::vector<TessellationPoint> tessellation_;        // of all smooth patches, one after the other
  std::vector<std::size_t> first_tessellation_point_;  // of each patch; empty before the first check
  std::vector<std::vector<Index>> curve_sides_;        // by curve: triangles of each of its patches

  LargeVector<UnresolvedPoint> unresolved_;
  std::vector<PendingSubsegment> pending_;
  LargeVector<Subsegment> subsegments_;
  std::vector<Index> free_subsegments_;

  std::vector<TriangleHierarchy::Crossing> crossings_;
  SegmentBundle dual_edges_;
  std::vector<TriangleHierarchy::BundleCrossing> dual_crossings_;
  std::vector<CrossedFace> crossed_faces_;
  std::vector<FaceId> faces_scratch_;
  std::vector<Index> nodes_scratch_, cells_scratch_, seeds_scratch_, nearby_balls_;

  MeshStatus stop_ = MeshStatus::complete;
  std::uint64_t random_state_;
  std::size_t warps_ = 0, yields_ = 0;
  std::function<void()> observer_;
  std::function<void(const CollarBall&)> collar_observer_;
  std::size_t steps_ = 0, peak_bytes_ = 0;
  std::chrono::steady_clock::time_point started_;
  double seconds_ = 0, reported_ = -1, fraction_ = 0;
  std::string message_;
  Point where_;
  unsigned surface_rounds_ = 0, gradation_rounds_ = 0, collar_rounds_ = 0;
};

}  // namespace collarmesh
