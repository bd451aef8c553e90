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

/// The solids of a shape, the other sub-shapes that become features, and the numbers of all.
struct Topology {
  struct Solid {
    TopoDS_Shape shape;
    int number = 0;
    std::vector<TopoDS_Shape> faces;  ///< faces of its boundary, with their orientation there
    bool open = false;                ///< whether some edges border only one face
  };

  /// An edge or vertex that belongs to no face, or a piece of such an edge.
  struct FreePart {
    TopoDS_Shape shape;
    int number = 0;
    double clearance = 0;  ///< the smaller of two distances: to the faces that it does not end on, and
                           ///< from its middle to curved faces
  };

  std::vector<Solid> solids;                 ///< pieces of one solid have the same number
  std::vector<TopoDS_Shape> internal_faces;  ///< faces that belong to no solid, or lie inside one
  std::vector<FreePart> free_parts;          ///< parts that lie inside a solid, or all edges of a shape of
                                             ///< edges alone
  TopoDS_Shape all;                          ///< the shape to tessellate
  TopTools_DataMapOfShapeInteger numbers;    ///< numbers of solids, faces, edges and vertices
  std::vector<std::pair<TopoDS_Shape, int>> kept_numbers;  ///< numbers of free parts, which no step may reuse
  std::vector<std::pair<Tag, Tag>> replaced_faces;         ///< pairs: the number that is gone, and the number
                                                           ///< that replaces it
  std::vector<std::string> notes;
  bool fused = true;      ///< whether all solids that touch or overlap were fused
  std::string open_text;  ///< text on which solids are open, at which edges; empty: none

  int number(const TopoDS_Shape& shape) const { return numbers.IsBound(shape) ? numbers.Find(shape) : 0; }
  /// Reserves the numbers of these parts and of their vertices.
  void keep_numbers(const std::vector<TopoDS_Shape>& parts);
  /// Returns a name such as "Face7".
  std::string name(const TopoDS_Shape& shape) const;
};

inline bool is_edge(const TopoDS_Shape& part) { return part.ShapeType() == TopAbs_EDGE; }

/// Finds the solids of a shape. Sews faces if there is no solid or one is open. Then makes touching solids
/// share faces. The edges of a shape without faces become free parts. Throws PlcError for a shape without
/// faces and edges.
Topology find_topology(const TopoDS_Shape& shape, const std::string& file, const CadOptions& options);

/// Returns the sub-shapes of one kind, each once, in the order of their numbers.
std::vector<TopoDS_Shape> subshapes(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind);

TopoDS_Compound compound_of(const std::vector<TopoDS_Shape>& shapes);

/// Returns whether a face of a solid, or an edge of a face, is marked by its orientation (internal or
/// external) as no part of the boundary.
bool inside_orientation(const TopoDS_Shape& face);

/// Returns the faces of a solid that are its boundary, oriented.
std::vector<TopoDS_Shape> boundary_of(const TopoDS_Shape& solid);

/// A function that returns the pieces of a sub-shape: the sub-shape itself, parts of it, or nothing.
using PartsOf = std::function<TopTools_ListOfShape(const TopoDS_Shape&)>;

/// Numbers the sub-shapes of `after`. A part of a sub-shape of `before` gets its number, or the smallest of
/// their numbers if it is part of several; other sub-shapes get the next free numbers. Records in
/// `replaced_faces` the numbers of faces that are gone.
void carry_numbers(const TopoDS_Shape& before, const TopoDS_Shape& after, const PartsOf& parts_of,
                   Topology& topology);

/// Returns the edges that border only one face of a shape, each with that face.
std::vector<std::pair<TopoDS_Shape, TopoDS_Shape>> open_edges(const TopoDS_Shape& shape);

/// Describes open edges: "4 edges border one face only: Edge2 of Face1 at (0, 1, 2), ...".
std::string open_edges_text(const Topology& topology, const TopoDS_Shape& shape);

/// Returns the middle of an edge, or of the box around another shape.
Point place_of(const TopoDS_Shape& shape);

/// Returns the diagonal of the box around a shape, which may be somewhat too large.
double rough_diagonal(const TopoDS_Shape& shape);

/// Returns coordinates as text: "(1, 2, 3)".
std::string text(const Point& p);

/// Throws a PlcError with one fault.
[[noreturn]] void fail(PlcFault::Kind kind, const std::string& message, const Point& where = {});

/// Returns the message of a failure of OpenCASCADE, or the name of its class if it has none.
std::string text(const Standard_Failure& failure);

}  // namespace collarmesh::brep
