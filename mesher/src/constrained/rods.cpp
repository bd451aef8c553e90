#include "constrained/rods.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "constrained/rod.h"

namespace collarmesh {

namespace constrained {
namespace {

/// The filling of a rod: numbers its vertices in a mesh, and adds its elements.
class Filling {
 public:
  Filling(const Rod& rod, TetMesh& mesh)
      : rod_(rod), mesh_(mesh), first_(static_cast<Index>(mesh.points.size())) {}

  void run() {
    add_vertices();
    const std::size_t steps = rod_.steps();
    for (std::size_t j = 0; j < steps; ++j) add_between(j);
    for (std::size_t j = rod_.is_loop() ? 0 : 1; j < steps; ++j)
      add_around(axis(j > 0 ? j - 1 : steps - 1), axis(j), j);
    for (std::size_t end = 0; end < rod_.ends().size(); ++end) add_end(end);
  }

 private:
  std::size_t ring_size() const { return rod_.in_ring(); }
  Index at(std::size_t ring, std::size_t k) const {
    const std::size_t n = ring_size();
    if (ring == rod_.rings().size()) return at(0, k + n - rod_.shift());  // a loop ends where it begins
    return first_ + static_cast<Index>(ring * n + k % n);
  }
  Index axis(std::size_t step) const {
    return first_ + static_cast<Index>(rod_.rings().size() * ring_size() + step);
  }
  Index centre(std::size_t end) const { return axis(rod_.steps() + end); }

  void add_vertices() {
    const auto add = [&](const Point& point, const TetMesh::VertexFeature& feature) {
      mesh_.points.push_back(point);
      mesh_.features.push_back(feature);
    };
    for (std::size_t j = 0; j < rod_.rings().size(); ++j)
      for (const Point& point : rod_.rings()[j]) add(point, rod_.feature_of(j, point));
    for (const Point& point : rod_.axis()) add(point, {});
    for (const RodEnd& end : rod_.ends()) add(end.centre, {2, end.patch});
  }

  void add_tet(Index a, Index b, Index c, Index d) {
    mesh_.tets.push_back({a, b, c, d});
    mesh_.tet_region.push_back(rod_.region());
    mesh_.tet_tag.push_back(rod_.plc().regions[rod_.region()].tag);
  }
  void add_face(Index a, Index b, Index c, Index patch) {
    mesh_.faces.push_back({a, b, c});
    mesh_.face_regions.push_back({rod_.region(), 0});
    mesh_.face_patch.push_back(patch);
    mesh_.face_tag.push_back(rod_.plc().patches[patch].tag);
  }

  /// Adds the tets between the faces from one ring to the next and the vertex on the axis between the rings.
  void add_between(std::size_t j) {
    for (std::size_t k = 0; k < ring_size(); ++k) {
      const Index a = at(j, k), b = at(j, k + 1), c = at(j + 1, k), d = at(j + 1, k + 1);
      add_tet(axis(j), a, b, c);
      add_tet(axis(j), b, d, c);
      add_face(a, b, c, rod_.patch_index());
      add_face(b, d, c, rod_.patch_index());
    }
  }
  /// Adds the tets between a ring and a piece of the axis.
  void add_around(Index before, Index after, std::size_t ring) {
    for (std::size_t k = 0; k < ring_size(); ++k) add_tet(before, after, at(ring, k), at(ring, k + 1));
  }
  void add_end(std::size_t end) {
    const auto& [patch, curve, place, outward] = rod_.ends()[end];
    const std::size_t ring = end == 0 ? 0 : rod_.steps();
    const Index inside = axis(end == 0 ? 0 : rod_.steps() - 1);
    add_around(end == 0 ? centre(end) : inside, end == 0 ? inside : centre(end), ring);
    for (std::size_t k = 0; k < ring_size(); ++k) {
      const Index a = at(ring, k), b = at(ring, k + 1);
      add_face(centre(end), end == 0 ? b : a, end == 0 ? a : b, patch);
      mesh_.edges.push_back({a, b});
      mesh_.edge_curve.push_back(curve);
      mesh_.edge_tag.push_back(rod_.plc().curves[curve].tag);
    }
  }

  const Rod& rod_;
  TetMesh& mesh_;
  Index first_;
};

/// Returns the patches of each region; nothing unless each patch lies between a region and the outside, and
/// each curve and vertex lies on a patch.
std::optional<std::vector<std::vector<Index>>> patches_of_bodies(const Plc& plc) {
  std::vector<std::vector<Index>> bodies(plc.regions.size());
  for (Index p = 0; p < plc.patches.size(); ++p) {
    const auto& [behind, before] = plc.patches[p].regions;
    if ((behind == 0) == (before == 0)) return std::nullopt;
    bodies[std::max(behind, before)].push_back(p);
  }
  const auto is_on_patch = [](const auto& feature) { return !feature.patches.empty(); };
  if (!std::ranges::all_of(plc.curves, is_on_patch) || !std::ranges::all_of(plc.vertices, is_on_patch))
    return std::nullopt;
  return bodies;
}

}  // namespace
}  // namespace constrained

std::optional<TetMesh> tetrahedra_of_rods(const Plc& plc, const SurfaceTolerance& tolerance,
                                          const RodLimits& limits, const Execution& execution) {
  using constrained::Rod;
  const auto bodies = constrained::patches_of_bodies(plc);
  if (!bodies) return std::nullopt;
  const auto exceeds = [&](std::size_t vertices) {
    return limits.most_vertices > 0 && vertices > limits.most_vertices;
  };
  std::vector<Rod> rods;
  std::size_t vertices = 0;
  for (Index region = 1; region < bodies->size(); ++region) {
    Rod& rod = rods.emplace_back(plc, tolerance, limits.size, execution, region, (*bodies)[region]);
    if (!rod.begin()) return std::nullopt;
    vertices += rod.fewest_vertices();
  }
  if (exceeds(vertices)) return std::nullopt;
  vertices = 0;
  for (Rod& rod : rods) {
    if (!rod.find_axis() || !rod.find_vertices_around()) return std::nullopt;
    rod.find_spacing();
    vertices += rod.vertices();
    if (exceeds(vertices)) return std::nullopt;
  }
  TetMesh mesh;
  for (Rod& rod : rods) {
    if (!rod.find_rings(0)) return std::nullopt;
    constrained::Filling(rod, mesh).run();
  }
  mesh.tet_collar.assign(mesh.tets.size(), 0);
  mesh.tet_crease.assign(mesh.tets.size(), 0);
  mesh.tet_thin.assign(mesh.tets.size(), 0);
  mesh.names = plc.names;
  return mesh;
}

}  // namespace collarmesh
