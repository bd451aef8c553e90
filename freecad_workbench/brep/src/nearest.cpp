// Nearest points on exact edges and surfaces.
#include "nearest.h"

#define BOOST_ALLOW_DEPRECATED_HEADERS  // of Boost itself
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

#include <algorithm>
#include <array>
#include <utility>

namespace collarmesh::brep {

namespace {

namespace bg = boost::geometry;
using TreePoint = bg::model::point<double, 3, bg::cs::cartesian>;
using Tree = bg::index::rtree<std::pair<TreePoint, std::size_t>, bg::index::quadratic<16>>;

gp_Pnt to_gp(const Point& p) { return {p.x, p.y, p.z}; }
Point to_point(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

/// Of two answers the nearer one.
void keep_nearer(std::optional<Point>& best, const std::optional<Point>& other, const Point& p) {
  if (other && (!best || squared_distance(*other, p) < squared_distance(*best, p))) best = other;
}

std::optional<Point> nearest_on_curve(const TopoDS_Shape& edge, const Point& p) {
  const BRepAdaptor_Curve curve(TopoDS::Edge(edge));
  const Extrema_ExtPC extrema(to_gp(p), curve);
  std::optional<Point> best;
  if (extrema.IsDone())
    for (int i = 1; i <= extrema.NbExt(); ++i) keep_nearer(best, to_point(extrema.Point(i).Value()), p);
  for (const double end : {curve.FirstParameter(), curve.LastParameter()})
    keep_nearer(best, to_point(curve.Value(end)), p);
  return best;
}

}  // namespace

class FaceSurface {
 public:
  explicit FaceSurface(const Samples& samples)
      : surface_(TopoDS::Face(samples.shape), /*R=*/true), samples_(samples) {
    if (is_elementary()) return;
    std::vector<std::pair<TreePoint, std::size_t>> entries;
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
      const Point& q = samples.points[i];
      entries.emplace_back(TreePoint(q.x, q.y, q.z), i);
    }
    tree_ = Tree(entries);
  }

  std::optional<Point> nearest(const Point& p) const {
    return is_elementary() ? on_elementary(to_gp(p)) : from_sample(p);
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

  /// Gauss-Newton from the nearest point of the tessellation; where that does not end, a global search.
  std::optional<Point> from_sample(const Point& p) const {
    std::vector<std::pair<TreePoint, std::size_t>> found;
    tree_.query(bg::index::nearest(TreePoint(p.x, p.y, p.z), 1), std::back_inserter(found));
    if (found.empty()) return std::nullopt;
    std::optional<Point> best = descend(samples_.parameters[found.front().second], to_gp(p));
    if (best) return best;
    constexpr double tolerance = 1e-12;  // of the parameters
    const Extrema_ExtPS global(to_gp(p), surface_, tolerance, tolerance);
    if (global.IsDone())
      for (int i = 1; i <= global.NbExt(); ++i) keep_nearer(best, to_point(global.Point(i).Value()), p);
    keep_nearer(best, samples_.points[found.front().second], p);
    return best;
  }

  /// Each step solves for the nearest point of the tangent plane and is halved until it comes nearer. Ends
  /// where the next step is within rounding; nothing when it does not get there.
  std::optional<Point> descend(std::array<double, 2> uv, const gp_Pnt& p) const {
    constexpr int steps = 50, halvings = 20;
    constexpr double rounding = 1e-15;
    const double scale = p.XYZ().Modulus() + p.Distance(surface_.Value(uv[0], uv[1]));
    for (int step = 0; step < steps; ++step) {
      gp_Pnt at;
      gp_Vec du, dv;
      surface_.D1(uv[0], uv[1], at, du, dv);
      const auto next = tangent_step(uv, gp_Vec(at, p), du, dv);
      const gp_Vec move = (next[0] - uv[0]) * du + (next[1] - uv[1]) * dv;
      if (move.Magnitude() <= rounding * scale) return to_point(at);
      double part = 1;
      int k = 0;
      for (; k < halvings; ++k, part *= 0.5) {
        const std::array<double, 2> trial{uv[0] + part * (next[0] - uv[0]), uv[1] + part * (next[1] - uv[1])};
        if (surface_.Value(trial[0], trial[1]).Distance(p) > at.Distance(p)) continue;
        uv = trial;
        break;
      }
      if (k == halvings)
        return move.Magnitude() <= converged * scale ? std::optional(to_point(at)) : std::nullopt;
    }
    return std::nullopt;
  }

  /// The parameters of the tangent plane's point nearest to at + d, within the face's bounds.
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
    // On a bound the other parameter alone decides.
    const double u = std::clamp(next[0], surface_.FirstUParameter(), surface_.LastUParameter());
    if (u != next[0] && g > 0) next = {u, uv[1] + (b - f * (u - uv[0])) / g};
    const double v = std::clamp(next[1], surface_.FirstVParameter(), surface_.LastVParameter());
    if (v != next[1] && e > 0)
      next = {std::clamp(uv[0] + (a - f * (v - uv[1])) / e, surface_.FirstUParameter(),
                         surface_.LastUParameter()),
              v};
    return next;
  }

  static constexpr double flat = 1e-14;       // determinant of dependent tangents, relative
  static constexpr double converged = 1e-11;  // a step this small is as good as rounding allows

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
  for (const Samples& piece : pieces->second) keep_nearer(best, nearest_on_curve(piece.shape, p), p);
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
