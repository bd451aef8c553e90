// Finds the edges and vertices that belong to no face and lie inside a solid.
#include "free_parts.h"

#include "free_parts_fuse.h"

#include <fmt/format.h>
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepIntCurveSurface_Inter.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace collarmesh::brep {

namespace {

double tolerance_of(const TopoDS_Shape& part) {
  double largest = Precision::Confusion();
  if (is_edge(part)) largest = std::max(largest, BRep_Tool::Tolerance(TopoDS::Edge(part)));
  for (const TopoDS_Shape& vertex : subshapes(part, TopAbs_VERTEX))
    largest = std::max(largest, BRep_Tool::Tolerance(TopoDS::Vertex(vertex)));
  return largest;
}

/// Returns whether a part has a place: some edges have no curve in space, or not two ends.
bool has_place(const TopoDS_Shape& part) {
  if (!is_edge(part)) return true;
  const TopoDS_Edge& edge = TopoDS::Edge(part);
  double first = 0, last = 0;
  const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
  return !curve.IsNull() && !BRep_Tool::Degenerated(edge) && !Precision::IsInfinite(first) &&
         !Precision::IsInfinite(last) && !TopExp::FirstVertex(edge).IsNull() &&
         !TopExp::LastVertex(edge).IsNull();
}

Bnd_Box box_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  return box;
}

/// Returns places along a part, its ends included.
std::vector<gp_Pnt> samples_of(const TopoDS_Shape& part) {
  if (!is_edge(part)) return {BRep_Tool::Pnt(TopoDS::Vertex(part))};
  constexpr int pieces = 8;
  const BRepAdaptor_Curve curve(TopoDS::Edge(part));
  std::vector<gp_Pnt> samples;
  for (int i = 0; i <= pieces; ++i)
    samples.push_back(
        curve.Value(curve.FirstParameter() + i * (curve.LastParameter() - curve.FirstParameter()) / pieces));
  return samples;
}

TopoDS_Shape middle_of(const TopoDS_Shape& edge) {
  const std::vector<gp_Pnt> samples = samples_of(edge);
  return BRepBuilderAPI_MakeVertex(samples[samples.size() / 2]).Shape();
}

bool runs_along(const TopoDS_Shape& edge, const TopoDS_Shape& other, double tolerance) {
  return distance_between(middle_of(edge), other) <= tolerance;
}

/// Returns whether two parts meet elsewhere than end to end, or run along each other. Also true if
/// OpenCASCADE fails.
bool meet_amid(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  const double tolerance = std::max(tolerance_of(a), tolerance_of(b));
  const BRepExtrema_DistShapeShape nearest(a, b);
  if (!nearest.IsDone()) return true;
  if (nearest.Value() > tolerance) return false;
  for (int i = 1; i <= nearest.NbSolution(); ++i)
    if (nearest.SupportTypeShape1(i) != BRepExtrema_IsVertex ||
        nearest.SupportTypeShape2(i) != BRepExtrema_IsVertex)
      return true;
  return is_edge(a) && is_edge(b) && (runs_along(a, b, tolerance) || runs_along(b, a, tolerance));
}

/// The faces of a shape, with their edges and vertices.
class Faces {
 public:
  explicit Faces(const TopoDS_Shape& all) : faces_(subshapes(all, TopAbs_FACE)) {
    for (const TopoDS_Shape& face : faces_) {
      TopExp::MapShapes(face, held_);
      boxes_.push_back(box_of(face));
    }
  }

  bool hold(const TopoDS_Shape& part) const { return held_.Contains(part); }

  /// Returns the distance of a part to the faces that it does not end on; infinite if there are none.
  double distance_to(const TopoDS_Shape& part) const {
    std::vector<TopoDS_Shape> ends = subshapes(part, TopAbs_VERTEX);
    std::erase_if(ends, [&](const TopoDS_Shape& end) { return !hold(end); });
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [to_box, f] : by_distance_of_boxes(part)) {
      if (to_box >= least) break;
      if (!has_one_of(ends, faces_[f])) least = std::min(least, distance_between(part, faces_[f]));
    }
    return least;
  }

  /// Returns the distance of an edge's middle, or of a vertex, from the faces that are not planar; infinite
  /// if there are none. An edge with both ends on a curved face may lie between the face and its triangles.
  double distance_to_curved(const TopoDS_Shape& part) const {
    const TopoDS_Shape middle = is_edge(part) ? middle_of(part) : part;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [to_box, f] : by_distance_of_boxes(middle)) {
      if (to_box >= least) break;
      if (BRepAdaptor_Surface(TopoDS::Face(faces_[f]), false).GetType() != GeomAbs_Plane)
        least = std::min(least, distance_between(middle, faces_[f]));
    }
    return least;
  }

  /// Returns places along an edge: one in each piece between the points at which the edge meets faces.
  std::vector<gp_Pnt> places_between(const TopoDS_Edge& edge) const {
    double first = 0, last = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
    const GeomAdaptor_Curve part(curve, first, last);
    const Bnd_Box box = box_of(edge);
    std::vector<double> at{first, last};
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (boxes_[f].IsOut(box)) continue;
      BRepIntCurveSurface_Inter meeting;
      for (meeting.Init(faces_[f], part, Precision::Confusion()); meeting.More(); meeting.Next())
        at.push_back(std::clamp(meeting.W(), first, last));
    }
    std::sort(at.begin(), at.end());
    std::vector<gp_Pnt> places;
    for (std::size_t i = 1; i < at.size(); ++i) places.push_back(curve->Value(0.5 * (at[i - 1] + at[i])));
    return places;
  }

 private:
  /// Returns the distances of the faces' boxes from the box of a part, with the faces; nearest first.
  std::vector<std::pair<double, std::size_t>> by_distance_of_boxes(const TopoDS_Shape& part) const {
    const Bnd_Box box = box_of(part);
    std::vector<std::pair<double, std::size_t>> faces;
    for (std::size_t f = 0; f < faces_.size(); ++f)
      if (!boxes_[f].IsVoid()) faces.emplace_back(boxes_[f].Distance(box), f);
    std::sort(faces.begin(), faces.end());
    return faces;
  }

  static bool has_one_of(const std::vector<TopoDS_Shape>& vertices, const TopoDS_Shape& face) {
    if (vertices.empty()) return false;
    TopTools_IndexedMapOfShape own;
    TopExp::MapShapes(face, TopAbs_VERTEX, own);
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](const TopoDS_Shape& vertex) { return own.Contains(vertex); });
  }

  std::vector<TopoDS_Shape> faces_;
  std::vector<Bnd_Box> boxes_;
  TopTools_IndexedMapOfShape held_;
};

/// The closed solids of a topology.
class Solids {
 public:
  explicit Solids(const Topology& topology) {
    for (const Topology::Solid& region : topology.solids)
      for (const TopoDS_Shape& solid : subshapes(region.shape, TopAbs_SOLID)) {
        if (region.open) continue;
        boxes_.push_back(box_of(solid));
        solids_.push_back(std::make_unique<BRepClass3d_SolidClassifier>(solid));
      }
  }

  /// Returns whether at least a piece of a part lies inside a solid and not just on its faces.
  bool hold_some_of(const TopoDS_Shape& part, const Faces& faces) const {
    return hold_some_of(samples_of(part)) ||
           (is_edge(part) &&
            hold_some_of(faces.places_between(TopoDS::Edge(part))));  // the samples may miss a thin solid
  }

 private:
  bool hold_some_of(const std::vector<gp_Pnt>& places) const {
    return std::any_of(places.begin(), places.end(), [&](const gp_Pnt& p) { return hold(p); });
  }
  bool hold(const gp_Pnt& p) const {
    for (std::size_t s = 0; s < solids_.size(); ++s) {
      if (boxes_[s].IsOut(p)) continue;
      solids_[s]->Perform(p, Precision::Confusion());
      if (solids_[s]->State() == TopAbs_IN) return true;
    }
    return false;
  }

  std::vector<std::unique_ptr<BRepClass3d_SolidClassifier>> solids_;
  std::vector<Bnd_Box> boxes_;
};

/// A sorter of the parts that belong to no face, by their position: inside solids, outside or on faces.
class Sorter {
 public:
  Sorter(const std::string& file, Topology& topology)
      : file_(file), topology_(topology), solids_(topology), faces_(topology.all) {}

  void add(const TopoDS_Shape& part, int number) {
    Candidate candidate{part, number, name_of(part, number)};
    try {
      if (!has_place(part) || !solids_.hold_some_of(part, faces_)) {
        left_out_.push_back(part);
        outside_.push_back(candidate.name);
        return;
      }
      const double distance = faces_.distance_to(part);
      candidate.meets = distance <= tolerance_of(part) || meets_another(part);
      candidate.clearance = std::min(distance, faces_.distance_to_curved(part));
    } catch (const Standard_Failure&) {
      candidate.meets = true;
    }
    inside_.push_back(std::move(candidate));
  }

  void finish() {
    const bool any_meets =
        std::any_of(inside_.begin(), inside_.end(), [](const Candidate& part) { return part.meets; });
    if (!any_meets || !cut()) keep_whole_ones();
    tell();
  }

 private:
  struct Candidate {
    TopoDS_Shape shape;
    int number = 0;
    std::string name;
    double clearance = 0;
    bool meets = false;  // whether it meets a face, or an earlier part
  };

  static std::string name_of(const TopoDS_Shape& part, int number) {
    return fmt::format("{}{} at {}", is_edge(part) ? "Edge" : "Vertex", number,
                       has_place(part) ? text(place_of(part)) : "an unknown place");
  }

  bool meets_another(const TopoDS_Shape& part) const {
    const Bnd_Box box = box_of(part);
    return std::any_of(inside_.begin(), inside_.end(), [&](const Candidate& other) {
      return !box_of(other.shape).IsOut(box) && meet_amid(part, other.shape);
    });
  }

  /// Cuts parts where they meet faces or one another. Returns false, without changes, if that fails.
  bool cut() {
    std::vector<TopoDS_Shape> parts;
    parts.reserve(inside_.size());
    for (const Candidate& part : inside_) parts.push_back(part.shape);
    std::optional<PartsOf> pieces_of;
    try {
      pieces_of = fuse_free_parts(parts, left_out_, topology_);
    } catch (const Standard_Failure&) {
      return false;
    }
    if (!pieces_of) return false;
    const Faces faces(topology_.all);
    for (const Candidate& part : inside_) keep_pieces(part, (*pieces_of)(part.shape), faces);
    return true;
  }

  void keep_pieces(const Candidate& part, const TopTools_ListOfShape& pieces, const Faces& faces) {
    bool any_inside = false, all_inside = true, all_cut = !pieces.IsEmpty();
    for (const TopoDS_Shape& piece : pieces) {
      bool inside = true;
      if (faces.hold(piece))
        note_number(part, piece);
      else if (!keep_piece(part, piece, faces, inside))
        all_cut = false;
      any_inside = any_inside || inside;
      all_inside = all_inside && inside;
    }
    if (!any_inside && all_cut)
      outside_.push_back(part.name);
    else if (!all_inside)
      partly_.push_back(part.name);
    if (!all_cut) meeting_.push_back(part.name);
  }

  /// Keeps a piece if it lies inside a solid, and sets `inside`. Returns false if the piece lies inside but
  /// still meets a face, or if OpenCASCADE fails.
  bool keep_piece(const Candidate& part, const TopoDS_Shape& piece, const Faces& faces, bool& inside) {
    try {
      inside = solids_.hold_some_of(piece, faces);
      if (!inside) return true;
      const double distance = faces.distance_to(piece);
      if (distance <= tolerance_of(piece)) return false;
      const double clearance = std::min(distance, faces.distance_to_curved(piece));
      if (kept_.Add(piece))
        topology_.free_parts.push_back({piece, part.number, clearance});
      else
        note_number(part, piece);
      return true;
    } catch (const Standard_Failure&) {
      return false;
    }
  }

  /// Records for a note that a piece has another number than its part. This is so if parts or faces share the
  /// piece.
  void note_number(const Candidate& part, const TopoDS_Shape& piece) {
    const int number = topology_.number(piece);
    if (number == part.number) return;
    std::string text = fmt::format("{} lies on {}{}", part.name, is_edge(piece) ? "Edge" : "Vertex", number);
    if (std::find(renumbered_.begin(), renumbered_.end(), text) == renumbered_.end())
      renumbered_.push_back(std::move(text));
  }

  void keep_whole_ones() {
    for (const Candidate& part : inside_)
      if (part.meets)
        meeting_.push_back(part.name);
      else
        topology_.free_parts.push_back({part.shape, part.number, part.clearance});
  }

  void tell() const {
    tell(
        outside_, "left out, because only edges and vertices of faces or inside closed solids are meshed",
        "to get nodes on lines and points, give them as segments and points of a .poly file beside this one");
    tell(partly_, "partly outside of the closed solids, and left out there", "end edges at the faces");
    tell(meeting_,
         "left out, because OpenCASCADE's general fuse made no cut at a face or at the middle of another "
         "edge inside a solid",
         "end edges before they reach a face, and cut an edge where another edge meets it");
    if (!renumbered_.empty())
      topology_.notes.push_back(fmt::format(
          "{}: {} and gets the number of the latter there{}", file_, renumbered_.front(),
          renumbered_.size() > 1 ? fmt::format("; so do {} more", renumbered_.size() - 1) : std::string()));
  }
  void tell(const std::vector<std::string>& names, const char* what, const char* advice) const {
    if (names.empty()) return;
    topology_.notes.push_back(fmt::format(
        "{}: {}{} {}; {}", file_, names.front(),
        names.size() > 1 ? fmt::format(" and {} more are", names.size() - 1) : " is", what, advice));
  }

  const std::string& file_;
  Topology& topology_;
  Solids solids_;
  Faces faces_;
  std::vector<Candidate> inside_;
  std::vector<TopoDS_Shape> left_out_;
  TopTools_MapOfShape kept_;
  std::vector<std::string> outside_, partly_, meeting_, renumbered_;
};

}  // namespace

double distance_between(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  try {
    const BRepExtrema_DistShapeShape nearest(a, b);
    return nearest.IsDone() && nearest.NbSolution() > 0 ? nearest.Value() : 0;
  } catch (const Standard_Failure&) {
    return 0;
  }
}

std::vector<TopoDS_Shape> parts_of_no_face(const TopoDS_Shape& shape) {
  TopTools_IndexedMapOfShape held;
  for (const TopoDS_Shape& face : subshapes(shape, TopAbs_FACE)) TopExp::MapShapes(face, held);
  std::vector<TopoDS_Shape> parts;
  for (const TopAbs_ShapeEnum kind : {TopAbs_EDGE, TopAbs_VERTEX})
    for (const TopoDS_Shape& part : subshapes(shape, kind)) {
      if (held.Contains(part)) continue;
      parts.push_back(part);
      TopExp::MapShapes(part, held);
    }
  return parts;
}

void keep_free_parts_inside(const std::vector<TopoDS_Shape>& parts, const std::string& file,
                            Topology& topology) {
  if (parts.empty()) return;
  Sorter sorter(file, topology);
  for (const TopoDS_Shape& part : parts) sorter.add(part, topology.number(part));
  sorter.finish();
}

}  // namespace collarmesh::brep
