#include "collar/flatness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/sorted.h"

namespace collarmesh {

namespace {

// Largest deviation of a feature from chords as long as a radius: as a share of the distance tolerance, and
// as a share of the radius. The latter lets a polyline turn by 30 degrees at one point.
constexpr double deviation_per_distance = 0.5;
constexpr double deviation_per_radius = 0.14;
// The radius of a ball on a curve that is not straight is at most this share of the curve's length.
constexpr double radius_per_length = 1.0 / 8;
// Another piece of a feature counts like a feature that does not contain the centre: radii are at most a
// third of the distance to it. A point of a curve is on another piece if its distance from the centre along
// the curve exceeds `detour` times its straight distance.
constexpr double pieces_per_radius = 3;
constexpr double detour = 1.5;
// Places on a chord, as shares of its length, where it is compared with the feature.
constexpr std::array<double, 3> chord_shares{0.25, 0.5, 0.75};
constexpr std::size_t most_spokes = 16;  // most edges from the ball's centre that are compared with a patch
constexpr double rounding = 1e-6;        // tolerance of lengths, relative to the ball's radius
constexpr int most_steps = 60;

}  // namespace

Flatness::Flatness(const Plc& plc, const FeatureHierarchy& features, const CurvePaths& paths,
                   const CreaseSheets& sheets, SurfaceTolerance tolerance)
    : plc_(plc), features_(features), paths_(paths), sheets_(sheets), tolerance_(std::move(tolerance)) {}

bool Flatness::matters_on(Index curve) const {
  const Plc::Curve& c = plc_.curves[curve];
  return !c.straight ||
         std::ranges::any_of(c.patches, [&](Index patch) { return !plc_.patches[patch].planar; });
}

// Returns the radius, shrunk until the deviation at it is permitted. On a smooth feature the deviation grows
// with the square of the radius, at a bend linearly.
template <class Deviation>
double Flatness::shrunk(double radius, double tolerance, const Deviation& deviation) {
  for (int step = 0; step < most_steps; ++step) {
    const double off = deviation(radius);
    const double allowed = std::min(deviation_per_distance * tolerance, deviation_per_radius * radius);
    if (off <= allowed) break;
    radius *= std::clamp(std::sqrt(allowed / off), 0.25, 0.97);
  }
  return radius;
}

// Returns how far the part of a curve between two parameters deviates from its chord.
double Flatness::off_chord(Index curve, double from, double to) const {
  const Point a = paths_.point(curve, from), b = paths_.point(curve, to);
  double largest = 0;
  for (const double share : chord_shares)
    largest = std::fmax(
        largest, squared_distance_to_triangle(paths_.point(curve, from + share * (to - from)), a, b, b));
  return std::sqrt(largest);
}

// Returns how far the chord of a sheet deviates from its patch. The chord leads from the centre to the
// patch's point nearest to centre + radius * direction.
double Flatness::off_patch(const Sheet& sheet, const Point& centre, double radius) const {
  return off_spoke(sheet.patch, centre,
                   features_.nearest_point({2, sheet.patch}, centre + radius * sheet.direction));
}

// Returns how far the edge between the centre and a point of the patch deviates from the patch.
double Flatness::off_spoke(Index patch, const Point& centre, const Point& end) const {
  double largest = 0;
  for (const double share : chord_shares) {
    const Point p = centre + share * (end - centre);
    largest = std::fmax(largest, distance(p, features_.nearest_point({2, patch}, p)));
  }
  return largest;
}

// Returns how far edges from the centre to the sphere deviate from the patch. They end at up to `most_spokes`
// points where sides of the patch's triangles leave the ball.
double Flatness::off_arc(Index patch, const Point& centre, double radius) const {
  Box box;
  box.add(centre - radius * Vector{1, 1, 1});
  box.add(centre + radius * Vector{1, 1, 1});
  std::vector<Point> ends;
  features_.visit_box({2, patch}, box, [&](Index element) {
    const auto t = features_.corners(element);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector a = t[i] - centre, side = t[(i + 1) % 3] - t[i];
      const double aa = squared_norm(a), ab = dot(a, side), bb = squared_norm(side);
      if (aa > radius * radius || squared_norm(a + side) <= radius * radius) continue;
      ends.push_back(t[i] + (std::sqrt(ab * ab + bb * (radius * radius - aa)) - ab) / bb * side);
    }
  });
  double largest = 0;
  const std::size_t stride = std::max<std::size_t>(1, (ends.size() + most_spokes - 1) / most_spokes);
  for (std::size_t i = 0; i < ends.size(); i += stride)
    largest = std::fmax(largest, off_spoke(patch, centre, ends[i]));
  return largest;
}

// Returns the distance from the point at `parameter` to the nearest other piece of the curve, at most
// `reach`.
double Flatness::other_arcs(Index curve, double parameter, double reach) const {
  const Point p = paths_.point(curve, parameter);
  const double length = paths_.length(curve);
  Index nearest = none;
  return features_.distance_within({1, curve}, p, reach, nearest, [&](Index element) {
    const auto t = features_.corners(element);
    const Point q = nearest_point_on_triangle(p, t[0], t[1], t[2]);
    double along =
        std::fabs(paths_.lengths(curve)[features_.number(element)] + distance(t[0], q) - parameter);
    if (plc_.curves[curve].closed) along = std::min(along, length - along);
    return along > detour * distance(p, q) + rounding * reach;
  });
}

// Returns the distance from the centre to the nearest other sheet of the patch, at most `reach`. A triangle
// is on another sheet if no path across sides that meet the ball B(centre, reach) leads from it to a triangle
// with both `points` (at a vertex, the same point twice).
double Flatness::other_sheets(Index patch, const Point& centre, double reach,
                              const std::array<Index, 2>& points) const {
  struct Side {
    std::array<Index, 2> key;
    std::size_t triangle;
  };
  struct Found {
    double squared_distance;
    bool reached;
  };
  std::vector<Found> found;
  std::vector<Side> sides;
  std::vector<std::size_t> stack;
  Box box;
  box.add(centre - reach * Vector{1, 1, 1});
  box.add(centre + reach * Vector{1, 1, 1});
  features_.visit_box({2, patch}, box, [&](Index element) {
    const auto t = features_.corners(element);
    const auto& v = features_.element(element);
    const double d = squared_distance_to_triangle(centre, t[0], t[1], t[2]);
    if (d > reach * reach) return;
    const auto has = [&](Index point) { return std::ranges::find(v, point) != v.end(); };
    const bool here = has(points[0]) && has(points[1]);
    if (here) stack.push_back(found.size());
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if (squared_distance_to_triangle(centre, t[i], t[j], t[j]) <= reach * reach)
        sides.push_back({sorted(v[i], v[j]), found.size()});
    }
    found.push_back({d, here});
  });
  std::ranges::sort(sides, {}, [](const Side& side) { return std::pair(side.key, side.triangle); });
  std::vector<std::pair<std::size_t, std::size_t>> neighbours;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    if (sides[i].key != sides[i + 1].key) continue;
    neighbours.push_back({sides[i].triangle, sides[i + 1].triangle});
    neighbours.push_back({sides[i + 1].triangle, sides[i].triangle});
  }
  std::ranges::sort(neighbours);
  while (!stack.empty()) {
    const std::size_t t = stack.back();
    stack.pop_back();
    for (auto it = std::ranges::lower_bound(neighbours, std::pair{t, std::size_t{0}});
         it != neighbours.end() && it->first == t; ++it) {
      if (found[it->second].reached) continue;
      found[it->second].reached = true;
      stack.push_back(it->second);
    }
  }
  double nearest = reach * reach;
  for (const Found& f : found)
    if (!f.reached) nearest = std::min(nearest, f.squared_distance);
  return std::sqrt(nearest);
}

double Flatness::radius_on_curve(Index curve, double parameter, double radius) const {
  const Plc::Curve& c = plc_.curves[curve];
  const double length = paths_.length(curve);
  const std::array<Index, 2> ends = paths_.segment_ends(curve, paths_.segment(curve, parameter));
  const double tolerance = tolerance_.at_segment(ends[0], ends[1]);
  const auto from = [&](double s) { return c.closed ? s : std::clamp(s, 0.0, length); };
  if (!c.straight) {
    radius = std::min(radius, radius_per_length * length);
    radius = shrunk(radius, tolerance, [&](double r) {
      return std::max(off_chord(curve, parameter, from(parameter + r)),
                      off_chord(curve, parameter, from(parameter - r)));
    });
    radius = other_arcs(curve, parameter, pieces_per_radius * radius) / pieces_per_radius;
  }
  const Point centre = paths_.point(curve, parameter);
  const Vector chord =
      paths_.point(curve, from(parameter + radius)) - paths_.point(curve, from(parameter - radius));
  const Vector along = chord / norm(chord);
  for (const Sheet& sheet : sheets_.at_segment(ends)) {
    if (plc_.patches[sheet.patch].planar) continue;
    for (const double lean : {0.0, 1.0, -1.0}) {
      const Vector direction = sheet.direction + lean * along;
      radius = shrunk(radius, tolerance, [&](double r) {
        return off_patch({sheet.patch, direction / norm(direction)}, centre, r);
      });
    }
  }
  for (const Index patch : c.patches)
    if (!plc_.patches[patch].planar)
      radius = other_sheets(patch, centre, pieces_per_radius * radius, ends) / pieces_per_radius;
  return radius;
}

double Flatness::radius_at_vertex(Index vertex, double radius) const {
  const Index point = plc_.vertices[vertex].point;
  const double tolerance = tolerance_.at_point(point);
  for (const Index c : plc_.vertices[vertex].curves) {
    const Plc::Curve& curve = plc_.curves[c];
    if (curve.straight) continue;
    const double length = paths_.length(c);
    radius = std::min(radius, radius_per_length * length);
    for (const bool at_start : {true, false}) {
      if (curve.ends[at_start ? 0 : 1] != vertex) continue;
      radius = shrunk(radius, tolerance, [&](double r) {
        return at_start ? off_chord(c, 0, r) : off_chord(c, length, length - r);
      });
      // A loop's other end is at the centre, too, so the distance to it would be 0.
      if (curve.ends[0] != curve.ends[1])
        radius = other_arcs(c, at_start ? 0 : length, pieces_per_radius * radius) / pieces_per_radius;
    }
  }
  const Point centre = features_.nearest_point({0, vertex}, {});
  for (const Sheet& sheet : sheets_.at_vertex(vertex))
    radius = shrunk(radius, tolerance, [&](double r) { return off_patch(sheet, centre, r); });
  for (const Index patch : plc_.vertices[vertex].patches) {
    if (plc_.patches[patch].planar) continue;
    radius = other_sheets(patch, centre, pieces_per_radius * radius, {point, point}) / pieces_per_radius;
    radius = shrunk(radius, tolerance, [&](double r) { return off_arc(patch, centre, r); });
  }
  return radius;
}

}  // namespace collarmesh
