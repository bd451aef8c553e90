#include "support/meshing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "location/triangle_hierarchy.h"

namespace collarmesh::testing {

namespace {

std::string_view name_of(MeshStatus status) {
  switch (status) {
    case MeshStatus::complete: return "complete";
    case MeshStatus::guarantee_missed: return "guarantee missed";
    case MeshStatus::budget_hit: return "budget hit";
    case MeshStatus::cancelled: return "cancelled";
  }
  return "?";
}

}  // namespace

Meshed mesh_of(const Plc& plc, const MeshOptions& options) {
  Meshed meshed{plc, generate(plc, options), {}};
  meshed.report = check(meshed.result.mesh, plc, {.bounds = options.bounds, .findings_per_guarantee = 2});
  return meshed;
}

Meshed mesh_of(const PolygonSoup& soup, const MeshOptions& options, double feature_angle) {
  return mesh_of({&soup, 1}, options, feature_angle);
}

Meshed mesh_of(std::span<const PolygonSoup> soups, const MeshOptions& options, double feature_angle) {
  PlcOptions plc_options;
  plc_options.feature_angle = feature_angle;
  return mesh_of(build_plc(soups, plc_options), options);
}

std::string faults(const Meshed& meshed) {
  std::string text;
  if (meshed.result.status != MeshStatus::complete)
    text = fmt::format("{}: {}\n", name_of(meshed.result.status), meshed.result.message);
  if (meshed.result.status == MeshStatus::budget_hit || meshed.result.status == MeshStatus::cancelled)
    return text;
  for (const Finding& f : meshed.report.findings) text += fmt::format("{}: {}\n", f.guarantee, f.message);
  return text;
}

MeshOptions with_size(double size, std::size_t max_vertices) {
  MeshOptions options;
  options.size = size;
  options.max_vertices = max_vertices;
  return options;
}

MeshOptions with_near_surface(std::span<const PolygonSoup> soups, double size) {
  Box bounds;
  for (const PolygonSoup& soup : soups)
    for (const Point& p : soup.points) bounds.add(p);
  MeshOptions options = with_size(size);
  options.bounds.distance = 0.5 * default_distance(size, bounds.diagonal());
  return options;
}

std::vector<double> circumradii(const TetMesh& mesh) {
  std::vector<double> radii;
  for (const auto& t : mesh.tets) {
    const Point& o = mesh.points[t[0]];
    const Vector a = mesh.points[t[1]] - o, b = mesh.points[t[2]] - o, c = mesh.points[t[3]] - o;
    const Vector centre =
        squared_norm(a) * cross(b, c) + squared_norm(b) * cross(c, a) + squared_norm(c) * cross(a, b);
    radii.push_back(norm(centre) / (2 * std::fabs(dot(a, cross(b, c)))));
  }
  return radii;
}

double circumradius(const Point& a, const Point& b, const Point& c) {
  return distance(a, b) * distance(b, c) * distance(c, a) / (2 * norm(cross(b - a, c - a)));
}

bool has_vertex_at(const TetMesh& mesh, const Point& p) {
  return std::find(mesh.points.begin(), mesh.points.end(), p) != mesh.points.end();
}

double distance_to_faces(const TetMesh& mesh, const Point& p) {
  double nearest = INFINITY;
  for (const auto& f : mesh.faces)
    nearest = std::min(
        nearest, squared_distance_to_triangle(p, mesh.points[f[0]], mesh.points[f[1]], mesh.points[f[2]]));
  return std::sqrt(nearest);
}

}  // namespace collarmesh::testing
