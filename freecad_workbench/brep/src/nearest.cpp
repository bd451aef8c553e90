// Finds nearest points on exact edges and surfaces.
#include "nearest.h"

#include "points.h"

#define BOOST_ALLOW_DEPRECATED_HEADERS  // Boost's own headers include some
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <ElSLib.hxx>
#include <Extrema_ExtPC.hxx>
#include <Extrema_ExtPS.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace collarmesh::brep {

namespace {

namespace bg = boost::geometry;
using TreePoint = bg::model::point<double, 3, bg::cs::cartesian>;
using TreeBox = bg::model::box<TreePoint>;
using Tree = bg::index::rtree<std::pair<TreeBox, std::size_t>, bg::index::quadratic<16>>;

gp_Pnt to_gp(const Point& p) { return {p.x, p.y, p.z}; }
/// Replaces `best` by `other` if `other` is nearer to p, or if there is no `best` yet.
void keep_nearer(std::optional<Point>& best, const std::optional<Point>& other, const Point& p) {
  if (other && (!best || squared_distance(*other, p) < squared_distance(*best, p))) best = other;
}

/// Limits of a descent to the point nearest to p. Lengths are relative to a scale: the distance of p from the
/// origin plus its distance from the start of the descent.
namespace descent {
constexpr int steps = 50, halvings = 20;
constexpr double rounding = 1e-15;
constexpr double converged = 1e-11;  // a step up to this may end a descent: rounding hides its gain
}  // namespace descent

/// Returns the barycentric coordinates of the point of a triangle that is nearest to p.
std::array<double, 3> nearest_weights(const Point& p, const std::array<Point, 3>& corners) {
  const Vector normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  std::array<double, 3> weights{-1, -1, -1};
  for (std::size_t i = 0; i < 3 && squared_norm(normal) > 0; ++i)
    weights[i] = dot(cross(corners[(i + 2) % 3] - corners[(i + 1) % 3], p - corners[(i + 1) % 3]), normal) /
                 squared_norm(normal);
  if (std::min({weights[0], weights[1], weights[2]}) >= 0) return weights;
  double least = INFINITY;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const Vector side = corners[j] - corners[i];
    const double length = squared_norm(side);
    const double t = length > 0 ? std::clamp(dot(p - corners[i], side) / length, 0., 1.) : 0;
    const double off = squared_distance(p, corners[i] + t * side);
    if (off >= least) continue;
    least = off;
    weights = {0, 0, 0};
    weights[i] = 1 - t;
    weights[j] = t;
  }
  return weights;
}

}  // namespace

class EdgeCurve {
 public:
  explicit EdgeCurve(const Samples& samples) : curve_(TopoDS::Edge(samples.shape)) {
    if (is_elementary() || samples.points.empty()) return;
    add(samples.parameters[0][0]);
    for (std::size_t i = 1; i < samples.points.size(); ++i) add_up_to(samples.parameters[i][0], 0);
  }

  std::optional<Point> nearest(const Point& p) const {
    if (points_.size() < 2) return nearest_of_all(p);
    std::optional<Point> best;
    for (const double start : starts_near(p)) {
      const std::optional<Point> found = descend(start, to_gp(p));
      if (!found) return nearest_of_all(p);
      keep_nearer(best, found, p);
    }
    return best ? best : nearest_of_all(p);
  }

 private:
  bool is_elementary() const { return curve_.GetType() <= GeomAbs_Parabola; }

  void add(double parameter) {
    parameters_.push_back(parameter);
    points_.push_back(to_point(curve_.Value(parameter)));
  }

  /// Adds points up to this parameter, so many that the edge is nearly straight between them (or `deepest`
  /// halvings are reached).
  void add_up_to(double parameter, int depth) {
    constexpr int deepest = 10;
    constexpr double straight = 0.02;  // largest distance of edge and chord, relative to the chord's length
    const double from = parameters_.back();
    const Point start = points_.back(), end = to_point(curve_.Value(parameter));
    double off = 0;
    for (const double share : {0.25, 0.5, 0.75}) {
      const Point p = to_point(curve_.Value(from + share * (parameter - from)));
      off = std::max(off, distance(p, nearest_on_chord(p, start, end).first));
    }
    if (off > straight * distance(start, end) && depth < deepest) {
      add_up_to((from + parameter) / 2, depth + 1);
      return add_up_to(parameter, depth + 1);
    }
    reach_ = std::max(reach_, chords_apart * off);
    add(parameter);
  }

  /// Returns the point of a chord nearest to p, and the share of the chord before it.
  static std::pair<Point, double> nearest_on_chord(const Point& p, const Point& from, const Point& to) {
    const Vector chord = to - from;
    const double length = squared_norm(chord);
    const double t = length > 0 ? std::clamp(dot(p - from, chord) / length, 0., 1.) : 0;
    return {from + t * chord, t};
  }

  /// Returns parameters from which to search for the point nearest to p: one for each chord that is nearer to
  /// p than the chords beside it, and so near that its part of the edge may have the nearest point.
  std::vector<double> starts_near(const Point& p) const {
    const std::size_t count = points_.size() - 1;
    std::vector<double> distances(count), at(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto [near, share] = nearest_on_chord(p, points_[i], points_[i + 1]);
      distances[i] = distance(p, near);
      at[i] = (1 - share) * parameters_[i] + share * parameters_[i + 1];
    }
    const double far = *std::min_element(distances.begin(), distances.end()) + reach_;
    std::vector<double> starts;
    for (std::size_t i = 0; i < count; ++i)
      if (distances[i] <= far && (i == 0 || distances[i] <= distances[i - 1]) &&
          (i + 1 == count || distances[i] < distances[i + 1]))
        starts.push_back(at[i]);
    return starts;
  }

  /// Steps towards the point of the tangent that is nearest to p. Halves each step until the distance to p
  /// does not increase. Ends when the next step is within rounding. Returns nothing if the descent does not
  /// converge.
  std::optional<Point> descend(double at, const gp_Pnt& p) const {
    using namespace descent;
    const double scale = p.XYZ().Modulus() + p.Distance(curve_.Value(at));
    double move = INFINITY;
    gp_Pnt point;
    for (int step = 0; step < steps; ++step) {
      gp_Vec tangent;
      curve_.D1(at, point, tangent);
      if (!(tangent.SquareMagnitude() > 0)) return std::nullopt;
      const double next = std::clamp(at + gp_Vec(point, p).Dot(tangent) / tangent.SquareMagnitude(),
                                     curve_.FirstParameter(), curve_.LastParameter());
      move = std::fabs(next - at) * tangent.Magnitude();
      if (move <= rounding * scale) break;
      double part = 1;
      int k = 0;
      for (; k < halvings; ++k, part *= 0.5) {
        const double trial = at + part * (next - at);
        if (curve_.Value(trial).Distance(p) > point.Distance(p) + rounding * scale) continue;
        at = trial;
        break;
      }
      if (k == halvings) break;
    }
    return move <= converged * scale ? std::optional(to_point(point)) : std::nullopt;
  }

  std::optional<Point> nearest_of_all(const Point& p) const {
    const Extrema_ExtPC extrema(to_gp(p), curve_);
    std::optional<Point> best;
    if (extrema.IsDone())
      for (int i = 1; i <= extrema.NbExt(); ++i) keep_nearer(best, to_point(extrema.Point(i).Value()), p);
    for (const double end : {curve_.FirstParameter(), curve_.LastParameter()})
      keep_nearer(best, to_point(curve_.Value(end)), p);
    return best;
  }

  // `reach_` is this many times the largest distance found between a chord and its part of the edge. Twice
  // that distance would be enough; the rest is a margin, because only a few points of each part are measured.
  static constexpr double chords_apart = 3;

  BRepAdaptor_Curve curve_;
  std::vector<Point> points_;  // ends of chords; none for elementary curves
  std::vector<double> parameters_;
  double reach_ = 0;
};

class FaceSurface {
 public:
  explicit FaceSurface(const Samples& samples)
      : surface_(TopoDS::Face(samples.shape), /*R=*/true), samples_(samples) {
    if (is_elementary()) return;
    std::vector<std::pair<TreeBox, std::size_t>> entries;
    for (std::size_t t = 0; t < samples.triangles.size(); ++t) {
      Box box;
      for (const Point& corner : corners(t)) box.add(corner);
      entries.emplace_back(TreeBox({box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}), t);
    }
    tree_ = Tree(entries);
  }

  std::optional<Point> nearest(const Point& p) const {
    return is_elementary() ? on_elementary(to_gp(p)) : from_triangle(p);
  }

 private:
  bool is_elementary() const { return surface_.GetType() <= GeomAbs_Torus; }

  Point on_elementary(const gp_Pnt& p) const {
    double u = 0, v = 0;
    switch (surface_.GetType()) {
      case GeomAbs_Plane: ElSLib::Parameters(surface_.Plane(), p, u, v); break;
      case GeomAbs_Cylinder: ElSLib::Parameters(surface_.Cylinder(), p, u, v); break;
      case GeomAbs_Cone: ElSLib::Parameters(surface_.Cone(), p, u, v); break;
      case GeomAbs_Sphere: ElSLib::Parameters(surface_.Sphere(), p, u, v); break;
      default: ElSLib::Parameters(surface_.Torus(), p, u, v); break;
    }
    return to_point(surface_.Value(u, v));
  }

  std::array<Point, 3> corners(std::size_t triangle) const {
    const auto& [a, b, c] = samples_.triangles[triangle];
    return {samples_.points[a], samples_.points[b], samples_.points[c]};
  }

  /// The nearest point of the tessellation, and its parameters.
  struct Start {
    std::array<double, 2> uv;
    Point point;
  };
  /// Searches the triangles in the nearest boxes first, then all triangles whose boxes may be nearer than the
  /// best point of these. (Boost's iterator over boxes by distance sorts its queue again at each step.)
  std::optional<Start> start_near(const Point& p) const {
    std::optional<Start> start;
    double least = INFINITY;
    const auto look_at = [&](std::size_t triangle) {
      const std::array<Point, 3> at = corners(triangle);
      const std::array<double, 3> weights = nearest_weights(p, at);
      const Point q = weights[0] * at[0] + weights[1] * at[1] + weights[2] * at[2];
      if (squared_distance(p, q) >= least) return;
      least = squared_distance(p, q);
      start = Start{{0, 0}, q};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 2; ++k)
          start->uv[k] += weights[i] * samples_.parameters[samples_.triangles[triangle][i]][k];
    };
    const auto look_at_entry = boost::make_function_output_iterator(
        [&](const std::pair<TreeBox, std::size_t>& entry) { look_at(entry.second); });
    constexpr unsigned first = 8;  // the nearest box may be that of a large triangle far from p
    tree_.query(bg::index::nearest(TreePoint(p.x, p.y, p.z), first), look_at_entry);
    const double reach = std::sqrt(least);
    if (start && reach > 0)
      tree_.query(bg::index::intersects(TreeBox({p.x - reach, p.y - reach, p.z - reach},
                                                {p.x + reach, p.y + reach, p.z + reach})),
                  look_at_entry);
    return start;
  }

  /// Descends from the nearest point of the tessellation; if that does not converge, searches globally.
  std::optional<Point> from_triangle(const Point& p) const {
    const std::optional<Start> start = start_near(p);
    if (!start) return std::nullopt;
    std::optional<Point> best = descend(start->uv, to_gp(p));
    if (best) return best;
    constexpr double tolerance = 1e-12;  // absolute, in parameters
    const Extrema_ExtPS global(to_gp(p), surface_, tolerance, tolerance);
    if (global.IsDone())
      for (int i = 1; i <= global.NbExt(); ++i) keep_nearer(best, to_point(global.Point(i).Value()), p);
    keep_nearer(best, to_point(surface_.Value(start->uv[0], start->uv[1])), p);
    return best;
  }

  /// Steps towards the point of the tangent plane that is nearest to p. Halves each step until the distance
  /// to p does not increase. Ends when the next step is within rounding. Returns nothing if the descent does
  /// not converge.
  std::optional<Point> descend(std::array<double, 2> uv, const gp_Pnt& p) const {
    using namespace descent;
    const double scale = p.XYZ().Modulus() + p.Distance(surface_.Value(uv[0], uv[1]));
    double length = INFINITY;
    gp_Pnt at;
    for (int step = 0; step < steps; ++step) {
      gp_Vec du, dv;
      surface_.D1(uv[0], uv[1], at, du, dv);
      const auto next = tangent_step(uv, gp_Vec(at, p), du, dv);
      length = ((next[0] - uv[0]) * du + (next[1] - uv[1]) * dv).Magnitude();
      if (length <= rounding * scale) break;
      double part = 1;
      int k = 0;
      for (; k < halvings; ++k, part *= 0.5) {
        const std::array<double, 2> trial{uv[0] + part * (next[0] - uv[0]), uv[1] + part * (next[1] - uv[1])};
        if (surface_.Value(trial[0], trial[1]).Distance(p) > at.Distance(p) + rounding * scale) continue;
        uv = trial;
        break;
      }
      if (k == halvings) break;
    }
    return length <= converged * scale ? std::optional(to_point(at)) : std::nullopt;
  }

  /// Returns the parameters, within the face's bounds, of the point of the tangent plane at `uv` that is
  /// nearest to a place. The vector `d` leads from the surface's point at `uv` to that place; `du` and `dv`
  /// are the surface's derivatives there.
  std::array<double, 2> tangent_step(const std::array<double, 2>& uv, const gp_Vec& d, const gp_Vec& du,
                                     const gp_Vec& dv) const {
    const double e = du.Dot(du), f = du.Dot(dv), g = dv.Dot(dv), a = d.Dot(du), b = d.Dot(dv);
    const double determinant = e * g - f * f;
    std::array<double, 2> next = uv;
    if (determinant > flat * e * g)
      next = {uv[0] + (g * a - f * b) / determinant, uv[1] + (e * b - f * a) / determinant};
    else if (e >= g && e > 0)
      next[0] += a / e;
    else if (g > 0)
      next[1] += b / g;
    // If one parameter is moved to its bound, choose the best value of the other one.
    const double u = std::clamp(next[0], surface_.FirstUParameter(), surface_.LastUParameter());
    if (u != next[0] && g > 0) next = {u, uv[1] + (b - f * (u - uv[0])) / g};
    const double v = std::clamp(next[1], surface_.FirstVParameter(), surface_.LastVParameter());
    if (v != next[1] && e > 0)
      next = {std::clamp(uv[0] + (a - f * (v - uv[1])) / e, surface_.FirstUParameter(),
                         surface_.LastUParameter()),
              v};
    return next;
  }

  static constexpr double flat = 1e-14;  // largest determinant of parallel tangents, relative to e * g

  BRepAdaptor_Surface surface_;
  const Samples& samples_;
  Tree tree_;
};

NearestOnShape::NearestOnShape(const Tessellation& tessellation) : tessellation_(tessellation) {}
NearestOnShape::~NearestOnShape() = default;

std::optional<Point> NearestOnShape::on_edge(int number, const Point& p) const {
  std::optional<Point> best;
  const auto pieces = tessellation_.edges.find(number);
  if (pieces == tessellation_.edges.end()) return best;
  auto& curves = curves_[number];
  if (curves.empty())
    for (const Samples& piece : pieces->second) curves.push_back(std::make_unique<EdgeCurve>(piece));
  for (const auto& curve : curves) keep_nearer(best, curve->nearest(p), p);
  return best;
}

std::optional<Point> NearestOnShape::on_face(int number, const Point& p) const {
  std::optional<Point> best;
  const auto pieces = tessellation_.faces.find(number);
  if (pieces == tessellation_.faces.end()) return best;
  auto& surfaces = surfaces_[number];
  if (surfaces.empty())
    for (const Samples& piece : pieces->second) surfaces.push_back(std::make_unique<FaceSurface>(piece));
  for (const auto& surface : surfaces) keep_nearer(best, surface->nearest(p), p);
  return best;
}

}  // namespace collarmesh::brep
