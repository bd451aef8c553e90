// Checks that every patch is a union of faces: tags, regions, planes, areas and distances.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "check/feature_sizes.h"
#include "check/mesh_to_check.h"
#include "check/patch_topology.h"
#include "check/polyline.h"
#include "check/predicates.h"
#include "common/patch_distance.h"
#include "common/patch_points.h"
#include "common/sort_uniquely.h"

namespace collarmesh::checks {

namespace {

class PatchCheck {
 public:
  PatchCheck(const MeshToCheck& to_check, Index patch, const Index* first, const Index* last,
             CheckReport& report, Findings& findings)
      : to_check_(to_check),
        id_(patch),
        patch_(to_check.plc.patches[patch]),
        faces_(first, last),
        allowed_(to_check.patch_allowance[patch]),
        least_allowed_(patch_.planar ? allowed_
                                     : to_check.tolerance.least_on_patch(patch) + to_check.rounding),
        report_(report),
        findings_(findings) {}

  void run(const CurveUses& uses, std::span<const Index> patch_points) {
    if (faces_.empty()) {
      if (!patch_is_outside(to_check_, id_)) report_missing();
      return;
    }
    check_patch_topology(to_check_, id_, faces_, uses, findings_);
    if (patch_.planar) {
      check_plane();
      check_area();
    } else {
      check_distances(patch_points);
    }
  }

 private:
  const Plc::Triangle& triangle(Index i) const { return to_check_.plc.triangles[patch_.first_triangle + i]; }
  std::array<Point, 3> corners(Index face) const {
    const auto& f = to_check_.mesh.faces[face];
    return {to_check_.point(f[0]), to_check_.point(f[1]), to_check_.point(f[2])};
  }

  void report_missing() {
    const Point& where = to_check_.plc_corner(triangle(0), 0);
    findings_.add(
        guarantee::patch_border, where, {id_},
        "Patch {} (tag {}) at {} has no faces; it was lost, or its faces are tagged with another patch.", id_,
        patch_.tag, At{where});
  }

  void check_plane() {
    for (const Index point : points()) {
      const double off = std::fabs(dot(to_check_.point(point) - patch_.origin, patch_.normal));
      if (off > allowed_)
        findings_.add(guarantee::patch_plane, to_check_.point(point), {id_, point},
                      "Point {} at {} is {:.6g} off the plane of patch {} (tag {}), allowed is {:.6g}; a "
                      "vertex was moved "
                      "or belongs to another patch.",
                      point, At{to_check_.point(point)}, off, id_, patch_.tag, allowed_);
    }
  }

  std::vector<Index> points() const {
    std::vector<Index> points;
    for (const Index f : faces_)
      points.insert(points.end(), to_check_.mesh.faces[f].begin(), to_check_.mesh.faces[f].end());
    sort_uniquely(points);
    return points;
  }

  // Returns the signed area of a triangle, projected along the plane's normal.
  double area_in_plane(const Point& a, const Point& b, const Point& c) const {
    return 0.5 * dot(cross(b - a, c - a), patch_.normal);
  }

  // Compares the area of the faces with the patch's. The faces of an internal patch may all be turned over.
  void check_area() {
    std::vector<double> areas;
    for (const Index f : faces_) {
      const auto [a, b, c] = corners(f);
      areas.push_back(area_in_plane(a, b, c) * (reversed(to_check_, f) ? -1 : 1));
    }
    const bool turned = patch_.regions[0] == patch_.regions[1] &&
                        std::count_if(areas.begin(), areas.end(), [](double a) { return a < 0; }) * 2 >
                            static_cast<std::ptrdiff_t>(areas.size());
    long double found = 0;
    for (std::size_t i = 0; i < areas.size(); ++i) {
      const double area = turned ? -areas[i] : areas[i];
      found += check_fold(faces_[i], area) ? area : std::fabs(area);
    }
    compare_area(static_cast<double>(found));
  }

  // Returns false, with a finding, if the face is turned against the plane by more than the allowed distance
  // from the plane can cause.
  bool check_fold(Index face, double signed_area) {
    const auto [a, b, c] = corners(face);
    const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
    if (signed_area >= -longest * allowed_) return true;
    const Point where = to_check_.centroid(to_check_.mesh.faces[face]);
    findings_.add(guarantee::patch_orientation, where, {id_, face},
                  "Face {} at {} is turned against the plane of its patch {} (tag {}): the surface folds "
                  "back on itself "
                  "or the face lists its corners the wrong way round.",
                  face, At{where}, id_, patch_.tag);
    return false;
  }

  // Compares `found`, the sum of signed areas projected along the plane's normal, with the complex. (A turned
  // face has a finding of its own, so its area counts as positive here.)
  void compare_area(double found) {
    const auto [expected, allowed] = planar_area(to_check_, id_);
    check_measure(area_of_patch, {"patch", id_, patch_.tag}, to_check_.plc_corner(triangle(0), 0), found,
                  expected, allowed, findings_);
  }

  void check_distances(std::span<const Index> patch_points) {
    PatchDistance(to_check_.mesh, to_check_.plc, to_check_.tolerance, id_, faces_, patch_points)
        .visit([&] { return enough(); },
               [&](const PatchDistance::Sample& sample, bool on_face) { measure(sample, on_face); });
  }

  /// Returns a bound: samples with a smaller distance need not be measured exactly, because they change
  /// neither the largest distance nor the verdict.
  double enough() const { return std::fmin(report_.max_surface_distance, least_allowed_); }

  void measure(const PatchDistance::Sample& sample, bool on_face) {
    report_.max_surface_distance = std::fmax(report_.max_surface_distance, sample.distance);
    const double allowed = sample.tolerance + to_check_.rounding;
    if (sample.distance <= allowed) return;
    const std::string what =
        on_face
            ? fmt::format("Face {} of patch {} (tag {}) is {:.6g} away from the patch at {}", sample.face,
                          id_, patch_.tag, sample.distance, At{sample.place})
            : fmt::format(
                  "The point of patch {} (tag {}) at {} is {:.6g} away from the patch's nearest mesh face, "
                  "face {}",
                  id_, patch_.tag, At{sample.place}, sample.distance, sample.face);
    findings_.add(guarantee::patch_distance, sample.place, {id_, sample.face},
                  "{}, allowed is {:.6g}; use a smaller size there or allow a larger distance.", what,
                  allowed);
  }

  const MeshToCheck& to_check_;
  Index id_;
  const Plc::Patch& patch_;
  std::vector<Index> faces_;
  double allowed_, least_allowed_;
  CheckReport& report_;
  Findings& findings_;
};

void check_labels(const MeshToCheck& to_check, Index face, Findings& findings) {
  const TetMesh& mesh = to_check.mesh;
  const Index id = to_check.match.face_patch[face];
  const Point where = to_check.centroid(mesh.faces[face]);
  if (id == none) {
    findings.add(guarantee::patch_tag, where, {face},
                 "Face {} at {} has tag {}, which no patch of the complex has; correct the tag.", face,
                 At{where}, mesh.face_tag[face]);
    return;
  }
  const Plc::Patch& patch = to_check.plc.patches[id];
  if (mesh.face_tag[face] != patch.tag)
    findings.add(guarantee::patch_tag, where, {face},
                 "Face {} at {} has tag {}, but its patch {} has tag {}; correct the tag or the patch.", face,
                 At{where}, mesh.face_tag[face], id, patch.tag);
  const auto& regions = mesh.face_regions[face];
  if (regions != patch.regions && !reversed(to_check, face))
    findings.add(
        guarantee::patch_regions, where, {face},
        "Face {} at {} separates the regions {} and {}, but its patch {} (tag {}) separates {} and {}; "
        "a region is wrong or the face belongs to another patch.",
        face, At{where}, regions[0], regions[1], id, patch.tag, patch.regions[0], patch.regions[1]);
}

}  // namespace

void check_patches(const MeshToCheck& to_check, CheckReport& report, Findings& findings) {
  assert(to_check.is_matched());
  for (Index f = 0; f < to_check.mesh.faces.size(); ++f) check_labels(to_check, f, findings);
  const CurveUses uses(to_check);
  const PatchPoints patch_points(to_check.plc);
  const Grouping by_patch(to_check.match.face_patch, to_check.plc.patches.size());
  for (Index p = 0; p < to_check.plc.patches.size(); ++p)
    PatchCheck(to_check, p, by_patch.begin(p), by_patch.end(p), report, findings).run(uses, patch_points[p]);
}

}  // namespace collarmesh::checks
