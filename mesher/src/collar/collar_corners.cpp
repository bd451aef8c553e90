#include "collar/collar_corners.h"

#include <algorithm>

namespace collarmesh {

namespace {

// Points closer than this, in radii of the circle, count as one: a circle that crosses the edge between two
// triangles gives two points.
constexpr double same_point = 1e-6;
constexpr int most_projections = 40;

// Returns whether a point is at most `slack` away from a triangle.
bool within(const Point& p, const std::array<Point, 3>& t, double slack) {
  return squared_distance_to_triangle(p, t[0], t[1], t[2]) <= slack * slack;
}

}  // namespace

CollarCorners::CollarCorners(const Plc& plc, const FeatureHierarchy& features, const CurvePaths& paths,
                             const CreaseSheets& sheets, std::vector<CornerPoint>& corners)
    : plc_(plc), features_(features), paths_(paths), sheets_(sheets), corners_(corners) {}

// Returns the places where the circle crosses triangles of the patch.
std::vector<Point> CollarCorners::crossings(Index patch, const Circle& circle) const {
  const Vector any = std::fabs(circle.axis.x) < 0.6 ? Vector{1, 0, 0} : Vector{0, 1, 0};
  const Vector across = cross(circle.axis, any), u = across / norm(across), v = cross(circle.axis, u);
  const Vector reach =
      circle.radius * Vector{std::hypot(u.x, v.x), std::hypot(u.y, v.y), std::hypot(u.z, v.z)};
  Box box;
  box.add(circle.centre - reach);
  box.add(circle.centre + reach);
  std::vector<Point> found;
  features_.visit_box({2, patch}, box, [&](Index element) {
    const auto t = features_.corners(element);
    const Vector n = cross(t[1] - t[0], t[2] - t[0]);
    // Solves n . (centre + radius (cos s u + sin s v) - t0) = 0.
    const double a = circle.radius * dot(n, u), b = circle.radius * dot(n, v),
                 c = dot(n, t[0] - circle.centre);
    const double amplitude = std::hypot(a, b);
    if (amplitude == 0 || std::fabs(c) > amplitude) return;
    const double middle = std::atan2(b, a), half = std::acos(std::clamp(c / amplitude, -1.0, 1.0));
    for (const double s : {middle - half, middle + half}) {
      const Point p = circle.centre + circle.radius * (std::cos(s) * u + std::sin(s) * v);
      if (!within(p, t, 0.1 * same_point * circle.radius)) continue;
      if (std::ranges::none_of(found,
                               [&](const Point& q) { return distance(p, q) <= same_point * circle.radius; }))
        found.push_back(p);
    }
  });
  return found;
}

void CollarCorners::add_on_circle(const CollarLink& link, const CollarBall& a, const CollarBall& b) {
  const double d = distance(a.centre, b.centre);
  const Vector axis = (b.centre - a.centre) / d;
  const double along = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);
  const Circle circle{a.centre + along * axis, axis,
                      std::sqrt(std::max(0.0, a.radius * a.radius - along * along))};
  const double parameter = link.parameters[0] + (link.parameters[1] - link.parameters[0]) * along / d;
  const std::vector<Sheet> sheets =
      sheets_.at_segment(paths_.segment_ends(link.curve, paths_.segment(link.curve, parameter)));
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const Index patch = sheets[i].patch;
    const Vector in_plane = sheets[i].direction - dot(sheets[i].direction, axis) * axis;
    const Point straight = circle.centre + circle.radius / norm(in_plane) * in_plane;
    if (plc_.patches[patch].planar) {
      corners_.push_back({straight, 2, patch});
      continue;
    }
    const auto same = [&](const Sheet& s) { return s.patch == patch; };
    const auto first = std::ranges::find_if(sheets, same);
    std::vector<Point> found = crossings(patch, circle);
    if (found.size() == static_cast<std::size_t>(std::ranges::count_if(sheets, same))) {
      if (first == sheets.begin() + static_cast<std::ptrdiff_t>(i))
        for (const Point& p : found) corners_.push_back({p, 2, patch});
      continue;
    }
    if (found.empty()) found.push_back(straight);
    const Point nearest =
        *std::ranges::min_element(found, {}, [&](const Point& p) { return squared_distance(p, straight); });
    corners_.push_back({nearest, 2, patch});
  }
}

void CollarCorners::add_around(const CollarBall& ball) {
  const Plc::Vertex& vertex = plc_.vertices[ball.feature];
  const std::vector<Sheet> sheets = sheets_.at_vertex(ball.feature);
  for (const Index patch : vertex.patches) {
    const bool has_border =
        std::ranges::any_of(vertex.curves, [&](Index c) { return plc_.curve_on_patch(c, patch); });
    if (plc_.patches[patch].planar || has_border) continue;
    // Find points of the patch on the sphere, then choose up to three of them, each as far as possible from
    // the previous ones.
    std::vector<Point> ring;
    for (const Sheet& sheet : sheets) {
      if (sheet.patch != patch) continue;
      Point p = ball.centre + ball.radius * sheet.direction;
      for (int k = 0; k < most_projections; ++k) {
        const Vector d = features_.nearest_point({2, patch}, p) - ball.centre;
        const Point next = ball.centre + ball.radius / norm(d) * d;
        const bool settled = distance(p, next) < 1e-9 * ball.radius;
        p = next;
        if (settled) break;
      }
      ring.push_back(p);
    }
    std::vector<Point> chosen;
    while (chosen.size() < 3 && !ring.empty()) {
      const auto clearance = [&](const Point& p) {
        double nearest = INFINITY;
        for (const Point& q : chosen) nearest = std::min(nearest, squared_distance(p, q));
        return nearest;
      };
      const auto farthest = std::ranges::max_element(ring, {}, clearance);
      if (clearance(*farthest) == 0) break;
      chosen.push_back(*farthest);
    }
    for (const Point& p : chosen) corners_.push_back({p, 2, patch});
  }
}

}  // namespace collarmesh
