#include "cad_meshing.h"

#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <Geom_Surface.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <map>
#include <set>

#include "collarmesh/pipeline.h"
#include "files/complex_input.h"
#include "support/sanitized.h"
#include "support/temporary_file.h"

namespace collarmesh::testing {

namespace {

bool ends_with_brep(const std::string& path) { return path.ends_with(".brep"); }

// Returns the distance to a face. OpenCASCADE sometimes misses the nearest point of a spline surface, or of a
// cylinder that the face goes around more than once, and returns a point of the border; so a point of the
// surface inside the border counts, too.
double distance_to_face(const gp_Pnt& p, const TopoDS_Face& face) {
  const BRepExtrema_DistShapeShape extrema(TopoDS_Vertex(BRepBuilderAPI_MakeVertex(p)), face);
  const double found = extrema.IsDone() ? extrema.Value() : INFINITY;
  if (found == 0) return 0;
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  const gp_Pnt2d near = ShapeAnalysis_Surface(surface).ValueOfUV(p, Precision::Confusion());
  constexpr double window = 1e-3;
  const GeomAPI_ProjectPointOnSurf projection(p, surface, near.X() - window, near.X() + window,
                                              near.Y() - window, near.Y() + window, 1e-12);
  if (projection.NbPoints() == 0) return found;
  double u = 0, v = 0;
  projection.LowerDistanceParameters(u, v);
  const double period = surface->IsUPeriodic() ? surface->UPeriod() : 0;
  for (const double turned : {u, u + period, u - period}) {
    const BRepClass_FaceClassifier place(face, gp_Pnt2d(turned, v), Precision::PConfusion());
    if (place.State() != TopAbs_OUT) return std::min(found, projection.LowerDistance());
  }
  return found;
}

}  // namespace

CadMeshed mesh_of_cad_file(const std::string& path, double relative_size, int order) {
  constexpr double relative_distance = sanitized ? 1.5e-3 : 1e-3;
  files::InputReading reading;
  reading.distance = [](double diagonal) { return relative_distance * diagonal; };
  files::ComplexInput input({path}, reading);
  CadMeshed meshed;
  meshed.plc = input.build({});
  PipelineOptions options;
  options.mesh.size = relative_size * meshed.plc.bounds.diagonal();
  options.mesh.bounds.distance = relative_distance * meshed.plc.bounds.diagonal();
  options.mesh.time_limit = 0;  // no limit, because sanitizers are slow
  options.coarsen = false;
  options.order = static_cast<unsigned>(order);
  options.exact = input.exact_geometry(meshed.plc);
  PipelineResult run = run_pipeline(meshed.plc, options);
  meshed.result = std::move(run.result);
  meshed.projection = run.projection.value_or(ProjectReport());
  meshed.second_order = std::move(run.second_order);
  meshed.report = std::move(run.check);
  return meshed;
}

CadMeshed mesh_of_shape(const TopoDS_Shape& shape, double relative_size, int order) {
  const TemporaryFolder folder;
  const std::string path = folder.file("shape.brep");
  BRepTools::Write(shape, path.c_str());
  return mesh_of_cad_file(path, relative_size, order);
}

TopoDS_Shape shape_in(const std::string& path) {
  if (ends_with_brep(path)) {
    TopoDS_Shape shape;
    BRepTools::Read(shape, path.c_str(), BRep_Builder());
    return shape;
  }
  STEPControl_Reader reader;
  reader.ReadFile(path.c_str());
  reader.TransferRoots();
  return reader.OneShape();
}

double farthest_from_faces(const CadMeshed& meshed, const TopoDS_Shape& shape, std::size_t samples) {
  const TetMesh& mesh = meshed.result.mesh;
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  std::set<Index> left_out;
  for (const auto& exception : meshed.projection.exceptions) left_out.insert(exception.point);
  for (const auto& node : meshed.second_order.straightened) left_out.insert(node.point);
  std::map<Index, Tag> face_of;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (const Index p : mesh.faces[f]) face_of.emplace(p, mesh.face_tag[f]);
    for (std::size_t k = 0; mesh.order() == 2 && k < 3; ++k)
      if (left_out.count(mesh.faces[f][k]) == 0 && left_out.count(mesh.faces[f][(k + 1) % 3]) == 0)
        face_of.emplace(mesh.face_mid_nodes[f][k], mesh.face_tag[f]);
  }
  const std::size_t step = std::max<std::size_t>(1, face_of.size() / samples);
  double farthest = 0;
  std::size_t i = 0;
  for (const auto& [p, face] : face_of) {
    if (i++ % step != 0 || left_out.count(p) > 0) continue;
    if (face < 1 || face > faces.Extent()) return INFINITY;
    const Point& at = mesh.points[p];
    farthest = std::max(
        farthest, distance_to_face(gp_Pnt(at.x, at.y, at.z), TopoDS::Face(faces(static_cast<int>(face)))));
  }
  return farthest;
}

std::string faults(const CadMeshed& meshed) {
  if (meshed.result.status != MeshStatus::complete) return "not complete: " + meshed.result.message;
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, meshed.report.findings.size()); ++i)
    text += meshed.report.findings[i].guarantee + ": " + meshed.report.findings[i].message + "\n";
  return text;
}

}  // namespace collarmesh::testing
