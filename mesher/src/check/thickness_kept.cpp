// Compares thickness of walls and width of gaps in the mesh with those of the complex: a thin place of a
// large region may vanish although the region keeps its volume.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "check/mesh_to_check.h"
#include "common/parallel_for.h"
#include "tolerance/thickness.h"

namespace collarmesh::checks {

namespace {

/// The faces of the mesh, curved ones as four flat triangles.
struct Faces {
  std::vector<std::array<Index, 3>> triangles;
  std::vector<Index> face;  ///< by triangle

  explicit Faces(const TetMesh& mesh) {
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      const auto& [a, b, c] = mesh.faces[f];
      if (mesh.order() == 1) {
        add(f, {a, b, c});
        continue;
      }
      const auto& [ab, bc, ca] = mesh.face_mid_nodes[f];
      add(f, {a, ab, ca});
      add(f, {b, bc, ab});
      add(f, {c, ca, bc});
      add(f, {ab, bc, ca});
    }
  }

 private:
  void add(Index of_face, const std::array<Index, 3>& corners) {
    triangles.push_back(corners);
    face.push_back(of_face);
  }
};

/// Sums of thicknesses over rays from one side of a patch, weighted by areas.
struct Thicknesses {
  double area = 0;       // area from which rays were sent
  double area_with = 0;  // part of that area whose rays meet an opposite surface
  double input = 0, mesh = 0;
  Point where;            // start of the ray on which the thickness in the mesh and in the complex differ
                          // most
  double farthest = 0;    // that difference
  Index opposite = none;  // the patch where that ray ends
};

class ThicknessKept {
 public:
  explicit ThicknessKept(const MeshToCheck& to_check)
      : to_check_(to_check),
        thickness_(to_check.plc),
        faces_(to_check.mesh),
        hierarchy_(to_check.mesh.points, faces_.triangles) {}

  void judge(CheckReport& report, Findings& findings) const {
    const std::size_t count = to_check_.plc.patches.size();
    std::vector<std::array<Thicknesses, 2>> sides(count);
    parallel_for(count, [&](std::size_t p) {
      if (to_check_.plc.patches[p].planar) return;
      for (unsigned side = 0; side < 2; ++side) sides[p][side] = along(static_cast<Index>(p), side);
    });
    for (Index p = 0; p < count; ++p)
      for (unsigned side = 0; side < 2; ++side) judge(p, side, sides[p][side], report, findings);
  }

 private:
  static constexpr double allowed = 0.5;       // share of the thickness that may be lost or gained
  static constexpr double least_facing = 0.9;  // cosine of the angle between opposite surfaces; if it is
                                               // less, they meet at an edge or bend away
  // Share of a patch that must face another patch for both to count as sides of a wall. On a smaller share
  // the patches meet in a wedge, whose thickness runs to zero, as where a thread's run-out meets the plane
  // that cuts it.
  static constexpr double least_part = 0.01;
  static constexpr Index most_rays = 2000;  // maximum number for each patch and side

  Thicknesses along(Index patch, unsigned side) const {
    const Plc::Patch& of = to_check_.plc.patches[patch];
    const Index stride = 1 + of.triangle_count / most_rays;
    Thicknesses sums;
    Thickness::Crossings crossings;
    for (Index t = of.first_triangle; t < of.first_triangle + of.triangle_count; t += stride)
      add(t, side, crossings, sums);
    return sums;
  }

  void add(Index triangle, unsigned side, Thickness::Crossings& crossings, Thicknesses& sums) const {
    const Plc& plc = to_check_.plc;
    const Thickness::Ray ray = thickness_.ray(triangle, side);
    const Thickness::Opposite opposite = thickness_.at(triangle, side, crossings).first;
    const Plc::Triangle& t = plc.triangles[triangle];
    const double weight =
        area(to_check_.plc_corner(t, 0), to_check_.plc_corner(t, 1), to_check_.plc_corner(t, 2));
    sums.area += weight;
    if (opposite.triangle == none || opposite.facing < least_facing) return;
    sums.area_with += weight;
    const Index patch = plc.triangles[triangle].patch, other = plc.triangles[opposite.triangle].patch,
                region = plc.patches[patch].regions[side];
    const double found = between(ray, opposite.distance, patch, other, region, crossings);
    if (std::isnan(found)) return;
    sums.input += weight * opposite.distance;
    sums.mesh += weight * found;
    const double off = std::fabs(found - opposite.distance);
    if (off <= sums.farthest) return;
    sums.farthest = off;
    sums.where = ray.from;
    sums.opposite = other;
  }

  /// Returns how far a ray goes through the region in the mesh: from where it enters through faces of `patch`
  /// to where it leaves through faces of `other`. If it enters or leaves several times, takes the entry and
  /// the exit that are nearest to those in the complex. NaN if one of them is missing.
  double between(const Thickness::Ray& ray, double distance, Index patch, Index other, Index region,
                 Thickness::Crossings& crossings) const {
    const TetMesh& mesh = to_check_.mesh;
    const Index root = hierarchy_.root();
    hierarchy_.crossings(ray.from - distance * ray.way, ray.from + 2 * distance * ray.way, {&root, 1},
                         crossings);
    double entered = INFINITY, left = INFINITY;  // differences from the places in the complex
    for (const auto& [triangle, direction] : crossings) {
      const Index face = faces_.face[triangle], of = to_check_.match.face_patch[face];
      const auto& regions = mesh.face_regions[face];
      const Index behind = regions[direction > 0 ? 0 : 1], ahead = regions[direction > 0 ? 1 : 0];
      const double at = place_on(ray, triangle);
      if (of == patch && ahead == region && std::fabs(at) < std::fabs(entered)) entered = at;
      if (of == other && behind == region && std::fabs(at - distance) < std::fabs(left)) left = at - distance;
    }
    return std::isinf(entered) || std::isinf(left) ? NAN : distance + left - entered;
  }

  double place_on(const Thickness::Ray& ray, Index triangle) const {
    const auto [a, b, c] = hierarchy_.corners(triangle);
    const Vector normal = cross(b - a, c - a);
    return dot(a - ray.from, normal) / dot(ray.way, normal);
  }

  void judge(Index patch, unsigned side, const Thicknesses& sums, CheckReport& report,
             Findings& findings) const {
    const Plc& plc = to_check_.plc;
    if (sums.area_with < least_part * sums.area) return;
    if (!(std::fabs(sums.mesh - sums.input) > allowed * sums.input)) return;
    const bool is_gap = plc.patches[patch].regions[side] == 0;
    const std::string found = fmt::format(
        "The {} between patches with tags {} and {}, near ({:.6g}, {:.6g}, {:.6g}), is {:.0f} % {} than in "
        "the input",
        is_gap ? "gap" : "wall", plc.patches[patch].tag, plc.patches[sums.opposite].tag, sums.where.x,
        sums.where.y, sums.where.z, 100 * std::fabs(sums.mesh / sums.input - 1),
        sums.mesh < sums.input ? "thinner" : "thicker");
    if (to_check_.options.bounds.distance <= 0)
      findings.add(guarantee::thickness_kept, sums.where, {patch, sums.opposite},
                   "{}; allowed are {:.0f} %. Ask for a smaller size or distance.", found, 100 * allowed);
    else
      report.warnings.push_back(found + "; a smaller size or distance reduces the difference.");
  }

  const MeshToCheck& to_check_;
  Thickness thickness_;
  Faces faces_;
  TriangleHierarchy hierarchy_;
};

}  // namespace

void check_thickness_kept(const MeshToCheck& to_check, CheckReport& report, Findings& findings) {
  assert(to_check.is_matched());
  const auto& patches = to_check.plc.patches;
  if (std::ranges::all_of(patches, [](const Plc::Patch& patch) { return patch.planar; })) return;
  ThicknessKept(to_check).judge(report, findings);
}

}  // namespace collarmesh::checks
