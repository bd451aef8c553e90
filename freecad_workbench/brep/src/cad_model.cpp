#include "collarmesh/brep/cad_model.h"

#include <fmt/format.h>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <Bnd_Box.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <utility>
#include <vector>

#include "measures.h"
#include "parts.h"

namespace collarmesh::brep {

namespace {

/// Runs OpenCASCADE on a shape, and turns its exceptions into errors about the shape.
template <class Work>
auto on_shape(const std::string& name, const char* doing, const Work& work) {
  try {
    return work();
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    fail(PlcFault::Kind::intersection,
         fmt::format(
             "{}: OpenCASCADE failed while {} ({}); the shape is probably invalid, check and repair it.",
             name, doing, text(failure)));
  }
}

std::array<gp_Pnt, 2> corners_of(const Bnd_Box& box) { return {box.CornerMin(), box.CornerMax()}; }

bool contains(const Bnd_Box& outer, const Bnd_Box& inner) {
  if (outer.IsVoid() || inner.IsVoid()) return inner.IsVoid();
  const auto [low, high] = corners_of(outer);
  const auto [inner_low, inner_high] = corners_of(inner);
  for (int axis = 1; axis <= 3; ++axis)
    if (inner_low.Coord(axis) < low.Coord(axis) || inner_high.Coord(axis) > high.Coord(axis)) return false;
  return true;
}

/// A face and its rough box. OpenCASCADE takes long to find the exact box of a spline.
struct BoxedFace {
  TopoDS_Shape face;
  Bnd_Box rough;
  bool has_slow_box = false;
  bool is_inside_rough = false;  // false for surfaces that OpenCASCADE only samples for the rough box
};

std::vector<BoxedFace> boxed_faces(const TopoDS_Shape& shape) {
  constexpr double margin = 1e-4;  // relative; exact boxes are a little larger than some rough ones
  std::vector<BoxedFace> faces;
  for (const TopoDS_Shape& face : subshapes(shape, TopAbs_FACE)) {
    Bnd_Box rough;
    BRepBndLib::Add(face, rough, /*useTriangulation=*/false);
    if (!rough.IsVoid()) rough.Enlarge(margin * std::sqrt(rough.SquareExtent()));
    const GeomAbs_SurfaceType type = BRepAdaptor_Surface(TopoDS::Face(face), false).GetType();
    const bool is_quadric = type == GeomAbs_Plane || type == GeomAbs_Cylinder || type == GeomAbs_Cone ||
                            type == GeomAbs_Sphere || type == GeomAbs_Torus;
    faces.push_back({face, rough, !is_quadric, is_quadric || type == GeomAbs_BSplineSurface});
  }
  return faces;
}

/// Returns the diagonal of the smallest box around a shape. Begins with faces whose exact boxes are fast to
/// compute, and among the others with large ones: a face whose rough box lies inside the box so far needs no
/// exact one.
double diagonal_of(const TopoDS_Shape& shape) {
  const auto add = [](const TopoDS_Shape& part, Bnd_Box& box) {
    BRepBndLib::AddOptimal(part, box, /*useTriangulation=*/false, /*useShapeTolerance=*/false);
  };
  std::vector<BoxedFace> faces = boxed_faces(shape);
  std::ranges::stable_sort(faces, {}, [](const BoxedFace& face) {
    return std::pair(face.has_slow_box, face.rough.IsVoid() ? 0 : -face.rough.SquareExtent());
  });
  Bnd_Box box;
  box.SetGap(0);
  for (const BoxedFace& face : faces)
    if (!face.is_inside_rough || !contains(box, face.rough)) add(face.face, box);
  for (TopExp_Explorer edge(shape, TopAbs_EDGE, TopAbs_FACE); edge.More(); edge.Next())
    add(edge.Current(), box);
  for (TopExp_Explorer vertex(shape, TopAbs_VERTEX, TopAbs_EDGE); vertex.More(); vertex.Next())
    add(vertex.Current(), box);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

/// Returns for each face the distance from a place to the nearest point of its tessellation, with the face's
/// number; nearest first.
std::vector<std::pair<double, int>> faces_by_distance(const Tessellation& tessellation, const Point& where) {
  std::vector<std::pair<double, int>> faces;
  for (const auto& [number, pieces] : tessellation.faces) {
    double least = std::numeric_limits<double>::infinity();
    for (const Samples& piece : pieces)
      for (const Point& p : piece.points) least = std::min(least, distance(p, where));
    faces.emplace_back(least, number);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

}  // namespace

CadModel::CadModel(const TopoDS_Shape& shape, std::string name, const CadOptions& options, CadLabels labels)
    : parts_(std::make_unique<Parts>()) {
  parts_->name = std::move(name);
  parts_->labels = std::move(labels);
  on_shape(parts_->name, "finding solids", [&] {
    // Use a copy, so that triangles of the caller's shape stay as they are.
    const TopoDS_Shape copy =
        shape.IsNull() ? shape : BRepBuilderAPI_Copy(shape, /*copyGeom=*/false, /*copyMesh=*/false).Shape();
    parts_->topology = find_topology(copy, parts_->name, options);
    parts_->diagonal = diagonal_of(parts_->topology.all);
  });
}

CadModel::~CadModel() = default;
CadModel::CadModel(CadModel&&) noexcept = default;
CadModel& CadModel::operator=(CadModel&&) noexcept = default;

const std::string& CadModel::name() const { return parts_->name; }
const CadLabels& CadModel::labels() const { return parts_->labels; }
double CadModel::diagonal() const { return parts_->diagonal; }
bool CadModel::fused() const { return parts_->topology.fused; }
const std::vector<std::pair<Tag, Tag>>& CadModel::replaced_faces() const {
  return parts_->topology.replaced_faces;
}
const std::string& CadModel::open_edges_text() const { return parts_->topology.open_text; }
std::vector<std::string> CadModel::notes() const {
  std::vector<std::string> notes = parts_->topology.notes;
  notes.insert(notes.end(), parts_->tessellation.notes.begin(), parts_->tessellation.notes.end());
  return notes;
}

std::vector<PolygonSoup> CadModel::tessellate(const TessellationOptions& options) {
  constexpr double relative_deflection = 1e-4;
  parts_->deflection = options.deflection > 0 ? options.deflection : relative_deflection * parts_->diagonal;
  return on_shape(parts_->name, "cutting faces into triangles", [&] {
    TessellationOptions absolute = options;
    absolute.deflection = parts_->deflection;
    parts_->tessellation = brep::tessellate(parts_->topology, parts_->name, absolute);
    parts_->exact = std::make_unique<NearestOnShape>(parts_->tessellation);
    return parts_->tessellation.soups;
  });
}

std::optional<Point> CadModel::nearest(unsigned dimension, Tag number, const Point& p) const {
  try {
    if (dimension == 1) return parts_->exact->on_edge(static_cast<int>(number), p);
    if (dimension == 2) return parts_->exact->on_face(static_cast<int>(number), p);
  } catch (const Standard_Failure&) {
    return std::nullopt;
  }
  return std::nullopt;
}

std::string CadModel::faces_near(const Point& where) const {
  const auto nearest = faces_by_distance(parts_->tessellation, where);
  if (nearest.empty()) return "no face";
  std::string names = fmt::format("Face{}", nearest[0].second);
  if (nearest.size() > 1) names += fmt::format(" and Face{}", nearest[1].second);
  return names;
}

double CadModel::distance_to(const Point& where) const {
  const auto nearest = faces_by_distance(parts_->tessellation, where);
  return nearest.empty() ? std::numeric_limits<double>::infinity() : nearest[0].first;
}

CadMeasures CadModel::measures() const {
  return on_shape(parts_->name, "integrating over faces", [&] {
    if (!parts_->integrals) parts_->integrals = std::make_unique<FaceIntegrals>(parts_->topology.all);
    return measure(parts_->topology, *parts_->integrals, parts_->tessellation, parts_->deflection);
  });
}

std::string CadModel::invalid_parts() const {
  const TopoDS_Shape& shape = parts_->topology.all;
  std::vector<std::string> invalid;
  try {
    const BRepCheck_Analyzer analyzer(shape);
    for (const TopAbs_ShapeEnum kind :
         {TopAbs_VERTEX, TopAbs_EDGE, TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID}) {
      for (const TopoDS_Shape& part : subshapes(shape, kind))
        if (!analyzer.IsValid(part))
          invalid.push_back(fmt::format("{} at {}", parts_->topology.name(part), text(place_of(part))));
      if (!invalid.empty()) break;  // shapes that contain invalid ones are invalid, too
    }
  } catch (const Standard_Failure&) {
    return {};
  }
  constexpr std::size_t listed = 5;
  const std::size_t count = invalid.size();
  invalid.resize(std::min(listed, count));
  return fmt::format("{}{}", fmt::join(invalid, ", "), count > listed ? ", ..." : "");
}

}  // namespace collarmesh::brep
