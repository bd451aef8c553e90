#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/openmesh_io/properties.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::openmesh_io {

/// A selection of triangles of a tetrahedral mesh, by their regions. Regions have the numbers in
/// TetMesh::tet_region; 0 is the outside.
struct SurfaceSelection {
  /// The regions behind and in front of a selected triangle; a triangle that fits only when reversed is
  /// reversed. `any` stands for every region and for the outside.
  Index back = any, front = 0;
  static constexpr Index any = none;

  /// Selects the triangles between the regions and the outside, oriented outwards.
  static SurfaceSelection boundary() { return {any, 0}; }
  /// Selects all triangles around a region, oriented away from it.
  static SurfaceSelection region(Index region) { return {region, any}; }
  /// Selects triangles between two regions, oriented towards the second one.
  static SurfaceSelection interface(Index back, Index front) { return {back, front}; }
};

/// Selected triangles in a form that OpenMesh can represent: around each vertex they form one fan. A vertex
/// is copied if several fans meet there, or at edges where more than two triangles meet.
struct SelectedSurface {
  std::vector<Index> points;                       ///< index in TetMesh::points, by vertex
  std::vector<std::array<Index, 3>> triangles;     ///< three vertices each; each triangle except the first of
                                                   ///< a component shares an edge with an earlier one
  std::vector<Index> faces;                        ///< index in TetMesh::faces, by triangle
  std::vector<std::array<Index, 2>> face_regions;  ///< regions behind and in front, by triangle
  struct Edge {
    Index a, b;  ///< vertices
    Tag tag;
  };
  std::vector<Edge> curves;  ///< edges on curves
  std::size_t copied_vertices = 0;
};

/// Selects triangles. Throws OptionError for a selection without triangles.
SelectedSurface select_surface(const TetMesh& mesh, const SurfaceSelection& selection);

/// Returns the selected surface of a tetrahedral mesh as an OpenMesh mesh of any traits. It has the
/// properties of properties.h except `vertex_tag`, and edges on curves have the feature bit in their status.
/// `to_plc` makes a complex of it again: it welds copied vertices and keeps tags. Precondition: the mesh has
/// its boundary triangles, as meshes from `generate` do. Throws OptionError for a selection without
/// triangles.
template <class Mesh>
Mesh boundary_surface(const TetMesh& mesh, const SurfaceSelection& selection = SurfaceSelection::boundary()) {
  const SelectedSurface surface = select_surface(mesh, selection);
  Mesh result;
  result.request_edge_status();
  OpenMesh::FPropHandleT<std::int64_t> patch;
  OpenMesh::EPropHandleT<std::int64_t> curve;
  OpenMesh::FPropHandleT<int> back, front, face_index;
  OpenMesh::VPropHandleT<int> point_index;
  result.add_property(patch, patch_tag);
  result.add_property(curve, curve_tag);
  result.add_property(back, region_back);
  result.add_property(front, region_front);
  result.add_property(face_index, mesh_face);
  result.add_property(point_index, mesh_point);

  using Coordinate = typename Mesh::Point::value_type;
  std::vector<typename Mesh::VertexHandle> vertices;
  for (const Index i : surface.points) {
    const Point& p = mesh.points[i];
    vertices.push_back(result.add_vertex(typename Mesh::Point(
        static_cast<Coordinate>(p.x), static_cast<Coordinate>(p.y), static_cast<Coordinate>(p.z))));
    result.property(point_index, vertices.back()) = static_cast<int>(i);
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const auto face = result.add_face(vertices[a], vertices[b], vertices[c]);
    if (!face.is_valid()) throw Error("OpenMesh refuses triangle " + std::to_string(surface.faces[t]));
    result.property(patch, face) = mesh.face_tag[surface.faces[t]];
    result.property(face_index, face) = static_cast<int>(surface.faces[t]);
    result.property(back, face) = static_cast<int>(surface.face_regions[t][0]);
    result.property(front, face) = static_cast<int>(surface.face_regions[t][1]);
  }
  for (const auto e : result.all_edges()) result.property(curve, e) = 0;
  for (const SelectedSurface::Edge& edge : surface.curves) {
    const auto h = result.find_halfedge(vertices[edge.a], vertices[edge.b]);
    if (!h.is_valid()) continue;
    const auto e = result.edge_handle(h);
    result.property(curve, e) = edge.tag;
    result.status(e).set_feature(true);
  }
  return result;
}

}  // namespace collarmesh::openmesh_io
