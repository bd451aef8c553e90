#include "face_integrals.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepGProp_Domain.hxx>
#include <BRepGProp_Face.hxx>
#include <BRepGProp_Sinert.hxx>
#include <BRepGProp_Vinert.hxx>
#include <Standard_Failure.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include <limits>

#include "topology.h"

namespace collarmesh::brep {

namespace {

/// Converts a face to a spline surface if its surface is an extruded or revolved spline curve: OpenCASCADE
/// does not know the spans of such surfaces, and its adaptive integrals miss waves on them. Returns other
/// faces unchanged.
TopoDS_Face with_known_spans(const TopoDS_Face& face) {
  const BRepAdaptor_Surface surface(face, false);
  const bool is_swept =
      surface.GetType() == GeomAbs_SurfaceOfExtrusion || surface.GetType() == GeomAbs_SurfaceOfRevolution;
  if (!is_swept || surface.BasisCurve()->GetType() != GeomAbs_BSplineCurve) return face;
  return TopoDS::Face(BRepBuilderAPI_NurbsConvert(face, true).Shape());
}

}  // namespace

FaceIntegrals::FaceIntegrals(const TopoDS_Shape& shape) {
  const Point centre = place_of(shape);
  apex_ = gp_Pnt(centre.x, centre.y, centre.z);
  for (const TopoDS_Shape& face : subshapes(shape, TopAbs_FACE)) measures_.Add(face, measure(face));
}

double FaceIntegrals::cone(const TopoDS_Shape& face) const {
  const double cone = measures_.FindFromKey(face).cone;
  return face.Orientation() == TopAbs_REVERSED ? -cone : cone;
}

FaceMeasure FaceIntegrals::measure(const TopoDS_Shape& face) const {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  try {
    if (const auto measured = integrate_along_edges(TopoDS::Face(face), apex_)) return *measured;
  } catch (const Standard_OutOfMemory&) {
    throw;
  } catch (const Standard_Failure&) {  // other integrals may succeed
  }
  try {
    return {integrated<BRepGProp_Sinert>(face), integrated<BRepGProp_Vinert>(face)};
  } catch (const Standard_OutOfMemory&) {
    throw;
  } catch (const Standard_Failure&) {
    return {unknown, unknown};
  }
}

/// Integrates over a face, with the normals of its surface. Adaptive integrals are much more exact than those
/// with a fixed number of points, which is too small for splines of many spans.
template <class Integral>
double FaceIntegrals::integrated(const TopoDS_Shape& face) const {
  const TopoDS_Face forward = with_known_spans(TopoDS::Face(face.Oriented(TopAbs_FORWARD)));
  BRepGProp_Face surface(forward);
  BRepGProp_Domain domain(forward);
  const int spans = surface.SUIntSubs() * surface.SVIntSubs();
  constexpr int few = 8, many = 10'000;             // with many spans adaptive integrals would take long
  const double error = spans <= few ? 1e-3 : 1e-5;  // relative; OpenCASCADE underestimates it on waves
  Integral integral;
  integral.SetLocation(apex_);
  if (forward.NbChildren() == 0)
    integral.Perform(surface, error);
  else if (spans > many)
    integral.Perform(surface, domain);
  else
    integral.Perform(surface, domain, error);
  return integral.Mass();
}

}  // namespace collarmesh::brep
