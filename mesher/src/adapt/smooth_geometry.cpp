#include "adapt/smooth_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "common/cells_at_vertices.h"
#include "common/distances.h"
#include "common/segments.h"
#include "common/sorted.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh::remeshing::adapting {

namespace {

// Largest distance of the smooth geometry from the facets, relative to the tolerance. The rest of the
// tolerance is left for mesh edges, which are off the smooth geometry between their nodes.
constexpr double share_of_tolerance = 0.7;
// Triangles of a patch, or segments of a curve, that turn by more than 50 degrees (cosine) are not smooth.
constexpr double least_cosine_of_turn = 0.643;
// A surface is not smooth at a corner whose normal is more than 60 degrees (cosine) from that of a triangle.
constexpr double least_cosine_to_facets = 0.5;
// A normal at the border is extrapolated from normals at two distances from the border. These distances must
// differ by at least this share of the larger one.
constexpr double least_room_to_extrapolate = 0.3;
// Limits on the steps from facet to facet, and on the steps of Newton's method, which needs three or four.
constexpr int most_walks = 16, most_newton_steps = 20;
constexpr double rounding = 1e-12;  // relative

Vector unit(const Vector& v) {
  const double length = norm(v);
  return length > 0 ? v / length : Vector{};
}

Vector across(const Vector& v, const Vector& direction) { return v - dot(v, direction) * direction; }

/// Limits a displacement to a length.
Vector limited(const Vector& v, double most) {
  const double length = norm(v);
  return length > most ? most / length * v : v;
}

/// A smooth curve through the points of a polyline.
class SmoothCurve {
 public:
  SmoothCurve(const Plc& plc, const Plc::Curve& curve, double most)
      : closed_(curve.closed), most_(most), segments_(plc.points, flat_triangles_of(curve)) {
    for (const Index p : curve.points) points_.push_back(plc.points[p]);
    const std::size_t n = points_.size();
    tangents_.resize(n);
    bends_.assign(n, 0);
    for (std::size_t i = closed_ ? 0 : 1; i < (closed_ ? n : n - 1); ++i) {
      const Vector before = points_[i] - points_[(i + n - 1) % n], after = points_[(i + 1) % n] - points_[i];
      tangents_[i] = unit(before / squared_norm(before) + after / squared_norm(after));
      bends_[i] = dot(unit(before), unit(after)) >= least_cosine_of_turn ? 1 : 0;
    }
    if (closed_) return;
    end_like(0, 1);
    end_like(n - 1, n - 2);
  }

  Point nearest(const Point& p) const {
    Index segment = none;
    segments_.squared_distance_to(p, INFINITY, &segment);
    double u = 0;
    for (int step = 0; step < most_walks; ++step) {
      u = solve(segment, p);
      const std::optional<Index> next = u < 0   ? neighbour(segment, -1)
                                        : u > 1 ? neighbour(segment, 1)
                                                : std::nullopt;
      if (!next) break;
      segment = *next;
    }
    return at(segment, std::clamp(u, 0.0, 1.0));
  }

  /// Returns the tangent at a point of the polyline; zero where the curve does not bend smoothly.
  Vector tangent(std::size_t i) const { return bends_[i] != 0 ? tangents_[i] : Vector{}; }

 private:
  std::size_t end_of(Index segment) const { return (segment + 1) % points_.size(); }

  /// Gives the end of an open curve the tangent of the circle through it and the next point that touches the
  /// curve at the next point.
  void end_like(std::size_t end, std::size_t next) {
    const Vector along = unit(points_[std::max(end, next)] - points_[std::min(end, next)]);
    bends_[end] = bends_[next];
    tangents_[end] = bends_[next] != 0 ? 2 * dot(tangents_[next], along) * along - tangents_[next] : along;
  }

  std::optional<Index> neighbour(Index segment, int direction) const {
    const auto count = static_cast<Index>(segments_.triangle_count());
    const bool is_last = direction > 0 ? segment + 1 == count : segment == 0;
    if (is_last && !closed_) return std::nullopt;
    return direction > 0 ? (segment + 1) % count : (segment + count - 1) % count;
  }

  /// Returns the parameter of the point on the segment from which the way to p is perpendicular to the
  /// interpolated tangent.
  double solve(Index segment, const Point& p) const {
    const Point& a = points_[segment];
    const Vector along = points_[end_of(segment)] - a, t = tangents_[segment],
                 turn = tangents_[end_of(segment)] - t;
    double u = parameter_on_segment(p, a, points_[end_of(segment)]);
    for (int i = 0; i < most_newton_steps; ++i) {
      const Vector off = p - a - u * along, tangent = t + u * turn;
      const double slope = dot(off, turn) - dot(along, tangent);
      if (slope == 0) break;
      const double change = dot(off, tangent) / slope;
      u -= change;
      if (std::fabs(change) < rounding) break;
    }
    if (!std::isfinite(u)) return parameter_on_segment(p, a, points_[end_of(segment)]);
    return std::clamp(u, -1.0, 2.0);
  }

  Point at(Index segment, double u) const {
    const Index end = static_cast<Index>(end_of(segment));
    const Vector along = points_[end] - points_[segment];
    Vector off{};
    if (bends_[segment] != 0) off = off - u * (1 - u) * (1 - u) * across(along, tangents_[segment]);
    if (bends_[end] != 0) off = off + u * u * (1 - u) * across(along, tangents_[end]);
    const Vector tangent = (1 - u) * tangents_[segment] + u * tangents_[end];
    const double length = norm(tangent);
    if (length > 0) off = across(off, tangent / length) / length;
    return points_[segment] + u * along + limited(off, most_);
  }

  bool closed_;
  double most_;
  std::vector<Point> points_;
  std::vector<Vector> tangents_;
  std::vector<std::uint8_t> bends_;  // by point: whether the curve is tangent to a circle there
  TriangleHierarchy segments_;
};

/// A smooth surface through the points of a patch.
class SmoothPatch {
 public:
  /// `tangents`: by point of the complex, the tangent of a smooth curve there, else zero.
  SmoothPatch(const Plc& plc, Index patch, const SurfaceTolerance& tolerance,
              const std::vector<Vector>& tangents);

  Point nearest(const Point& p) const;

 private:
  using Corners = std::array<Index, 3>;
  using Shares = std::array<double, 3>;  // barycentric coordinates

  Vector facet_normal(const Corners& t) const {
    return cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]);
  }
  void number_points(const Plc& plc, const Plc::Patch& patch, const SurfaceTolerance& tolerance,
                     const std::vector<Vector>& tangents);
  void find_neighbours();
  void find_normals();
  Vector weighted_normal(Index triangle, Index vertex) const;
  Vector border_normal(Index vertex, const CellsAtVertices& at) const;
  void find_heights();
  std::optional<Shares> solve(Index triangle, const Point& p) const;
  Point at(Index triangle, const Shares& shares) const;

  // By point of the patch.
  std::vector<Point> points_;
  std::vector<Vector> tangents_, normals_;
  std::vector<double> most_;                   // largest distance of the surface from the facets
  std::vector<std::uint8_t> border_, folded_;  // whether it is on the border, and whether facets fold there
  // By triangle.
  std::vector<Corners> triangles_;
  std::vector<Corners> neighbours_;             // across the side opposite each corner; none at the border
  std::vector<std::array<double, 6>> heights_;  // heights at control points 01, 10, 12, 21, 20, 02, see `at`
  std::optional<TriangleHierarchy> hierarchy_;
};

SmoothPatch::SmoothPatch(const Plc& plc, Index patch, const SurfaceTolerance& tolerance,
                         const std::vector<Vector>& tangents) {
  number_points(plc, plc.patches[patch], tolerance, tangents);
  find_neighbours();
  find_normals();
  find_heights();
  hierarchy_.emplace(points_, triangles_);
}

void SmoothPatch::number_points(const Plc& plc, const Plc::Patch& patch, const SurfaceTolerance& tolerance,
                                const std::vector<Vector>& tangents) {
  std::vector<Index> numbers;
  for (Index t = 0; t < patch.triangle_count; ++t)
    for (const Index p : plc.triangles[patch.first_triangle + t].points) numbers.push_back(p);
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  for (const Index p : numbers) {
    points_.push_back(plc.points[p]);
    tangents_.push_back(tangents[p]);
    most_.push_back(share_of_tolerance * tolerance.at_point(p));
  }
  for (Index t = 0; t < patch.triangle_count; ++t) {
    Corners corners = plc.triangles[patch.first_triangle + t].points;
    for (Index& p : corners) p = static_cast<Index>(std::ranges::lower_bound(numbers, p) - numbers.begin());
    triangles_.push_back(corners);
  }
}

void SmoothPatch::find_neighbours() {
  border_.assign(points_.size(), 0);
  folded_.assign(points_.size(), 0);
  neighbours_.assign(triangles_.size(), {none, none, none});
  struct Side {
    std::array<Index, 2> ends;
    Index triangle;
    unsigned opposite;
  };
  std::vector<Side> sides;
  for (Index t = 0; t < triangles_.size(); ++t)
    for (unsigned i = 0; i < 3; ++i)
      sides.push_back({sorted(triangles_[t][(i + 1) % 3], triangles_[t][(i + 2) % 3]), t, i});
  std::ranges::sort(sides, [](const Side& a, const Side& b) {
    return std::tie(a.ends, a.triangle) < std::tie(b.ends, b.triangle);
  });
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].ends == sides[first].ends) ++last;
    const Side &a = sides[first], &b = sides[last - 1];
    if (last - first == 2) {
      neighbours_[a.triangle][a.opposite] = b.triangle;
      neighbours_[b.triangle][b.opposite] = a.triangle;
      if (dot(unit(facet_normal(triangles_[a.triangle])), unit(facet_normal(triangles_[b.triangle]))) <
          least_cosine_of_turn)
        for (const Index p : a.ends) folded_[p] = 1;
    } else {
      for (const Index p : a.ends) border_[p] = 1;
    }
  }
}

/// Returns the normal of a triangle with its weight at a corner; zero for a triangle without area.
Vector SmoothPatch::weighted_normal(Index triangle, Index vertex) const {
  const Corners& t = triangles_[triangle];
  const auto i = static_cast<std::size_t>(std::ranges::find(t, vertex) - t.begin());
  const Vector a = points_[t[(i + 1) % 3]] - points_[vertex], b = points_[t[(i + 2) % 3]] - points_[vertex];
  const double scale = squared_norm(a) * squared_norm(b);
  return scale > 0 ? cross(a, b) / scale : Vector{};
}

void SmoothPatch::find_normals() {
  normals_.assign(points_.size(), {});
  for (Index t = 0; t < triangles_.size(); ++t)
    for (const Index p : triangles_[t]) normals_[p] = normals_[p] + weighted_normal(t, p);
  for (Vector& normal : normals_) normal = unit(normal);
  const CellsAtVertices at(triangles_, points_.size());
  std::vector<std::pair<Index, Vector>> found;
  for (Index p = 0; p < points_.size(); ++p)
    if (border_[p] != 0 && squared_norm(tangents_[p]) > 0) found.emplace_back(p, border_normal(p, at));
  for (const auto& [p, normal] : found) normals_[p] = normal;
  for (const Corners& t : triangles_)
    for (const Index p : t)
      if (dot(normals_[p], unit(facet_normal(t))) < least_cosine_to_facets) folded_[p] = 1;
}

/// Returns the normal at a point of a smooth curve at the border. All triangles there are on one side of the
/// curve, so their mean normal belongs to a place farther inside. So the normal at the curve is extrapolated,
/// in the direction across the curve, from this mean and the mean normal of the neighbours inside.
Vector SmoothPatch::border_normal(Index vertex, const CellsAtVertices& at) const {
  const Vector mean = unit(across(normals_[vertex], tangents_[vertex]));
  const Vector inwards = cross(mean, tangents_[vertex]);
  Vector inside{};
  double weights = 0, to_mean = 0, neighbours = 0, to_inside = 0;
  for (const Index t : at[vertex]) {
    const double weight = norm(weighted_normal(t, vertex));
    for (const Index other : triangles_[t]) {
      const double way = dot(points_[other] - points_[vertex], inwards);
      to_mean += weight * way / 3;
      if (other == vertex || border_[other] != 0) continue;
      inside = inside + normals_[other];
      to_inside += way;
      ++neighbours;
    }
    weights += weight;
  }
  if (weights == 0 || neighbours == 0) return mean;
  to_mean /= weights;
  to_inside /= neighbours;
  inside = unit(across(inside, tangents_[vertex]));
  const double left = to_inside - to_mean;
  if (!(left / to_inside > least_room_to_extrapolate)) return mean;
  return unit(mean + to_mean / left * (mean - inside));
}

void SmoothPatch::find_heights() {
  for (const Corners& t : triangles_) {
    std::array<double, 6> heights{};
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = t[i], b = t[(i + 1) % 3];
      if (folded_[a] == 0) heights[2 * i] = dot(points_[a] - points_[b], normals_[a]) / 3;
      if (folded_[b] == 0) heights[2 * i + 1] = dot(points_[b] - points_[a], normals_[b]) / 3;
    }
    heights_.push_back(heights);
  }
}

Point SmoothPatch::nearest(const Point& p) const {
  Index triangle = none;
  hierarchy_->squared_distance_to(p, INFINITY, &triangle);
  const std::array<Point, 3> corners = hierarchy_->corners(triangle);
  std::optional<Shares> found = solve(triangle, p);
  for (int walk = 0; walk < most_walks && found; ++walk) {
    const auto beyond = static_cast<std::size_t>(std::ranges::min_element(*found) - found->begin());
    const Index next = neighbours_[triangle][beyond];
    if ((*found)[beyond] >= -rounding || next == none) break;
    triangle = next;
    found = solve(triangle, p);
  }
  if (!found) return nearest_point_on_triangle(p, corners[0], corners[1], corners[2]);
  double sum = 0;
  for (double& share : *found) sum += share = std::max(share, 0.0);
  for (double& share : *found) share /= sum;
  return at(triangle, *found);
}

/// Finds the point of a triangle's plane from which the interpolated normal leads to p, by Newton's method.
std::optional<SmoothPatch::Shares> SmoothPatch::solve(Index triangle, const Point& p) const {
  const auto& [a, b, c] = triangles_[triangle];
  const Vector ab = points_[b] - points_[a], ac = points_[c] - points_[a], normal = cross(ab, ac);
  const Vector turn_b = normals_[b] - normals_[a], turn_c = normals_[c] - normals_[a];
  const double twice_area = squared_norm(normal),
               size = std::sqrt(std::max(squared_norm(ab), squared_norm(ac)));
  if (!(twice_area > 0)) return std::nullopt;
  double u = dot(cross(p - points_[a], ac), normal) / twice_area,
         v = dot(cross(ab, p - points_[a]), normal) / twice_area, height = 0;
  for (int i = 0; i < most_newton_steps; ++i) {
    const Vector along = normals_[a] + u * turn_b + v * turn_c;
    const Vector off = points_[a] + u * ab + v * ac + height * along - p;
    const Vector by_u = ab + height * turn_b, by_v = ac + height * turn_c;
    const double determinant = dot(cross(by_u, by_v), along);
    if (determinant == 0) return std::nullopt;
    const double du = dot(cross(off, by_v), along) / determinant,
                 dv = dot(cross(by_u, off), along) / determinant,
                 dh = dot(cross(by_u, by_v), off) / determinant;
    u -= du, v -= dv, height -= dh;
    if (std::fabs(du) + std::fabs(dv) + std::fabs(dh) / size < rounding) return Shares{1 - u - v, u, v};
  }
  return std::nullopt;
}

Point SmoothPatch::at(Index triangle, const Shares& s) const {
  const Corners& t = triangles_[triangle];
  const std::array<double, 6>& h = heights_[triangle];
  Point p{};
  Vector normal{};
  double most = 0, height = 0, sum = 0;
  for (unsigned i = 0; i < 3; ++i) {
    const double mine = s[i], next = s[(i + 1) % 3];
    p = p + mine * points_[t[i]];
    normal = normal + mine * normals_[t[i]];
    most += mine * most_[t[i]];
    height += 3 * mine * next * (mine * h[2 * i] + next * h[2 * i + 1]);
    sum += h[2 * i] + h[2 * i + 1];
  }
  height +=
      6 * s[0] * s[1] * s[2] * sum / 4;  // the middle coefficient with which quadratic heights are exact
  return p + std::clamp(height, -most, most) * unit(normal);
}

class SmoothGeometry {
 public:
  SmoothGeometry(const Plc& plc, const SurfaceTolerance& tolerance)
      : curves_(plc.curves.size()), patches_(plc.patches.size()) {
    std::vector<Vector> tangents(plc.points.size());
    for (Index c = 0; c < plc.curves.size(); ++c) {
      const Plc::Curve& curve = plc.curves[c];
      if (curve.straight || curve.points.size() < 3) continue;
      const double most = share_of_tolerance * tolerance.least_on_curve(curve);
      curves_[c] = std::make_unique<SmoothCurve>(plc, curve, most);
      for (std::size_t i = 0; i < curve.points.size(); ++i)
        if (curve.closed || (i > 0 && i + 1 < curve.points.size()))
          tangents[curve.points[i]] = curves_[c]->tangent(i);
    }
    for (Index k = 0; k < plc.patches.size(); ++k)
      if (!plc.patches[k].planar) patches_[k] = std::make_unique<SmoothPatch>(plc, k, tolerance, tangents);
  }

  std::optional<Point> operator()(unsigned dimension, Index feature, const Point& p) const {
    if (dimension == 1 && curves_[feature]) return curves_[feature]->nearest(p);
    if (dimension == 2 && patches_[feature]) return patches_[feature]->nearest(p);
    return std::nullopt;
  }

 private:
  std::vector<std::unique_ptr<SmoothCurve>> curves_;   // null for straight ones
  std::vector<std::unique_ptr<SmoothPatch>> patches_;  // null for planar ones
};

}  // namespace

ExactGeometry smooth_geometry(const Plc& plc, const SurfaceTolerance& tolerance) {
  const auto geometry = std::make_shared<const SmoothGeometry>(plc, tolerance);
  return [geometry](unsigned dimension, Index feature, const Point& p) {
    return (*geometry)(dimension, feature, p);
  };
}

}  // namespace collarmesh::remeshing::adapting
