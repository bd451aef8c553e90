// Where the balls go, how large they are, and which corner points their circles need (DESIGN 9).
#include "collar/collar_placement.h"

#include <algorithm>

namespace collarmesh {

namespace {

constexpr double radius_per_gap = 1.0 / 3;
// Radii are shrunk by a random share of up to this, so that spheres are in general position.
constexpr double largest_shrinkage = 0.08;
// On curved creases radii change by at most this share of the way along the curve: towards an end of
// an open one the gap size itself falls by a third of it.
constexpr double radius_slope = 1.0 / 3;
constexpr double closed_radius_slope = 0.25;
constexpr int smoothing_samples = 8;
// Consecutive centres are so many radii apart at most.
constexpr double step_per_radius = 1.1;
// Consecutive balls overlap so deeply that the angle at their circle stays below 90 degrees:
// d^2 <= r1^2 + r2^2, with a reserve.
constexpr double deepest_step = 0.9;

}  // namespace

CollarPlacement::CollarPlacement(const Plc& plc, std::span<const Point> points,
                                 std::span<const Crease> creases,
                                 const std::function<double(const Point&)>& size,
                                 double distance, std::uint64_t seed, CollarSystem& system)
    : plc_(plc),
      points_(points),
      creases_(creases),
      size_(size),
      gap_(plc, points),
      random_state_(seed ^ 0x5851f42d4c957f2dULL),
      system_(system),
      lengths_(plc.curves.size()),
      distance_(distance) {}

void CollarPlacement::place() {
  system_.crease_curve_.assign(plc_.curves.size(), false);
  system_.vertex_ball_.assign(plc_.vertices.size(), none);
  std::vector<Index> vertices;
  for (const Crease& crease : creases_) {
    if (crease.curve != none) system_.crease_curve_[crease.curve] = true;
    if (crease.vertex != none) vertices.push_back(crease.vertex);
  }
  for (Index c = 0; c < plc_.curves.size(); ++c)
    if (system_.crease_curve_[c] && !plc_.curves[c].closed)
      vertices.insert(vertices.end(), plc_.curves[c].ends.begin(), plc_.curves[c].ends.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  find_sheets(vertices);
  for (const Index vertex : vertices) system_.vertex_ball_[vertex] = place_at_vertex(vertex);
  for (Index c = 0; c < plc_.curves.size(); ++c) {
    if (!system_.crease_curve_[c]) continue;
    if (plc_.curves[c].closed) place_around_closed_curve(c);
    else place_along_curve(c);
  }
  for (const CollarLink& link : system_.links_) add_circle_corners(link);
}

double CollarPlacement::shrink() {
  std::uint64_t z = (random_state_ += 0x9e3779b97f4a7c15ULL);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return 1 - largest_shrinkage * (static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53);
}

Index CollarPlacement::place_at_vertex(Index vertex) {
  const Point& centre = points_[plc_.vertices[vertex].point];
  const double radius =
      flat_radius_at(vertex, std::min(radius_per_gap * gap_.at_vertex(vertex), size_(centre)));
  system_.balls_.push_back({centre, radius * shrink(), 0, vertex, 0});
  return static_cast<Index>(system_.balls_.size() - 1);
}

double CollarPlacement::radius_on_curve(Index curve, double parameter) const {
  if (plc_.curves[curve].straight) return own_radius(curve, parameter);
  // The flat radius jumps at the corners of a polyline; neighbours must not differ by more than a
  // share of their distance, else a third ball reaches into the circle of two.
  double radius = own_radius(curve, parameter);
  const double reach = 2 * radius;
  const double slope = plc_.curves[curve].closed ? closed_radius_slope : radius_slope;
  for (int k = 1; k <= smoothing_samples; ++k)
    for (const double side : {-1.0, 1.0}) {
      const double off = reach * k / smoothing_samples;
      if (slope * off >= radius) break;
      radius = std::min(radius, own_radius(curve, parameter + side * off) + slope * off);
    }
  return radius;
}

double CollarPlacement::own_radius(Index curve, double parameter) const {
  if (!plc_.curves[curve].closed) parameter = std::clamp(parameter, 0.0, lengths_[curve].back());
  const Point p = curve_point(curve, parameter);
  const double gap = gap_.on_curve(curve, p);
  const double radius = std::min(radius_per_gap * gap, size_(p));
  return plc_.curves[curve].straight || radius == 0 ? radius : flat_radius(curve, parameter, radius);
}

// The radius, made smaller until the curve leaves its chord and the patches theirs by no more than
// the tolerance inside the ball: there they are replaced by straight edges and flat triangles.
double CollarPlacement::flat_radius(Index curve, double parameter, double radius) const {
  const Point centre = curve_point(curve, parameter);
  const double length = lengths_[curve].back();
  const auto sagitta = [&](double r) {
    const Point a = curve_point(curve, parameter - r), b = curve_point(curve, parameter + r);
    return std::sqrt(squared_distance_to_triangle(centre, a, b, b));
  };
  radius = std::min(radius, length / 8);
  while (sagitta(radius) > 0.5 * distance_) radius *= 0.8;
  const Vector axis = curve_point(curve, parameter + radius) - curve_point(curve, parameter - radius);
  for (const Sheet& sheet : sheets_at(curve, parameter)) {
    if (plc_.patches[sheet.patch].planar) continue;
    while (leaves_chord(sheet.patch, centre, sheet_point(sheet, centre, axis / norm(axis), radius)))
      radius *= 0.8;
  }
  return radius;
}

// Does the patch leave the straight line between two of its points by more than the tolerance?
bool CollarPlacement::leaves_chord(Index patch, const Point& a, const Point& b) const {
  const Point middle = 0.5 * (a + b);
  return distance(middle, gap_.nearest_on_patch(patch, middle)) > 0.5 * distance_;
}

// The same at a vertex: along its curves, and on its smooth patches in the directions of their
// triangles.
double CollarPlacement::flat_radius_at(Index vertex, double radius) const {
  const Point& centre = points_[plc_.vertices[vertex].point];
  for (const Index c : plc_.vertices[vertex].curves) {
    if (plc_.curves[c].straight) continue;
    for (const bool at_start : {true, false}) {
      if (plc_.curves[c].ends[at_start ? 0 : 1] != vertex) continue;
      const double length = lengths_[c].back();
      const auto at = [&](double r) { return curve_point(c, at_start ? r : length - r); };
      radius = std::min(radius, length / 8);
      const auto sagitta = [&](double r) {
        return std::sqrt(squared_distance_to_triangle(at(0.5 * r), centre, at(r), at(r)));
      };
      while (sagitta(radius) > 0.5 * distance_) radius *= 0.8;
    }
  }
  const auto corner = plc_.vertices[vertex].point;
  for (auto it = std::lower_bound(fans_.begin(), fans_.end(), std::pair{corner, Index{0}});
       it != fans_.end() && it->first == corner; ++it) {
    const Plc::Triangle& t = plc_.triangles[it->second];
    if (plc_.patches[t.patch].planar) continue;
    const Point middle = (points_[t.points[0]] + points_[t.points[1]] + points_[t.points[2]]) / 3;
    const Vector direction = (middle - centre) / distance(middle, centre);
    while (leaves_chord(t.patch, centre, gap_.nearest_on_patch(t.patch, centre + radius * direction)))
      radius *= 0.8;
  }
  return radius;
}

std::size_t CollarPlacement::curve_segment(Index curve, double parameter) const {
  const auto& lengths = lengths_[curve];
  const auto after = static_cast<std::size_t>(
      std::upper_bound(lengths.begin(), lengths.end(), parameter) - lengths.begin());
  return std::clamp<std::size_t>(after, 1, lengths.size() - 1) - 1;
}

// On a closed curve parameters wrap around.
Point CollarPlacement::curve_point(Index curve, double parameter) const {
  const auto& lengths = lengths_[curve];
  const auto& points = plc_.curves[curve].points;
  if (plc_.curves[curve].closed) parameter -= lengths.back() * std::floor(parameter / lengths.back());
  const std::size_t segment = curve_segment(curve, parameter);
  const double step = lengths[segment + 1] - lengths[segment];
  const double t = step > 0 ? std::clamp((parameter - lengths[segment]) / step, 0.0, 1.0) : 0;
  const Point& a = points_[points[segment]];
  return a + t * (points_[points[(segment + 1) % points.size()]] - a);
}

Index CollarPlacement::add_ball_on_curve(Index curve, double parameter) {
  system_.balls_.push_back({curve_point(curve, parameter),
                            radius_on_curve(curve, parameter) * shrink(), 1, curve, parameter});
  return static_cast<Index>(system_.balls_.size() - 1);
}

void CollarPlacement::place_along_curve(Index curve) {
  const auto& ends = plc_.curves[curve].ends;
  const std::array<Index, 2> end_balls{system_.vertex_ball_[ends[0]], system_.vertex_ball_[ends[1]]};
  const double from = system_.balls_[end_balls[0]].radius;
  const double to = lengths_[curve].back() - system_.balls_[end_balls[1]].radius;
  Index previous = end_balls[0];
  double before = 0;
  for (const double parameter : centre_parameters(curve, from, to)) {
    const Index ball = add_ball_on_curve(curve, parameter);
    system_.links_.push_back({{previous, ball}, curve, {before, parameter}});
    previous = ball;
    before = parameter;
  }
  system_.links_.push_back({{previous, end_balls[1]}, curve, {before, lengths_[curve].back()}});
}

void CollarPlacement::place_around_closed_curve(Index curve) {
  const double length = lengths_[curve].back();
  std::vector<double> parameters = centre_parameters(curve, 0, length);
  parameters.pop_back();  // the first one again
  const auto first = static_cast<Index>(system_.balls_.size());
  double before = 0;
  for (const double parameter : parameters) {
    const Index ball = add_ball_on_curve(curve, parameter);
    if (ball != first) system_.links_.push_back({{ball - 1, ball}, curve, {before, parameter}});
    before = parameter;
  }
  const auto last = static_cast<Index>(system_.balls_.size() - 1);
  system_.links_.push_back({{last, first}, curve, {before, length}});
}

// From one vertex ball's sphere to the other's: natural steps first, then all of them compressed so
// that the last centre comes to lie on the sphere, then the steps that are too long halved.
std::vector<double> CollarPlacement::centre_parameters(Index curve, double from, double to) const {
  std::vector<double> natural{from};
  while (natural.back() < to) {
    const double here = radius_on_curve(curve, natural.back());
    const double ahead = radius_on_curve(curve, std::min(to, natural.back() + step_per_radius * here));
    natural.push_back(natural.back() + step_per_radius * std::min(here, ahead));
  }
  const double compression = (to - from) / (natural.back() - from);
  std::vector<double> centres;
  for (const double parameter : natural) {
    const double next = from + (parameter - from) * compression;
    while (!centres.empty()) {
      const double r1 = (1 - largest_shrinkage) * radius_on_curve(curve, centres.back());
      const double r2 = (1 - largest_shrinkage) * radius_on_curve(curve, next);
      const double step = next - centres.back();
      const double longest = deepest_step * std::sqrt(r1 * r1 + r2 * r2);
      if (step <= longest) break;
      centres.push_back(centres.back() + std::min(0.5 * step, longest));
    }
    centres.push_back(next);
  }
  return centres;
}

void CollarPlacement::find_sheets(const std::vector<Index>& vertices) {
  std::vector<std::array<Index, 2>> segments;
  for (Index c = 0; c < plc_.curves.size(); ++c) {
    const auto& points = plc_.curves[c].points;
    auto& lengths = lengths_[c];
    lengths.assign(1, 0);
    const std::size_t count = points.size() - (plc_.curves[c].closed ? 0 : 1);
    for (std::size_t i = 0; i < count; ++i) {
      const Index a = points[i], b = points[(i + 1) % points.size()];
      lengths.push_back(lengths.back() + distance(points_[a], points_[b]));
      if (system_.crease_curve_[c]) segments.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(segments.begin(), segments.end());
  for (Index t = 0; t < plc_.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = plc_.triangles[t].points[i], b = plc_.triangles[t].points[(i + 1) % 3];
      const std::array<Index, 2> edge{std::min(a, b), std::max(a, b)};
      if (std::binary_search(segments.begin(), segments.end(), edge)) sheets_.push_back({edge, t});
    }
  std::sort(sheets_.begin(), sheets_.end());
  std::vector<Index> corners;
  corners.reserve(vertices.size());
  for (const Index vertex : vertices) corners.push_back(plc_.vertices[vertex].point);
  std::sort(corners.begin(), corners.end());
  for (Index t = 0; t < plc_.triangles.size(); ++t)
    for (const Index point : plc_.triangles[t].points)
      if (std::binary_search(corners.begin(), corners.end(), point)) fans_.push_back({point, t});
  std::sort(fans_.begin(), fans_.end());
}

std::vector<CollarPlacement::Sheet> CollarPlacement::sheets_at(Index curve, double parameter) const {
  const auto& points = plc_.curves[curve].points;
  const std::size_t segment = curve_segment(curve, parameter);
  const Index a = points[segment], b = points[(segment + 1) % points.size()];
  const std::array<Index, 2> edge{std::min(a, b), std::max(a, b)};
  const Vector along = (points_[b] - points_[a]) / distance(points_[a], points_[b]);
  std::vector<Sheet> sheets;
  for (auto it = std::lower_bound(sheets_.begin(), sheets_.end(), std::pair{edge, Index{0}});
       it != sheets_.end() && it->first == edge; ++it) {
    for (const Index corner : plc_.triangles[it->second].points) {
      if (corner == a || corner == b) continue;
      const Vector w = points_[corner] - points_[a];
      const Vector inwards = w - dot(w, along) * along;
      sheets.push_back({plc_.triangles[it->second].patch, inwards / norm(inwards)});
    }
  }
  return sheets;
}

// Where a sheet passes through the circle around `axis`. A plane's point is known; on a smooth patch
// it is searched from the sheet's direction to both sides.
Point CollarPlacement::sheet_point(const Sheet& sheet, const Point& centre, const Vector& axis,
                                   double radius) const {
  const Vector in_plane = sheet.direction - dot(sheet.direction, axis) * axis;
  const Vector u = in_plane / norm(in_plane), v = cross(axis, u);
  const auto at = [&](double angle) {
    return centre + radius * (std::cos(angle) * u + std::sin(angle) * v);
  };
  if (plc_.patches[sheet.patch].planar) return at(0);
  constexpr double step = 0.04, widest = 1.0;
  for (double angle = 0; angle < widest; angle += step)
    for (const double side : {1.0, -1.0}) {
      double low = side * (angle - 0.5 * step), high = side * (angle + 0.5 * step);
      if (!gap_.crosses(sheet.patch, at(low), at(high))) continue;
      for (int k = 0; k < 50; ++k) {
        const double middle = 0.5 * (low + high);
        (gap_.crosses(sheet.patch, at(low), at(middle)) ? high : low) = middle;
      }
      return at(0.5 * (low + high));
    }
  return at(0);
}

// The points where the sheets that meet at the crease pass through the circle of two consecutive
// spheres.
void CollarPlacement::add_circle_corners(const CollarLink& link) {
  const CollarBall &a = system_.balls_[link.balls[0]], &b = system_.balls_[link.balls[1]];
  const double d = distance(a.centre, b.centre);
  const Vector axis = (b.centre - a.centre) / d;
  const double along = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);
  const double radius = std::sqrt(std::max(0.0, a.radius * a.radius - along * along));
  const Point centre = a.centre + along * axis;
  const double parameter =
      link.parameters[0] + (link.parameters[1] - link.parameters[0]) * along / d;
  for (const Sheet& sheet : sheets_at(link.curve, parameter))
    system_.corners_.push_back({sheet_point(sheet, centre, axis, radius), 2, sheet.patch});
}

}  // namespace collarmesh
