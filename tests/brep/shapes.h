#pragma once

#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>
#include <vector>

namespace collarmesh::testing {

inline TopoDS_Compound compound(const std::vector<TopoDS_Shape>& parts) {
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& part : parts) builder.Add(compound, part);
  return compound;
}

inline std::vector<TopoDS_Shape> faces_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shape> faces;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) faces.push_back(face.Current());
  return faces;
}

}  // namespace collarmesh::testing
