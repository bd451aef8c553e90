#pragma once

#include <Standard_Failure.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "collarmesh/error.h"

namespace collarmesh::brep {

/// The sub-shapes that become features, and their numbers.
struct Topology {
  struct Solid {
    TopoDS_Shape shape;
    int number = 0;
  };

  std::vector<Solid> solids;
  std::vector<TopoDS_Shape> internal_faces;  ///< that belong to no solid, or lie inside one
  TopoDS_Shape all;                          ///< what is tessellated
  TopTools_DataMapOfShapeInteger numbers;    ///< of solids, faces, edges and vertices
  std::vector<std::string> notes;

  int number(const TopoDS_Shape& shape) const { return numbers.IsBound(shape) ? numbers.Find(shape) : 0; }
  /// "Face7".
  std::string name(const TopoDS_Shape& shape) const;
};

/// Find the solids of a shape, make those that touch share faces, sew where there is none.
/// Throws PlcError.
Topology find_topology(const TopoDS_Shape& shape, const std::string& file);

/// The sub-shapes of one kind, each once, in the order that numbers them.
std::vector<TopoDS_Shape> subshapes(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind);

/// The middle of an edge, of the box around anything else.
Point place_of(const TopoDS_Shape& shape);

/// "(1, 2, 3)".
std::string text(const Point& p);

/// A PlcError of one fault.
[[noreturn]] void fail(PlcFault::Kind kind, const std::string& message, const Point& where = {});

/// What OpenCASCADE says about a failure of its own; its exceptions are no std::exception.
std::string text(const Standard_Failure& failure);

}  // namespace collarmesh::brep
