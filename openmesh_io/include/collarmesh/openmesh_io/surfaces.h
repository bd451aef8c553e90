#pragma once

#include <OpenMesh/Core/Mesh/PolyConnectivity.hh>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/openmesh_io/properties.h"
#include "collarmesh/plc.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/polygon_soup.h"

namespace collarmesh::openmesh_io {

/// Options for reading an OpenMesh mesh. Members that end in `_property` name properties of type int,
/// unsigned, std::int64_t or std::uint64_t; an empty name stands for none. A missing property throws
/// OptionError, unless its name is the default.
struct SurfaceOptions {
  std::string name = {};           ///< name in messages
  std::optional<Tag> region = {};  ///< tag of the regions inside this surface; none: numbers as tags
  /// Face property: faces with the same value form a separate surface, whose regions get the value as their
  /// tag; empty: all faces form one surface.
  std::string region_property = {};
  std::string patch_property = patch_tag;  ///< face property: tag of the patch
  /// Edge property: an edge with a value other than 0 is on a curve with this tag.
  std::string curve_property = curve_tag;
  /// Vertex property: a vertex with a value other than 0 is a feature with this tag.
  std::string vertex_property = vertex_tag;
  bool feature_edges = true;  ///< edges with the feature bit of their status are curves
};

/// Counts of the contents of an OpenMesh mesh. No count is an error by itself: `build_plc` decides whether it
/// can use the surface.
struct SurfaceReport {
  std::string name;
  std::size_t faces = 0;                  ///< faces used
  std::size_t deleted_faces = 0;          ///< faces that are marked as deleted but still stored: left
                                          ///< out
  std::size_t isolated_vertices = 0;      ///< vertices without a face: left out
  std::size_t non_manifold_vertices = 0;  ///< vertices where several fans of faces meet
  std::size_t border_edges = 0;           ///< edges with one face; coincident ones are welded
  /// Faces to which OpenMesh gave vertices of their own, because it cannot represent a non-manifold edge or
  /// vertex there. `to_plc` welds them to their neighbours again.
  std::size_t detached_faces = 0;
};

struct SurfacesPlc {
  Plc plc;  ///< plc.cleanup counts what was welded and dropped
  std::vector<SurfaceReport> surfaces;
  /// Remarks for the user, one sentence each; empty if everything was used unchanged.
  std::vector<std::string> notes;
};

/// A collector of OpenMesh meshes, possibly of different types, from which it builds one complex.
class Surfaces {
 public:
  /// Adds a TriMesh or PolyMesh of any traits. Does not change the mesh, and keeps no reference to it. Throws
  /// OptionError for a missing property.
  template <class Mesh>
  void add(const Mesh& mesh, const SurfaceOptions& options = {});

  /// Builds one complex of all meshes, with regions numbered in the order of the meshes. Throws PlcError like
  /// `build_plc`, for example if a border stays open after welding.
  SurfacesPlc to_plc(const PlcOptions& options = {}) const;

  const std::vector<PolygonSoup>& soups() const { return soups_; }

 private:
  PolygonSoup& soup_of(Tag region, std::size_t first, const PolygonSoup& pattern);

  std::vector<PolygonSoup> soups_;
  std::vector<SurfaceReport> reports_;
};

/// Builds the complex of one mesh.
template <class Mesh>
SurfacesPlc to_plc(const Mesh& mesh, const SurfaceOptions& options = {}, const PlcOptions& plc_options = {}) {
  Surfaces surfaces;
  surfaces.add(mesh, options);
  return surfaces.to_plc(plc_options);
}

namespace detail {

template <class Mesh>
SurfaceReport inspect(const Mesh& mesh, const std::string& name) {
  SurfaceReport report;
  report.name = name;
  for (const auto v : mesh.all_vertices()) {
    if (mesh.has_vertex_status() && mesh.status(v).deleted()) continue;
    if (mesh.is_isolated(v))
      ++report.isolated_vertices;
    else if (!mesh.is_manifold(v))
      ++report.non_manifold_vertices;
  }
  for (const auto e : mesh.all_edges())
    if (!(mesh.has_edge_status() && mesh.status(e).deleted()) && mesh.is_boundary(e)) ++report.border_edges;
  for (const auto f : mesh.all_faces()) {
    const bool deleted = mesh.has_face_status() && mesh.status(f).deleted();
    ++(deleted ? report.deleted_faces : report.faces);
    if (!deleted && mesh.has_face_status() && mesh.status(f).fixed_nonmanifold()) ++report.detached_faces;
  }
  return report;
}

template <class Mesh>
std::vector<Point> points_of(const Mesh& mesh) {
  std::vector<Point> points;
  points.reserve(mesh.n_vertices());
  for (const auto v : mesh.all_vertices()) {
    const auto& p = mesh.point(v);
    points.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  }
  return points;
}

}  // namespace detail

template <class Mesh>
void Surfaces::add(const Mesh& mesh, const SurfaceOptions& options) {
  using OpenMesh::EPropHandleT, OpenMesh::FPropHandleT, OpenMesh::VPropHandleT;
  const detail::TagProperty<Mesh, FPropHandleT> patch(mesh, options.patch_property, patch_tag),
      region(mesh, options.region_property, {});
  const detail::TagProperty<Mesh, EPropHandleT> curve(mesh, options.curve_property, curve_tag);
  const detail::TagProperty<Mesh, VPropHandleT> vertex(mesh, options.vertex_property, vertex_tag);
  reports_.push_back(detail::inspect(mesh, options.name));

  PolygonSoup pattern;
  pattern.name = options.name;
  pattern.points = detail::points_of(mesh);
  pattern.region_tag = options.region;
  if (vertex)
    for (const auto v : mesh.all_vertices()) pattern.point_tags.push_back(vertex[v]);

  const std::size_t first = soups_.size();
  if (!region) soups_.push_back(pattern);
  std::vector<Index> corners;
  for (const auto f : mesh.all_faces()) {
    if (mesh.has_face_status() && mesh.status(f).deleted()) continue;
    corners.clear();
    for (const auto v : mesh.fv_range(f)) corners.push_back(static_cast<Index>(v.idx()));
    PolygonSoup& soup = region ? soup_of(region[f], first, pattern) : soups_.back();
    soup.add_facet(corners, patch ? patch[f] : 0);
  }
  if (soups_.size() == first) return;
  for (const auto e : mesh.all_edges()) {
    if (mesh.has_edge_status() && mesh.status(e).deleted()) continue;
    const Tag tag = curve ? curve[e] : 0;
    const bool feature = options.feature_edges && mesh.has_edge_status() && mesh.status(e).feature();
    if (tag == 0 && !feature) continue;
    const auto h = mesh.halfedge_handle(e, 0);
    soups_[first].segments.push_back({static_cast<Index>(mesh.from_vertex_handle(h).idx()),
                                      static_cast<Index>(mesh.to_vertex_handle(h).idx()), tag});
  }
}

}  // namespace collarmesh::openmesh_io
