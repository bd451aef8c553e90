// Triangulates faces, after dividing each edge once for all faces that share it.
#include "tessellation.h"

#include "face_mending.h"
#include "folded_triangles.h"
#include "free_chords.h"
#include "points.h"

#include <fmt/format.h>
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Geom2d_Curve.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Vertex.hxx>

#include <algorithm>
#include <cassert>
#include <numbers>
#include <set>

namespace collarmesh::brep {

namespace {

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
    edge_parameters_.resize(edge_points_.size());
    face_triangles_.resize(static_cast<std::size_t>(faces_.Extent()));
    is_vertex_.assign(points_.size(), false);
  }

  Tessellation run(const TessellationOptions& options) {
    finer_faces_.insert(options.finer_faces.begin(), options.finer_faces.end());
    BRepTools::Clean(topology_.all);
    // Divide finer faces first: the others use the same chords on shared edges.
    if (const TopoDS_Compound finer = finer_faces(); finer.NbChildren() > 0) {
      set_fineness(options, true);
      cut(finer);
    }
    set_fineness(options, false);
    cut(topology_.all);
    std::vector<int> failed;
    for (int f = 1; f <= faces_.Extent(); ++f) {
      set_fineness(options, is_finer(faces_(f)));
      if (!add_face(TopoDS::Face(faces_(f)), f)) failed.push_back(f);
    }
    for (const int f : failed) {
      set_fineness(options, is_finer(faces_(f)));
      mend(TopoDS::Face(faces_(f)), f);
    }
    set_fineness(options, false);
    require_triangles();
    bend_single_chords();
    find_features();
    measure();
    for (const Topology::Solid& solid : topology_.solids) result_.soups.push_back(soup_of(solid));
    if (!topology_.internal_faces.empty()) result_.soups.push_back(internal_soup());
    if (!topology_.free_parts.empty())  // even if all are left out: the number of soups must not depend on
                                        // the fineness
      result_.soups.push_back(cut_free_parts(topology_, file_, options, result_));
    return std::move(result_);
  }

 private:
  static constexpr double straight_ = 1e-13;  // rounding of distances, relative to the diagonal
  static constexpr double seam_gap_ = 1e-3;   // largest distance in space, relative to the diagonal,
                                              // between two ends of edges that are one node
  static constexpr double flat_ = 1e-3;       // largest height of a flat triangle, relative to the deflection

  void set_fineness(const TessellationOptions& options, bool finer) {
    const double by = finer ? options.finer : 1;
    deflection_ = options.deflection / by;
    angle_ = options.angle / by * std::numbers::pi / 180;
  }

  bool is_finer(const TopoDS_Shape& face) const { return finer_faces_.contains(topology_.number(face)); }

  TopoDS_Compound finer_faces() const {
    TopoDS_Compound faces;
    BRep_Builder builder;
    builder.MakeCompound(faces);
    for (int f = 1; f <= faces_.Extent(); ++f)
      if (is_finer(faces_(f))) builder.Add(faces, faces_(f));
    return faces;
  }

  void cut(const TopoDS_Shape& shape) const {
    IMeshTools_Parameters parameters;
    parameters.Deflection = deflection_;
    parameters.Angle = angle_;
    parameters.InParallel = true;
    const BRepMesh_IncrementalMesh mesh(shape, parameters);
  }

  static std::size_t slot(int index) { return static_cast<std::size_t>(index - 1); }

  /// Adds the triangles that BRepMesh gave a face; returns false without adding any if it failed.
  bool add_face(const TopoDS_Face& face, int index) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
    if (!fits_neighbours(face, triangulation, location)) return false;
    std::vector<Index> at(static_cast<std::size_t>(triangulation->NbNodes()), none);
    for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
      add_edge(TopoDS::Edge(edge.Current()), triangulation, location, at);
    const std::size_t first_inner = points_.size();
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
    if (sides_off(triangles, chords_of(face)) > 0) {  // the triangles have holes or cover too much
      triangles.clear();
      points_.resize(first_inner);
      result_.faces[topology_.number(face)].pop_back();
      return false;
    }
    insert_vertices_amid(face, at, triangles);
    flip_flat_triangles(points_, flat_ * deflection_, triangles);
    unfold(points_, static_cast<Index>(first_inner), deflection_, triangles);
    return true;
  }

  /// Returns whether a face has triangles, with as many points on each edge as the faces added before.
  bool fits_neighbours(const TopoDS_Face& face, const Handle(Poly_Triangulation) & triangulation,
                       const TopLoc_Location& location) const {
    if (triangulation.IsNull() || triangulation->NbTriangles() == 0) return false;
    for (TopExp_Explorer side(face, TopAbs_EDGE); side.More(); side.Next()) {
      const TopoDS_Edge& edge = TopoDS::Edge(side.Current());
      const Handle(Poly_PolygonOnTriangulation) polygon =
          BRep_Tool::PolygonOnTriangulation(edge, triangulation, location);
      if (polygon.IsNull()) return false;
      const auto& points = edge_points_[slot(edges_.FindIndex(edge))];
      if (!points.empty() && !BRep_Tool::Degenerated(edge) &&
          points.size() != static_cast<std::size_t>(polygon->NbNodes()))
        return false;
    }
    return true;
  }

  /// Returns the chords of the edges around a face, without those of edges inside it.
  std::vector<std::array<Index, 2>> chords_of(const TopoDS_Face& face) const {
    std::vector<std::array<Index, 2>> chords;
    for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next()) {
      const auto& points = edge_points_[slot(edges_.FindIndex(edge.Current()))];
      if (inside_orientation(edge.Current())) continue;
      for (std::size_t i = 0; i + 1 < points.size(); ++i) chords.push_back({points[i], points[i + 1]});
    }
    return chords;
  }

  /// Sets `at`, which maps nodes of the triangulation to points of the shape, for the nodes on an edge.
  void add_edge(const TopoDS_Edge& edge, const Handle(Poly_Triangulation) & triangulation,
                const TopLoc_Location& location, std::vector<Index>& at) {
    const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, triangulation, location);
    std::vector<double> parameters;
    for (int i = 1; i <= polygon->NbNodes(); ++i) parameters.push_back(polygon->Parameter(i));
    const std::vector<Index>& points = points_of(edge, parameters);
    for (int i = 1; i <= polygon->NbNodes(); ++i)
      at[slot(polygon->Node(i))] = points[BRep_Tool::Degenerated(edge) ? 0 : slot(i)];
  }

  /// Returns the points on an edge in the order of its parameter; for a degenerate edge, its vertex. Divides
  /// the edge at the parameters if it is not divided yet.
  const std::vector<Index>& points_of(const TopoDS_Edge& edge, const std::vector<double>& parameters) {
    const std::size_t index = slot(edges_.FindIndex(edge));
    std::vector<Index>& points = edge_points_[index];
    if (!points.empty()) return points;
    const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
    const TopoDS_Vertex first = TopExp::FirstVertex(forward), last = TopExp::LastVertex(forward);
    points.push_back(static_cast<Index>(slot(vertices_.FindIndex(first))));
    edge_parameters_[index] = parameters;
    if (BRep_Tool::Degenerated(edge)) return points;
    const BRepAdaptor_Curve curve(forward);
    Samples& samples = result_.edges[topology_.number(edge)].emplace_back();
    samples.shape = forward;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const Point p = to_point(curve.Value(parameters[i]));
      samples.points.push_back(p);
      samples.parameters.push_back({parameters[i], 0});
      if (i == 0 || i + 1 == parameters.size()) continue;
      points.push_back(static_cast<Index>(points_.size()));
      points_.push_back(p);
    }
    points.push_back(static_cast<Index>(slot(vertices_.FindIndex(last))));
    return points;
  }

  /// Divides an edge if BRepMesh failed on all of its faces.
  void cut_edge(const TopoDS_Edge& edge) {
    if (!edge_points_[slot(edges_.FindIndex(edge))].empty()) return;
    const BRepAdaptor_Curve curve(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)));
    std::vector<double> parameters;
    if (BRep_Tool::Degenerated(edge)) {
      parameters = {curve.FirstParameter(), curve.LastParameter()};
    } else {
      constexpr int least = 3;  // points, so that a circle is not flat
      const GCPnts_TangentialDeflection cut(curve, angle_, deflection_, least);
      for (int i = 1; i <= cut.NbPoints(); ++i) parameters.push_back(cut.Parameter(i));
    }
    points_of(edge, parameters);
  }

  /// Triangulates a face by one of the ways of `mend_face`, and adds a note that tells which one.
  void mend(const TopoDS_Face& face, int index) {
    for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
      cut_edge(TopoDS::Edge(edge.Current()));
    const MendedFace mended = mend_face(face, outline_of(face), deflection_, angle_);
    const auto first_inner = static_cast<Index>(points_.size());
    std::vector<Index> at = mended.outline_points;
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (at[i] != none) continue;
      at[i] = static_cast<Index>(points_.size());
      points_.push_back(mended.points[i]);
    }
    auto& triangles = face_triangles_[slot(index)];
    for (const auto& [a, b, c] : mended.triangles)
      if (at[a] != at[b] && at[b] != at[c] && at[c] != at[a]) triangles.push_back({at[a], at[b], at[c]});
    flip_flat_triangles(points_, flat_ * deflection_, triangles);
    unfold(points_, first_inner, deflection_, triangles);
    Samples& samples = result_.faces[topology_.number(face)].emplace_back();
    samples.shape = mended.triangles.empty() ? face : mended.face;
    samples.points = mended.points;
    samples.parameters = mended.parameters;
    if (!mended.parameters.empty()) samples.triangles = mended.triangles;
    tell(face, mended, triangles.empty());
  }

  void tell(const TopoDS_Face& face, const MendedFace& mended, bool left_out) {
    const std::string done =
        left_out
            ? "it is left out; its outline is open or crosses itself, or it has no area"
            : fmt::format(
                  "it was triangulated {}{}", mended.how,
                  mended.fits ? "" : ", but the points on its border differ from those of its neighbours");
    result_.notes.push_back(
        fmt::format("{}: {} around {} cannot be cut into triangles together with its neighbours; {}", file_,
                    topology_.name(face), text(place_of(face)), done));
  }

  void require_triangles() const {
    if (faces_.IsEmpty() ||
        std::any_of(face_triangles_.begin(), face_triangles_.end(), [](const auto& t) { return !t.empty(); }))
      return;
    fail(PlcFault::Kind::degenerate_facet,
         fmt::format("{}: none of its faces can be cut into triangles; check and repair the shape.", file_),
         place_of(topology_.all));
  }

  /// Returns the chords of a face's edges, with the parameters of the points on its surface.
  Outline outline_of(const TopoDS_Face& face) const {
    Outline outline;
    std::map<Index, std::vector<Index>> nodes_of;  // by point
    const BRepAdaptor_Surface surface(face, false);
    const auto node = [&](Index p, const std::array<double, 2>& uv) {
      const gp_Pnt at = surface.Value(uv[0], uv[1]);
      for (const Index n : nodes_of[p])
        if (at.Distance(surface.Value(outline.parameters[n][0], outline.parameters[n][1])) <=
                seam_gap_ * diagonal_ &&
            near_in_plane(surface, uv, outline.parameters[n]))
          return n;
      const auto n = static_cast<Index>(outline.points.size());
      outline.points.push_back(p);
      outline.places.push_back(points_[p]);
      outline.parameters.push_back(uv);
      nodes_of[p].push_back(n);
      return n;
    };
    for (TopExp_Explorer side(face.Oriented(TopAbs_FORWARD), TopAbs_EDGE); side.More(); side.Next()) {
      const TopoDS_Edge& edge = TopoDS::Edge(side.Current());
      if (inside_orientation(edge)) continue;
      const auto& points = edge_points_[slot(edges_.FindIndex(edge))];
      const auto uv = parameters_on(face, edge, surface);
      std::vector<Index> nodes;
      for (std::size_t i = 0; i < uv.size(); ++i)
        nodes.push_back(node(points[BRep_Tool::Degenerated(edge) ? 0 : i], uv[i]));
      if (edge.Orientation() == TopAbs_REVERSED) std::reverse(nodes.begin(), nodes.end());
      for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
        if (nodes[i] != nodes[i + 1]) outline.chords.push_back({nodes[i], nodes[i + 1]});
    }
    return outline;
  }

  /// Returns whether two parameter pairs of one place lie on the same side of every seam: in each periodic or
  /// closed direction they differ by at most 1% of its length. Other directions are not compared.
  static bool near_in_plane(const BRepAdaptor_Surface& surface, const std::array<double, 2>& a,
                            const std::array<double, 2>& b) {
    constexpr double share = 0.01;  // share of a period
    return !(surface.IsUPeriodic() && std::fabs(a[0] - b[0]) > share * surface.UPeriod()) &&
           !(surface.IsVPeriodic() && std::fabs(a[1] - b[1]) > share * surface.VPeriod()) &&
           !(!surface.IsUPeriodic() && surface.IsUClosed() &&
             std::fabs(a[0] - b[0]) > share * (surface.LastUParameter() - surface.FirstUParameter())) &&
           !(!surface.IsVPeriodic() && surface.IsVClosed() &&
             std::fabs(a[1] - b[1]) > share * (surface.LastVParameter() - surface.FirstVParameter()));
  }

  /// Returns the parameters of an edge's points on a face: by its curve in the parameter plane, or by
  /// projection if that curve is missing or too far from the points.
  std::vector<std::array<double, 2>> parameters_on(const TopoDS_Face& face, const TopoDS_Edge& edge,
                                                   const BRepAdaptor_Surface& surface) const {
    const std::size_t index = slot(edges_.FindIndex(edge));
    double first = 0, last = 0;
    const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
    ShapeAnalysis_Surface projection(BRep_Tool::Surface(face));
    std::vector<std::array<double, 2>> result;
    const auto& t = edge_parameters_[index];
    for (std::size_t i = 0; i < t.size(); ++i) {
      gp_Pnt2d uv;
      if (!curve.IsNull())
        uv = curve->Value(first + (t[i] - t.front()) / (t.back() - t.front()) * (last - first));
      if (!BRep_Tool::Degenerated(edge)) {
        const Point& p = points_[edge_points_[index][i]];
        const double off = std::max(deflection_, 2 * BRep_Tool::Tolerance(edge));
        if (curve.IsNull() || distance(to_point(surface.Value(uv.X(), uv.Y())), p) > off)
          uv = projection.ValueOfUV(gp_Pnt(p.x, p.y, p.z), BRep_Tool::Tolerance(edge));
      }
      result.push_back({uv.X(), uv.Y()});
    }
    return result;
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

  /// Returns the vertex inside a face at this place, or none.
  Index vertex_amid(const TopoDS_Face& face, const Point& p) const {
    for (TopExp_Explorer vertex(face, TopAbs_VERTEX, TopAbs_EDGE); vertex.More(); vertex.Next()) {
      const TopoDS_Vertex& v = TopoDS::Vertex(vertex.Current());
      if (distance(to_point(BRep_Tool::Pnt(v)), p) <= BRep_Tool::Tolerance(v))
        return static_cast<Index>(slot(vertices_.FindIndex(v)));
    }
    return none;
  }

  /// Inserts vertices inside a face that are no nodes of its triangulation. Each divides its triangle into
  /// three.
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
    return 0.5 * norm(cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]));
  }
  /// Returns the sum of the areas of the triangles that a point forms with the sides of a triangle. It equals
  /// the triangle's area if the point lies inside.
  double area_with(const std::array<Index, 3>& t, Index p) const {
    return area_of({t[0], t[1], p}) + area_of({t[1], t[2], p}) + area_of({t[2], t[0], p});
  }

  /// Adds the curve's middle point to each edge that has a single chord but is not straight (or has vertices
  /// off its curve), so that the complex does not take the edge as straight. Divides the triangles at the
  /// chord into two.
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
        i = std::size_t(-1);  // begin again with all sides of the changed triangle
      }
  }

  /// Finds the edges that are features: all except seams (both sides on one face) and degenerate edges.
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
        is_vertex_[slot(vertices_.FindIndex(vertex.Current()))] = true;  // inside a face
  }

  void measure() {
    for (int e = 1; e <= edges_.Extent(); ++e) {
      if (!is_feature_[slot(e)]) continue;
      const auto& points = edge_points_[slot(e)];
      double length = 0;
      for (std::size_t i = 0; i + 1 < points.size(); ++i)
        length += distance(points_[points[i]], points_[points[i + 1]]);
      result_.lengths.Bind(edges_(e), length);
    }
    for (int f = 1; f <= faces_.Extent(); ++f) {
      double area = 0;
      for (const auto& triangle : face_triangles_[slot(f)]) area += area_of(triangle);
      result_.areas.Bind(faces_(f), area);
    }
  }

  /// Makes the vertex of a degenerate edge a feature if the surface ends there in a point, such as a cone's
  /// apex; the poles of a sphere are no features.
  void mark_apex(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces) {
    for (const TopoDS_Shape& face : faces)
      if (BRepAdaptor_Surface(TopoDS::Face(face), false).GetType() != GeomAbs_Sphere)
        is_vertex_[edge_points_[slot(edges_.FindIndex(edge))].front()] = true;
  }

  /// A collector of the data of one soup, with the points it uses.
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
  std::vector<std::vector<double>> edge_parameters_;
  std::vector<std::vector<std::array<Index, 3>>> face_triangles_;
  std::vector<bool> is_feature_, is_vertex_;
  std::set<Tag> finer_faces_;
  double deflection_ = 0, angle_ = 0;  // bounds for the faces that are being triangulated
  double diagonal_ = 0;
  Tessellation result_;
};

}  // namespace

Tessellation tessellate(const Topology& topology, const std::string& file,
                        const TessellationOptions& options) {
  assert(options.deflection > 0);
  return Tessellator(topology, file).run(options);
}

}  // namespace collarmesh::brep
