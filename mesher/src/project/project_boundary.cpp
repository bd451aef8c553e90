// Moves all boundary vertices onto exact geometry at once, then relaxes the vertices around tets that became
// invalid. Moves boundary vertices back where tets stay invalid, where faces are too far from the complex, or
// where thin tets are no longer in narrow places.
#include "collarmesh/project_boundary.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <unordered_set>

#include "collarmesh/mesher.h"
#include "common/flat_features.h"
#include "common/patch_distance.h"
#include "common/patch_points.h"
#include "common/thread_limit.h"
#include "location/triangle_hierarchy.h"
#include "project/relaxation.h"
#include "project/rules.h"
#include "tolerance/facing.h"

namespace collarmesh {

namespace {

class BoundaryProjection {
 public:
  BoundaryProjection(TetMesh& mesh, const Plc& plc, const ExactGeometry& exact, const ProjectOptions& options,
                     const Execution& execution)
      : mesh_(mesh),
        plc_(plc),
        exact_(exact),
        flat_(plc),
        limited_(flat_.limit(exact)),
        options_(options),
        execution_(execution),
        tolerance_(tolerance_of_any_size(plc, options.bounds)),
        thin_(plc, mesh, options.bounds.thin_angle, 0,
              remeshing::forced_edges_of(plc, mesh, options.bounds.lower_where_forced),
              options.bounds.tets_across()),
        cells_(plc, mesh, options.bounds),
        room_(mesh, limited_, bounds(plc)) {}

  ProjectReport run() {
    find_targets();
    if (execution_.cancelled()) return report_;
    std::vector<Index> tets;
    for (Index slot = 0; slot < moves_.size(); ++slot) {
      if (moves_[slot].hopeless) continue;
      set_done(slot, true);
      room_.put(moves_[slot].point, moves_[slot].to);
    }
    keep_courses();
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      if (!room_.good(t)) tets.push_back(t);
    make_room(std::move(tets));
    for (unsigned pass = 0; pass < projection::retries && retry(pass > 0); ++pass) {
    }
    while (!(tets = keep_distances_and_narrow_places()).empty()) make_room(std::move(tets));
    finish();
    if (!thin_.empty())
      ThreadLimit(options_.threads).run([&] {
        remeshing::mark_thin_tets(mesh_, options_.bounds.radius_edge);
      });
    return report_;
  }

 private:
  // Largest distances from the exact geometry, relative to the tolerance: `largest_sag` of edges and
  // triangles between vertices, `most_off` of vertices before they move.
  static constexpr double largest_sag = 0.5, most_off = 0.75;

  struct Move {
    Index point;
    Point to;
    bool limited;   // stays off the exact geometry because its feature is flat
    bool hopeless;  // the move exceeds `projection::longest_way`
    bool done = false;
    std::uint32_t tried = 0;  // number of commits when it was last tried in vain
  };

  projection::Bounds bounds(const Plc& plc) const {
    projection::Bounds bounds{options_.bounds.radius_edge,
                              options_.bounds.collar_angle,
                              thin_.empty() ? nullptr : &thin_,
                              &cells_,
                              {},
                              {}};
    const SurfaceTolerance tolerance = tolerance_.scaled(largest_sag);
    for (Index p = 0; p < plc.patches.size(); ++p) bounds.patch_sag.push_back(tolerance.least_on_patch(p));
    for (const Plc::Curve& curve : plc.curves) bounds.curve_sag.push_back(tolerance.least_on_curve(curve));
    return bounds;
  }

  // Returns the largest distance over which the vertex at p is moved onto the exact geometry. If the
  // tolerance is small, the exact geometry may be farther than that from the complex.
  double farthest_from(unsigned dimension, Index feature, const Point& p) const {
    if (dimension == 1) return most_off * tolerance_.least_on_curve(plc_.curves[feature]);
    if (!tolerance_.varies()) return most_off * tolerance_.largest();
    Index nearest = none;
    triangles_->squared_distance_to(p, INFINITY, &nearest,
                                    [&](Index t) { return plc_.triangles[t].patch == feature; });
    return most_off * tolerance_.at_triangle(nearest);
  }

  void find_targets() {
    if (tolerance_.varies()) triangles_.emplace(plc_.points, corners_of_triangles(plc_));
    slot_of_.assign(mesh_.points.size(), none);
    for (Index p = 0; p < mesh_.features.size(); ++p) {
      const auto [dimension, feature] = mesh_.features[p];
      if ((dimension != 1 && dimension != 2) || feature == none) continue;
      if (p % 1024 == 0 && execution_.cancelled()) return;
      const std::optional<Point> target = exact_(dimension, feature, mesh_.points[p]);
      if (!target) continue;
      ++report_.vertices;
      const double off = distance(*target, mesh_.points[p]);
      const std::optional<Point> place = off <= farthest_from(dimension, feature, mesh_.points[p])
                                             ? flat_.keep(dimension, feature, *target)
                                             : std::nullopt;
      if (!place) {
        add_exception(p, off);
        continue;
      }
      slot_of_[p] = static_cast<Index>(moves_.size());
      const double most = projection::longest_way * room_.shortest_edge(p);
      moves_.push_back(
          {p, *place, *place != *target, squared_distance(*place, mesh_.points[p]) > most * most});
    }
    for (const TetMesh::CollarBall& ball : mesh_.collar_balls) stays_.insert(ball.point);
    for (const TetMesh::PeriodicFaces& faces : mesh_.periodic)
      for (const auto& pair : faces.nodes) stays_.insert(pair.begin(), pair.end());
  }

  // Relaxes the given tets, and moves vertices back, until all tets keep their bounds.
  void make_room(std::vector<Index> tets) {
    do {
      for (tets = room_.relax(std::move(tets)); !tets.empty();) tets = give_way(tets);
      tets = keep_courses();
    } while (!tets.empty());
    room_.commit();
  }

  double way_of(Index slot) const { return distance(room_.origin(moves_[slot].point), moves_[slot].to); }

  // Records whether a vertex is on its exact feature. If so, it may slide along the feature, unless it is the
  // centre of a ball or a node of periodic faces.
  void set_done(Index slot, bool done) {
    moves_[slot].done = done;
    room_.set_free(moves_[slot].point, done && stays_.count(moves_[slot].point) == 0);
  }

  // Moves back vertices that passed the end of an exact curve, because curves of CAD files may end beside
  // their vertices, within tolerances. As long as an edge has turned too far (`on_course`), moves back the
  // one of its ends that moved farther. Returns the tets around the vertices moved back.
  std::vector<Index> keep_courses() {
    std::vector<Index> around;
    for (bool turned = true; turned;) {
      turned = false;
      for (Index edge = 0; edge < mesh_.edges.size(); ++edge) {
        if (room_.on_course(edge)) continue;
        Index farthest = none;
        for (const Index p : mesh_.edges[edge]) {
          const Index slot = slot_of_[p];
          if (slot == none || !moves_[slot].done) continue;
          if (farthest == none || way_of(slot) > way_of(farthest)) farthest = slot;
        }
        if (farthest == none) continue;
        set_done(farthest, false);
        go_back(moves_[farthest].point, around);
        turned = true;
      }
    }
    return around;
  }

  // Moves back corners of faces that are too far from a smooth patch, the corner that moved farthest first.
  // Such faces occur because the exact geometry may itself be nearly as far from the patch as is allowed.
  // Returns the tets around these corners.
  std::vector<Index> keep_distances() {
    std::vector<Index> around;
    const PatchPoints points_of(plc_);
    std::vector<std::vector<Index>> faces_of(plc_.patches.size());
    for (Index f = 0; f < mesh_.faces.size(); ++f)
      if (mesh_.face_patch[f] != none) faces_of[mesh_.face_patch[f]].push_back(f);
    for (Index patch = 0; patch < plc_.patches.size(); ++patch) {
      const std::vector<Index>& faces = faces_of[patch];
      if (plc_.patches[patch].planar || faces.empty()) continue;
      const double enough = tolerance_.least_on_patch(patch);
      PatchDistance(mesh_, plc_, tolerance_, patch, faces, points_of[patch])
          .visit([&] { return enough; },
                 [&](const PatchDistance::Sample& sample, bool) {
                   if (sample.distance > sample.tolerance)
                     move_farthest_back(mesh_.faces[sample.face], around);
                 });
    }
    return around;
  }

  /// Moves back the vertex that moved farthest. Returns false if none of the vertices had moved.
  template <std::size_t n>
  bool move_farthest_back(const std::array<Index, n>& vertices, std::vector<Index>& around) {
    const auto moved = [&](Index p) { return distance(mesh_.points[p], room_.origin(p)); };
    const Index farthest = *std::ranges::max_element(vertices, {}, moved);
    if (moved(farthest) == 0) return false;
    if (const Index slot = slot_of_[farthest]; slot != none) set_done(slot, false);
    go_back(farthest, around);
    return true;
  }

  std::vector<Index> keep_distances_and_narrow_places() {
    std::vector<Index> around = keep_distances();
    return around.empty() ? keep_narrow_places() : around;
  }

  // Moves back corners of thin tets that no longer are in a narrow place: moving vertices turns the normals
  // that define narrow places. Moves back the corner that moved farthest; if no corner of a tet moved, does
  // this for each tet that shares a corner with it. Returns the tets around these vertices.
  std::vector<Index> keep_narrow_places() {
    std::vector<Index> around;
    if (!options_.bounds.thin_in_narrow_places_only) return around;
    const remeshing::CellBounds now(plc_, mesh_, options_.bounds);
    for (Index t = 0; t < mesh_.tets.size() && !execution_.cancelled(); ++t) {
      if (now.allow(room_.corners_of(t), mesh_.tets[t]) || !cells_.allow(room_.origins_of(t), mesh_.tets[t]))
        continue;
      if (move_farthest_back(mesh_.tets[t], around)) continue;
      for (const Index p : mesh_.tets[t])
        for (const Index other : room_.tets_at()[p]) move_farthest_back(mesh_.tets[other], around);
    }
    return around;
  }

  void go_back(Index p, std::vector<Index>& around) {
    room_.set_free(p, false);
    room_.put(p, room_.origin(p));
    const auto tets = room_.tets_at()[p];
    around.insert(around.end(), tets.begin(), tets.end());
  }

  // Moves back one vertex of each spoilt tet: among those on their exact features the one with the longest
  // move. If there is none, moves back all corners. Returns the tets that are still spoilt.
  std::vector<Index> give_way(const std::vector<Index>& spoilt) {
    std::vector<Index> around;
    for (const Index t : spoilt) {
      Index farthest = none;
      for (const Index p : mesh_.tets[t]) {
        const Index slot = slot_of_[p];
        if (slot == none || !moves_[slot].done) continue;
        if (farthest == none || way_of(slot) > way_of(farthest)) farthest = slot;
      }
      around.push_back(t);
      if (room_.good(t)) continue;
      if (farthest != none) {
        set_done(farthest, false);
        go_back(moves_[farthest].point, around);
      } else {
        for (const Index p : mesh_.tets[t]) go_back(p, around);
      }
    }
    return room_.relax(std::move(around));
  }

  // Tries again to move the vertices that were moved back, one by one, because later changes may have made
  // this possible. Returns whether anything changed.
  bool retry(bool again) {
    bool any = false;
    for (Index slot = 0; slot < moves_.size() && !execution_.cancelled(); ++slot) {
      Move& move = moves_[slot];
      if (move.done || move.hopeless || (again && !room_.changed_around(move.point, move.tried))) continue;
      room_.put(move.point, move.to);
      const auto tets = room_.tets_at()[move.point];
      if (room_.keeps_course(move.point) && room_.relax({tets.begin(), tets.end()}).empty()) {
        set_done(slot, true);
        any = true;
        room_.commit();
      } else {
        room_.roll_back();
        move.tried = room_.commits();
      }
    }
    return any;
  }

  void finish() {
    for (Index p = 0; p < mesh_.features.size(); ++p)
      if (mesh_.features[p].dimension == 3 && mesh_.points[p] != room_.origin(p)) ++report_.moved_inside;
    for (Index slot = 0; slot < moves_.size(); ++slot) {
      const Move& move = moves_[slot];
      const double off = move.limited ? off_exact(move.point) : move.done ? 0 : way_of(slot);
      if (move.done)
        report_.largest_move =
            std::max(report_.largest_move, distance(room_.origin(move.point), mesh_.points[move.point]));
      if (off > options_.tolerance)
        add_exception(move.point, off);
      else
        report_.largest_distance = std::max(report_.largest_distance, off);
    }
  }

  double off_exact(Index point) const {
    const auto& [dimension, feature] = mesh_.features[point];
    const Point& now = mesh_.points[point];
    return distance(now, exact_(dimension, feature, now).value_or(now));
  }

  void add_exception(Index p, double off) {
    report_.largest_distance = std::max(report_.largest_distance, off);
    report_.exceptions.push_back(
        {p, mesh_.features[p].dimension, mesh_.features[p].feature, mesh_.points[p], off});
  }

  TetMesh& mesh_;
  const Plc& plc_;
  const ExactGeometry& exact_;
  FlatFeatures flat_;
  ExactGeometry limited_;
  const ProjectOptions& options_;
  const Execution& execution_;
  SurfaceTolerance tolerance_;
  std::optional<TriangleHierarchy> triangles_;  // set if the tolerance varies
  remeshing::ThinShape thin_;
  remeshing::CellBounds cells_;
  projection::Relaxation room_;
  std::vector<Move> moves_;
  std::vector<Index> slot_of_;       // by point: index in moves_
  std::unordered_set<Index> stays_;  // centres of balls and nodes of periodic faces
  ProjectReport report_;
};

}  // namespace

ProjectReport project_boundary(TetMesh& mesh, const Plc& plc, const ExactGeometry& exact,
                               const ProjectOptions& options, const Execution& execution) {
  assert(mesh.order() == 1);
  return BoundaryProjection(mesh, plc, exact, options, execution).run();
}

}  // namespace collarmesh
