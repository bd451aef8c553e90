// Checks that every patch is a union of faces: tags, regions, planes, areas and distances.
#include <algorithm>
#include <bit>
#include <cmath>

#include "check/patch_topology.h"
#include "check/polyline.h"
#include "check/subject.h"
#include "common/distance_tree.h"
#include "common/patch_points.h"

namespace collarmesh::checks {

namespace {

// The sides and corners (sides with equal ends) of faces that were seen; a cache, in which new ones replace
// old ones.
class SeenSides {
 public:
  explicit SeenSides(std::size_t faces) : places_(std::bit_ceil(2 * faces + 1), {none, none}) {}

  /// Records a side with sorted ends; returns false if it was seen.
  bool add(const std::array<Index, 2>& side) {
    auto& place = places_[(number_of(side) * 0x9e3779b97f4a7c15 >> 32U) & (places_.size() - 1)];
    if (place == side) return false;
    place = side;
    return true;
  }

 private:
  std::vector<std::array<Index, 2>> places_;
};

class PatchCheck {
 public:
  PatchCheck(const Subject& subject, Index patch, const Index* first, const Index* last, CheckReport& report,
             Findings& findings)
      : subject_(subject),
        id_(patch),
        patch_(subject.plc.patches[patch]),
        faces_(first, last),
        allowed_(subject.patch_allowance[patch]),
        least_allowed_(patch_.planar ? allowed_ : subject.tolerance.least_on_patch(patch) + subject.rounding),
        report_(report),
        findings_(findings) {}

  void run(const CurveUses& uses, std::span<const Index> patch_points) {
    if (faces_.empty()) {
      if (!patch_is_outside(subject_, id_)) report_missing();
      return;
    }
    check_patch_topology(subject_, id_, faces_, uses, findings_);
    if (patch_.planar) {
      check_plane();
      check_area();
    } else {
      check_faces_against_patch();
      check_patch_against_faces(patch_points);
    }
  }

 private:
  const Plc::Triangle& triangle(Index i) const { return subject_.plc.triangles[patch_.first_triangle + i]; }
  std::array<Point, 3> corners(Index face) const {
    const auto& f = subject_.mesh.faces[face];
    return {subject_.point(f[0]), subject_.point(f[1]), subject_.point(f[2])};
  }

  void report_missing() {
    const Point& where = subject_.plc_corner(triangle(0), 0);
    findings_.add(
        guarantee::patch_border, where, {id_},
        "Patch {} (tag {}) at {} has no faces; it was lost, or its faces are tagged with another patch.", id_,
        patch_.tag, At{where});
  }

  void check_plane() {
    for (const Index point : points()) {
      const double off = std::fabs(dot(subject_.point(point) - patch_.origin, patch_.normal));
      if (off > allowed_)
        findings_.add(guarantee::patch_plane, subject_.point(point), {id_, point},
                      "Point {} at {} is {:.6g} off the plane of patch {} (tag {}), allowed is {:.6g}; a "
                      "vertex was moved "
                      "or belongs to another patch.",
                      point, At{subject_.point(point)}, off, id_, patch_.tag, allowed_);
    }
  }

  std::vector<Index> points() const {
    std::vector<Index> points;
    for (const Index f : faces_)
      points.insert(points.end(), subject_.mesh.faces[f].begin(), subject_.mesh.faces[f].end());
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
  }

  // Signed, as seen along the plane's normal.
  double area_in_plane(const Point& a, const Point& b, const Point& c) const {
    return 0.5 * dot(cross(b - a, c - a), patch_.normal);
  }

  // An internal facet may be turned either way.
  void check_area() {
    std::vector<double> areas;
    for (const Index f : faces_) {
      const auto [a, b, c] = corners(f);
      areas.push_back(area_in_plane(a, b, c) * (reversed(subject_, f) ? -1 : 1));
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

  // False when it is turned.
  bool check_fold(Index face, double signed_area) {
    const auto [a, b, c] = corners(face);
    const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
    if (signed_area >= -longest * allowed_) return true;
    const Point where = subject_.centroid(subject_.mesh.faces[face]);
    findings_.add(guarantee::patch_orientation, where, {id_, face},
                  "Face {} at {} is turned against the plane of its patch {} (tag {}): the surface folds "
                  "back on itself "
                  "or the face lists its corners the wrong way round.",
                  face, At{where}, id_, patch_.tag);
    return false;
  }

  // Both areas are those of the projections along the plane's normal, with signs (a turned face has a
  // finding of its own, so here it counts as if it were not turned). Such an area depends on the border
  // alone: it is half the sum of dot(normal, cross(a, b)) over its edges ab, to which each inner edge adds
  // nothing, as its two sides run against each other. How the triangles of a patch that is planar up to a
  // tolerance are tilted, or folded where they are narrower than that, is no part of it. (The triangles' own
  // areas are: tilted by an angle t they exceed their projection by t^2 / 2, relatively, needles by
  // anything.) So the areas differ where the border does: by its length times how far it may move, and by
  // rounding.
  void compare_area(double found) {
    long double sum = 0;
    for (Index i = 0; i < patch_.triangle_count; ++i) {
      const Plc::Triangle& t = triangle(i);
      sum += area_in_plane(subject_.plc_corner(t, 0), subject_.plc_corner(t, 1), subject_.plc_corner(t, 2));
    }
    const double expected = std::fabs(static_cast<double>(sum));
    double allowed = 1e-9 * expected;
    for (const Index c : patch_.curves)
      allowed += subject_.curve_allowance[c] * length(subject_.plc.curves[c]);
    const double difference = found - expected;
    if (std::fabs(difference) <= allowed) return;
    const Point& where = subject_.plc_corner(triangle(0), 0);
    findings_.add(
        guarantee::patch_area, where, {id_},
        "The faces of patch {} (tag {}) at {} have an area of {:.15g}, the patch has {:.15g}; the difference "
        "{:.6g} is above the allowed {:.6g}. Faces are missing or doubled.",
        id_, patch_.tag, At{where}, found, expected, difference, allowed);
  }

  double length(const Plc::Curve& curve) const {
    double sum = 0;
    for (std::size_t i = 1; i < curve.points.size(); ++i)
      sum += distance(subject_.plc.points[curve.points[i - 1]], subject_.plc.points[curve.points[i]]);
    if (curve.closed)
      sum += distance(subject_.plc.points[curve.points.back()], subject_.plc.points[curve.points.front()]);
    return sum;
  }

  // Corners, centres, and two points on each side, each of them once.
  void check_faces_against_patch() {
    std::vector<DistanceTree::Triangle> triangles;
    triangles.reserve(patch_.triangle_count);
    for (Index i = 0; i < patch_.triangle_count; ++i)
      triangles.push_back({subject_.plc_corner(triangle(i), 0), subject_.plc_corner(triangle(i), 1),
                           subject_.plc_corner(triangle(i), 2)});
    const DistanceTree patch(std::move(triangles));
    Index hint = none;
    const auto look_at = [&](Index face, const Point& sample) {
      const auto nearest = patch.nearest(sample, enough(), hint);
      hint = nearest.triangle;
      measure(nearest.distance, subject_.tolerance.at_triangle(patch_.first_triangle + nearest.triangle),
              face, sample, "Face {} of patch {} (tag {}) is {:.6g} away from the patch at {}");
    };
    SeenSides seen(faces_.size());
    for (const Index face : faces_) {
      const auto& f = subject_.mesh.faces[face];
      look_at(face, subject_.centroid(f));
      for (unsigned k = 0; k < 3; ++k) {
        const Point &a = subject_.point(f[k]), &b = subject_.point(f[(k + 1) % 3]);
        if (seen.add({f[k], f[k]})) look_at(face, a);
        if (!seen.add(sorted(f[k], f[(k + 1) % 3]))) continue;
        look_at(face, (2 * a + b) / 3);
        look_at(face, (a + 2 * b) / 3);
      }
    }
  }

  // Corners and centres.
  void check_patch_against_faces(std::span<const Index> patch_points) {
    std::vector<DistanceTree::Triangle> triangles;
    triangles.reserve(faces_.size());
    for (const Index face : faces_) triangles.push_back(corners(face));
    const DistanceTree faces(std::move(triangles));
    Index hint = none;
    const auto look_at = [&](const Point& sample, double tolerance) {
      const auto nearest = faces.nearest(sample, enough(), hint);
      hint = nearest.triangle;
      measure(nearest.distance, tolerance, faces_[nearest.triangle], sample,
              "Face {}, the nearest of patch {} (tag {}), is {:.6g} away from the patch's point at {}");
    };
    for (const Index point : patch_points)
      look_at(subject_.plc.points[point], subject_.tolerance.at_point(point));
    for (Index i = 0; i < patch_.triangle_count; ++i) {
      const Plc::Triangle& t = triangle(i);
      look_at((subject_.plc_corner(t, 0) + subject_.plc_corner(t, 1) + subject_.plc_corner(t, 2)) / 3,
              subject_.tolerance.at_triangle(patch_.first_triangle + i));
    }
  }

  /// Distances below this change neither the maximum nor the verdict.
  double enough() const { return std::fmin(report_.max_surface_distance, least_allowed_); }

  void measure(double distance, double tolerance, Index face, const Point& where,
               fmt::format_string<Index&, Index&, const Tag&, double&, At> what) {
    report_.max_surface_distance = std::fmax(report_.max_surface_distance, distance);
    const double allowed = tolerance + subject_.rounding;
    if (distance <= allowed) return;
    findings_.add(guarantee::patch_distance, where, {id_, face},
                  "{}, allowed is {:.6g}; use a smaller size there or "
                  "allow a larger distance.",
                  fmt::format(what, face, id_, patch_.tag, distance, At{where}), allowed);
  }

  const Subject& subject_;
  Index id_;
  const Plc::Patch& patch_;
  std::vector<Index> faces_;
  double allowed_, least_allowed_;
  CheckReport& report_;
  Findings& findings_;
};

void check_labels(const Subject& subject, Index face, Findings& findings) {
  const TetMesh& mesh = subject.mesh;
  const Index id = subject.match.face_patch[face];
  const Point where = subject.centroid(mesh.faces[face]);
  if (id == none) {
    findings.add(guarantee::patch_tag, where, {face},
                 "Face {} at {} has tag {}, which no patch of the complex has; correct the tag.", face,
                 At{where}, mesh.face_tag[face]);
    return;
  }
  const Plc::Patch& patch = subject.plc.patches[id];
  if (mesh.face_tag[face] != patch.tag)
    findings.add(guarantee::patch_tag, where, {face},
                 "Face {} at {} has tag {}, its patch {} has {}; correct the tag or the patch.", face,
                 At{where}, mesh.face_tag[face], id, patch.tag);
  const auto& regions = mesh.face_regions[face];
  if (regions != patch.regions && !reversed(subject, face))
    findings.add(guarantee::patch_regions, where, {face},
                 "Face {} at {} separates the regions {} and {}, its patch {} (tag {}) separates {} and {}; "
                 "a region is "
                 "wrong or the face belongs to another patch.",
                 face, At{where}, regions[0], regions[1], id, patch.tag, patch.regions[0], patch.regions[1]);
}

}  // namespace

void check_patches(const Subject& subject, CheckReport& report, Findings& findings) {
  for (Index f = 0; f < subject.mesh.faces.size(); ++f) check_labels(subject, f, findings);
  const CurveUses uses(subject);
  const PatchPoints patch_points(subject.plc);
  const Grouping by_patch(subject.match.face_patch, subject.plc.patches.size());
  for (Index p = 0; p < subject.plc.patches.size(); ++p)
    PatchCheck(subject, p, by_patch.begin(p), by_patch.end(p), report, findings).run(uses, patch_points[p]);
}

}  // namespace collarmesh::checks
