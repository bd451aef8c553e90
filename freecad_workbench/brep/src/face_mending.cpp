// Triangulates single faces if BRepMesh fails on them when it triangulates the whole shape.
#include "face_mending.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Surface.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "outline_triangles.h"
#include "points.h"
#include "topology.h"

namespace collarmesh::brep {

namespace {

using Ends = std::array<Index, 2>;
using Parameters = std::array<double, 2>;

Ends sorted(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// Returns the sides that belong to an odd number of triangles, with these numbers.
std::map<Ends, int> odd_sides(const std::vector<std::array<Index, 3>>& triangles) {
  std::map<Ends, int> uses;
  for (const auto& t : triangles)
    for (std::size_t i = 0; i < 3; ++i)
      if (t[i] != t[(i + 1) % 3]) ++uses[sorted(t[i], t[(i + 1) % 3])];
  std::erase_if(uses, [](const auto& side) { return side.second % 2 == 0; });
  return uses;
}

TopoDS_Face face_in(const TopoDS_Shape& shape) {
  const TopExp_Explorer face(shape, TopAbs_FACE);
  return face.More() ? TopoDS::Face(face.Current()) : TopoDS_Face();
}

TopoDS_Face copied(const TopoDS_Face& face) {
  return face_in(BRepBuilderAPI_Copy(face, /*copyGeom=*/true, /*copyMesh=*/false).Shape());
}

TopoDS_Face healed(const TopoDS_Face& face) {
  const TopoDS_Face copy = copied(face);
  BRepLib::SameParameter(copy, Precision::Confusion(), /*forced=*/true);
  ShapeFix_Shape fix(copy);
  fix.Perform();
  return face_in(fix.Shape());
}

void triangulate(const TopoDS_Shape& shape, double deflection, double angle) {
  BRepTools::Clean(shape);
  IMeshTools_Parameters parameters;
  parameters.Deflection = deflection;
  parameters.Angle = angle;
  const BRepMesh_IncrementalMesh mesh(shape, parameters);
}

/// Returns the triangulation that is stored with a face; a result without triangles if there is none or it
/// has no parameters.
MendedFace triangles_on(const TopoDS_Face& face) {
  MendedFace own;
  own.face = face;
  TopLoc_Location location;
  const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
  if (mesh.IsNull() || !mesh->HasUVNodes()) return own;
  for (int i = 1; i <= mesh->NbNodes(); ++i) {
    own.points.push_back(to_point(mesh->Node(i).Transformed(location.Transformation())));
    own.parameters.push_back({mesh->UVNode(i).X(), mesh->UVNode(i).Y()});
  }
  own.outline_points.assign(own.points.size(), none);
  for (int t = 1; t <= mesh->NbTriangles(); ++t) {
    std::array<int, 3> n{};
    mesh->Triangle(t).Get(n[0], n[1], n[2]);
    if (location.Transformation().IsNegative()) std::swap(n[1], n[2]);
    own.triangles.push_back(
        {static_cast<Index>(n[0] - 1), static_cast<Index>(n[1] - 1), static_cast<Index>(n[2] - 1)});
  }
  return own;
}

/// A triangulator of a face, which tries several ways, best first, until the result fits the outline.
class Mender {
 public:
  Mender(const TopoDS_Face& face, const Outline& outline, double deflection, double angle)
      : face_(face), outline_(outline), deflection_(deflection), angle_(angle) {
    Box box;
    for (const Point& p : outline.places) box.add(p);
    near_ = std::max(1e-6 * box.diagonal(), 2 * BRep_Tool::Tolerance(face));
    for (const auto& [a, b] : outline.chords) chords_.push_back({outline.points[a], outline.points[b]});
  }

  MendedFace run() {
    constexpr double coarse =
        4;  // factor of the deflection; less than 1 rarely helps, and takes long if an outline crosses itself
    try_way([&] { return alone(copied(face_), "alone"); });
    try_way([&] { return alone(healed(face_), "alone after shape healing"); });
    try_way([&] { return in_parameter_plane(); });
    try_way([&] { return in_fitted_plane(); });
    try_way([&] { return alone(healed(face_), "alone with a larger deflection", coarse); });
    return best_;
  }

 private:
  template <class Way>
  void try_way(const Way& way) {
    if (best_.fits) return;
    try {
      MendedFace next = way();
      if (next.triangles.empty()) return;
      const std::size_t off = off_outline(next);
      next.fits = off == 0;
      if (off >= least_off_) return;
      least_off_ = off;
      best_ = std::move(next);
    } catch (const Standard_Failure&) {
      return;  // try the next way
    }
  }

  std::size_t off_outline(const MendedFace& mended) const {
    std::vector<std::array<Index, 3>> triangles;
    const auto point = [&](Index p) {
      return mended.outline_points[p] != none ? mended.outline_points[p] : first_own + p;
    };
    for (const auto& [a, b, c] : mended.triangles) triangles.push_back({point(a), point(b), point(c)});
    return sides_off(triangles, chords_);
  }

  MendedFace alone(const TopoDS_Face& face, const char* how, double factor = 1) const {
    if (face.IsNull()) return {};
    triangulate(face, factor * deflection_, angle_);
    MendedFace own = triangles_on(face);
    own.how = how;
    for (const auto& [side, uses] : odd_sides(own.triangles))
      for (const Index p : side) own.outline_points[p] = outline_point_at(own.points[p]);
    return own;
  }

  Index outline_point_at(const Point& p) const {
    Index nearest = none;
    double least = near_;
    for (std::size_t i = 0; i < outline_.points.size(); ++i)
      if (distance(p, outline_.places[i]) <= least) {
        least = distance(p, outline_.places[i]);
        nearest = outline_.points[i];
      }
    return nearest;
  }

  /// Returns the outline's nodes as points, without triangles.
  MendedFace bare() const {
    MendedFace result;
    result.face = face_;
    result.points = outline_.places;
    result.parameters = outline_.parameters;
    result.outline_points = outline_.points;
    return result;
  }

  MendedFace in_parameter_plane() const {
    const BRepAdaptor_Surface surface(face_, false);
    MendedFace result = bare();
    result.how = "from its outline in the parameter plane";
    const Parameters scale = lengths_of_parameters(surface);
    std::vector<Parameters> nodes;
    for (const Parameters& uv : outline_.parameters) nodes.push_back({scale[0] * uv[0], scale[1] * uv[1]});
    if (surface.GetType() != GeomAbs_Plane)
      for (const Parameters& uv : inner_parameters(nodes, scale)) nodes.push_back(uv);
    const OutlineTriangles plane = triangulate_outline(nodes, outline_.chords);
    nodes.insert(nodes.end(), plane.crossings.begin(), plane.crossings.end());
    for (std::size_t i = outline_.points.size(); i < nodes.size(); ++i) {
      const Parameters uv{nodes[i][0] / scale[0], nodes[i][1] / scale[1]};
      result.parameters.push_back(uv);
      result.points.push_back(to_point(surface.Value(uv[0], uv[1])));
      result.outline_points.push_back(none);
    }
    result.triangles = plane.triangles;
    turn_if_mirrored(result);
    return result;
  }

  /// Returns the approximate length in space of a unit step in each parameter, so that triangles can be well
  /// shaped in space.
  Parameters lengths_of_parameters(const BRepAdaptor_Surface& surface) const {
    Parameters sum{0, 0};
    for (const Parameters& uv : outline_.parameters) {
      gp_Pnt p;
      gp_Vec du, dv;
      surface.D1(uv[0], uv[1], p, du, dv);
      sum[0] += du.Magnitude();
      sum[1] += dv.Magnitude();
    }
    for (double& length : sum) length = length > 0 ? length / static_cast<double>(outline_.points.size()) : 1;
    return sum;
  }

  /// Returns scaled parameters of inner nodes. They are the nodes of a triangulated patch of the surface,
  /// which covers the outline's box in the parameter plane, without those close to the outline.
  std::vector<Parameters> inner_parameters(const std::vector<Parameters>& outline,
                                           const Parameters& scale) const {
    std::vector<Parameters> inner;
    if (outline.empty()) return inner;
    Parameters low = outline.front(), high = low;
    for (const Parameters& uv : outline)
      for (std::size_t k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], uv[k]);
        high[k] = std::max(high[k], uv[k]);
      }
    const TopoDS_Face patch =
        BRepBuilderAPI_MakeFace(BRep_Tool::Surface(face_), low[0] / scale[0], high[0] / scale[0],
                                low[1] / scale[1], high[1] / scale[1], Precision::Confusion());
    triangulate(patch, deflection_, angle_);
    for (const Parameters& uv : triangles_on(patch).parameters) {
      const Parameters p{scale[0] * uv[0], scale[1] * uv[1]};
      if (!comes_close(p, outline)) inner.push_back(p);
    }
    return inner;
  }

  /// Returns whether a point is closer to a chord than a third of the chord's length.
  bool comes_close(const Parameters& p, const std::vector<Parameters>& outline) const {
    return std::any_of(outline_.chords.begin(), outline_.chords.end(), [&](const Ends& chord) {
      const Parameters &a = outline[chord[0]], &b = outline[chord[1]];
      const Parameters side{b[0] - a[0], b[1] - a[1]}, to{p[0] - a[0], p[1] - a[1]};
      const double length = side[0] * side[0] + side[1] * side[1];
      const double t = length > 0 ? std::clamp((side[0] * to[0] + side[1] * to[1]) / length, 0., 1.) : 0;
      return std::hypot(to[0] - t * side[0], to[1] - t * side[1]) < std::sqrt(length) / 3;
    });
  }

  /// Triangulates the outline in the plane orthogonal to its area vector. Returns no triangles if chords
  /// cross in that plane, or if the centre of a triangle is far from the surface.
  MendedFace in_fitted_plane() const {
    MendedFace result = bare();
    result.how = "from its outline in a fitted plane";
    Vector normal;
    for (const auto& [a, b] : outline_.chords)
      normal = normal +
               cross(outline_.places[a] - outline_.places.front(), outline_.places[b] - outline_.places[a]);
    if (!(norm(normal) > 0)) return {};
    const Vector across = std::fabs(normal.x) < 0.5 * norm(normal) ? Vector{1, 0, 0} : Vector{0, 1, 0};
    Vector u = cross(across, normal);
    u = (1 / norm(u)) * u;
    const Vector v = (1 / norm(normal)) * cross(normal, u);
    std::vector<Parameters> nodes;
    for (const Point& p : outline_.places)
      nodes.push_back({dot(p - outline_.places.front(), u), dot(p - outline_.places.front(), v)});
    const OutlineTriangles plane = triangulate_outline(nodes, outline_.chords);
    if (!plane.crossings.empty()) return {};
    result.parameters.clear();
    result.triangles = plane.triangles;
    if (!lies_on_surface(result)) return {};
    return result;
  }

  bool lies_on_surface(const MendedFace& mended) const {
    ShapeAnalysis_Surface surface(BRep_Tool::Surface(face_));
    constexpr double rough = 10;  // relative to the deflection
    return std::all_of(mended.triangles.begin(), mended.triangles.end(), [&](const auto& t) {
      const Point centre = mended.points[t[0]] + (mended.points[t[1]] - mended.points[t[0]]) / 3 +
                           (mended.points[t[2]] - mended.points[t[0]]) / 3;
      const gp_Pnt p(centre.x, centre.y, centre.z);
      return surface.Value(surface.ValueOfUV(p, Precision::Confusion())).Distance(p) <= rough * deflection_;
    });
  }

  void turn_if_mirrored(MendedFace& mended) const {
    if (!face_.Location().Transformation().IsNegative()) return;
    for (auto& t : mended.triangles) std::swap(t[1], t[2]);
  }

  static constexpr Index first_own = Index(1) << 31U;  // first number of the face's own points, above the
                                                       // numbers of the shape's points

  const TopoDS_Face& face_;
  const Outline& outline_;
  double deflection_, angle_;
  double near_ = 0;  // below this distance a point of the face's own triangles is taken for a point of
                     // the outline
  std::vector<Ends> chords_;  // chords between points
  MendedFace best_;
  std::size_t least_off_ = std::numeric_limits<std::size_t>::max();
};

}  // namespace

std::size_t sides_off(const std::vector<std::array<Index, 3>>& triangles,
                      const std::vector<std::array<Index, 2>>& chords) {
  std::map<Ends, int> uses = odd_sides(triangles);
  for (const auto& [a, b] : chords)
    if (a != b) ++uses[sorted(a, b)];
  return static_cast<std::size_t>(
      std::count_if(uses.begin(), uses.end(), [](const auto& side) { return side.second % 2 == 1; }));
}

MendedFace mend_face(const TopoDS_Face& face, const Outline& outline, double deflection, double angle) {
  return Mender(face, outline, deflection, angle).run();
}

}  // namespace collarmesh::brep
