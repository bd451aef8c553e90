// Where the balls go, how large they are, and which corner points their circles need (DESIGN 9).
#include "collar/collar_placement.h"

#include <algorithm>

namespace collarmesh {

namespace {

constexpr double radius_per_gap = 1.0 / 3;
// Radii are shrunk by a random share of up to this, so that spheres are in general position.
constexpr double largest_shrinkage = 0.08;
// Consecutive centres are so many radii apart at most.
constexpr double step_per_radius = 1.1;
// Consecutive balls overlap so deeply that the angle at their circle stays below 90 degrees:
// d^2 <= r1^2 + r2^2, with a reserve.
constexpr double deepest_step = 0.9;

}  // namespace

CollarPlacement::CollarPlacement(const Plc& plc, std::span<const Point> points,
                                 std::span<const Crease> creases,
                                 const std::function<double(const Point&)>& size,
                                 std::uint64_t seed, CollarSystem& system)
    : plc_(plc),
      points_(points),
      creases_(creases),
      size_(size),
      gap_(plc, points),
      random_state_(seed ^ 0x5851f42d4c957f2dULL),
      system_(system),
      lengths_(plc.curves.size()) {}

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
  for (const Index vertex : vertices) system_.vertex_ball_[vertex] = place_at_vertex(vertex);
  for (Index c = 0; c < plc_.curves.size(); ++c)
    if (system_.crease_curve_[c]) place_along_curve(c);
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
  const double radius = std::min(radius_per_gap * gap_.at_vertex(vertex), size_(centre));
  system_.balls_.push_back({centre, radius * shrink(), 0, vertex, 0});
  return static_cast<Index>(system_.balls_.size() - 1);
}

double CollarPlacement::radius_on_curve(Index curve, double parameter) const {
  const Point p = curve_point(curve, parameter);
  return std::min(radius_per_gap * gap_.on_curve(curve, p), size_(p));
}

Point CollarPlacement::curve_point(Index curve, double parameter) const {
  const auto& lengths = lengths_[curve];
  const auto& points = plc_.curves[curve].points;
  auto after = static_cast<std::size_t>(
      std::upper_bound(lengths.begin(), lengths.end(), parameter) - lengths.begin());
  after = std::clamp<std::size_t>(after, 1, lengths.size() - 1);
  const double step = lengths[after] - lengths[after - 1];
  const double t = step > 0 ? (parameter - lengths[after - 1]) / step : 0;
  const Point& a = points_[points[after - 1]];
  return a + t * (points_[points[after % points.size()]] - a);
}

void CollarPlacement::place_along_curve(Index curve) {
  const auto& points = plc_.curves[curve].points;
  auto& lengths = lengths_[curve];
  lengths.assign(1, 0);
  for (std::size_t i = 1; i < points.size(); ++i)
    lengths.push_back(lengths.back() + distance(points_[points[i - 1]], points_[points[i]]));
  const auto& ends = plc_.curves[curve].ends;
  const std::array<Index, 2> end_balls{system_.vertex_ball_[ends[0]], system_.vertex_ball_[ends[1]]};
  const double from = system_.balls_[end_balls[0]].radius;
  const double to = lengths.back() - system_.balls_[end_balls[1]].radius;
  Index previous = end_balls[0];
  for (const double parameter : centre_parameters(curve, from, to)) {
    const auto ball = static_cast<Index>(system_.balls_.size());
    system_.balls_.push_back({curve_point(curve, parameter),
                              radius_on_curve(curve, parameter) * shrink(), 1, curve, parameter});
    system_.links_.push_back({{previous, ball}, curve});
    previous = ball;
  }
  system_.links_.push_back({{previous, end_balls[1]}, curve});
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

// The points where the sheets of patches that meet at the crease pass through the circle of two
// consecutive spheres.
void CollarPlacement::add_circle_corners(const CollarLink& link) {
  const CollarBall &a = system_.balls_[link.balls[0]], &b = system_.balls_[link.balls[1]];
  const Vector axis = (b.centre - a.centre) / distance(a.centre, b.centre);
  const double d = distance(a.centre, b.centre);
  const double along = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);
  const double radius = std::sqrt(std::max(0.0, a.radius * a.radius - along * along));
  const Point centre = a.centre + along * axis;
  const auto& points = plc_.curves[link.curve].points;
  for (const Index patch : plc_.curves[link.curve].patches) {
    const Plc::Patch& p = plc_.patches[patch];
    std::vector<Vector> sheets;
    for (Index t = p.first_triangle; t < p.first_triangle + p.triangle_count; ++t) {
      const auto& corners = plc_.triangles[t].points;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k + 1 < points.size(); ++k) {
          const Index u = corners[i], v = corners[(i + 1) % 3];
          if (!((u == points[k] && v == points[k + 1]) || (v == points[k] && u == points[k + 1]))) continue;
          const Vector w = points_[corners[(i + 2) % 3]] - centre;
          const Vector inwards = w - dot(w, axis) * axis;
          const Vector direction = inwards / norm(inwards);
          const bool known = std::any_of(sheets.begin(), sheets.end(), [&](const Vector& s) {
            return dot(s, direction) > 1 - 1e-9;
          });
          if (!known) sheets.push_back(direction);
        }
    }
    for (const Vector& direction : sheets)
      system_.corners_.push_back({centre + radius * direction, 2, patch});
  }
}

}  // namespace collarmesh
