// Makes closed shells from faces that do not share their edges.
#include "sewing.h"

#include <fmt/format.h>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>

#include <algorithm>
#include <array>
#include <memory>

namespace collarmesh::brep {

namespace {

constexpr std::array relative_gaps{1e-5, 1e-4, 1e-3};  // relative to the diagonal of the sewn faces

struct Sewn {
  std::shared_ptr<BRepBuilderAPI_Sewing> sewing;
  TopoDS_Shape shape;
  double gap = 0;
  std::size_t open = 0;  ///< number of open edges
};

Sewn sewn_within(double gap, const TopoDS_Shape& shape) {
  Sewn sewn;
  sewn.gap = gap;
  sewn.sewing = std::make_shared<BRepBuilderAPI_Sewing>(gap);
  for (const TopoDS_Shape& face : subshapes(shape, TopAbs_FACE)) sewn.sewing->Add(face);
  sewn.sewing->Perform();
  sewn.shape = sewn.sewing->SewedShape();
  if (!sewn.shape.IsNull()) sewn.open = open_edges(sewn.shape).size();
  return sewn;
}

/// Sews with the gap that leaves the fewest edges open, and of equal ones with the smallest. Returns no shape
/// if sewing fails.
Sewn sewn(const TopoDS_Shape& shape) {
  Sewn best;
  const double diagonal = rough_diagonal(shape);
  for (const double relative_gap : relative_gaps) {
    try {
      const Sewn next = sewn_within(relative_gap * diagonal, shape);
      if (next.shape.IsNull() || (!best.shape.IsNull() && next.open >= best.open)) continue;
      best = next;
    } catch (const Standard_Failure&) {
      continue;  // another gap may work
    }
    if (best.open == 0) break;
  }
  return best;
}

TopoDS_Shell shell_of(const TopoDS_Shape& face) {
  BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  builder.Add(shell, face);
  return shell;
}

/// Returns the shells of sewn faces. A face without neighbours, such as a sphere, belongs to no shell and
/// gets its own.
std::vector<TopoDS_Shell> shells_of(const TopoDS_Shape& sewn) {
  std::vector<TopoDS_Shell> shells;
  for (const TopoDS_Shape& shell : subshapes(sewn, TopAbs_SHELL)) shells.push_back(TopoDS::Shell(shell));
  for (TopExp_Explorer face(sewn, TopAbs_FACE, TopAbs_SHELL); face.More(); face.Next())
    shells.push_back(shell_of(face.Current()));
  return shells;
}

TopoDS_Solid solid_of(const std::vector<TopoDS_Shell>& shells) {
  BRepBuilderAPI_MakeSolid maker;
  for (const TopoDS_Shell& shell : shells) maker.Add(shell);
  TopoDS_Solid solid = maker.Solid();
  BRepLib::OrientClosedSolid(solid);
  return solid;
}

/// Keeps all faces as one open solid: the sewn faces or, if sewing failed, the original ones.
void keep_open(const Sewn& sewn, const std::string& file, Topology& topology) {
  Topology::Solid open;
  open.shape = sewn.shape.IsNull() ? topology.all : sewn.shape;
  open.number = 1;
  open.faces = boundary_of(open.shape);
  open.open = true;
  topology.all = open.shape;
  topology.open_text = fmt::format(
      "{} holds no solid, and its faces, sewn with a tolerance of {:.3g}, enclose none: {}; close the "
      "surface and make a solid of it.",
      file, sewn.gap, open_edges_text(topology, open.shape));
  topology.notes.push_back(topology.open_text);
  topology.solids.push_back(open);
}

/// Returns whether a shell looks like a closed surface with some faces missing, rather than a sheet: fewer
/// than half of its edges are open.
bool nearly_closed(const TopoDS_Shape& shell) {
  return 2 * open_edges(shell).size() < subshapes(shell, TopAbs_EDGE).size();
}

/// Makes solids of closed shells, and open solids of nearly closed ones. Returns the number of faces in the
/// other shells, which are left out.
std::size_t make_solids(const std::vector<TopoDS_Shell>& shells, Topology& topology) {
  std::size_t left_out = 0;
  for (const TopoDS_Shell& shell : shells) {
    Topology::Solid solid;
    solid.open = !open_edges(shell).empty();
    if (solid.open && !nearly_closed(shell)) {
      left_out += subshapes(shell, TopAbs_FACE).size();
      continue;
    }
    solid.number = static_cast<int>(topology.solids.size()) + 1;
    solid.shape = solid.open ? TopoDS_Shape(shell) : solid_of({shell});
    solid.faces = boundary_of(solid.shape);
    topology.numbers.Bind(solid.shape, solid.number);
    topology.solids.push_back(solid);
  }
  return left_out;
}

/// Sews the faces of an open solid. Returns the closed solid, or the open one if sewing does not close it.
TopoDS_Shape closed(const Topology::Solid& open, const std::string& file, Topology& topology,
                    std::vector<Sewn>& sewings) {
  const Sewn result = sewn(open.shape);
  if (result.shape.IsNull() || result.open > 0) return open.shape;
  TopoDS_Shape solid;
  try {
    solid = solid_of(shells_of(result.shape));
  } catch (const Standard_Failure&) {
    return open.shape;
  }
  sewings.push_back(result);
  topology.notes.push_back(fmt::format("{}: {} was open; its faces were sewn with a tolerance of {:.3g}",
                                       file, topology.name(open.shape), result.gap));
  return solid;
}

void tell_open_solids(const std::string& file, Topology& topology) {
  for (const Topology::Solid& solid : topology.solids) {
    if (!solid.open) continue;
    const std::string sentence =
        fmt::format("Solid{} is open: {}; close it, for instance by sewing its faces.", solid.number,
                    open_edges_text(topology, solid.shape));
    topology.open_text += (topology.open_text.empty() ? "" : " ") + sentence;
    topology.notes.push_back(fmt::format("{}: {}", file, sentence));
  }
}

PartsOf parts_after(const std::vector<Sewn>& sewings) {
  return [&sewings](const TopoDS_Shape& old) {
    TopTools_ListOfShape parts;
    for (const Sewn& sewn : sewings)
      if (sewn.sewing->IsModifiedSubShape(old)) parts.Append(sewn.sewing->ModifiedSubShape(old));
    if (parts.IsEmpty()) parts.Append(old);
    return parts;
  };
}

}  // namespace

void sew_faces(const std::string& file, Topology& topology) {
  const Sewn result = sewn(topology.all);
  if (result.shape.IsNull()) return keep_open(result, file, topology);
  const std::vector<Sewn> sewings{result};
  carry_numbers(topology.all, result.shape, parts_after(sewings), topology);
  const std::size_t left_out = make_solids(shells_of(result.shape), topology);
  const auto closed = std::count_if(topology.solids.begin(), topology.solids.end(),
                                    [](const Topology::Solid& solid) { return !solid.open; });
  if (closed == 0) {
    topology.solids.clear();
    return keep_open(result, file, topology);
  }
  std::vector<TopoDS_Shape> kept;
  for (const Topology::Solid& solid : topology.solids) kept.push_back(solid.shape);
  topology.all = compound_of(kept);
  topology.notes.push_back(fmt::format("{}: its faces were sewn into {} solid{}, with a tolerance of {:.3g}",
                                       file, closed, closed == 1 ? "" : "s", result.gap));
  if (left_out > 0)
    topology.notes.push_back(
        fmt::format("{}: {} of its faces enclose nothing and are left out", file, left_out));
  tell_open_solids(file, topology);
}

void close_solids(const std::string& file, Topology& topology) {
  std::vector<Sewn> sewings;
  std::vector<TopoDS_Shape> after;
  for (Topology::Solid& solid : topology.solids) {
    if (!open_edges(solid.shape).empty()) solid.shape = closed(solid, file, topology, sewings);
    solid.open = !open_edges(solid.shape).empty();
    after.push_back(solid.shape);
  }
  if (!sewings.empty()) {
    for (TopExp_Explorer face(topology.all, TopAbs_FACE, TopAbs_SOLID); face.More(); face.Next())
      after.push_back(face.Current());
    const TopoDS_Compound all = compound_of(after);
    carry_numbers(topology.all, all, parts_after(sewings), topology);
    topology.all = all;
    for (const Topology::Solid& solid : topology.solids) {
      topology.numbers.UnBind(solid.shape);
      topology.numbers.Bind(solid.shape, solid.number);
    }
  }
  for (Topology::Solid& solid : topology.solids) solid.faces = boundary_of(solid.shape);
  tell_open_solids(file, topology);
}

}  // namespace collarmesh::brep
