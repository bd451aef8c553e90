// Computes the places and radii of balls.
#include "collar/collar_placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <string>

#include "collarmesh/error.h"
#include "common/edge_key.h"
#include "common/shared_bounds.h"
#include "common/split_mix.h"
#include "facets/faults.h"

namespace collarmesh {

namespace {

constexpr double radius_per_gap = 1 / gap_per_radius;
// Features farther away than this many sizes (CollarOptions::size) are ignored in the gap size.
constexpr double gap_per_size = 4;
// Radii are shrunk by a random share, at most this one, so that spheres are in general position.
constexpr double largest_shrinkage = 0.02;
// Radii change along a curve by at most this share of the distance along it, because a radius is at most a
// third of the gap size, which changes no faster than the position.
constexpr double radius_slope = 1.0 / 3;
// The same bound where flatness limits the radii. It is smaller, so that radii are nearly constant along rims
// of constant curvature.
constexpr double flat_radius_slope = 0.05;
constexpr double sample_step = 0.5;  // distance between samples along a curve, in radii
// Consecutive centres are at most this many radii apart. Then their distance d has d^2 <= r1^2 + r2^2, even
// after shrinking: the lines from a point of the two balls' circle to their centres meet at an angle of at
// most 90 degrees.
constexpr double step_per_radius = 1.2;
// Mesh vertices nearer than this, in radii, to the previous centre or to the curve's last centre do not
// become centres. Parts longer than `step_per_radius` are divided into equal steps, which are at least this
// long, too.
constexpr double least_step_per_radius = step_per_radius / 2;

// Lowers values until none exceeds a neighbour by more than `slope` times the distance between their
// parameters; goes around twice if the curve is closed.
void limit_slope(const std::vector<double>& parameters, double slope, bool closed,
                 std::vector<double>& values) {
  const std::size_t n = values.size();
  const auto pass = [&](std::size_t from, std::size_t to) {
    values[to] = std::min(values[to], values[from] + slope * std::fabs(parameters[to] - parameters[from]));
  };
  for (int lap = 0; lap < (closed ? 2 : 1); ++lap) {
    if (closed) values.front() = values.back() = std::min(values.front(), values.back());
    for (std::size_t i = 0; i + 1 < n; ++i) pass(i, i + 1);
    if (closed) values.front() = values.back() = std::min(values.front(), values.back());
    for (std::size_t i = n; i-- > 1;) pass(i, i - 1);
  }
}

// Returns the value at x, interpolated linearly between the values `ys` at increasing positions `xs`.
double interpolated(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  const auto after = static_cast<std::size_t>(std::upper_bound(xs.begin() + 1, xs.end() - 1, x) - xs.begin());
  const double width = xs[after] - xs[after - 1];
  const double t = width > 0 ? (x - xs[after - 1]) / width : 0;
  return (1 - t) * ys[after - 1] + t * ys[after];
}

}  // namespace

CollarPlacement::CollarPlacement(const Plc& plc, std::span<const Point> points, GapSize& gap,
                                 const CollarOptions& options, CollarSystem& system)
    : plc_(plc),
      points_(points),
      options_(options),
      system_(system),
      paths_(plc, points),
      features_(*system.features_),
      gap_(gap),
      sheets_(plc, points, system.crease_vertices_, system.crease_curve_),
      flatness_(plc, features_, paths_, sheets_, options.tolerance),
      corners_(plc, features_, paths_, sheets_, system.corners_),
      random_state_(options.seed ^ 0x5851f42d4c957f2dULL) {}

bool CollarPlacement::place_all() {
  for (const Index vertex : system_.crease_vertices_) {
    if (stopped()) return false;
    add_at_vertex(vertex);
  }
  for (Index c = 0; c < plc_.curves.size() && !stopped_; ++c)
    if (system_.crease_curve_[c]) add_on_curve(c, {});
  system_.complete();
  return !stopped_;
}

void CollarPlacement::place_at_vertex(Index vertex) {
  assert(system_.is_crease_vertex(vertex) && system_.ball_at_vertex(vertex) == none);
  add_at_vertex(vertex);
  system_.index_balls({0, vertex});
}

void CollarPlacement::place_on_curve(Index curve, std::span<const PlaceOnCurve> vertices) {
  assert(system_.is_crease_curve(curve));
  add_on_curve(curve, vertices);
  system_.index_balls({1, curve});
}

bool CollarPlacement::stopped(std::size_t more_balls) {
  return stopped_ = stopped_ || (options_.stopped && options_.stopped(system_.balls_.size() + more_balls));
}

void CollarPlacement::require_room(double radius, const Point& where) const {
  if (radius > 0 && !(options_.too_small && options_.too_small(where, radius))) return;
  const Point p = options_.outside ? options_.outside(where) : where;
  const std::string message = fmt::format(
      "Features at {} are only {:.3g} apart, too near to each other for elements between them; move them "
      "apart, or remove one.",
      facets::text(p), radius / radius_per_gap);
  throw PlcError(message, {{PlcFault::Kind::intersection, message, {}, p}});
}

double CollarPlacement::shrink() { return 1 - largest_shrinkage * next_unit(random_state_); }

void CollarPlacement::add_at_vertex(Index vertex) {
  const Point& centre = points_[plc_.vertices[vertex].point];
  const double size = options_.size({0, vertex}, centre);
  const double gap = gap_.at_vertex(vertex, gap_per_size * size);
  const double radius = flatness_.radius_at_vertex(vertex, std::min(radius_per_gap * gap, size));
  require_room(radius, centre);
  system_.vertex_ball_[vertex] = static_cast<Index>(system_.balls_.size());
  system_.balls_.push_back({centre, radius * shrink(), 0, vertex});
  corners_.add_around(system_.balls_.back());
}

double CollarPlacement::radius_for_gap(Index curve, double parameter) {
  const Point p = paths_.point(curve, parameter);
  const double size = options_.size({1, curve}, p);
  return std::min(radius_per_gap * gap_.on_curve(curve, p, gap_per_size * size), size);
}

CollarPlacement::Profile CollarPlacement::make_profile(Index curve, double from, double to) {
  const bool closed = plc_.curves[curve].closed;
  const bool curved = flatness_.matters_on(curve);
  Profile profile;
  std::vector<double> flat;
  for (double s = from;;) {
    const double radius = radius_for_gap(curve, s);
    profile.parameters.push_back(s);
    profile.radii.push_back(radius);
    flat.push_back(curved ? flatness_.radius_on_curve(curve, s, radius) : radius);
    if (s >= to) break;
    require_room(flat.back(), paths_.point(curve, s));
    s = std::min(to, s + sample_step * flat.back());
    // There are two samples per radius, and balls are at most 1.2 radii apart, so there are fewer than three
    // samples per ball.
    if (stopped(profile.parameters.size() / 3)) return {};
  }
  limit_slope(profile.parameters, radius_slope, closed, profile.radii);
  if (curved) {
    limit_slope(profile.parameters, flat_radius_slope, closed, flat);
    for (std::size_t i = 0; i < flat.size(); ++i) profile.radii[i] = std::min(profile.radii[i], flat[i]);
  }
  profile.steps.assign(1, 0);
  for (std::size_t i = 0; i + 1 < flat.size(); ++i)
    profile.steps.push_back(profile.steps.back() + 0.5 * (1 / profile.radii[i] + 1 / profile.radii[i + 1]) *
                                                       (profile.parameters[i + 1] - profile.parameters[i]));
  return profile;
}

double CollarPlacement::Profile::radius(double at) const { return interpolated(parameters, radii, at); }

double CollarPlacement::Profile::parameter(double step) const {
  return interpolated(steps, parameters, step);
}

double CollarPlacement::Profile::step(double parameter) const {
  return interpolated(parameters, steps, parameter);
}

// Returns places from the first sample to the last: the vertices that are not too near to other centres, and
// between them places at equal distances, measured in radii.
std::vector<PlaceOnCurve> CollarPlacement::centres(Index curve, const Profile& profile,
                                                   std::span<const PlaceOnCurve> vertices) const {
  const double total = profile.steps.back();
  std::vector<PlaceOnCurve> found;
  const auto add = [&](double step) {
    const double parameter = profile.parameter(step);
    found.push_back({parameter, paths_.point(curve, parameter)});
  };
  double from = 0;
  const auto add_up_to = [&](double to) {
    const auto count = static_cast<std::size_t>(std::max(1.0, std::ceil((to - from) / step_per_radius)));
    for (std::size_t i = 1; i <= count; ++i)
      add(from + (to - from) * static_cast<double>(i) / static_cast<double>(count));
    from = to;
  };
  add(0);
  for (const PlaceOnCurve& vertex : vertices) {
    const double step = profile.step(vertex.parameter);
    if (std::min(step - from, total - step) < least_step_per_radius) continue;
    add_up_to(step);
    found.back() = vertex;
  }
  add_up_to(total);
  return found;
}

Index CollarPlacement::add_ball(Index curve, const PlaceOnCurve& centre, double radius) {
  radius = std::min(radius, radius_for_gap(curve, centre.parameter));
  system_.balls_.push_back({centre.point, radius * shrink(), 1, curve});
  return static_cast<Index>(system_.balls_.size() - 1);
}

// Places the balls of a curve. If the curve is not closed, the first and the last centre lie on the spheres
// of the balls at its ends.
void CollarPlacement::add_on_curve(Index curve, std::span<const PlaceOnCurve> vertices) {
  const bool closed = plc_.curves[curve].closed;
  const double length = paths_.length(curve);
  std::array<Index, 2> ends{none, none};
  double from = 0, to = length;
  if (!closed) {
    ends = {system_.vertex_ball_[plc_.curves[curve].ends[0]],
            system_.vertex_ball_[plc_.curves[curve].ends[1]]};
    assert(ends[0] != none && ends[1] != none);
    from = system_.balls_[ends[0]].radius;
    to = length - system_.balls_[ends[1]].radius;
  }
  const Profile profile = make_profile(curve, from, to);
  if (stopped_) return;
  std::vector<PlaceOnCurve> places = centres(curve, profile, vertices);
  if (closed) places.pop_back();
  const auto first = static_cast<Index>(system_.balls_.size());
  Index previous = ends[0];
  double before = 0;
  for (const PlaceOnCurve& place : places) {
    if (stopped()) return;
    const Index ball = add_ball(curve, place, profile.radius(place.parameter));
    if (previous != none) link(previous, ball, curve, before, place.parameter);
    previous = ball;
    before = place.parameter;
  }
  link(previous, closed ? first : ends[1], curve, before, length);
}

void CollarPlacement::link(Index a, Index b, Index curve, double from, double to) {
  system_.links_.push_back({{a, b}, curve, {from, to}});
  system_.consecutive_.insert(edge_key(a, b));
  corners_.add_on_circle(system_.links_.back(), system_.balls_[a], system_.balls_[b]);
}

}  // namespace collarmesh
