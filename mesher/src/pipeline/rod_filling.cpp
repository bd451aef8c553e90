#include "pipeline/rod_filling.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "collarmesh/plc_builder.h"
#include "constrained/constrained_tetrahedra.h"

namespace collarmesh::pipeline {

namespace {

using Corners = std::array<Index, 3>;

/// The complex of a gap: the walls of the cavity, the skin of the sheath, and the parts of planar patches
/// between these.
class GapComplex {
 public:
  GapComplex(const Plc& plc, const TetMesh& mesh, const SheathedRod& rod, const RodCavity& cavity)
      : plc_(plc), mesh_(mesh), rod_(rod), cavity_(cavity) {
    gap_.regions = plc.regions;
  }

  std::optional<RodFilling> fill(const Execution& execution) {
    for (const Corners& corners : rod_.skin) add_facet(corners, true, {0, rod_.around});
    for (const auto& [corners, region] : cavity_.walls()) add_facet(corners, false, {region, 0});
    for (const auto& [host, edges] : cavity_.outlines()) add_plane(host, plane_between(host, edges));
    made_.gap = constrained_tetrahedra(gap_, execution).mesh;
    if (made_.gap.tets.empty()) return std::nullopt;
    require_undivided();
    made_.tets = cavity_.tets();
    made_.faces = cavity_.faces();
    return std::move(made_);
  }

 private:
  /// Adds a triangle as a patch of its own, so that it stays as it is.
  void add_facet(const Corners& corners, bool is_of_rod, const std::array<Index, 2>& regions) {
    const auto patch = static_cast<Index>(gap_.patches.size());
    Plc::Patch& added = gap_.patches.emplace_back();
    added.first_triangle = static_cast<Index>(gap_.triangles.size());
    added.triangle_count = 1;
    added.regions = regions;
    made_.hosts.push_back(none);
    Corners points{};
    for (unsigned i = 0; i < 3; ++i) points[i] = point_of(corners[i], is_of_rod);
    gap_.triangles.push_back({points, patch});
  }
  Index point_of(Index vertex, bool is_of_rod) {
    const Point& p = (is_of_rod ? rod_.mesh : mesh_).points[vertex];
    const auto next = static_cast<Index>(gap_.points.size());
    const RodFilling::Origin origin{is_of_rod, vertex, next};
    const Index number = made_.origins.try_emplace({p.x, p.y, p.z}, origin).first->second.number;
    if (number == next) gap_.points.push_back(p);
    return number;
  }

  /// Returns a complex of the part of a host's plane between the cavity's outline (`edges`) and the sheath's
  /// rims.
  Plc plane_between(Index host, const RodCavity::Edges& edges) const {
    PolygonSoup soup;
    soup.begin_facet();
    const auto add_loop = [&](const std::vector<Index>& loop, const TetMesh& of) {
      std::vector<Index> corners;
      for (const Index v : loop) {
        corners.push_back(static_cast<Index>(soup.points.size()));
        soup.points.push_back(of.points[v]);
      }
      soup.add_polygon(corners);
    };
    for (const std::vector<Index>& loop : loops_of(edges)) add_loop(loop, mesh_);
    for (const SheathedRod::End& end : rod_.ends) {
      if (end.host != host) continue;
      add_loop(end.rim, rod_.mesh);
      Point centre{};
      for (const Index v : end.rim) centre = centre + rod_.mesh.points[v];
      soup.facet_holes.push_back({0, centre / static_cast<double>(end.rim.size())});
    }
    PlcOptions options;
    options.require_solid = false;
    return build_plc(std::vector{soup}, options);
  }
  /// Returns the loops of vertices that directed edges form. Throws NoRoom if two edges begin at one vertex.
  static std::vector<std::vector<Index>> loops_of(const RodCavity::Edges& edges) {
    std::map<Index, Index> after;
    for (const auto& [a, b] : edges)
      if (!after.emplace(a, b).second) throw NoRoom();
    std::vector<std::vector<Index>> loops;
    while (!after.empty()) {
      std::vector<Index>& loop = loops.emplace_back();
      for (auto at = after.begin(); at != after.end();) {
        loop.push_back(at->first);
        const Index next = at->second;
        after.erase(at);
        at = after.find(next);
      }
    }
    return loops;
  }
  void add_plane(Index host, const Plc& plane) {
    const Plc::Patch& patch = plc_.patches[host];
    const bool is_solid_behind = patch.regions[0] != 0;
    const auto number = static_cast<Index>(gap_.patches.size());
    Plc::Patch& added = gap_.patches.emplace_back();
    added.first_triangle = static_cast<Index>(gap_.triangles.size());
    added.triangle_count = static_cast<Index>(plane.triangles.size());
    added.planar = true;
    added.normal = is_solid_behind ? patch.normal : -1 * patch.normal;
    added.origin = patch.origin;
    added.regions = {patch.regions[is_solid_behind ? 0 : 1], 0};
    made_.hosts.push_back(host);
    const auto& p = gap_.points;
    for (const Plc::Triangle& t : plane.triangles) {
      Corners corners{};
      for (unsigned i = 0; i < 3; ++i) {
        const RodFilling::Origin* const origin = made_.origin_of(plane.points[t.points[i]]);
        if (origin == nullptr) throw NoRoom();
        corners[i] = origin->number;
      }
      if (dot(cross(p[corners[1]] - p[corners[0]], p[corners[2]] - p[corners[0]]), added.normal) < 0)
        std::swap(corners[1], corners[2]);
      gap_.triangles.push_back({corners, number});
    }
  }

  /// Throws NoRoom if a triangle of the walls or of the skin was divided, because it no longer fits the tets
  /// on its other side.
  void require_undivided() const {
    std::vector<unsigned> times(made_.hosts.size(), 0);
    for (const Index patch : made_.gap.face_patch) ++times[patch];
    for (std::size_t patch = 0; patch < times.size(); ++patch)
      if (made_.hosts[patch] == none && times[patch] != 1) throw NoRoom();
  }

  const Plc& plc_;
  const TetMesh& mesh_;
  const SheathedRod& rod_;
  const RodCavity& cavity_;
  Plc gap_;
  RodFilling made_;
};

}  // namespace

std::optional<RodFilling> fill_cavity(const Plc& plc, MeshAroundRods& around, Index rod, double room,
                                      const Execution& execution) {
  const RodCavity cavity(around, rod, room);
  return GapComplex(plc, around.mesh, around.rods[rod], cavity).fill(execution);
}

}  // namespace collarmesh::pipeline
