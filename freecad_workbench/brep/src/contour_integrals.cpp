#include "contour_integrals.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <Geom2d_Curve.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <gp_Ax3.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Lin2d.hxx>
#include <gp_Pln.hxx>
#include <gp_Pnt2d.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>
#include <gp_Vec2d.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace collarmesh::brep {

namespace {

FaceMeasure operator+(const FaceMeasure& a, const FaceMeasure& b) {
  return {a.area + b.area, a.cone + b.cone};
}
FaceMeasure operator-(const FaceMeasure& a, const FaceMeasure& b) {
  return {a.area - b.area, a.cone - b.cone};
}
FaceMeasure operator*(double s, const FaceMeasure& a) { return {s * a.area, s * a.cone}; }

bool is_above(const FaceMeasure& a, const FaceMeasure& limit) {
  return std::fabs(a.area) > limit.area || std::fabs(a.cone) > limit.cone;
}

/// A quadrature rule of Kronrod (1965) on [-1, 1], and the Gauss rule whose points it contains. Lists the
/// points from 1 down to 0, the middle; every second one, the middle too, is a point of the Gauss rule.
template <std::size_t N>
struct Rule {
  std::array<double, N> at, kronrod;
  std::array<double, N / 2> gauss;
};

constexpr Rule<4> of_7_points{{0.960491268708020283423507092629080, 0.774596669241483377035853079956480,
                               0.434243749346802558002071502844628, 0},
                              {0.104656226026467265193823857192073, 0.268488089868333440728569280666710,
                               0.401397414775962222905051818618432, 0.450916538658474142345110087045571},
                              {0.555555555555555555555555555555556, 0.888888888888888888888888888888889}};

constexpr Rule<8> of_15_points{{0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                0.586087235467691130294144838258730, 0.405845151377397166906606412076961,
                                0.207784955007898467600689403773245, 0},
                               {0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                0.204432940075298892414161999234649, 0.209482141084727828012999174891714},
                               {0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
                                0.381830050505118944950369775488975, 0.417959183673469387755102040816327}};

/// Integrates from a to b by Kronrod's rule, whose error is far smaller than its difference from the Gauss
/// rule. Halves the interval, and for each half the tolerance, while the rules differ by more than the
/// tolerance, at most `halvings` times; if they still differ then, sets `converges` to false.
template <std::size_t N, class Function>
FaceMeasure integrate(const Rule<N>& rule, const Function& f, double a, double b,
                      const FaceMeasure& tolerance, bool& converges, unsigned halvings = 8) {
  const double middle = (a + b) / 2, half = (b - a) / 2;
  const FaceMeasure centre = f(middle);
  FaceMeasure fine = rule.kronrod.back() * centre, coarse = rule.gauss.back() * centre;
  for (std::size_t i = 0; i + 1 < N; ++i) {
    const FaceMeasure both = f(middle - half * rule.at[i]) + f(middle + half * rule.at[i]);
    fine = fine + rule.kronrod[i] * both;
    if (i % 2 == 1) coarse = coarse + rule.gauss[i / 2] * both;
  }
  if (!is_above(half * (fine - coarse), tolerance)) return half * fine;
  if (halvings == 0) {
    converges = false;
    return half * fine;
  }
  const FaceMeasure each = 0.5 * tolerance;
  return integrate(rule, f, a, middle, each, converges, halvings - 1) +
         integrate(rule, f, middle, b, each, converges, halvings - 1);
}

/// The axes of a surface, relative to the apex.
struct Frame {
  double x, y, z;     ///< vector from the apex to the origin of the axes, along these axes
  double handedness;  ///< 1, or -1 if the axes are left-handed

  Frame(const gp_Ax3& axes, const gp_Pnt& apex) : handedness(axes.Direct() ? 1 : -1) {
    const gp_Vec to_origin(apex, axes.Location());
    x = to_origin.Dot(axes.XDirection());
    y = to_origin.Dot(axes.YDirection());
    z = to_origin.Dot(axes.Direction());
  }
  double rotated(double u) const { return x * std::sin(u) - y * std::cos(u); }
};

/// Antiderivatives with respect to u of |Su x Sv| (area) and S . (Su x Sv) / 3 (cone), where S is a point of
/// the surface relative to the apex, and Su and Sv are its derivatives.
using Antiderivative = std::function<FaceMeasure(double u, double v)>;

Antiderivative of_plane(const Frame& f) {
  return [f](double u, double) { return FaceMeasure{u, f.handedness * f.z * u / 3}; };
}

Antiderivative of_cylinder(const Frame& f, double r) {
  return [f, r](double u, double) {
    return FaceMeasure{r * u, f.handedness * r * (f.rotated(u) + r * u) / 3};
  };
}

Antiderivative of_cone(const Frame& f, double radius, double half_angle) {
  const double c = std::cos(half_angle), s = std::sin(half_angle);
  return [f, radius, c, s](double u, double v) {
    const double r = radius + v * s;
    const double across = r * c - s * (f.z + v * c);
    return FaceMeasure{std::fabs(r) * u, f.handedness * r * (c * f.rotated(u) + u * across) / 3};
  };
}

Antiderivative of_sphere(const Frame& f, double r) {
  return [f, r](double u, double v) {
    const double c = std::cos(v), element = r * r * c;
    return FaceMeasure{std::fabs(element) * u,
                       f.handedness * element * (c * f.rotated(u) + u * (f.z * std::sin(v) + r)) / 3};
  };
}

Antiderivative of_torus(const Frame& f, double major, double minor) {
  return [f, major, minor](double u, double v) {
    const double c = std::cos(v), s = std::sin(v), r = major + minor * c, element = r * minor;
    const double across = r * c + s * (f.z + minor * s);
    return FaceMeasure{std::fabs(element) * u, f.handedness * element * (c * f.rotated(u) + u * across) / 3};
  };
}

/// Returns the antiderivative for the surface; an empty function if it has no simple form.
Antiderivative known_antiderivative(const BRepAdaptor_Surface& surface, const gp_Pnt& apex) {
  if (std::fabs(surface.Trsf().ScaleFactor()) != 1) return {};
  switch (surface.GetType()) {
    case GeomAbs_Plane: return of_plane(Frame(surface.Plane().Position(), apex));
    case GeomAbs_Cylinder:
      return of_cylinder(Frame(surface.Cylinder().Position(), apex), surface.Cylinder().Radius());
    case GeomAbs_Cone:
      return of_cone(Frame(surface.Cone().Position(), apex), surface.Cone().RefRadius(),
                     surface.Cone().SemiAngle());
    case GeomAbs_Sphere:
      return of_sphere(Frame(surface.Sphere().Position(), apex), surface.Sphere().Radius());
    case GeomAbs_Torus:
      return of_torus(Frame(surface.Torus().Position(), apex), surface.Torus().MajorRadius(),
                      surface.Torus().MinorRadius());
    default: return {};
  }
}

/// Returns the parameters that bound the spans of a curve or surface, on each of which it has one formula.
template <class Shape, class Count, class Get>
std::vector<double> ends_of_spans(Shape& shape, const Count& count, const Get& get) {
  const int spans = (shape.*count)(GeomAbs_CN);
  TColStd_Array1OfReal ends(1, spans + 1);
  (shape.*get)(ends, GeomAbs_CN);
  return {ends.begin(), ends.end()};
}

/// Repeats the ends of spans by whole periods, so that they cover an interval.
void repeat(std::vector<double>& ends, double period, double low, double high) {
  const std::vector<double> once = ends;
  const double from = std::floor((low - once.front()) / period),
               to = std::ceil((high - once.back()) / period);
  for (double k = from; k <= to; ++k)
    for (const double end : once)
      if (k != 0) ends.push_back(end + k * period);
  std::sort(ends.begin(), ends.end());
}

/// The integrals over one face.
class Contour {
 public:
  Contour(const TopoDS_Face& face, const gp_Pnt& apex)
      : face_(face), apex_(apex), surface_(face, false), known_(known_antiderivative(surface_, apex)) {
    BRepTools::UVBounds(face, u_low_, u_high_, v_low_, v_high_);
    if (!known_) {
      find_spans();
      inner_is_v_ = v_spans_.size() > u_spans_.size();
    }
    set_tolerance();
  }

  std::optional<FaceMeasure> measure() {
    FaceMeasure sum;
    for (TopExp_Explorer edges(face_, TopAbs_EDGE); edges.More(); edges.Next()) {
      const TopoDS_Edge& edge = TopoDS::Edge(edges.Current());
      if (edge.Orientation() != TopAbs_FORWARD && edge.Orientation() != TopAbs_REVERSED) continue;
      double from = 0, to = 0;
      const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face_, from, to);
      if (curve.IsNull()) return {};
      Geom2dAdaptor_Curve adaptor(curve, std::min(from, to), std::max(from, to));
      const FaceMeasure part = along(adaptor);
      if (!converges_) return {};
      sum = edge.Orientation() == TopAbs_FORWARD ? sum + part : sum - part;
    }
    if (!(sum.area > 0) || !std::isfinite(sum.area) || !std::isfinite(sum.cone)) return {};
    return sum;
  }

 private:
  void find_spans() {
    u_spans_ = ends_of_spans(surface_, &BRepAdaptor_Surface::NbUIntervals, &BRepAdaptor_Surface::UIntervals);
    v_spans_ = ends_of_spans(surface_, &BRepAdaptor_Surface::NbVIntervals, &BRepAdaptor_Surface::VIntervals);
    if (surface_.IsUPeriodic()) repeat(u_spans_, surface_.UPeriod(), u_low_, u_high_);
    if (surface_.IsVPeriodic()) repeat(v_spans_, surface_.VPeriod(), v_low_, v_high_);
  }

  /// Sets tolerances relative to the size of the face. The tolerance of the cone comes from the face's
  /// distance to the apex, because the cone itself has no volume if the face lies in a plane through the
  /// apex.
  void set_tolerance() {
    const double precision = known_ ? 1e-8 : 1e-5;
    FaceMeasure largest{};
    constexpr int samples = 5;
    for (int i = 0; i < samples; ++i)
      for (int j = 0; j < samples; ++j) {
        const double u = u_low_ + (u_high_ - u_low_) * (i + 0.5) / samples,
                     v = v_low_ + (v_high_ - v_low_) * (j + 0.5) / samples;
        const double area = element(u, v).area;
        largest = {std::max(largest.area, area),
                   std::max(largest.cone, area * apex_.Distance(surface_.Value(u, v)) / 3)};
      }
    const double inner = inner_is_v_ ? v_high_ - v_low_ : u_high_ - u_low_;
    const double outer = inner_is_v_ ? u_high_ - u_low_ : v_high_ - v_low_;
    inner_tolerance_ = precision * inner * largest;
    outer_tolerance_ = outer * inner_tolerance_;
    slowest_ = 1e-13 * outer;
  }

  FaceMeasure element(double u, double v) {
    if (evaluations_left_ == 0) {
      converges_ = false;
      return {};
    }
    --evaluations_left_;
    gp_Pnt at;
    gp_Vec du, dv;
    surface_.D1(u, v, at, du, dv);
    const gp_Vec normal = du.Crossed(dv);
    return {normal.Magnitude(), gp_Vec(apex_, at).Dot(normal) / 3};
  }

  /// Integrates along the inner parameter, from its least value on the face to (u, v).
  FaceMeasure inner_integral(double u, double v) {
    if (known_) return known_(u, v) - known_(u_low_, v);
    const double to = inner_is_v_ ? v : u;
    double from = inner_is_v_ ? v_low_ : u_low_;
    const auto f = [&](double t) { return inner_is_v_ ? element(u, t) : element(t, v); };
    FaceMeasure sum;
    for (const double end : inner_is_v_ ? v_spans_ : u_spans_) {
      const double until = std::min(end, to);
      if (until <= from) continue;
      sum = sum + integrate(of_7_points, f, from, until, inner_tolerance_, converges_);
      from = until;
    }
    if (from != to) sum = sum + integrate(of_7_points, f, from, to, inner_tolerance_, converges_);
    return sum;
  }

  /// Integrates the inner integral along a curve in the parameter plane.
  FaceMeasure along(Geom2dAdaptor_Curve& curve) {
    std::vector<double> ends =
        ends_of_spans(curve, &Geom2dAdaptor_Curve::NbIntervals, &Geom2dAdaptor_Curve::Intervals);
    if (curve.GetType() == GeomAbs_Line) divide_at_spans(curve.Line(), ends);
    const double slowest = slowest_ / (ends.back() - ends.front());
    const auto f = [&](double t) {
      gp_Pnt2d at;
      gp_Vec2d tangent;
      curve.D1(t, at, tangent);
      const double speed = inner_is_v_ ? -tangent.X() : tangent.Y();
      return std::fabs(speed) <= slowest ? FaceMeasure{} : speed * inner_integral(at.X(), at.Y());
    };
    FaceMeasure sum;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      sum = sum + (known_ ? integrate(of_15_points, f, ends[i], ends[i + 1], outer_tolerance_, converges_)
                          : integrate(of_7_points, f, ends[i], ends[i + 1], outer_tolerance_, converges_));
    return sum;
  }

  /// Adds the parameters at which a line crosses from one span of the outer direction to the next.
  void divide_at_spans(const gp_Lin2d& line, std::vector<double>& ends) const {
    const double start = inner_is_v_ ? line.Location().X() : line.Location().Y();
    const double slope = inner_is_v_ ? line.Direction().X() : line.Direction().Y();
    if (std::fabs(slope) < 1e-12) return;
    const double first = ends.front(), last = ends.back();
    for (const double end : inner_is_v_ ? u_spans_ : v_spans_)
      if (const double t = (end - start) / slope; t > first && t < last) ends.push_back(t);
    std::sort(ends.begin(), ends.end());
  }

  TopoDS_Face face_;
  gp_Pnt apex_;
  BRepAdaptor_Surface surface_;
  Antiderivative known_;
  double u_low_ = 0, u_high_ = 0, v_low_ = 0, v_high_ = 0;  // bounds of the face's parameters
  std::vector<double> u_spans_, v_spans_;
  bool inner_is_v_ = false;
  FaceMeasure inner_tolerance_, outer_tolerance_;
  double slowest_ = 0;  // a curve that goes no farther than this in the outer direction adds nothing
  std::size_t evaluations_left_ = 2'000'000;  // with more, OpenCASCADE's integrals are as fast
  bool converges_ = true;
};

}  // namespace

std::optional<FaceMeasure> integrate_along_edges(const TopoDS_Face& face, const gp_Pnt& apex) {
  return Contour(TopoDS::Face(face.Oriented(TopAbs_FORWARD)), apex).measure();
}

}  // namespace collarmesh::brep
