// Moves all boundary vertices onto exact geometry at once, then makes room where tets became invalid. Moves
// vertices back that have no room, take faces too far from the complex, or leave thin tets outside narrow
// places.
#include "collarmesh/project_boundary.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "collarmesh/mesher.h"
#include "collarmesh/tet_mesh.h"
#include "common/cell_shapes.h"
#include "common/cells_at_vertices.h"
#include "common/flat_features.h"
#include "common/patch_distance.h"
#include "common/patch_points.h"
#include "common/sort_uniquely.h"
#include "common/thread_limit.h"
#include "delaunay/predicates.h"
#include "location/triangle_hierarchy.h"
#include "remesh/cell_bounds.h"
#include "remesh/shape.h"
#include "remesh/thin_shape.h"
#include "tolerance/facing.h"

namespace collarmesh {

namespace projection {

namespace {

// Sweeps go on as long as the penalty falls to the share `worthwhile` within `idle_sweeps`, at most `sweeps`
// times.
constexpr unsigned sweeps = 50, idle_sweeps = 3;
constexpr double worthwhile = 0.9;
// Vertices move by steps that start with this share of their shortest edge and are halved this many times.
constexpr double first_step = 0.3;
constexpr unsigned halvings = 5;
// Least gain of a move.
constexpr double least_gain = 1e-3;
// Tets get room until they are as good as before the move, or until the smallest sine of their dihedral
// angles reaches this value.
constexpr double good_shape = 0.2;
// Least cosine between an edge of a curve and its initial direction.
constexpr double least_course = 0.5;
// Relative margin of the bounds, for rounding.
constexpr double margin = 1e-6;

double radius_edge(const remeshing::Corners& p) {
  const remeshing::Circumsphere sphere = remeshing::circumsphere(p);
  return std::sqrt(sphere.squared_radius / sphere.shortest_squared_edge);
}

struct Bounds {
  double radius_edge = 2;                        ///< bound for tets that are neither thin nor in collars
  double collar_angle = 150;                     ///< largest dihedral angle in collars, degrees
  const remeshing::ThinShape* thin = nullptr;    ///< null: no tet is thin
  const remeshing::CellBounds* cells = nullptr;  ///< set if tets may be thin
  /// Largest distance of faces and edges from the exact geometry, by patch and by curve, absolute.
  std::vector<double> patch_sag, curve_sag;
};

/// Makes room for placed vertices: moves the corners of the tets that became invalid, inside their regions or
/// along their exact features, until the tets are within their bounds again. Changes since the last `commit`
/// can be undone.
class Relaxation {
 public:
  /// Keeps a reference to the mesh. A tet that misses a bound at the beginning may still miss it, but not by
  /// more.
  Relaxation(TetMesh& mesh, const ExactGeometry& exact, const Bounds& bounds)
      : mesh_(mesh),
        exact_(exact),
        bounds_(bounds),
        tets_at_(mesh.tets, mesh.points.size()),
        origins_(mesh.points),
        free_(mesh.points.size()),
        wanted_(mesh.tets.size()),
        changed_(mesh.points.size(), 0),
        moved_(mesh.points.size(), 0),
        stuck_(mesh.points.size(), 0) {
    for (std::size_t v = 0; v < free_.size(); ++v) free_[v] = mesh.features[v].dimension == 3;
  }

  const CellsAtVertices& tets_at() const { return tets_at_; }
  /// Returns the initial place of the vertex.
  const Point& origin(Index vertex) const { return origins_[vertex]; }
  remeshing::Corners corners_of(Index tet) const { return corners(tet, mesh_.points); }
  /// Returns the initial corners of the tet.
  remeshing::Corners origins_of(Index tet) const { return corners(tet, origins_); }
  /// Returns the initial shortest edge at the vertex.
  double shortest_edge(Index vertex) const {
    double shortest = INFINITY;
    for (const Index t : tets_at_[vertex])
      for (const Index v : mesh_.tets[t])
        if (v != vertex) shortest = std::min(shortest, squared_distance(origins_[v], origins_[vertex]));
    return std::sqrt(shortest);
  }

  /// Returns whether the tet has positive volume and is within its bound.
  bool good(Index tet) const {
    const Corners now = corners(tet, mesh_.points), then = corners(tet, origins_);
    if (predicates::orientation(now[0], now[1], now[2], now[3]) <= 0) return false;
    const TetQuality quality = measure(now[0], now[1], now[2], now[3]);
    const auto before = [&] { return measure(then[0], then[1], then[2], then[3]); };
    if (in_ball(tet))
      return quality.max_dihedral <= bounds_.collar_angle || quality.max_dihedral <= before().max_dihedral;
    if (bounds_.thin != nullptr) {
      if (!may_be_thin(tet, now) && may_be_thin(tet, then)) return false;
      if (is_thin(tet, now)) return true;
      if (is_thin(tet, then) || angle_score(tet, now) < 1) return false;
    }
    return quality.radius_edge <= bounds_.radius_edge || quality.radius_edge <= before().radius_edge;
  }

  /// Returns whether a mesh edge of a curve has turned by less than 60 degrees. If it turned by more, a
  /// vertex has passed its neighbour.
  bool on_course(Index edge) const {
    const auto& [a, b] = mesh_.edges[edge];
    const Vector then = origins_[b] - origins_[a], now = mesh_.points[b] - mesh_.points[a];
    return dot(then, now) > least_course * norm(then) * norm(now);
  }

  /// Returns whether all such edges at the vertex are on course.
  bool keeps_course(Index vertex) {
    find_features_around();
    const auto edges = edges_at_[vertex];
    return std::ranges::all_of(edges, [&](Index edge) { return on_course(edge); });
  }

  void put(Index vertex, const Point& place) {
    log_.emplace_back(vertex, mesh_.points[vertex]);
    mesh_.points[vertex] = place;
    moved_[vertex] = ++moves_;
  }

  /// Sets whether `relax` may move a vertex. By default only vertices inside regions may move.
  void set_free(Index vertex, bool is_free) { free_[vertex] = is_free; }

  /// Moves vertices of spoilt tets sweep by sweep, each to a place where the worst tet around it is better.
  /// Returns the tets that still miss a bound, among `tets` and all tets around moved vertices.
  std::vector<Index> relax(std::vector<Index> tets) {
    double missing = INFINITY;  // sum over all tets
    unsigned idle = 0;          // sweeps since the sum last fell much
    for (unsigned sweep = 0; sweep < sweeps && idle < idle_sweeps; ++sweep) {
      std::vector<Index> vertices;
      double missing_now = 0;
      for (const Index t : tets) {
        const double lack = lack_of(t, corners(t, mesh_.points));
        if (lack <= 0) continue;
        missing_now += lack;
        for (const Index v : mesh_.tets[t])
          if (free_[v]) vertices.push_back(v);
      }
      if (missing_now <= worthwhile * missing) {
        missing = missing_now;
        idle = 0;
      } else {
        ++idle;
      }
      sort_uniquely(vertices);
      bool moved = false;
      for (const Index v : vertices) {
        if (in_vain(v)) continue;
        if (!improve(v)) {
          stuck_[v] = moves_;
          continue;
        }
        moved = true;
        tets.insert(tets.end(), tets_at_[v].begin(), tets_at_[v].end());
      }
      sort_uniquely(tets);
      if (!moved) break;
    }
    tets.erase(std::remove_if(tets.begin(), tets.end(), [&](Index t) { return good(t); }), tets.end());
    return tets;
  }

  void commit() {
    ++commits_;
    for (const auto& [vertex, place] : log_) changed_[vertex] = commits_;
    log_.clear();
  }

  void roll_back() {
    for (; !log_.empty(); log_.pop_back()) {
      const auto& [vertex, place] = log_.back();
      mesh_.points[vertex] = place;
      moved_[vertex] = ++moves_;
    }
  }

  /// Returns the number of commits, and whether commits after that number changed a tet at the vertex.
  std::size_t commits() const { return commits_; }
  bool changed_around(Index vertex, std::size_t since) const {
    for (const Index t : tets_at_[vertex])
      for (const Index v : mesh_.tets[t])
        if (changed_[v] > since) return true;
    return false;
  }

 private:
  using Corners = std::array<Point, 4>;

  /// The target of a tet: its bound, or its initial shape if that was poorer.
  struct Wanted {
    double shape = -1;  // negative until computed
    double ratio = 0;
    double angle = 0;   // bound on its angles at creases
    bool thin = false;  // whether its angles are bounded instead of its ratio
  };

  const Wanted& wanted(Index tet) const {
    Wanted& want = wanted_[tet];
    if (want.shape >= 0) return want;
    const Corners before = corners(tet, origins_);
    want.shape = std::min(good_shape, remeshing::shape_quality(before));
    want.angle = (1 - margin) * std::max(bounds_.collar_angle,
                                         measure(before[0], before[1], before[2], before[3]).max_dihedral);
    want.ratio = (1 - margin) * std::max(bounds_.radius_edge, radius_edge(before));
    want.thin = !in_ball(tet) && is_thin(tet, before);
    return want;
  }

  Corners corners(Index tet, const std::vector<Point>& points) const {
    const auto& [a, b, c, d] = mesh_.tets[tet];
    return {points[a], points[b], points[c], points[d]};
  }

  bool is_thin(Index tet, const Corners& p) const {
    return bounds_.thin != nullptr && bounds_.thin->contains(p, mesh_.tets[tet]) && may_be_thin(tet, p);
  }

  bool may_be_thin(Index tet, const Corners& p) const {
    return !bounds_.cells->forbid_thin_tets() || bounds_.cells->allow(p, mesh_.tets[tet]);
  }

  // Returns whether the tet is in a collar that was not coarsened: then only its obtuse angles are bounded.
  bool in_ball(Index tet) const { return mesh_.tet_collar[tet] != 0 && !mesh_.collar_balls.empty(); }
  double collar_score(Index tet, const Corners& p) const {
    const double angle = measure(p[0], p[1], p[2], p[3]).max_dihedral;
    return angle <= bounds_.collar_angle ? 1 : (180 - angle) / (180 - wanted(tet).angle);
  }

  // Returns 1 if the tet keeps its bound and its shape; a smaller positive value if it has positive volume.
  double score(Index tet, const Corners& p) const {
    const double six = six_volume(p[0], p[1], p[2], p[3]);
    if (six <= 0) {
      double longest = 0;
      for (const auto& [i, j] : cell_shapes::corner_pairs)
        longest = std::max(longest, squared_distance(p[i], p[j]));
      return longest > 0 ? six / (longest * std::sqrt(longest)) : -1;
    }
    if (!in_ball(tet) && bounds_.thin != nullptr && bounds_.thin->is_thin_by_force(p, mesh_.tets[tet]) &&
        may_be_thin(tet, p))
      return 1;
    const Wanted& want = wanted(tet);
    double score = std::min(1., remeshing::shape_quality(p) / want.shape);
    if (in_ball(tet)) return std::min(score, collar_score(tet, p));
    if (bounds_.thin != nullptr) {
      score = std::min(score, angle_score(tet, p));
      if (mesh_.tet_collar[tet] != 0 && bounds_.cells->forbid_thin_tets())
        score = std::min(score, collar_score(tet, p));
    }
    if (want.thin) return score;
    const double ratio = radius_edge(p), most = bounds_.radius_edge * (1 - margin);
    return ratio <= most ? score : std::min(score, want.ratio / ratio);
  }

  // Returns 1 if angles are within the bounds of thin tets, or no farther beyond them than at the beginning.
  double angle_score(Index tet, const Corners& p) const {
    constexpr double largest = remeshing::ThinShape::largest_angle, rounding = remeshing::ThinShape::rounding;
    const remeshing::ExtremeAngles now = remeshing::extreme_angles(p),
                                   then = remeshing::extreme_angles(corners(tet, origins_));
    const double bound = std::asin(bounds_.thin->smallest_sine(p, mesh_.tets[tet])) * 180 / std::numbers::pi,
                 sharpest = std::min(bound, then.smallest),
                 bluntest = std::max(largest - 2 * rounding, then.largest);
    return std::min({1., now.smallest / sharpest, (180 - now.largest) / (180 - bluntest)});
  }

  double lack_of(Index tet, const Corners& p) const {
    const double missing = 1 - score(tet, p);
    return missing * missing;
  }

  // Returns the sum of the penalties of the tets at the vertex; any value >= `below` if the sum is not
  // smaller than that.
  double lack_around(std::span<const Index> tets, Index vertex, const Point& place, double below) const {
    double lack = 0;
    for (const Index t : tets) {
      Corners p = corners(t, mesh_.points);
      for (unsigned i = 0; i < 4; ++i)
        if (mesh_.tets[t][i] == vertex) p[i] = place;
      lack += lack_of(t, p);
      if (lack >= below) break;
    }
    return lack;
  }

  // Moves the vertex to the place where the penalty of the tets around it is least, found by pattern search.
  bool improve(Index vertex) {
    const Point start = mesh_.points[vertex];
    // Most places do not help the worst tets, so evaluate these first.
    worst_first_.clear();
    for (const Index t : tets_at_[vertex])
      worst_first_.emplace_back(-lack_of(t, corners(t, mesh_.points)), t);
    std::ranges::sort(worst_first_);
    around_.clear();
    double at_start = 0;
    for (const auto& [lack, t] : worst_first_) {
      at_start -= lack;
      around_.push_back(t);
    }
    if (at_start <= 0) return false;
    double least = at_start;
    Vector to_centre{0, 0, 0};
    double shortest = INFINITY, count = 0;
    for (const Index t : tets_at_[vertex])
      for (const Index v : mesh_.tets[t]) {
        if (v == vertex) continue;
        shortest = std::min(shortest, squared_distance(mesh_.points[v], start));
        to_centre = to_centre + (mesh_.points[v] - start);
        ++count;
      }
    Point place = start;
    const auto consider = [&](const Point& wish) {
      const std::optional<Point> p = on_feature(vertex, wish);
      if (!p || least <= 0) return false;
      const double lack = lack_around(around_, vertex, *p, least);
      if (lack >= least || !fits_features(vertex, *p)) return false;
      least = lack;
      place = *p;
      return true;
    };
    consider(start + to_centre / count);
    consider(start + 0.5 * to_centre / count);
    double step = first_step * std::sqrt(shortest);
    for (unsigned h = 0; h < halvings; ++h, step *= 0.5)
      for (const Vector& direction : {Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}})
        if (!consider(place + step * direction)) consider(place - step * direction);
    if (least >= (1 - least_gain) * at_start) return false;
    put(vertex, place);
    return true;
  }

  // Returns whether a search found no better place for the vertex and nothing around it has changed since.
  bool in_vain(Index vertex) const {
    if (stuck_[vertex] == 0) return false;
    for (const Index t : tets_at_[vertex])
      for (const Index v : mesh_.tets[t])
        if (moved_[v] > stuck_[vertex]) return false;
    return true;
  }

  std::optional<Point> on_feature(Index vertex, const Point& wish) const {
    const auto& [dimension, feature] = mesh_.features[vertex];
    return dimension == 3 ? wish : exact_(dimension, feature, wish);
  }

  // Updates faces and edges on smooth features after vertices slid along them.
  bool fits_features(Index vertex, const Point& place) {
    if (mesh_.features[vertex].dimension == 3) return true;
    find_features_around();
    const Point now = mesh_.points[vertex];
    mesh_.points[vertex] = place;
    const bool on_course = keeps_course(vertex);
    const double after = on_course ? sag_around(vertex) : 0;
    mesh_.points[vertex] = now;
    return on_course && (after <= 1 || after <= sag_around(vertex));
  }

  void find_features_around() {
    if (!faces_at_.empty()) return;
    faces_at_ = {mesh_.faces, mesh_.points.size()};
    edges_at_ = {mesh_.edges, mesh_.points.size()};
  }

  // Returns the largest distance of the middle of a face or edge at the vertex from the exact geometry,
  // relative to its bound.
  double sag_around(Index vertex) const {
    double most = 0;
    const auto see = [&](unsigned dimension, Index feature, const Point& middle) {
      if (feature == none) return;
      const double bound = (dimension == 1 ? bounds_.curve_sag : bounds_.patch_sag)[feature];
      if (const auto nearest = exact_(dimension, feature, middle))
        most = std::max(most, distance(*nearest, middle) / bound);
    };
    const auto& points = mesh_.points;
    for (const Index f : faces_at_[vertex]) {
      const auto& [a, b, c] = mesh_.faces[f];
      see(2, mesh_.face_patch[f], (points[a] + points[b] + points[c]) / 3);
      const Index next = vertex == a ? b : vertex == b ? c : a;  // another face has its other side
      see(2, mesh_.face_patch[f], 0.5 * (points[vertex] + points[next]));
    }
    for (const Index e : edges_at_[vertex]) {
      const auto& [a, b] = mesh_.edges[e];
      see(1, mesh_.edge_curve[e], 0.5 * (points[a] + points[b]));
    }
    return most;
  }

  TetMesh& mesh_;
  const ExactGeometry& exact_;
  Bounds bounds_;
  CellsAtVertices tets_at_, faces_at_, edges_at_;
  std::vector<Point> origins_;
  std::vector<bool> free_;
  mutable std::vector<Wanted> wanted_;  // by tet
  std::vector<std::size_t> changed_;    // by vertex: the last commit that moved it; 0: none
  std::size_t commits_ = 0;
  // By vertex: its last move, and the last attempt without a better place, as numbers of all moves until
  // then.
  std::vector<std::size_t> moved_, stuck_;
  std::size_t moves_ = 0;
  std::vector<std::pair<double, Index>> worst_first_;
  std::vector<Index> around_;
  std::vector<std::pair<Index, Point>> log_;  // vertices and their previous places, in order
};

}  // namespace

}  // namespace projection

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
    for (int pass = 0; pass < retries && retry(pass > 0); ++pass) {
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
  // Largest distances from the exact geometry, relative to the tolerance: of edges and triangles between
  // vertices, and of vertices.
  static constexpr double largest_sag = 0.5, most_off = 0.75;
  // Limit of a vertex's move, relative to its shortest edge: a longer move would pass through other tets.
  // (The faces of a CAD file may be farther from their edges than features are from each other.)
  static constexpr double longest_way = 2;
  static constexpr int retries = 2;

  struct Move {
    Index point;
    Point to;
    bool limited;   // stays off the exact geometry because its feature is flat
    bool hopeless;  // farther away than the tets there can follow
    bool done = false;
    std::size_t tried = 0;  // number of commits after which no place was found
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

  // Returns the allowed distance of a vertex from a feature of the complex. If the tolerance is small, the
  // complex may be farther from the exact geometry than the mesh may be from the complex.
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
      const double most = longest_way * room_.shortest_edge(p);
      moves_.push_back(
          {p, *place, *place != *target, squared_distance(*place, mesh_.points[p]) > most * most});
    }
    for (const TetMesh::CollarBall& ball : mesh_.collar_balls) stays_.insert(ball.point);
    for (const TetMesh::PeriodicFaces& faces : mesh_.periodic)
      for (const auto& pair : faces.nodes) stays_.insert(pair.begin(), pair.end());
  }

  // Makes room until these tets are good.
  void make_room(std::vector<Index> tets) {
    do {
      for (tets = room_.relax(std::move(tets)); !tets.empty();) tets = give_way(tets);
      tets = keep_courses();
    } while (!tets.empty());
    room_.commit();
  }

  double way_of(Index slot) const { return distance(room_.origin(moves_[slot].point), moves_[slot].to); }

  // Records whether a vertex is on its exact feature; then it may slide along it, unless it is the centre of
  // a ball or a node of periodic faces.
  void set_done(Index slot, bool done) {
    moves_[slot].done = done;
    room_.set_free(moves_[slot].point, done && stays_.count(moves_[slot].point) == 0);
  }

  // Moves back vertices that passed the end of an exact curve: curves of CAD files may end beside their
  // vertices, within tolerances. Moves back the end of such an edge that moved farther, until no such edge is
  // left. Returns the tets around the vertices moved back.
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
  // Such faces occur because the exact geometry may be nearly as far from the complex as the mesh may be.
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

  /// Returns whether one of these vertices had moved.
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
  // that define narrow places. Moves back the corner that moved farthest; if no corner moved, does so for
  // each tet around. Returns the tets around these vertices.
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

  // Moves back, in each spoilt tet, the vertex that moved farthest, or all moved vertices. Returns the tets
  // that are spoilt afterwards.
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
  // room. Returns whether anything changed.
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
  return BoundaryProjection(mesh, plc, exact, options, execution).run();
}

}  // namespace collarmesh
