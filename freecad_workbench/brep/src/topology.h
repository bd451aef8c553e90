#pragma once

#include <Standard_Failure.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/brep/cad_model.h"
#include "collarmesh/error.h"

namespace collarmesh::brep {

/// The sub-shapes that become features, and their numbers.
struct Topology {
  struct Solid {
    TopoDS_Shape shape;
    int number = 0;
    std::vector<TopoDS_Shape> faces;  ///< its boundary, each as it is oriented there
    bool open = false;                ///< edges border one face only
  };

  /// An edge or vertex of no face, or a piece of one.
  struct FreePart {
    TopoDS_Shape shape;
    int number = 0;
    double clearance = 0;  ///< to the faces that it does not end on; of its middle, to curved ones
  };

  std::vector<Solid> solids;                 ///< parts of one solid have the same number
  std::vector<TopoDS_Shape> internal_faces;  ///< that belong to no solid, or lie inside one
  std::vector<FreePart> free_parts;          ///< that lie inside a solid, or all of a shape of edges alone
  TopoDS_Shape all;                          ///< what is tessellated
  TopTools_DataMapOfShapeInteger numbers;    ///< of solids, faces, edges and vertices
  std::vector<std::pair<TopoDS_Shape, int>> kept_numbers;  ///< of parts that no step changes
  std::vector<std::pair<Tag, Tag>> replaced_faces;         ///< number that is gone, number in its place
  std::vector<std::string> notes;
  bool fused = true;      ///< all that touch or overlap
  std::string open_text;  ///< which solids are open, at which edges; empty: none

  int number(const TopoDS_Shape& shape) const { return numbers.IsBound(shape) ? numbers.Find(shape) : 0; }
  /// Reserves the numbers of these parts and of their vertices.
  void keep_numbers(const std::vector<TopoDS_Shape>& parts);
  /// "Face7".
  std::string name(const TopoDS_Shape& shape) const;
};

/// Find the solids of a shape, sew where there is none or one is open, make those that touch share faces.
/// A shape of edges alone keeps these as free parts. Throws PlcError for a shape without faces and edges.
Topology find_topology(const TopoDS_Shape& shape, const std::string& file, const CadOptions& options);

/// The sub-shapes of one kind, each once, in the order that numbers them.
std::vector<TopoDS_Shape> subshapes(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind);

TopoDS_Compound compound_of(const std::vector<TopoDS_Shape>& shapes);

/// Is it no part of the boundary of the solid that it is met in?
bool inside_orientation(const TopoDS_Shape& face);

/// The faces of a solid that are its boundary, oriented.
std::vector<TopoDS_Shape> boundary_of(const TopoDS_Shape& solid);

/// What became of a sub-shape: itself, parts of it, or nothing.
using PartsOf = std::function<TopTools_ListOfShape(const TopoDS_Shape&)>;

/// Numbers for the parts that the sub-shapes of `before` became in `after`, the smallest where several became
/// one; and the next free ones for parts that come from none. Records the numbers of faces that went.
void carry_numbers(const TopoDS_Shape& before, const TopoDS_Shape& after, const PartsOf& parts_of,
                   Topology& topology);

/// The edges at which the faces of a shape are open, each with a face there.
std::vector<std::pair<TopoDS_Shape, TopoDS_Shape>> open_edges(const TopoDS_Shape& shape);

/// "4 edges border one face only: Edge2 of Face1 at (0, 1, 2), ...".
std::string open_edges_text(const Topology& topology, const TopoDS_Shape& shape);

/// The middle of an edge, of the box around anything else.
Point place_of(const TopoDS_Shape& shape);

/// Of the box around a shape, which may be somewhat too large.
double rough_diagonal(const TopoDS_Shape& shape);

/// "(1, 2, 3)".
std::string text(const Point& p);

/// A PlcError of one fault.
[[noreturn]] void fail(PlcFault::Kind kind, const std::string& message, const Point& where = {});

/// What OpenCASCADE says about a failure of its own; its exceptions are no std::exception.
std::string text(const Standard_Failure& failure);

}  // namespace collarmesh::brep
