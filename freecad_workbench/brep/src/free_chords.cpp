// Converts the edges and vertices inside solids that belong to no face to chords and points.
#include "free_chords.h"

#include "free_parts.h"
#include "points.h"

#include <fmt/format.h>
#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <numbers>

namespace collarmesh::brep {

namespace {

class Cutter {
 public:
  Cutter(const Topology& topology, const std::string& file, const TessellationOptions& options,
         Tessellation& result)
      : topology_(topology), options_(options), result_(result) {
    soup_.name = fmt::format("{}, lines and points inside", file);
    soup_.given_features = true;
  }

  void add(const Topology::FreePart& part) {
    if (!is_edge(part.shape)) {
      soup_.point_tags[vertex(TopoDS::Vertex(part.shape))] = part.number;
      return;
    }
    const TopoDS_Edge edge = TopoDS::Edge(part.shape.Oriented(TopAbs_FORWARD));
    Samples samples = samples_of(edge);
    Index before = vertex(TopExp::FirstVertex(edge));
    double length = 0;
    for (std::size_t i = 1; i < samples.points.size(); ++i) {
      const bool last = i + 1 == samples.points.size();
      const Index next = last ? vertex(TopExp::LastVertex(edge)) : point(samples.points[i], 0);
      if (next != before) soup_.segments.push_back({before, next, part.number});
      length += distance(soup_.points[before], soup_.points[next]);
      before = next;
    }
    result_.lengths.Bind(part.shape, length);
    result_.edges[part.number].push_back(std::move(samples));
  }

  PolygonSoup finish() { return std::move(soup_); }

 private:
  Samples samples_of(const TopoDS_Edge& edge) const {
    const BRepAdaptor_Curve curve(edge);
    const int least = curve.GetType() == GeomAbs_Line ? 2 : 3;  // points, so that no curve counts as straight
    const GCPnts_TangentialDeflection cut(curve, options_.angle * std::numbers::pi / 180, options_.deflection,
                                          least);
    Samples samples;
    samples.shape = edge;
    for (int i = 1; i <= cut.NbPoints(); ++i) {
      samples.points.push_back(to_point(curve.Value(cut.Parameter(i))));
      samples.parameters.push_back({cut.Parameter(i), 0});
    }
    return samples;
  }

  Index point(const Point& p, Tag tag) {
    soup_.points.push_back(p);
    soup_.point_tags.push_back(tag);
    return static_cast<Index>(soup_.points.size() - 1);
  }

  /// Returns the point of a vertex. A vertex within its tolerance of an earlier one shares the point of that
  /// one.
  Index vertex(const TopoDS_Vertex& vertex) {
    const Point p = to_point(BRep_Tool::Pnt(vertex));
    const double tolerance = std::max(Precision::Confusion(), BRep_Tool::Tolerance(vertex));
    for (const Index known : soup_.vertices)
      if (distance(soup_.points[known], p) <= tolerance) return known;
    soup_.vertices.push_back(point(p, topology_.number(vertex)));
    return soup_.vertices.back();
  }

  const Topology& topology_;
  const TessellationOptions& options_;
  Tessellation& result_;
  PolygonSoup soup_;
};

bool is_straight(const TopoDS_Shape& edge) {
  return BRepAdaptor_Curve(TopoDS::Edge(edge)).GetType() == GeomAbs_Line;
}

bool share_an_end(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  for (const TopoDS_Shape& of_a : subshapes(a, TopAbs_VERTEX))
    for (const TopoDS_Shape& of_b : subshapes(b, TopAbs_VERTEX)) {
      const TopoDS_Vertex &v = TopoDS::Vertex(of_a), &w = TopoDS::Vertex(of_b);
      const double tolerance =
          std::max({Precision::Confusion(), BRep_Tool::Tolerance(v), BRep_Tool::Tolerance(w)});
      if (BRep_Tool::Pnt(v).Distance(BRep_Tool::Pnt(w)) <= tolerance) return true;
    }
  return false;
}

/// Edges whose chords have been made.
class CutEdges {
 public:
  explicit CutEdges(double deflection) : reach_(2 * deflection) {}

  /// Returns whether an earlier edge without a common end is so near that its chords and those of this edge
  /// may cross. Two straight edges are never too near, because their chords are the edges themselves.
  bool are_near(const TopoDS_Shape& edge) const {
    const bool straight = is_straight(edge);
    const Bnd_Box box = box_of(edge);
    return std::any_of(edges_.begin(), edges_.end(), [&](const Cut& other) {
      return !(straight && other.straight) && other.box.Distance(box) <= reach_ &&
             !share_an_end(edge, other.edge) && distance_between(edge, other.edge) <= reach_;
    });
  }
  void add(const TopoDS_Shape& edge) { edges_.push_back({edge, box_of(edge), is_straight(edge)}); }

 private:
  struct Cut {
    TopoDS_Shape edge;
    Bnd_Box box;
    bool straight;
  };

  static Bnd_Box box_of(const TopoDS_Shape& edge) {
    Bnd_Box box;
    BRepBndLib::Add(edge, box);
    return box;
  }

  double reach_;
  std::vector<Cut> edges_;
};

/// The parts that are left out, for a note.
class LeftOut {
 public:
  void add(const Topology::FreePart& part) {
    if (count_++ == 0)
      first_ = fmt::format("{}{} at {}", is_edge(part.shape) ? "Edge" : "Vertex", part.number,
                           text(place_of(part.shape)));
  }
  void tell(const std::string& file, const char* near, const char* what,
            std::vector<std::string>& notes) const {
    if (count_ == 0) return;
    const bool several = count_ > 1;
    notes.push_back(fmt::format(
        "{}: {}{} so near to {} that {} may cross {}; mesh with a smaller --distance", file, first_,
        several ? fmt::format(" and {} more are left out, because they are", count_ - 1)
                : " is left out, because it is",
        near, what, several ? "them" : "it"));
  }

 private:
  std::size_t count_ = 0;
  std::string first_;
};

}  // namespace

PolygonSoup cut_free_parts(const Topology& topology, const std::string& file,
                           const TessellationOptions& options, Tessellation& result) {
  Cutter cutter(topology, file, options, result);
  CutEdges edges(options.deflection);
  LeftOut near_faces, near_edges;
  const bool alone = topology.solids.empty();  // in a shape of edges alone the builder of the complex cuts
                                               // chords that cross
  for (const Topology::FreePart& part : topology.free_parts) {
    if (alone) {
      cutter.add(part);
    } else if (part.clearance <= 2 * options.deflection) {
      near_faces.add(part);
    } else if (!is_edge(part.shape)) {
      cutter.add(part);
    } else if (edges.are_near(part.shape)) {
      near_edges.add(part);
    } else {
      edges.add(part.shape);
      cutter.add(part);
    }
  }
  near_faces.tell(file, "faces", "their triangles", result.notes);
  near_edges.tell(file, "other edges", "their chords", result.notes);
  return cutter.finish();
}

}  // namespace collarmesh::brep
