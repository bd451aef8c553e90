// The angles between the features of a complex (paper, Definition 1).
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "plc/angles.h"
#include "plc/edges.h"

namespace collarmesh::build {

namespace {

// Shorter edges and lower triangles than this many planar tolerances point anywhere.
constexpr double noise = 10;
// A fan whose normals all lie within this cosine of the first one is too flat to fold.
constexpr double flat_fan_cosine = 0.866;

// The triangles of one patch around a point, between segments.
struct Fan {
  Index patch = none;
  bool closed = false;
  std::vector<Index> rim;    // the other ends of their edges at the point, in order
  std::vector<Vector> rays;  // towards them

  std::size_t sector_count() const { return closed ? rim.size() : rim.size() - 1; }
  Sector sector(std::size_t i) const { return {rays[i], rays[(i + 1) % rays.size()]}; }
};

// An end of a curve at a vertex.
struct Ray {
  Index curve;
  Index next;  // the next point of its polyline
  Vector direction;
};

class AngleFinder {
 public:
  explicit AngleFinder(const Plc& plc)
      : plc_(plc),
        triangles_(corners_of(plc)),
        edges_(triangles_, plc.points.size()),
        is_segment_(edges_.size(), false) {
    for (const Plc::Curve& curve : plc.curves)
      for_each_segment(curve, [&](Index a, Index b) {
        if (const Index e = edges_.find(a, b); e != none) is_segment_[e] = true;
      });
    index_corners();
    collect_rays();
  }

  std::vector<Crease> run() {
    for (Index c = 0; c < plc_.curves.size(); ++c) measure_curve(c);
    std::vector<Index> vertex_at(plc_.points.size(), none);
    for (Index v = 0; v < plc_.vertices.size(); ++v) vertex_at[plc_.vertices[v].point] = v;
    for (Index p = 0; p < plc_.points.size(); ++p) {
      if (vertex_at[p] != none)
        measure_vertex(vertex_at[p]);
      else
        measure_folds(p, none, fans_at(p, true));
    }
    return std::move(result_);
  }

 private:
  using Kind = Crease::Kind;

  static std::vector<Corners> corners_of(const Plc& plc) {
    std::vector<Corners> triangles;
    triangles.reserve(plc.triangles.size());
    for (const Plc::Triangle& t : plc.triangles) triangles.push_back(t.points);
    return triangles;
  }

  template <class Visit>
  static void for_each_segment(const Plc::Curve& curve, const Visit& visit) {
    for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) visit(curve.points[i], curve.points[i + 1]);
    if (curve.closed) visit(curve.points.back(), curve.points.front());
  }

  void index_corners() {
    first_corner_.assign(plc_.points.size() + 1, 0);
    for (const Corners& t : triangles_)
      for (const Index p : t) ++first_corner_[p + 1];
    for (std::size_t p = 0; p + 1 < first_corner_.size(); ++p) first_corner_[p + 1] += first_corner_[p];
    corners_.resize(3 * triangles_.size());
    std::vector<Index> next(first_corner_.begin(), first_corner_.end() - 1);
    for (Index corner = 0; corner < corners_.size(); ++corner)
      corners_[next[triangles_[corner / 3][corner % 3]]++] = corner;
    visited_.assign(corners_.size(), false);
  }

  const Point& at(Index p) const { return plc_.points[p]; }
  Vector direction(Index from, Index to) const {
    const Vector d = at(to) - at(from);
    return d / norm(d);
  }
  double noise_length() const { return noise * plc_.planar_tolerance; }

  // The polyline's first point that is far enough away tells where an end of a curve heads.
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
    for_each_segment(plc_.curves[c], [&](Index a, Index b) {
      const Index edge = edges_.find(a, b);
      if (edge == none) return;
      const auto sides = edges_.sides(edge);
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

  Index patch_of(Index side) const { return plc_.triangles[side / 3].patch; }

  // Unit vector in the facet, orthogonal to the triangle's side.
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

  // The triangle itself, or the nearest one in its patch that is no needle.
  Index reliable_triangle(Index triangle) const {
    std::vector<Index> seen{triangle};
    for (std::size_t next = 0; next < seen.size() && seen.size() < 64; ++next) {
      if (height(seen[next]) > noise_length()) return seen[next];
      for (Index side = 3 * seen[next]; side < 3 * seen[next] + 3; ++side) {
        const Index other = across(side);
        if (other != none && std::find(seen.begin(), seen.end(), other / 3) == seen.end())
          seen.push_back(other / 3);
      }
    }
    return triangle;
  }

  // The side of the neighbour in the same patch, none at a segment.
  Index across(Index side) const {
    const Index edge = edges_.edge_of(side);
    const auto sides = edges_.sides(edge);
    if (is_segment_[edge] || sides.size() != 2) return none;
    return sides[0] == side ? sides[1] : sides[0];
  }

  // The corner that follows (counterclockwise) or precedes this one in its fan.
  Index next_corner(Index corner) const {
    const Index side = across(corner - corner % 3 + (corner % 3 + 2) % 3);
    return side;
  }
  Index previous_corner(Index corner) const {
    const Index side = across(corner);
    return side == none ? none : side - side % 3 + (side % 3 + 1) % 3;
  }

  std::vector<Fan> fans_at(Index p, bool smooth_only) {
    std::vector<Fan> fans;
    for (Index i = first_corner_[p]; i < first_corner_[p + 1]; ++i) {
      const Index start = corners_[i];
      if (visited_[start]) continue;
      if (smooth_only && plc_.patches[patch_of(start)].planar) continue;
      fans.push_back(make_fan(start));
    }
    return fans;
  }

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
      // A segment ends inside the patch: its two sides are one ray.
      fan.rim.pop_back();
      fan.closed = true;
    }
    for (const Index q : fan.rim) fan.rays.push_back(direction(p, q));
    return fan;
  }

  void measure_vertex(Index v) {
    const Index p = plc_.vertices[v].point;
    const std::vector<Fan> fans = fans_at(p, false);
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

  // A curve and a facet that it is no side of there.
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

  // Facets without a common segment there.
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
    return std::find(fan.rim.begin(), fan.rim.end(), point) != fan.rim.end();
  }
  static bool have_common_ray(const Fan& f, const Fan& g) {
    return std::any_of(f.rim.begin(), f.rim.end(), [&](Index p) { return has_ray(g, p); });
  }

  void measure_folds(Index p, Index v, const std::vector<Fan>& fans) {
    for (const Fan& fan : fans) {
      if (plc_.patches[fan.patch].planar || too_flat_to_fold(fan) || too_small(p, fan)) continue;
      const double angle = fold_angle(fan.rays, fan.closed);
      if (angle < 90) result_.push_back({Kind::patch_fold, angle, none, v, {fan.patch, fan.patch}, at(p)});
    }
  }

  static bool too_flat_to_fold(const Fan& fan) {
    Vector first{};
    for (std::size_t i = 0; i < fan.sector_count(); ++i) {
      const Sector s = fan.sector(i);
      const Vector n = cross(s.u, s.v);
      if (i == 0) first = n / norm(n);
      if (dot(first, n) < flat_fan_cosine * norm(n)) return false;
    }
    return true;
  }

  bool too_small(Index p, const Fan& fan) const {
    return std::any_of(fan.rim.begin(), fan.rim.end(),
                       [&](Index q) { return distance(at(p), at(q)) <= noise_length(); });
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
  std::vector<Corners> triangles_;
  EdgeTable edges_;
  std::vector<bool> is_segment_;               // by edge
  std::vector<Index> first_corner_, corners_;  // corners (3 t + i) at each point
  std::vector<bool> visited_;                  // corners that are in a fan already
  std::vector<std::vector<Ray>> rays_;         // by vertex
  std::vector<Crease> result_;
};

}  // namespace

std::vector<Crease> measure_angles(const Plc& plc) { return AngleFinder(plc).run(); }

}  // namespace collarmesh::build
