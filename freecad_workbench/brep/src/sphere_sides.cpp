#include "sphere_sides.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Interface_InterfaceModel.hxx>
#include <ShapeFix_Face.hxx>
#include <StepShape_FaceSurface.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Wire.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <gp_Sphere.hxx>

#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "topology.h"

namespace collarmesh::brep {

namespace {

/// By face: whether its orientation in the file is that of its surface.
using Senses = std::map<const TopoDS_TShape*, bool>;

Senses senses_of(const STEPControl_Reader& reader) {
  Senses senses;
  const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto face = Handle(StepShape_FaceSurface)::DownCast(model->Value(i));
    if (face.IsNull()) continue;
    const TopoDS_Shape made = TransferBRep::ShapeResult(process, face);
    if (!made.IsNull() && made.ShapeType() == TopAbs_FACE) senses[made.TShape().get()] = face->SameSense();
  }
  return senses;
}

std::vector<TopoDS_Face> faces_in_shell(const TopoDS_Shape& shell) {
  std::vector<TopoDS_Face> faces;
  for (TopoDS_Iterator face(shell, /*cumOri=*/false, /*cumLoc=*/false); face.More(); face.Next())
    if (face.Value().ShapeType() == TopAbs_FACE) faces.push_back(TopoDS::Face(face.Value()));
  return faces;
}

/// Returns the direction in which a face uses an edge; nothing if it uses the edge twice or not at all.
std::optional<TopAbs_Orientation> direction_of(const TopoDS_Edge& edge, const TopoDS_Face& face) {
  std::optional<TopAbs_Orientation> direction;
  for (TopExp_Explorer side(face, TopAbs_EDGE); side.More(); side.Next()) {
    if (!side.Current().IsSame(edge)) continue;
    if (direction) return std::nullopt;
    direction = side.Current().Orientation();
  }
  return direction;
}

bool is_sphere_between_poles(const TopoDS_Face& face) {
  int poles = 0;
  for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
    if (BRep_Tool::Degenerated(TopoDS::Edge(edge.Current()))) ++poles;
  return poles == 2 && BRepAdaptor_Surface(face, false).GetType() == GeomAbs_Sphere;
}

/// Returns the sphere of a face, turned about its axis so that its seam is midway between the longitudes
/// `from` and `to` (radians), which bound the face.
Handle(Geom_SphericalSurface) with_seam_amid(const TopoDS_Face& face, double from, double to) {
  gp_Sphere sphere = BRepAdaptor_Surface(face, false).Sphere();
  sphere.Rotate(gp_Ax1(sphere.Location(), sphere.Position().Direction()), 0.5 * (from + to));
  return new Geom_SphericalSurface(sphere);
}

/// Returns the face on the other side of the given face's outline. It uses the edges in the same directions.
/// Returns a null face if it cannot be made.
TopoDS_Face other_side(const TopoDS_Face& face) {
  constexpr double slack = 1e-6;  // radians by which both sides together may miss a full turn
  double from = 0, to = 0, low = 0, high = 0;
  BRepTools::UVBounds(face, from, to, low, high);
  BRep_Builder builder;
  TopoDS_Face other;
  builder.MakeFace(other, with_seam_amid(face, from, to), BRep_Tool::Tolerance(face));
  TopoDS_Wire wire;
  builder.MakeWire(wire);
  TopoDS_Edge first;
  for (TopExp_Explorer edge(face.Oriented(TopAbs_FORWARD), TopAbs_EDGE); edge.More(); edge.Next()) {
    if (BRep_Tool::Degenerated(TopoDS::Edge(edge.Current()))) continue;
    if (first.IsNull()) first = TopoDS::Edge(edge.Current());
    builder.Add(wire, edge.Current());
  }
  if (first.IsNull()) return {};
  builder.Add(other, wire.Reversed());  // the face is on the left of its outline
  ShapeFix_Face fix(other);
  fix.Perform();
  other = fix.Face();
  if (other.IsNull()) return {};
  double other_from = 0, other_to = 0;
  BRepTools::UVBounds(other, other_from, other_to, low, high);
  if (to - from + other_to - other_from < 2 * std::numbers::pi - slack) return {};
  const auto before = direction_of(first, TopoDS::Face(face.Oriented(TopAbs_FORWARD)));
  other.Orientation(TopAbs_FORWARD);
  const auto now = direction_of(first, other);
  if (!before || !now) return {};
  if (*before != *now) other.Orientation(TopAbs_REVERSED);
  return other;
}

/// Gives a face the surface and the outline of another one. Reverses the face if the other one is reversed.
void take_over(TopoDS_Face& face, const TopoDS_Face& by) {
  BRep_Builder builder;
  TopoDS_Face forward = TopoDS::Face(face.Oriented(TopAbs_FORWARD));
  forward.Location(TopLoc_Location());
  std::vector<TopoDS_Shape> wires;
  for (TopoDS_Iterator wire(forward, false, false); wire.More(); wire.Next()) wires.push_back(wire.Value());
  const bool free = forward.Free();
  forward.Free(true);
  for (const TopoDS_Shape& wire : wires) builder.Remove(forward, wire);
  builder.UpdateFace(forward, BRep_Tool::Surface(by), TopLoc_Location(), BRep_Tool::Tolerance(by));
  for (TopoDS_Iterator wire(by.Oriented(TopAbs_FORWARD)); wire.More(); wire.Next())
    builder.Add(forward, wire.Value());
  forward.Free(free);
  if (by.Orientation() == TopAbs_REVERSED) face.Reverse();
}

/// Replaces a shell's faces `before` by `faces`, in this order and with these orientations.
void refill(const TopoDS_Shape& shell, const std::vector<TopoDS_Face>& before,
            const std::vector<TopoDS_Face>& faces) {
  BRep_Builder builder;
  TopoDS_Shape bare = shell.Oriented(TopAbs_FORWARD);
  bare.Location(TopLoc_Location());
  const bool free = bare.Free(), closed = bare.Closed();
  bare.Free(true);
  for (const TopoDS_Face& face : before) builder.Remove(bare, face);
  for (const TopoDS_Face& face : faces) builder.Add(bare, face);
  bare.Free(free);
  bare.Closed(closed);
}

/// Returns the indices of spherical faces with both poles whose orientation, unlike that of most faces of the
/// shell, is the opposite of the file's.
std::vector<std::size_t> turned_spheres(const TopoDS_Shape& shell, const Senses& senses) {
  const std::vector<TopoDS_Face> faces = faces_in_shell(shell);
  std::vector<std::size_t> turned, kept;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto sense = senses.find(faces[f].TShape().get());
    if (sense == senses.end()) return {};
    const bool same = faces[f].Orientation() == TopAbs_FORWARD;
    (same == sense->second ? kept : turned).push_back(f);
  }
  if (turned.size() > kept.size()) std::swap(turned, kept);  // the shell may be reversed as a whole
  if (turned.size() == kept.size()) return {};
  std::erase_if(turned, [&](std::size_t f) { return !is_sphere_between_poles(faces[f]); });
  return turned;
}

}  // namespace

bool take_other_side(const TopoDS_Shape& shell, std::size_t index) {
  const std::vector<TopoDS_Face> before = faces_in_shell(shell);
  const TopoDS_Face& face = before[index];
  if (!face.Location().IsIdentity() || !is_sphere_between_poles(face)) return false;
  const TopoDS_Face other = other_side(face);
  if (other.IsNull() || other.Orientation() != TopAbs_REVERSED || !BRepCheck_Analyzer(other).IsValid())
    return false;
  std::vector<TopoDS_Face> after = before;
  take_over(after[index], other);
  refill(shell, before, after);
  return true;
}

void mend_sphere_sides(const STEPControl_Reader& reader, const TopoDS_Shape& shape) {
  const Senses senses = senses_of(reader);
  const auto shells = subshapes(shape, TopAbs_SHELL);
  std::map<const TopoDS_TShape*, int> uses;
  for (const TopoDS_Shape& shell : shells)
    for (const TopoDS_Face& face : faces_in_shell(shell)) ++uses[face.TShape().get()];
  for (const TopoDS_Shape& shell : shells)
    for (const std::size_t face : turned_spheres(shell, senses))
      // Skip faces that two shells share: they use the face in two orientations, and only one of them would
      // be mended.
      if (uses[faces_in_shell(shell)[face].TShape().get()] == 1) take_other_side(shell, face);
}

}  // namespace collarmesh::brep
