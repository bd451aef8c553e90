// Triangles of faces whose edges are cut once, for all faces that share them.
#include "tessellation.h"

#include "flat_triangles.h"

#include <fmt/format.h>
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <numbers>

namespace collarmesh::brep {

namespace {

Point to_point(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

class Tessellator {
 public:
  Tessellator(const Topology& topology, const std::string& file) : topology_(topology), file_(file) {
    TopExp::MapShapes(topology.all, TopAbs_VERTEX, vertices_);
    TopExp::MapShapes(topology.all, TopAbs_EDGE, edges_);
    TopExp::MapShapes(topology.all, TopAbs_FACE, faces_);
    for (const TopoDS_Shape& vertex : subshapes(topology.all, TopAbs_VERTEX))
      points_.push_back(to_point(BRep_Tool::Pnt(TopoDS::Vertex(vertex))));
    Box box;
    for (const Point& p : points_) box.add(p);
    diagonal_ = box.diagonal();
    edge_points_.resize(static_cast<std::size_t>(edges_.Extent()));
    face_triangles_.resize(static_cast<std::size_t>(faces_.Extent()));
    is_vertex_.assign(points_.size(), false);
  }

  Tessellation run(double deflection, double angle) {
    deflection_ = deflection;
    BRepTools::Clean(topology_.all);
    IMeshTools_Parameters parameters;
    parameters.Deflection = deflection;
    parameters.Angle = angle * std::numbers::pi / 180;
    parameters.InParallel = true;
    const BRepMesh_IncrementalMesh mesh(topology_.all, parameters);
    for (int f = 1; f <= faces_.Extent(); ++f) add_face(TopoDS::Face(faces_(f)), f);
    bend_single_chords();
    find_features();
    for (const Topology::Solid& solid : topology_.solids) result_.soups.push_back(soup_of(solid));
    if (!topology_.internal_faces.empty()) result_.soups.push_back(internal_soup());
    return std::move(result_);
  }

 private:
  static constexpr double straight_ = 1e-13;  // rounding, relative to the diagonal
  static constexpr double flat_ = 1e-3;       // height of a triangle without one, relative to the deflection

  static std::size_t slot(int index) { return static_cast<std::size_t>(index - 1); }

  void add_face(const TopoDS_Face& face, int index) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
    if (triangulation.IsNull() || triangulation->NbTriangles() == 0)
      fail(PlcFault::Kind::degenerate_facet,
           fmt::format("{}: {} around {} cannot be cut into triangles; its outline is open or crosses "
                       "itself, or it has "
                       "no area. Repair it.",
                       file_, topology_.name(face), text(place_of(face))),
           place_of(face));
    std::vector<Index> at(static_cast<std::size_t>(triangulation->NbNodes()), none);
    for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
      add_edge(TopoDS::Edge(edge.Current()), face, triangulation, location, at);
    add_inner_points(face, *triangulation, location, at);
    auto& triangles = face_triangles_[slot(index)];
    for (int t = 1; t <= triangulation->NbTriangles(); ++t) {
      std::array<int, 3> n{};
      triangulation->Triangle(t).Get(n[0], n[1], n[2]);
      std::array<Index, 3> corners{at[slot(n[0])], at[slot(n[1])], at[slot(n[2])]};
      if (location.Transformation().IsNegative()) std::swap(corners[1], corners[2]);
      if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
        triangles.push_back(corners);
    }
    insert_vertices_amid(face, at, triangles);
    flip_flat_triangles(points_, flat_ * deflection_, triangles);
  }

  /// Says which points of the shape the triangulation's nodes on an edge are.
  void add_edge(const TopoDS_Edge& edge, const TopoDS_Face& face,
                const Handle(Poly_Triangulation) & triangulation, const TopLoc_Location& location,
                std::vector<Index>& at) {
    const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, triangulation, location);
    if (polygon.IsNull())
      fail(PlcFault::Kind::degenerate_facet,
           fmt::format("{}: {} around {} cannot be cut into triangles along its {}; repair it.", file_,
                       topology_.name(face), text(place_of(face)), topology_.name(edge)),
           place_of(edge));
    const std::vector<Index>& points = points_of(edge, *polygon);
    if (points.size() != static_cast<std::size_t>(polygon->NbNodes()) && !BRep_Tool::Degenerated(edge))
      fail(PlcFault::Kind::degenerate_facet,
           fmt::format("{}: the faces at {} around {} have different points on it; repair it.", file_,
                       topology_.name(edge), text(place_of(edge))),
           place_of(edge));
    for (int i = 1; i <= polygon->NbNodes(); ++i)
      at[slot(polygon->Node(i))] = points[BRep_Tool::Degenerated(edge) ? 0 : slot(i)];
  }

  /// The points on an edge in the order of its parameter; of a degenerate one its vertex.
  const std::vector<Index>& points_of(const TopoDS_Edge& edge, const Poly_PolygonOnTriangulation& polygon) {
    std::vector<Index>& points = edge_points_[slot(edges_.FindIndex(edge))];
    if (!points.empty()) return points;
    const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
    const TopoDS_Vertex first = TopExp::FirstVertex(forward), last = TopExp::LastVertex(forward);
    const Index first_point = static_cast<Index>(slot(vertices_.FindIndex(first)));
    points.push_back(first_point);
    if (BRep_Tool::Degenerated(edge)) return points;
    const BRepAdaptor_Curve curve(forward);
    Samples& samples = result_.edges[topology_.number(edge)].emplace_back();
    samples.shape = forward;
    for (int i = 1; i <= polygon.NbNodes(); ++i) {
      const double t = polygon.Parameter(i);
      const Point p = to_point(curve.Value(t));
      samples.points.push_back(p);
      samples.parameters.push_back({t, 0});
      if (i == 1 || i == polygon.NbNodes()) continue;
      points.push_back(static_cast<Index>(points_.size()));
      points_.push_back(p);
    }
    points.push_back(static_cast<Index>(slot(vertices_.FindIndex(last))));
    return points;
  }

  void add_inner_points(const TopoDS_Face& face, const Poly_Triangulation& triangulation,
                        const TopLoc_Location& location, std::vector<Index>& at) {
    const BRepAdaptor_Surface surface(face, false);
    Samples& samples = result_.faces[topology_.number(face)].emplace_back();
    samples.shape = face;
    for (int t = 1; t <= triangulation.NbTriangles() && triangulation.HasUVNodes(); ++t) {
      std::array<int, 3> n{};
      triangulation.Triangle(t).Get(n[0], n[1], n[2]);
      samples.triangles.push_back(
          {static_cast<Index>(slot(n[0])), static_cast<Index>(slot(n[1])), static_cast<Index>(slot(n[2]))});
    }
    for (int i = 1; i <= triangulation.NbNodes(); ++i) {
      Point p = to_point(triangulation.Node(i).Transformed(location.Transformation()));
      if (triangulation.HasUVNodes()) {
        const gp_Pnt2d uv = triangulation.UVNode(i);
        p = to_point(surface.Value(uv.X(), uv.Y()));
        samples.points.push_back(p);
        samples.parameters.push_back({uv.X(), uv.Y()});
      }
      if (at[slot(i)] != none) continue;
      at[slot(i)] = vertex_amid(face, p);
      if (at[slot(i)] != none) continue;
      at[slot(i)] = static_cast<Index>(points_.size());
      points_.push_back(p);
    }
  }

  /// The vertex that lies amid a face at this place, none if there is no such.
  Index vertex_amid(const TopoDS_Face& face, const Point& p) const {
    for (TopExp_Explorer vertex(face, TopAbs_VERTEX, TopAbs_EDGE); vertex.More(); vertex.Next()) {
      const TopoDS_Vertex& v = TopoDS::Vertex(vertex.Current());
      if (distance(to_point(BRep_Tool::Pnt(v)), p) <= BRep_Tool::Tolerance(v))
        return static_cast<Index>(slot(vertices_.FindIndex(v)));
    }
    return none;
  }

  /// Those vertices amid a face that are no node of its triangulation: each cuts its triangle in three.
  void insert_vertices_amid(const TopoDS_Face& face, const std::vector<Index>& nodes,
                            std::vector<std::array<Index, 3>>& triangles) const {
    for (TopExp_Explorer vertex(face, TopAbs_VERTEX, TopAbs_EDGE); vertex.More(); vertex.Next()) {
      const auto p = static_cast<Index>(slot(vertices_.FindIndex(vertex.Current())));
      if (std::find(nodes.begin(), nodes.end(), p) != nodes.end()) continue;
      const auto around =
          std::min_element(triangles.begin(), triangles.end(), [&](const auto& s, const auto& t) {
            return area_with(s, p) - area_of(s) < area_with(t, p) - area_of(t);
          });
      if (around == triangles.end()) continue;
      const auto [a, b, c] = *around;
      *around = {a, b, p};
      triangles.push_back({b, c, p});
      triangles.push_back({c, a, p});
    }
  }

  double area_of(const std::array<Index, 3>& t) const {
    return norm(cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]));
  }
  /// Of the three triangles that a point makes with the sides: as large as the triangle if it lies in it.
  double area_with(const std::array<Index, 3>& t, Index p) const {
    return area_of({t[0], t[1], p}) + area_of({t[1], t[2], p}) + area_of({t[2], t[0], p});
  }

  /// An edge of one chord that its curve leaves, if by less than the deflection (also where vertices lie
  /// off it), gets a point in its middle, so that the complex knows it is not straight: its neighbours'
  /// triangles there are cut in two.
  void bend_single_chords() {
    std::map<std::array<Index, 2>, Index> middle_of;
    for (int e = 1; e <= edges_.Extent(); ++e) {
      auto& points = edge_points_[slot(e)];
      const TopoDS_Edge& edge = TopoDS::Edge(edges_(e));
      if (points.size() != 2 || points[0] == points[1] || BRep_Tool::Degenerated(edge)) continue;
      const BRepAdaptor_Curve curve(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)));
      const double t = 0.5 * (curve.FirstParameter() + curve.LastParameter());
      const Point p = to_point(curve.Value(t)), chord = points_[points[1]] - points_[points[0]];
      if (norm(cross(chord, p - points_[points[0]])) <= straight_ * diagonal_ * norm(chord)) continue;
      const auto middle = static_cast<Index>(points_.size());
      points_.push_back(p);
      middle_of[{std::min(points[0], points[1]), std::max(points[0], points[1])}] = middle;
      points.insert(points.begin() + 1, middle);
    }
    if (middle_of.empty()) return;
    for (auto& triangles : face_triangles_) cut_at(middle_of, triangles);
  }

  static void cut_at(const std::map<std::array<Index, 2>, Index>& middle_of,
                     std::vector<std::array<Index, 3>>& triangles) {
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::array<Index, 3> corners{triangles[t][i], triangles[t][(i + 1) % 3],
                                           triangles[t][(i + 2) % 3]};
        const auto found =
            middle_of.find({std::min(corners[0], corners[1]), std::max(corners[0], corners[1])});
        if (found == middle_of.end()) continue;
        triangles[t] = {found->second, corners[1], corners[2]};
        triangles.push_back({corners[0], found->second, corners[2]});
        i = std::size_t(-1);  // other sides of this part
      }
  }

  /// Edges that are features: all but seams (both sides on one face) and degenerate ones.
  void find_features() {
    TopTools_IndexedDataMapOfShapeListOfShape faces_at;
    TopExp::MapShapesAndAncestors(topology_.all, TopAbs_EDGE, TopAbs_FACE, faces_at);
    is_feature_.assign(edge_points_.size(), false);
    for (int e = 1; e <= edges_.Extent(); ++e) {
      const TopoDS_Edge& edge = TopoDS::Edge(edges_(e));
      if (edge_points_[slot(e)].empty()) continue;
      if (BRep_Tool::Degenerated(edge)) {
        mark_apex(edge, faces_at.FindFromKey(edge));
        continue;
      }
      bool seam = false;
      for (const TopoDS_Shape& face : faces_at.FindFromKey(edge))
        seam = seam || BRep_Tool::IsClosed(edge, TopoDS::Face(face));
      TopTools_IndexedMapOfShape different;
      for (const TopoDS_Shape& face : faces_at.FindFromKey(edge)) different.Add(face);
      if (seam && different.Extent() == 1) continue;
      is_feature_[slot(e)] = true;
      is_vertex_[edge_points_[slot(e)].front()] = is_vertex_[edge_points_[slot(e)].back()] = true;
    }
    for (const TopoDS_Shape& face : subshapes(topology_.all, TopAbs_FACE))
      for (TopExp_Explorer vertex(face, TopAbs_VERTEX, TopAbs_EDGE); vertex.More(); vertex.Next())
        is_vertex_[slot(vertices_.FindIndex(vertex.Current()))] = true;  // amid a face
  }

  /// Where a surface ends in a point, as a cone in its apex, that is a vertex; but not the poles of a sphere.
  void mark_apex(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces) {
    for (const TopoDS_Shape& face : faces)
      if (BRepAdaptor_Surface(TopoDS::Face(face), false).GetType() != GeomAbs_Sphere)
        is_vertex_[edge_points_[slot(edges_.FindIndex(edge))].front()] = true;
  }

  /// Collects what belongs to one soup, with the points it uses.
  class Collector {
   public:
    Collector(const Tessellator& all, std::string name) : all_(all), used_(all.points_.size(), none) {
      soup_.name = std::move(name);
      soup_.given_features = true;
    }

    void add_face(const TopoDS_Shape& face) {
      const Tag tag = all_.topology_.number(face);
      const bool turned = face.Orientation() == TopAbs_REVERSED;
      for (const auto& [a, b, c] : all_.face_triangles_[slot(all_.faces_.FindIndex(face))]) {
        const std::array<Index, 3> corners{point(a), point(turned ? c : b), point(turned ? b : c)};
        soup_.add_facet(corners, tag);
      }
      for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next()) add_edge(edge.Current());
      for (TopExp_Explorer vertex(face, TopAbs_VERTEX); vertex.More(); vertex.Next())
        add_vertex(vertex.Current());
    }
    PolygonSoup finish() {
      for (Index p = 0; p < used_.size(); ++p)
        if (used_[p] != none && all_.is_vertex_of(p)) soup_.vertices.push_back(used_[p]);
      return std::move(soup_);
    }
    void set_region(Tag tag) { soup_.region_tag = tag; }

   private:
    Index point(Index p) {
      if (used_[p] == none) {
        used_[p] = static_cast<Index>(soup_.points.size());
        soup_.points.push_back(all_.points_[p]);
        soup_.point_tags.push_back(0);
      }
      return used_[p];
    }
    void add_edge(const TopoDS_Shape& edge) {
      const int index = all_.edges_.FindIndex(edge);
      if (!all_.is_feature_[slot(index)] || !added_.Add(edge)) return;
      const auto& points = all_.edge_points_[slot(index)];
      for (std::size_t i = 0; i + 1 < points.size(); ++i)
        if (points[i] != points[i + 1])
          soup_.segments.push_back({point(points[i]), point(points[i + 1]), all_.topology_.number(edge)});
    }
    void add_vertex(const TopoDS_Shape& vertex) {
      const auto p = static_cast<Index>(slot(all_.vertices_.FindIndex(vertex)));
      if (used_[p] != none) soup_.point_tags[used_[p]] = all_.topology_.number(vertex);
    }

    const Tessellator& all_;
    PolygonSoup soup_;
    std::vector<Index> used_;
    TopTools_MapOfShape added_;
  };

  bool is_vertex_of(Index point) const { return point < is_vertex_.size() && is_vertex_[point]; }

  PolygonSoup soup_of(const Topology::Solid& solid) const {
    Collector soup(*this, fmt::format("{}, Solid{}", file_, solid.number));
    soup.set_region(solid.number);
    for (const TopoDS_Shape& face : solid.faces) soup.add_face(face);
    return soup.finish();
  }

  PolygonSoup internal_soup() const {
    Collector soup(*this, fmt::format("{}, faces inside", file_));
    for (const TopoDS_Shape& face : topology_.internal_faces) soup.add_face(face);
    return soup.finish();
  }

  const Topology& topology_;
  const std::string& file_;
  TopTools_IndexedMapOfShape vertices_, edges_, faces_;
  std::vector<Point> points_;                    // vertices first
  std::vector<std::vector<Index>> edge_points_;  // by index in edges_
  std::vector<std::vector<std::array<Index, 3>>> face_triangles_;
  std::vector<bool> is_feature_, is_vertex_;
  double deflection_ = 0, diagonal_ = 0;
  Tessellation result_;
};

}  // namespace

Tessellation tessellate(const Topology& topology, const std::string& file, double deflection, double angle) {
  return Tessellator(topology, file).run(deflection, angle);
}

}  // namespace collarmesh::brep
