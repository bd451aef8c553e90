#pragma once

#include <span>
#include <string>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/mesher.h"
#include "collarmesh/plc_builder.h"

/// The way from a soup to a judged mesh, as every test of `generate` takes it.
namespace collarmesh::testing {

struct Meshed {
  Plc plc;
  MeshResult result;
  CheckReport report;
};

/// Build the complex, mesh it, and check the mesh against the bounds of the options.
Meshed mesh_of(const Plc& plc, const MeshOptions& options = {});
Meshed mesh_of(const PolygonSoup& soup, const MeshOptions& options = {}, double feature_angle = 30);
Meshed mesh_of(std::span<const PolygonSoup> soups, const MeshOptions& options = {},
               double feature_angle = 30);

/// What is wrong with it in words: the status if it is not complete, else the first findings of the
/// certificate. Empty when all is right.
std::string faults(const Meshed& meshed);

/// The options with this target edge length and a budget of vertices, which ends a run that would not end.
MeshOptions with_size(double size, std::size_t max_vertices = 1'000'000);
/// The same with half the default surface distance, for volumes of curved shapes.
MeshOptions with_near_surface(std::span<const PolygonSoup> soups, double size);
/// The bounds of a mesh that is not coarsened: no tet may be thin.
inline Bounds without_thin(double distance = 0) { return {.thin_angle = 0, .distance = distance}; }

/// Circumradius of every tet.
std::vector<double> circumradii(const TetMesh& mesh);
/// Circumradius of a triangle.
double circumradius(const Point& a, const Point& b, const Point& c);

/// Is there a mesh vertex at exactly this place?
bool has_vertex_at(const TetMesh& mesh, const Point& p);

/// Distance from p to the nearest face of the mesh.
double distance_to_faces(const TetMesh& mesh, const Point& p);

}  // namespace collarmesh::testing
