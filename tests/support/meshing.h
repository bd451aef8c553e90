#pragma once

#include <span>
#include <string>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/mesher.h"
#include "collarmesh/plc_builder.h"

/// Meshes for tests of `generate`: from a soup to a judged mesh.
namespace collarmesh::testing {

struct Meshed {
  Plc plc;
  MeshResult result;
  CheckReport report;
};

/// Builds the complex, meshes it, and checks the mesh against the bounds of the options.
Meshed mesh_of(const Plc& plc, const MeshOptions& options = {});
Meshed mesh_of(const PolygonSoup& soup, const MeshOptions& options = {}, double feature_angle = 30);
Meshed mesh_of(std::span<const PolygonSoup> soups, const MeshOptions& options = {},
               double feature_angle = 30);

/// Returns the faults of a mesh as text: the status if it is not complete, else the first findings of the
/// certificate. Empty if there are none.
std::string faults(const Meshed& meshed);

/// Returns options with this target edge length and a budget of vertices, which ends a run that would not
/// terminate.
MeshOptions with_size(double size, std::size_t max_vertices = 1'000'000);
/// Returns such options with half the default surface distance, for volumes of curved shapes.
MeshOptions with_near_surface(std::span<const PolygonSoup> soups, double size);
/// Returns the bounds of a mesh that is not coarsened: no tet may be thin.
inline Bounds without_thin(double distance = 0) { return {.thin_angle = 0, .distance = distance}; }

/// Returns the circumradius of every tet.
std::vector<double> circumradii(const TetMesh& mesh);
/// Returns the circumradius of a triangle.
double circumradius(const Point& a, const Point& b, const Point& c);

/// Returns whether there is a mesh vertex at exactly this place.
bool has_vertex_at(const TetMesh& mesh, const Point& p);

/// Returns the distance from p to the nearest face of the mesh.
double distance_to_faces(const TetMesh& mesh, const Point& p);

}  // namespace collarmesh::testing
