// From a shape to its solids with numbered sub-shapes.
#include "topology.h"

#include <fmt/format.h>
#include <BOPAlgo_Builder.hxx>
#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Precision.hxx>
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
#include <functional>
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

/// Numbers for the parts that `parts_of` says an original sub-shape became, the smallest where several
/// became one; and the next free ones for parts that come from none.
void carry_numbers(const TopoDS_Shape& before, const TopoDS_Shape& after,
                   const std::function<TopTools_ListOfShape(const TopoDS_Shape&)>& parts_of,
                   Topology& topology) {
  TopTools_DataMapOfShapeInteger numbers;
  for (const TopAbs_ShapeEnum kind : numbered_kinds) {
    std::map<int, TopoDS_Shape> by_number;
    for (const TopoDS_Shape& old : subshapes(before, kind)) by_number[topology.number(old)] = old;
    int next = by_number.empty() ? 1 : by_number.rbegin()->first + 1;
    for (const auto& [number, old] : by_number)
      for (const TopoDS_Shape& part : parts_of(old))
        if (!numbers.IsBound(part)) numbers.Bind(part, number);
    for (const TopoDS_Shape& part : subshapes(after, kind))
      if (!numbers.IsBound(part)) numbers.Bind(part, next++);
  }
  topology.numbers = numbers;
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

/// Faces that bound no solid.
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

/// An edge that a closed surface would have two faces at.
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

/// The edges at which the faces of a shape are open.
std::vector<std::pair<TopoDS_Shape, TopoDS_Shape>> open_edges(const TopoDS_Shape& shape) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_at;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_at);
  std::vector<std::pair<TopoDS_Shape, TopoDS_Shape>> open;
  for (int i = 1; i <= faces_at.Extent(); ++i)
    if (!faces_at(i).IsEmpty() && borders_one_face(faces_at.FindKey(i), faces_at(i)))
      open.emplace_back(faces_at.FindKey(i), faces_at(i).First());
  return open;
}

std::string open_text(const Topology& topology, const TopoDS_Shape& shape) {
  const auto open = open_edges(shape);
  std::string sentence =
      fmt::format("{} edge{} border one face only", open.size(), open.size() == 1 ? "" : "s");
  constexpr std::size_t listed = 3;
  for (std::size_t i = 0; i < std::min(listed, open.size()); ++i)
    sentence += fmt::format("{} {} of {} at {}", i == 0 ? ":" : ",", topology.name(open[i].first),
                            topology.name(open[i].second), text(place_of(open[i].first)));
  return open.size() > listed ? sentence + ", ..." : sentence;
}

void require_closed(const Topology& topology) {
  for (const Topology::Solid& solid : topology.solids) {
    const auto open = open_edges(solid.shape);
    if (open.empty()) continue;
    fail(PlcFault::Kind::open_boundary,
         fmt::format("{} is open: {}; close it, for instance by sewing its faces.",
                     topology.name(solid.shape), open_text(topology, solid.shape)),
         place_of(open.front().first));
  }
}

/// Faces without a solid: sewn, and solids made of the shells that are closed then.
void sew(const TopoDS_Shape& shape, const std::string& file, Topology& topology) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  constexpr double relative_gap = 1e-5;
  const double gap = relative_gap * std::sqrt(box.SquareExtent());
  BRepBuilderAPI_Sewing sewing(gap);
  sewing.Add(shape);
  sewing.Perform();
  const TopoDS_Shape sewn = sewing.SewedShape();
  std::vector<TopoDS_Shape> solids;
  for (TopExp_Explorer shell(sewn, TopAbs_SHELL); shell.More(); shell.Next()) {
    if (!open_edges(shell.Current()).empty()) continue;
    TopoDS_Solid solid = BRepBuilderAPI_MakeSolid(TopoDS::Shell(shell.Current()));
    BRepLib::OrientClosedSolid(solid);
    solids.push_back(solid);
  }
  carry_numbers(
      shape, sewn,
      [&](const TopoDS_Shape& old) {
        TopTools_ListOfShape parts;
        parts.Append(sewing.IsModifiedSubShape(old) ? sewing.ModifiedSubShape(old) : old);
        return parts;
      },
      topology);
  if (solids.empty()) {
    const auto open = open_edges(sewn);
    fail(PlcFault::Kind::open_boundary,
         fmt::format("{} holds no solid, and its faces, sewn within {:.3g}, enclose none: {}; close the "
                     "surface and make a solid of it.",
                     file, gap, open_text(topology, sewn)),
         open.empty() ? Point{} : place_of(open.front().first));
  }
  int number = 0;
  for (const TopoDS_Shape& solid : solids) topology.solids.push_back({solid, ++number});
  for (const Topology::Solid& solid : topology.solids) topology.numbers.Bind(solid.shape, solid.number);
  topology.all = compound_of(solids);
  topology.notes.push_back(fmt::format("{}: its faces were sewn within {:.3g} to {} solid{}", file, gap,
                                       solids.size(), solids.size() == 1 ? "" : "s"));
}

/// A part of two solids: they overlap.
void require_apart(const std::vector<Topology::Solid>& before, const BOPAlgo_Builder& fuse,
                   const Topology& topology) {
  TopTools_DataMapOfShapeInteger owner;
  for (std::size_t s = 0; s < before.size(); ++s) {
    if (!fuse.Images().IsBound(before[s].shape)) continue;
    for (const TopoDS_Shape& part : fuse.Images().Find(before[s].shape)) {
      if (!owner.IsBound(part)) {
        owner.Bind(part, static_cast<int>(s));
        continue;
      }
      fail(PlcFault::Kind::intersection,
           fmt::format("{} and {} overlap around {}; cut one from the other, or fragment them (FreeCAD: "
                       "Boolean Fragments).",
                       topology.name(before[static_cast<std::size_t>(owner.Find(part))].shape),
                       topology.name(before[s].shape), text(place_of(part))),
           place_of(part));
    }
  }
}

bool share_a_vertex(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  TopTools_IndexedMapOfShape vertices;
  TopExp::MapShapes(a, TopAbs_VERTEX, vertices);
  const auto others = subshapes(b, TopAbs_VERTEX);
  return std::any_of(others.begin(), others.end(),
                     [&](const TopoDS_Shape& v) { return vertices.Contains(v); });
}

/// Where solids touch in a point only, which general fuse does not see: a vertex for each.
std::vector<TopoDS_Shape> contact_points(const std::vector<TopoDS_Shape>& solids) {
  std::vector<Bnd_Box> boxes(solids.size());
  for (std::size_t i = 0; i < solids.size(); ++i) BRepBndLib::Add(solids[i], boxes[i]);
  std::vector<TopoDS_Shape> vertices;
  for (std::size_t i = 0; i < solids.size(); ++i)
    for (std::size_t j = i + 1; j < solids.size(); ++j) {
      if (boxes[i].IsOut(boxes[j]) || share_a_vertex(solids[i], solids[j])) continue;
      const BRepExtrema_DistShapeShape extrema(solids[i], solids[j]);
      if (!extrema.IsDone() || extrema.Value() > Precision::Confusion()) continue;
      for (int k = 1; k <= extrema.NbSolution(); ++k)
        vertices.push_back(BRepBuilderAPI_MakeVertex(extrema.PointOnShape1(k)).Vertex());
    }
  return vertices;
}

void fuse_all(const std::vector<TopoDS_Shape>& arguments, const std::string& file, const Topology& topology,
              BOPAlgo_Builder& fuse) {
  fuse.SetNonDestructive(true);
  for (const TopoDS_Shape& argument : arguments) fuse.AddArgument(argument);
  fuse.Perform();
  if (!fuse.HasErrors()) return;
  fail(PlcFault::Kind::intersection,
       fmt::format("{}: the common faces of its {} solids and {} other faces cannot be found; fragment them "
                   "(FreeCAD: Boolean Fragments) and check the result.",
                   file, topology.solids.size(), topology.internal_faces.size()),
       place_of(topology.all));
}

/// Make solids and internal faces that touch share faces, edges and vertices (general fuse).
void share_faces(const std::string& file, Topology& topology) {
  std::vector<TopoDS_Shape> arguments = topology.internal_faces;
  for (const Topology::Solid& solid : topology.solids) arguments.push_back(solid.shape);
  const TopoDS_Shape before = compound_of(arguments);
  BOPAlgo_Builder fuse;
  fuse_all(arguments, file, topology, fuse);
  const auto contacts = contact_points(subshapes(fuse.Shape(), TopAbs_SOLID));
  if (!contacts.empty()) {
    arguments.insert(arguments.end(), contacts.begin(), contacts.end());
    fuse.Clear();
    fuse_all(arguments, file, topology, fuse);
  }
  require_apart(topology.solids, fuse, topology);
  const auto parts_of = [&](const TopoDS_Shape& old) {
    TopTools_ListOfShape parts = fuse.Modified(old);
    if (parts.IsEmpty() && !fuse.IsDeleted(old)) parts.Append(old);
    return parts;
  };
  std::vector<Topology::Solid> solids;
  for (const Topology::Solid& solid : topology.solids)
    for (const TopoDS_Shape& part : parts_of(solid.shape)) solids.push_back({part, solid.number});
  std::vector<TopoDS_Shape> faces;
  for (const TopoDS_Shape& face : topology.internal_faces)
    for (const TopoDS_Shape& part : parts_of(face)) faces.push_back(part);
  carry_numbers(before, fuse.Shape(), parts_of, topology);
  topology.all = fuse.Shape();
  topology.solids = solids;
  TopTools_MapOfShape bounding;
  for (const Topology::Solid& solid : solids)
    for (TopExp_Explorer face(solid.shape, TopAbs_FACE); face.More(); face.Next())
      if (!inside_orientation(face.Current())) bounding.Add(face.Current());
  topology.internal_faces.clear();
  for (const TopoDS_Shape& face : faces)
    if (bounding.Add(face)) topology.internal_faces.push_back(face);
}

}  // namespace

std::vector<TopoDS_Shape> subshapes(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return {map.cbegin(), map.cend()};
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

std::string Topology::name(const TopoDS_Shape& shape) const {
  const int n = number(shape);
  return n > 0 ? fmt::format("{}{}", kind_name(shape.ShapeType()), n) : kind_name(shape.ShapeType());
}

Topology find_topology(const TopoDS_Shape& shape, const std::string& file) {
  if (shape.IsNull())
    fail(PlcFault::Kind::empty, fmt::format("{}: the shape is null; there is nothing to mesh.", file));
  Topology topology;
  topology.all = shape;
  number_subshapes(shape, topology.numbers);
  if (!TopExp_Explorer(shape, TopAbs_FACE).More())
    fail(PlcFault::Kind::empty, fmt::format("{} holds no solid and no face; there is nothing to mesh.", file),
         place_of(shape));
  for (const TopoDS_Shape& solid : subshapes(shape, TopAbs_SOLID))
    topology.solids.push_back({solid, topology.number(solid)});
  if (topology.solids.empty()) {
    sew(shape, file, topology);
    return topology;
  }
  require_closed(topology);
  topology.internal_faces = internal_faces_of(shape);
  if (topology.solids.size() + topology.internal_faces.size() > 1) share_faces(file, topology);
  return topology;
}

}  // namespace collarmesh::brep
