#include "measures.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace collarmesh::brep {

namespace {

/// Returns the length of an edge; NaN if OpenCASCADE fails, as it does on some edges.
double length_of(const TopoDS_Shape& edge) {
  try {
    const BRepAdaptor_Curve curve(TopoDS::Edge(edge));
    const double from = curve.FirstParameter(), to = curve.LastParameter();
    if (curve.GetType() == GeomAbs_Line) return to - from;
    if (curve.GetType() == GeomAbs_Circle) return (to - from) * curve.Circle().Radius();
    GProp_GProps properties;
    BRepGProp::LinearProperties(edge, properties);
    return properties.Mass();
  } catch (const Standard_Failure&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

double area_of_triangles(const PolygonSoup& soup) {
  double area = 0;
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto t = soup.polygon(f);
    area += norm(cross(soup.points[t[1]] - soup.points[t[0]], soup.points[t[2]] - soup.points[t[0]])) / 2;
  }
  return area;
}

double volume_of_triangles(const PolygonSoup& soup) {
  const Point origin = soup.points.empty() ? Point{} : soup.points.front();
  double volume = 0;
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto t = soup.polygon(f);
    const auto at = [&](std::size_t i) { return soup.points[t[i]] - origin; };
    volume += dot(at(0), cross(at(1), at(2))) / 6;
  }
  return volume;
}

/// Sums over the parts of a sub-shape: of both measures, and of the difference that the deflection allows.
struct Sum {
  CadMeasure measure;
  double allowed = 0;

  void add(double exact, double cut, double off) {
    measure.exact += exact;
    measure.cut += cut;
    allowed += off;
  }
  /// Returns whether the exact measure and that of the tessellation agree. If not, one of them is wrong.
  bool is_plausible() const {
    constexpr double share = 0.05;  // relative; an arc of 20 degrees exceeds its chord by less than 1%
    return std::fabs(measure.exact - measure.cut) <= share * measure.cut + allowed;
  }
};

std::map<Tag, CadMeasure> plausible(const std::map<Tag, Sum>& sums) {
  std::map<Tag, CadMeasure> measures;
  for (const auto& [number, sum] : sums)
    if (sum.is_plausible()) measures.emplace(number, sum.measure);
  return measures;
}

std::map<Tag, CadMeasure> lengths_of(const Topology& topology, const Tessellation& tessellation,
                                     double deflection) {
  std::map<Tag, Sum> sums;
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(topology.all, TopAbs_EDGE, edges);
  for (const Topology::FreePart& part : topology.free_parts)
    TopExp::MapShapes(part.shape, TopAbs_EDGE, edges);
  for (int e = 1; e <= edges.Extent(); ++e)
    if (const TopoDS_Shape& edge = edges(e); tessellation.lengths.IsBound(edge))
      sums[topology.number(edge)].add(length_of(edge), tessellation.lengths.Find(edge), 2 * deflection);
  return plausible(sums);
}

double border_of(const TopoDS_Shape& face, const Tessellation& tessellation) {
  double length = 0;
  for (const TopoDS_Shape& edge : subshapes(face, TopAbs_EDGE))
    if (tessellation.lengths.IsBound(edge)) length += tessellation.lengths.Find(edge);
  return length;
}

std::map<Tag, CadMeasure> areas_of(const Topology& topology, const Tessellation& tessellation,
                                   const FaceIntegrals& integrals, double deflection) {
  std::map<Tag, Sum> sums;
  for (const TopoDS_Shape& face : subshapes(topology.all, TopAbs_FACE))
    sums[topology.number(face)].add(integrals.area(face), tessellation.areas.Find(face),
                                    2 * deflection * border_of(face, tessellation));
  return plausible(sums);
}

std::vector<std::optional<CadMeasure>> volumes_of(const Topology& topology, const Tessellation& tessellation,
                                                  const FaceIntegrals& integrals, double deflection) {
  std::vector<std::optional<CadMeasure>> volumes(tessellation.soups.size());
  for (std::size_t s = 0; s < topology.solids.size(); ++s) {
    if (topology.solids[s].open) continue;
    const PolygonSoup& soup = tessellation.soups[s];
    const double cut = volume_of_triangles(soup), sign = cut < 0 ? -1 : 1;  // a solid may be inside out
    Sum sum;
    sum.add(0, sign * cut, 2 * deflection * area_of_triangles(soup));
    for (const TopoDS_Shape& face : topology.solids[s].faces) sum.add(sign * integrals.cone(face), 0, 0);
    if (sum.is_plausible()) volumes[s] = sum.measure;
  }
  return volumes;
}

}  // namespace

CadMeasures measure(const Topology& topology, const FaceIntegrals& integrals,
                    const Tessellation& tessellation, double deflection) {
  return {lengths_of(topology, tessellation, deflection),
          areas_of(topology, tessellation, integrals, deflection),
          volumes_of(topology, tessellation, integrals, deflection)};
}

}  // namespace collarmesh::brep
