#include "project/relaxation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/sort_uniquely.h"
#include "delaunay/predicates.h"
#include "project/rules.h"
#include "remesh/shape.h"

namespace collarmesh::projection {

namespace {

// Sweeps end after `sweeps` of them, or when `idle_sweeps` in sequence have not reduced the penalty to the
// share `worthwhile` of its value before them.
constexpr unsigned sweeps = 50, idle_sweeps = 3;
constexpr double worthwhile = 0.9;
// Vertices move by steps that start with this share of their shortest edge and are halved this many times.
constexpr double first_step = 0.3;
constexpr unsigned halvings = 5;
// Tets are relaxed until they are as good as at the beginning, or until the smallest sine of their dihedral
// angles reaches this value.
constexpr double good_shape = 0.2;
// Relative margin of the bounds, for rounding.
constexpr double margin = 1e-6;

double radius_edge(const remeshing::Corners& p) {
  const remeshing::Circumsphere sphere = remeshing::circumsphere(p);
  return std::sqrt(sphere.squared_radius / sphere.shortest_squared_edge);
}

}  // namespace

Relaxation::Relaxation(TetMesh& mesh, const ExactGeometry& exact, const Bounds& bounds)
    : mesh_(mesh),
      exact_(exact),
      bounds_(bounds),
      tets_at_(mesh.tets, mesh.points.size()),
      origins_(mesh.points),
      free_(mesh.points.size()),
      wanted_(mesh.tets.size()),
      commits_(mesh.points.size()),
      moves_(mesh.points.size()),
      stuck_(mesh.points.size(), 0) {
  for (std::size_t v = 0; v < free_.size(); ++v) free_[v] = mesh.features[v].dimension == 3;
}

Relaxation::Corners Relaxation::corners(Index tet, const std::vector<Point>& points) const {
  const auto& [a, b, c, d] = mesh_.tets[tet];
  return {points[a], points[b], points[c], points[d]};
}

double Relaxation::shortest_edge(Index vertex) const {
  double shortest = INFINITY;
  for (const Index t : tets_at_[vertex])
    for (const Index v : mesh_.tets[t])
      if (v != vertex) shortest = std::min(shortest, squared_distance(origins_[v], origins_[vertex]));
  return std::sqrt(shortest);
}

bool Relaxation::good(Index tet) const {
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

void Relaxation::put(Index vertex, const Point& place) {
  log_.emplace_back(vertex, mesh_.points[vertex]);
  mesh_.points[vertex] = place;
  moves_.note_next(vertex);
}

void Relaxation::commit() {
  commits_.advance();
  for (const auto& [vertex, place] : log_) commits_.note(vertex);
  log_.clear();
}

bool Relaxation::any_around_after(const remeshing::ChangeTimes& times, std::uint32_t time,
                                  Index vertex) const {
  const auto tets = tets_at_[vertex];
  return std::ranges::any_of(tets, [&](Index t) { return times.any_after(time, mesh_.tets[t]); });
}

void Relaxation::roll_back() {
  for (; !log_.empty(); log_.pop_back()) {
    const auto& [vertex, place] = log_.back();
    mesh_.points[vertex] = place;
    moves_.note_next(vertex);
  }
}

// Returns whether a search found no better place for the vertex and nothing around it has changed since.
bool Relaxation::in_vain(Index vertex) const {
  return stuck_[vertex] > 0 && !any_around_after(moves_, stuck_[vertex], vertex);
}

// Returns 1 if the tet keeps its bound and its shape; else a smaller value, positive if the tet has positive
// volume.
double Relaxation::score(Index tet, const Corners& p) const {
  const double six = six_volume(p[0], p[1], p[2], p[3]);
  if (six <= 0) return score_of_inverted(p, six);
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

double Relaxation::collar_score(Index tet, const Corners& p) const {
  const double angle = measure(p[0], p[1], p[2], p[3]).max_dihedral;
  return angle <= bounds_.collar_angle ? 1 : (180 - angle) / (180 - wanted(tet).angle);
}

// Returns 1 if angles are within the bounds of thin tets, or no farther beyond them than at the beginning.
double Relaxation::angle_score(Index tet, const Corners& p) const {
  constexpr double largest = remeshing::ThinShape::largest_angle, rounding = remeshing::ThinShape::rounding;
  const remeshing::ExtremeAngles now = remeshing::extreme_angles(p),
                                 then = remeshing::extreme_angles(corners(tet, origins_));
  const double bound = std::asin(bounds_.thin->smallest_sine(p, mesh_.tets[tet])) * 180 / std::numbers::pi,
               sharpest = std::min(bound, then.smallest),
               bluntest = std::max(largest - 2 * rounding, then.largest);
  return std::min({1., now.smallest / sharpest, (180 - now.largest) / (180 - bluntest)});
}

const Relaxation::Wanted& Relaxation::wanted(Index tet) const {
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

// Returns the sum of the penalties of the tets at the vertex. If the sum is not smaller than `below`, may
// return any value that is at least `below`.
double Relaxation::penalty_around(std::span<const Index> tets, Index vertex, const Point& place,
                                  double below) const {
  double penalty = 0;
  for (const Index t : tets) {
    Corners p = corners(t, mesh_.points);
    for (unsigned i = 0; i < 4; ++i)
      if (mesh_.tets[t][i] == vertex) p[i] = place;
    penalty += penalty_of(t, p);
    if (penalty >= below) break;
  }
  return penalty;
}

double Relaxation::penalty_of(Index tet, const Corners& p) const {
  const double missing = 1 - score(tet, p);
  return missing * missing;
}

std::optional<Point> Relaxation::on_feature(Index vertex, const Point& wish) const {
  const auto& [dimension, feature] = mesh_.features[vertex];
  return dimension == 3 ? wish : exact_(dimension, feature, wish);
}

// Reduces the penalty of the tets around the vertex by moving it, with a pattern search. Returns whether it
// moved.
bool Relaxation::improve(Index vertex) {
  const Point start = mesh_.points[vertex];
  // Evaluate the worst tets first: most places do not help them and are soon rejected.
  worst_first_.clear();
  for (const Index t : tets_at_[vertex])
    worst_first_.emplace_back(-penalty_of(t, corners(t, mesh_.points)), t);
  std::ranges::sort(worst_first_);
  around_.clear();
  double at_start = 0;
  for (const auto& [penalty, t] : worst_first_) {
    at_start -= penalty;
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
    const double penalty = penalty_around(around_, vertex, *p, least);
    if (penalty >= least || !fits_features(vertex, *p)) return false;
    least = penalty;
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

std::vector<Index> Relaxation::relax(std::vector<Index> tets) {
  double missing = INFINITY;  // sum over all tets
  unsigned idle = 0;          // sweeps since the sum last fell much
  for (unsigned sweep = 0; sweep < sweeps && idle < idle_sweeps; ++sweep) {
    std::vector<Index> vertices;
    double missing_now = 0;
    for (const Index t : tets) {
      const double penalty = penalty_of(t, corners(t, mesh_.points));
      if (penalty <= 0) continue;
      missing_now += penalty;
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
        stuck_[v] = moves_.now();
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

void Relaxation::find_features_around() {
  if (!faces_at_.empty()) return;
  faces_at_ = {mesh_.faces, mesh_.points.size()};
  edges_at_ = {mesh_.edges, mesh_.points.size()};
}

bool Relaxation::on_course(Index edge) const {
  const auto& [a, b] = mesh_.edges[edge];
  return projection::on_course(origins_[b] - origins_[a], mesh_.points[b] - mesh_.points[a]);
}

bool Relaxation::keeps_course(Index vertex) {
  find_features_around();
  const auto edges = edges_at_[vertex];
  return std::ranges::all_of(edges, [&](Index edge) { return on_course(edge); });
}

// Returns whether faces and edges at the vertex still fit their features if it moves to this place.
bool Relaxation::fits_features(Index vertex, const Point& place) {
  if (mesh_.features[vertex].dimension == 3) return true;
  find_features_around();
  const Point now = mesh_.points[vertex];
  mesh_.points[vertex] = place;
  const bool on_course = keeps_course(vertex);
  const double after = on_course ? sag_around(vertex) : 0;
  mesh_.points[vertex] = now;
  return on_course && (after <= 1 || after <= sag_around(vertex));
}

// Returns the largest distance of the middle of a face or edge at the vertex from the exact geometry,
// relative to its bound.
double Relaxation::sag_around(Index vertex) const {
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
    const Index next = vertex == a   ? b
                       : vertex == b ? c
                                     : a;  // the face beside this one tests the other side
    see(2, mesh_.face_patch[f], 0.5 * (points[vertex] + points[next]));
  }
  for (const Index e : edges_at_[vertex]) {
    const auto& [a, b] = mesh_.edges[e];
    see(1, mesh_.edge_curve[e], 0.5 * (points[a] + points[b]));
  }
  return most;
}

}  // namespace collarmesh::projection
