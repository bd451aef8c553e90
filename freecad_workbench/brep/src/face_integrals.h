#pragma once

#include <NCollection_IndexedDataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Pnt.hxx>

#include "contour_integrals.h"

namespace collarmesh::brep {

/// Areas of faces and volumes of the cones over them. The apex is the centre of the shape's bounding box.
/// Each face is integrated once. A measure is NaN if OpenCASCADE fails, as it does on some faces.
class FaceIntegrals {
 public:
  explicit FaceIntegrals(const TopoDS_Shape& shape);

  double area(const TopoDS_Shape& face) const { return measures_.FindFromKey(face).area; }
  /// Returns the signed volume of the cone: positive if the face's normal points away from the apex.
  double cone(const TopoDS_Shape& face) const;

 private:
  FaceMeasure measure(const TopoDS_Shape& face) const;
  template <class Integral>
  double integrated(const TopoDS_Shape& face) const;

  gp_Pnt apex_;
  NCollection_IndexedDataMap<TopoDS_Shape, FaceMeasure, TopTools_ShapeMapHasher> measures_;
};

}  // namespace collarmesh::brep
