// Finds the solids of a shape and numbers its sub-shapes.
#include "topology.h"

#include "free_parts.h"
#include "fuse.h"
#include "sewing.h"

#include <fmt/format.h>
#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace collarmesh::brep {

namespace {

constexpr std::array numbered_kinds{TopAbs_SOLID, TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX};

const char* kind_name(TopAbs_ShapeEnum kind) {
  switch (kind) {
    case TopAbs_COMPOUND: return "Compound";
    case TopAbs_COMPSOLID: return "CompSolid";
    case TopAbs_SOLID: return "Solid";
    case TopAbs_SHELL: return "Shell";
    case TopAbs_FACE: return "Face";
    case TopAbs_WIRE: return "Wire";
    case TopAbs_EDGE: return "Edge";
    case TopAbs_VERTEX: return "Vertex";
    case TopAbs_SHAPE: break;
  }
  return "Shape";
}

void number_subshapes(const TopoDS_Shape& shape, TopTools_DataMapOfShapeInteger& numbers) {
  for (const TopAbs_ShapeEnum kind : numbered_kinds) {
    int number = 0;
    for (const TopoDS_Shape& part : subshapes(shape, kind)) numbers.Bind(part, ++number);
  }
}

/// Returns the faces that bound no solid.
std::vector<TopoDS_Shape> internal_faces_of(const TopoDS_Shape& shape) {
  TopTools_MapOfShape bounding;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
    for (TopExp_Explorer face(solid.Current(), TopAbs_FACE); face.More(); face.Next())
      if (!inside_orientation(face.Current())) bounding.Add(face.Current());
  std::vector<TopoDS_Shape> internal;
  for (const TopoDS_Shape& face : subshapes(shape, TopAbs_FACE))
    if (!bounding.Contains(face)) internal.push_back(face.Oriented(TopAbs_FORWARD));
  return internal;
}

/// Returns whether an edge borders only one face, once; inner edges of a face and degenerate edges do not
/// count.
bool borders_one_face(const TopoDS_Shape& edge, const TopTools_ListOfShape& faces) {
  if (BRep_Tool::Degenerated(TopoDS::Edge(edge))) return false;
  int uses = 0;
  TopTools_MapOfShape seen;
  for (const TopoDS_Shape& face : faces) {
    if (!seen.Add(face) || inside_orientation(face)) continue;
    for (TopExp_Explorer side(face, TopAbs_EDGE); side.More(); side.Next())
      if (side.Current().IsSame(edge)) {
        if (side.Current().Orientation() == TopAbs_INTERNAL) return false;
        ++uses;
      }
  }
  return uses == 1;
}

}  // namespace

std::vector<TopoDS_Shape> subshapes(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return {map.cbegin(), map.cend()};
}

TopoDS_Compound compound_of(const std::vector<TopoDS_Shape>& shapes) {
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes) builder.Add(compound, shape);
  return compound;
}

bool inside_orientation(const TopoDS_Shape& face) {
  return face.Orientation() == TopAbs_INTERNAL || face.Orientation() == TopAbs_EXTERNAL;
}

std::vector<TopoDS_Shape> boundary_of(const TopoDS_Shape& solid) {
  std::vector<TopoDS_Shape> faces;
  for (TopExp_Explorer face(solid, TopAbs_FACE); face.More(); face.Next())
    if (!inside_orientation(face.Current())) faces.push_back(face.Current());
  return faces;
}

void carry_numbers(const TopoDS_Shape& before, const TopoDS_Shape& after, const PartsOf& parts_of,
                   Topology& topology) {
  TopTools_DataMapOfShapeInteger numbers;
  for (const TopAbs_ShapeEnum kind : numbered_kinds) {
    std::multimap<int, TopoDS_Shape> by_number;  // parts of a solid have its number
    for (const TopoDS_Shape& old : subshapes(before, kind))
      if (topology.number(old) > 0) by_number.emplace(topology.number(old), old);
    int next = by_number.empty() ? 1 : by_number.rbegin()->first + 1;
    for (const auto& [part, number] : topology.kept_numbers) {
      if (part.ShapeType() != kind) continue;
      next = std::max(next, number + 1);
      if (!numbers.IsBound(part)) numbers.Bind(part, number);
    }
    for (const auto& [number, old] : by_number)
      for (const TopoDS_Shape& part : parts_of(old))
        if (!numbers.IsBound(part))
          numbers.Bind(part, number);
        else if (kind == TopAbs_FACE && numbers.Find(part) != number)
          topology.replaced_faces.emplace_back(number, numbers.Find(part));
    for (const TopoDS_Shape& part : subshapes(after, kind))
      if (!numbers.IsBound(part)) numbers.Bind(part, next++);
  }
  topology.numbers = numbers;
}

std::vector<std::pair<TopoDS_Shape, TopoDS_Shape>> open_edges(const TopoDS_Shape& shape) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_at;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_at);
  std::vector<std::pair<TopoDS_Shape, TopoDS_Shape>> open;
  for (int i = 1; i <= faces_at.Extent(); ++i)
    if (!faces_at(i).IsEmpty() && borders_one_face(faces_at.FindKey(i), faces_at(i)))
      open.emplace_back(faces_at.FindKey(i), faces_at(i).First());
  return open;
}

std::string open_edges_text(const Topology& topology, const TopoDS_Shape& shape) {
  const auto open = open_edges(shape);
  std::string sentence =
      fmt::format("{} {} one face only", open.size(), open.size() == 1 ? "edge borders" : "edges border");
  constexpr std::size_t listed = 3;
  for (std::size_t i = 0; i < std::min(listed, open.size()); ++i)
    sentence += fmt::format("{} {} of {} at {}", i == 0 ? ":" : ",", topology.name(open[i].first),
                            topology.name(open[i].second), text(place_of(open[i].first)));
  return open.size() > listed ? sentence + ", ..." : sentence;
}

double rough_diagonal(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

std::string text(const Point& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z); }

std::string text(const Standard_Failure& failure) {
  const char* said = failure.GetMessageString();
  return said != nullptr && *said != '\0' ? said : failure.DynamicType()->Name();
}

void fail(PlcFault::Kind kind, const std::string& message, const Point& where) {
  throw PlcError(message, {{kind, message, {}, where}});
}

Point place_of(const TopoDS_Shape& shape) {
  if (shape.ShapeType() == TopAbs_EDGE && !BRep_Tool::Degenerated(TopoDS::Edge(shape))) {
    const BRepAdaptor_Curve curve(TopoDS::Edge(shape));
    const gp_Pnt p = curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter()));
    return {p.X(), p.Y(), p.Z()};
  }
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  if (box.IsVoid()) return {};
  const gp_Pnt low = box.CornerMin(), high = box.CornerMax();
  return {0.5 * (low.X() + high.X()), 0.5 * (low.Y() + high.Y()), 0.5 * (low.Z() + high.Z())};
}

void Topology::keep_numbers(const std::vector<TopoDS_Shape>& parts) {
  for (const TopoDS_Shape& part : parts) {
    kept_numbers.emplace_back(part, number(part));
    for (TopExp_Explorer end(part, TopAbs_VERTEX); end.More(); end.Next())
      kept_numbers.emplace_back(end.Current(), number(end.Current()));
  }
}

std::string Topology::name(const TopoDS_Shape& shape) const {
  const int n = number(shape);
  return n > 0 ? fmt::format("{}{}", kind_name(shape.ShapeType()), n) : kind_name(shape.ShapeType());
}

namespace {

/// Makes each edge of a shape without faces a free part, for meshes of lines. Fails if there is no edge.
void take_wires(const TopoDS_Shape& shape, const std::string& file, Topology& topology) {
  for (const TopoDS_Shape& edge : subshapes(shape, TopAbs_EDGE))
    if (!BRep_Tool::Degenerated(TopoDS::Edge(edge)))
      topology.free_parts.push_back({edge, topology.number(edge), std::numeric_limits<double>::infinity()});
  if (topology.free_parts.empty())
    fail(PlcFault::Kind::empty,
         fmt::format("{} holds no solid, no face and no edge; there is nothing to mesh.", file),
         place_of(shape));
}

}  // namespace

Topology find_topology(const TopoDS_Shape& shape, const std::string& file, const CadOptions& options) {
  if (shape.IsNull())
    fail(PlcFault::Kind::empty, fmt::format("{}: the shape is null; there is nothing to mesh.", file));
  Topology topology;
  topology.all = shape;
  number_subshapes(shape, topology.numbers);
  if (!TopExp_Explorer(shape, TopAbs_FACE).More()) {
    take_wires(shape, file, topology);
    return topology;
  }
  const std::vector<TopoDS_Shape> free_parts = parts_of_no_face(shape);
  topology.keep_numbers(free_parts);
  for (const TopoDS_Shape& solid : subshapes(shape, TopAbs_SOLID))
    topology.solids.push_back({solid, topology.number(solid), {}, false});
  if (topology.solids.empty()) {
    sew_faces(file, topology);
  } else {
    close_solids(file, topology);
    topology.internal_faces = internal_faces_of(topology.all);
  }
  share_faces(file, options, topology);
  keep_free_parts_inside(free_parts, file, topology);
  return topology;
}

}  // namespace collarmesh::brep
