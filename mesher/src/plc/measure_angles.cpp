// Measures the angles between the features of a complex (paper, Definition 1).
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "common/cells_at_vertices.h"
#include "common/segments.h"
#include "facets/edges.h"
#include "plc/angles.h"

namespace collarmesh::plc {

using namespace facets;

namespace {

/// The triangles of one patch around a point, bounded by segments.
struct Fan {
  Index patch = none;
  bool closed = false;
  std::vector<Index> rim;    ///< the other ends of the triangles' edges at the point, in order
  std::vector<Vector> rays;  ///< unit vectors towards them

  std::size_t sector_count() const { return closed ? rim.size() : rim.size() - 1; }
  Sector sector(std::size_t i) const { return {rays[i], rays[(i + 1) % rays.size()]}; }
};

// A fan is too flat to fold if the cosines between all its normals and the first one exceed this.
constexpr double flat_fan_cosine = 0.866;

std::vector<Corners> corners_of(const std::vector<Plc::Triangle>& triangles) {
  std::vector<Corners> corners;
  corners.reserve(triangles.size());
  for (const Plc::Triangle& t : triangles) corners.push_back(t.points);
  return corners;
}

bool too_flat_to_fold(const Fan& fan) {
  Vector first{};
  for (std::size_t i = 0; i < fan.sector_count(); ++i) {
    const Sector s = fan.sector(i);
    const Vector n = cross(s.u, s.v);
    if (i == 0) first = n / norm(n);
    if (dot(first, n) < flat_fan_cosine * norm(n)) return false;
  }
  return true;
}

/// The triangles of each patch around its points, divided by segments.
class PatchFans {
 public:
  /// Keeps points and patches by reference. Segments are pairs of points in any order.
  PatchFans(std::span<const Point> points, const std::vector<Plc::Triangle>& triangles,
            const std::vector<Plc::Patch>& patches, std::span<const std::array<Index, 2>> segments)
      : points_(points),
        patches_(patches),
        triangles_(corners_of(triangles)),
        edges_(triangles_, points.size()),
        is_segment_(edges_.size(), false) {
    patch_of_.reserve(triangles.size());
    for (const Plc::Triangle& t : triangles) patch_of_.push_back(t.patch);
    for (const auto& [a, b] : segments)
      if (const Index e = edges_.find(a, b); e != none) is_segment_[e] = true;
    triangles_at_ = {triangles_, points_.size()};
    visited_.assign(3 * triangles_.size(), false);
  }

  const std::vector<Corners>& triangles() const { return triangles_; }
  const EdgeTable& edges() const { return edges_; }
  Index patch_of(Index side) const { return patch_of_[side / 3]; }

  /// Returns the fans around a point, of smooth patches only or of all.
  std::vector<Fan> at(Index point, bool smooth_only) {
    std::vector<Fan> fans;
    const auto corner_of = [&](Index t) {
      return 3 * t + (triangles_[t][0] == point ? 0 : triangles_[t][1] == point ? 1 : 2);
    };
    for (const Index t : triangles_at_[point]) {
      const Index start = corner_of(t);
      if (visited_[start] || (smooth_only && patches_[patch_of(start)].planar)) continue;
      fans.push_back(make_fan(start));
    }
    for (const Index t : triangles_at_[point]) visited_[corner_of(t)] = false;
    return fans;
  }
  /// Returns the side of the neighbouring triangle on the same edge; none at a segment, or if not exactly two
  /// triangles meet there.
  Index across(Index side) const {
    const Index edge = edges_.edge_of(side);
    const auto sides = edges_.sides(edge);
    if (is_segment_[edge] || sides.size() != 2) return none;
    return sides[0] == side ? sides[1] : sides[0];
  }

  /// Returns how sharply a smooth patch folds in a fan around the point (degrees, see fold_angle); 180 if the
  /// fan is too flat to fold, or if an edge of it is no longer than `noise_length`, because the direction of
  /// such an edge is unreliable.
  double fold(Index point, const Fan& fan, double noise_length) const {
    const bool too_small = std::ranges::any_of(
        fan.rim, [&](Index q) { return distance(points_[point], points_[q]) <= noise_length; });
    return too_small || too_flat_to_fold(fan) ? 180 : fold_angle(fan.rays, fan.closed);
  }

 private:
  Fan make_fan(Index start) {
    Index first = start;
    for (Index c = previous_corner(start); c != none && c != start; c = previous_corner(c)) first = c;
    Fan fan;
    fan.patch = patch_of(start);
    fan.closed = previous_corner(first) != none;
    const Index p = triangles_[start / 3][start % 3];
    Index last = first;
    for (Index c = first; c != none && !visited_[c]; c = next_corner(c)) {
      visited_[c] = true;
      last = c;
      fan.rim.push_back(triangles_[c / 3][(c % 3 + 1) % 3]);
    }
    if (!fan.closed) fan.rim.push_back(triangles_[last / 3][(last % 3 + 2) % 3]);
    if (!fan.closed && fan.rim.size() > 2 && fan.rim.front() == fan.rim.back()) {
      // If a segment ends inside the patch, its two sides are one ray.
      fan.rim.pop_back();
      fan.closed = true;
    }
    for (const Index q : fan.rim)
      fan.rays.push_back((points_[q] - points_[p]) / distance(points_[p], points_[q]));
    return fan;
  }
  // Returns the corner that follows (counterclockwise) or precedes this one in its fan.
  Index next_corner(Index corner) const { return across(corner - corner % 3 + (corner % 3 + 2) % 3); }
  Index previous_corner(Index corner) const {
    const Index side = across(corner);
    return side == none ? none : side - side % 3 + (side % 3 + 1) % 3;
  }

  std::span<const Point> points_;
  const std::vector<Plc::Patch>& patches_;
  std::vector<Corners> triangles_;
  std::vector<Index> patch_of_;  // by triangle
  EdgeTable edges_;
  std::vector<bool> is_segment_;  // by edge
  CellsAtVertices triangles_at_;
  std::vector<bool> visited_;  // corners that already are in a fan
};

// The direction of an edge is unreliable if the edge is shorter than this many planar tolerances; so is the
// normal of a triangle whose height is smaller.
constexpr double noise = 10;
// A patch has a vertex at a point where it folds to less than this angle (degrees).
constexpr double folded = 90;
// An end of a curve at a vertex.
struct Ray {
  Index curve;
  Index next;  // the curve's next point
  Vector direction;
};

class AngleFinder {
 public:
  explicit AngleFinder(const Plc& plc)
      : plc_(plc),
        fans_(plc.points, plc.triangles, plc.patches, segments_of(plc)),
        triangles_(fans_.triangles()) {
    collect_rays();
  }

  std::vector<Crease> run() {
    for (Index c = 0; c < plc_.curves.size(); ++c) measure_curve(c);
    for (Index v = 0; v < plc_.vertices.size(); ++v) measure_vertex(v);
    return std::move(result_);
  }

 private:
  using Kind = Crease::Kind;

  static std::vector<std::array<Index, 2>> segments_of(const Plc& plc) {
    std::vector<std::array<Index, 2>> segments;
    for (const Plc::Curve& curve : plc.curves)
      visit_segments(curve, [&](Index a, Index b) { segments.push_back({a, b}); });
    return segments;
  }

  const Point& at(Index p) const { return plc_.points[p]; }
  Vector direction(Index from, Index to) const {
    const Vector d = at(to) - at(from);
    return d / norm(d);
  }
  double noise_length() const { return noise * plc_.planar_tolerance; }

  // Returns the direction of a curve's end, towards the first point that is farther from it than
  // `noise_length`.
  Ray make_ray(Index curve, std::vector<Index> points) const {
    std::size_t far = 1;
    while (far + 1 < points.size() && distance(at(points[0]), at(points[far])) <= noise_length()) ++far;
    return {curve, points[1], direction(points[0], points[far])};
  }

  void collect_rays() {
    rays_.resize(plc_.vertices.size());
    for (Index c = 0; c < plc_.curves.size(); ++c) {
      const Plc::Curve& curve = plc_.curves[c];
      if (curve.closed) continue;
      rays_[curve.ends[0]].push_back(make_ray(c, curve.points));
      rays_[curve.ends[1]].push_back(make_ray(c, {curve.points.rbegin(), curve.points.rend()}));
    }
  }

  void measure_curve(Index c) {
    Crease best{Kind::facets, 180, c, none, {none, none}, {}};
    visit_segments(plc_.curves[c], [&](Index a, Index b) {
      const Index edge = fans_.edges().find(a, b);
      if (edge == none) return;
      const auto sides = fans_.edges().sides(edge);
      for (std::size_t i = 0; i < sides.size(); ++i)
        for (std::size_t j = i + 1; j < sides.size(); ++j) {
          const double angle = angle_between(into_facet(sides[i]), into_facet(sides[j]));
          if (angle < best.angle)
            best = {Kind::facets,         angle, c, none, {patch_of(sides[i]), patch_of(sides[j])},
                    0.5 * (at(a) + at(b))};
        }
    });
    if (best.features[0] != none) result_.push_back(best);
  }

  Index patch_of(Index side) const { return fans_.patch_of(side); }

  // Returns the unit vector in the triangle's plane that points inwards, orthogonal to its side.
  Vector into_facet(Index side) const {
    const Corners& t = triangles_[side / 3];
    const Vector d = cross(facet_normal(side / 3), at(t[(side % 3 + 1) % 3]) - at(t[side % 3]));
    return d / norm(d);
  }

  Vector facet_normal(Index triangle) const {
    const Plc::Patch& patch = plc_.patches[plc_.triangles[triangle].patch];
    return patch.planar ? patch.normal : normal(reliable_triangle(triangle));
  }

  Vector normal(Index t) const {
    const Vector n =
        cross(at(triangles_[t][1]) - at(triangles_[t][0]), at(triangles_[t][2]) - at(triangles_[t][0]));
    return n / norm(n);
  }

  double height(Index t) const {
    const Point &a = at(triangles_[t][0]), &b = at(triangles_[t][1]), &c = at(triangles_[t][2]);
    return norm(cross(b - a, c - a)) / std::max({distance(a, b), distance(b, c), distance(c, a)});
  }

  // Returns the triangle itself or, if its normal is unreliable, a near triangle of its patch whose normal is
  // not.
  Index reliable_triangle(Index triangle) const {
    std::vector<Index> seen{triangle};
    for (std::size_t next = 0; next < seen.size() && seen.size() < 64; ++next) {
      if (height(seen[next]) > noise_length()) return seen[next];
      for (Index side = 3 * seen[next]; side < 3 * seen[next] + 3; ++side) {
        const Index other = fans_.across(side);
        if (other != none && std::ranges::find(seen, other / 3) == seen.end()) seen.push_back(other / 3);
      }
    }
    return triangle;
  }

  void measure_vertex(Index v) {
    const Index p = plc_.vertices[v].point;
    const std::vector<Fan> fans = fans_.at(p, false);
    measure_segments(v);
    measure_segments_and_facets(v, fans);
    measure_facets(v, fans);
    measure_folds(p, v, fans);
  }

  void measure_segments(Index v) {
    const auto& rays = rays_[v];
    Crease best = at_vertex(Kind::segments, v);
    for (std::size_t i = 0; i < rays.size(); ++i)
      for (std::size_t j = i + 1; j < rays.size(); ++j)
        keep_smaller(best, angle_between(rays[i].direction, rays[j].direction), rays[i].curve, rays[j].curve);
    add(best);
  }

  // Measures angles between a curve and facets at a vertex, except facets with the curve as a side.
  void measure_segments_and_facets(Index v, const std::vector<Fan>& fans) {
    Crease best = at_vertex(Kind::segment_and_facet, v);
    for (const Ray& ray : rays_[v])
      for (const Fan& fan : fans) {
        if (has_ray(fan, ray.next)) continue;
        for (std::size_t i = 0; i < fan.sector_count(); ++i)
          keep_smaller(best, angle_between(ray.direction, fan.sector(i)), ray.curve, fan.patch);
      }
    add(best);
  }

  // Measures angles between facets that share no segment at a vertex.
  void measure_facets(Index v, const std::vector<Fan>& fans) {
    Crease best = at_vertex(Kind::facets_in_vertex, v);
    for (std::size_t f = 0; f < fans.size(); ++f)
      for (std::size_t g = f + 1; g < fans.size(); ++g) {
        if (have_common_ray(fans[f], fans[g])) continue;
        for (std::size_t i = 0; i < fans[f].sector_count(); ++i)
          for (std::size_t j = 0; j < fans[g].sector_count(); ++j)
            keep_smaller(best, angle_between(fans[f].sector(i), fans[g].sector(j)), fans[f].patch,
                         fans[g].patch);
      }
    add(best);
  }

  static bool has_ray(const Fan& fan, Index point) {
    return std::ranges::find(fan.rim, point) != fan.rim.end();
  }
  static bool have_common_ray(const Fan& f, const Fan& g) {
    return std::ranges::any_of(f.rim, [&](Index p) { return has_ray(g, p); });
  }

  void measure_folds(Index p, Index v, const std::vector<Fan>& fans) {
    for (const Fan& fan : fans) {
      if (plc_.patches[fan.patch].planar) continue;
      const double angle = fans_.fold(p, fan, noise_length());
      if (angle < folded)
        result_.push_back({Kind::patch_fold, angle, none, v, {fan.patch, fan.patch}, at(p)});
    }
  }

  Crease at_vertex(Kind kind, Index v) const {
    return {kind, 180, none, v, {none, none}, at(plc_.vertices[v].point)};
  }
  static void keep_smaller(Crease& best, double angle, Index first, Index second) {
    if (angle >= best.angle) return;
    best.angle = angle;
    best.features = {first, second};
  }
  void add(const Crease& crease) {
    if (crease.features[0] != none) result_.push_back(crease);
  }

  const Plc& plc_;
  PatchFans fans_;
  const std::vector<Corners>& triangles_;
  std::vector<std::vector<Ray>> rays_;  // by vertex
  std::vector<Crease> result_;
};

// If the cosines between all normals and one of them exceed this, the triangles are within 30 degrees of each
// other: their fan is too flat to fold.
constexpr double flat_cosine = 0.966;

// Returns the points where a triangle of a smooth patch turns by more than 15 degrees from the patch's first
// triangle there.
std::vector<Index> points_not_flat(std::span<const Point> points, const Plc& plc) {
  struct First {
    Index patch = none;  // the last patch found at the point
    Vector normal;       // normal of that patch's first triangle there
  };
  std::vector<First> first(points.size());
  std::vector<bool> flat(points.size(), true);
  for (const Plc::Triangle& t : plc.triangles) {
    if (plc.patches[t.patch].planar) continue;
    const Point& a = points[t.points[0]];
    const Vector n = cross(points[t.points[1]] - a, points[t.points[2]] - a);
    const double nn = squared_norm(n);
    for (const Index p : t.points) {
      if (first[p].patch != t.patch) first[p] = {t.patch, n};
      const double agreement = dot(first[p].normal, n);
      if (!(agreement > 0) ||
          agreement * agreement < flat_cosine * flat_cosine * nn * squared_norm(first[p].normal))
        flat[p] = false;
    }
  }
  std::vector<Index> result;
  for (Index p = 0; p < points.size(); ++p)
    if (!flat[p]) result.push_back(p);
  return result;
}

}  // namespace

std::vector<Crease> measure_angles(const Plc& plc) {
  if (plc.curves.empty() && plc.vertices.empty()) return {};
  return AngleFinder(plc).run();
}

std::vector<Index> find_folds(std::span<const Point> points, const Plc& plc,
                              std::span<const FeatureSegment> segments) {
  std::vector<Index> folds = points_not_flat(points, plc);
  if (folds.empty()) return folds;
  std::vector<std::array<Index, 2>> ends;
  ends.reserve(segments.size());
  for (const FeatureSegment& s : segments) ends.push_back({s.a, s.b});
  PatchFans fans(points, plc.triangles, plc.patches, ends);
  std::erase_if(folds, [&](Index p) {
    const std::vector<Fan> around = fans.at(p, true);
    return std::ranges::none_of(
        around, [&](const Fan& fan) { return fans.fold(p, fan, noise * plc.planar_tolerance) < folded; });
  });
  return folds;
}

}  // namespace collarmesh::plc
