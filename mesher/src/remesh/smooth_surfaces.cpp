#include "remesh/smooth_surfaces.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "tolerance/triangle_within_tolerance.h"

namespace collarmesh::remeshing {

namespace {

// A face whose normal has at least this cosine with its patch's normal agrees well enough, even if the old
// faces agree better.
constexpr double enough_agreement = 0.8;

double squared_distance_to(const Point& p, const SmoothSurfaces::Triangle& t) {
  return squared_distance_to_triangle(p, t[0], t[1], t[2]);
}

Vector normal(const SmoothSurfaces::Triangle& t) { return cross(t[1] - t[0], t[2] - t[0]); }

// Returns whether the foot of the perpendicular from p lies in the triangle.
bool has_foot(const Point& p, const SmoothSurfaces::Triangle& t) {
  const Vector n = normal(t);
  if (!(squared_norm(n) > 0)) return false;
  for (unsigned i = 0; i < 3; ++i)
    if (dot(cross(t[(i + 1) % 3] - t[i], p - t[i]), n) < 0) return false;
  return true;
}

// Returns whether the foot of the perpendicular from p lies in the triangle, and p is nearer to its plane
// than the square root of the bound.
bool lies_over(const Point& p, const SmoothSurfaces::Triangle& t, double squared_bound) {
  const Vector n = normal(t);
  const double height = dot(p - t[0], n);
  return height * height < squared_bound * squared_norm(n) && has_foot(p, t);
}

Point centre(const SmoothSurfaces::Triangle& t) { return (t[0] + t[1] + t[2]) / 3; }

}  // namespace

bool SmoothSurfaces::smooth(Index face) const { return is_smooth(mesh_.face_patch[face]); }

SmoothSurfaces::Triangle SmoothSurfaces::corners(Index face) const {
  const auto& v = mesh_.faces[face];
  return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]]};
}

SmoothSurfaces::Surface& SmoothSurfaces::surface(Index patch) const {
  Surface& surface = surfaces_[patch];
  std::call_once(surface.once, [&] {
    surface.triangles = hierarchy_of_patch(plc_, patch);
    share_out(patch, surface);
  });
  return surface;
}

// Makes the corners and centres of the patch's triangles samples, and assigns each to the nearest face or to
// the face of the last sample, if that is near and the sample lies straight above or below it.
void SmoothSurfaces::share_out(Index patch, Surface& surface) const {
  std::vector<Index> faces;
  std::vector<std::array<Index, 3>> corners;
  for (Index f = 0; f < mesh_.faces.size(); ++f)
    if (mesh_.face_patch[f] == patch) {
      faces.push_back(f);
      corners.push_back(mesh_.faces[f]);
    }
  if (faces.empty()) return;
  const TriangleHierarchy hierarchy(mesh_.points, std::move(corners));
  Index nearest = none;  // the face of the last point is tried first
  const auto add = [&](const Point& p, double tolerance) {
    const Index hint = std::exchange(nearest, hierarchy.triangle_within(p, tolerance * tolerance, nearest));
    if (nearest == none) return;  // no face is within the tolerance of p, so it is no sample
    const Triangle found = hierarchy.corners(nearest);
    if (nearest != hint || !has_foot(p, found))
      hierarchy.squared_distance_to(p, squared_distance_to(p, found), &nearest);
    surface.next_sample.push_back(first_sample_[faces[nearest]]);
    first_sample_[faces[nearest]] = static_cast<Index>(surface.samples.size());
    surface.samples.push_back(p);
    if (tolerance_.varies()) surface.squared_tolerances.push_back(tolerance * tolerance);
  };
  const Plc::Patch& p = plc_.patches[patch];
  const std::size_t most = patch_points_[patch].size() + p.triangle_count;
  surface.samples.reserve(most);
  surface.next_sample.reserve(most);
  for (Index t = p.first_triangle; t < p.first_triangle + p.triangle_count; ++t) {
    const auto& v = plc_.triangles[t].points;
    add((plc_.points[v[0]] + plc_.points[v[1]] + plc_.points[v[2]]) / 3, tolerance_.at_triangle(t));
  }
  for (const Index point : patch_points_[patch]) add(plc_.points[point], tolerance_.at_point(point));
}

SmoothSurfaces::Nearest SmoothSurfaces::nearest(Index patch, const Point& p, double near) const {
  const TriangleHierarchy& triangles = this->triangles(patch);
  Index at = none;
  triangles.squared_distance_to(p, near * near, &at);
  if (at == none) triangles.squared_distance_to(p, INFINITY, &at);
  const auto t = triangles.corners(at);
  return {nearest_point_on_triangle(p, t[0], t[1], t[2]), normal(t)};
}

// Returns a triangle of the patch within the tolerance of p (the hint, if it is such a triangle), or none.
Index SmoothSurfaces::triangle_near(Index patch, const Point& p, Index hint) const {
  const Index first = plc_.patches[patch].first_triangle;
  return triangle_within_tolerance(
      triangles(patch), p, tolerance_.least_on_patch(patch), tolerance_.largest_on_patch(patch),
      [&](Index triangle) { return tolerance_.at_triangle(first + triangle); }, hint,
      [](Index) { return true; });
}

// Tests the ends, the thirds and the middle of an edge. If both ends are near the same triangle, so are all
// points between them, because the distance to one triangle is convex.
bool SmoothSurfaces::edge_near(Index patch, const Point& a, const Point& b, Index hint) const {
  const Index near_a = triangle_near(patch, a, hint);
  if (near_a == none) return false;
  const Index near_b = triangle_near(patch, b, near_a);
  if (near_b == none || near_a == near_b) return near_b != none;
  return triangle_near(patch, 0.5 * (a + b), hint) != none &&
         triangle_near(patch, (2 * a + b) / 3, near_a) != none &&
         triangle_near(patch, (a + 2 * b) / 3, near_b) != none;
}

// Tests the edges of the created face i. Skips edges of the old faces, which are as near as before, and edges
// of created faces before i, which have been tested.
bool SmoothSurfaces::edges_near(std::span<const Index> old, std::span<const Face> created, std::size_t i,
                                Index hint) const {
  const auto has_edge = [](const Triangle& t, const Point& a, const Point& b) {
    return std::ranges::find(t, a) != t.end() && std::ranges::find(t, b) != t.end();
  };
  const Triangle& t = created[i].corners;
  const Index patch = created[i].patch;
  for (unsigned k = 0; k < 3; ++k) {
    const Point &a = t[k], &b = t[(k + 1) % 3];
    const bool asked =
        std::any_of(created.begin(), created.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const Face& f) { return f.patch == patch && has_edge(f.corners, a, b); });
    if (!asked &&
        std::ranges::none_of(
            old, [&](Index f) { return mesh_.face_patch[f] == patch && has_edge(corners(f), a, b); }) &&
        !edge_near(patch, a, b, hint))
      return false;
  }
  return true;
}

// Returns the largest squared distance from the patch of a triangle's centre and the middles of its edges.
double SmoothSurfaces::squared_distance(Index patch, const Triangle& t) const {
  double largest = triangles(patch).squared_distance_to(centre(t), INFINITY);
  for (unsigned k = 0; k < 3; ++k)
    largest =
        std::max(largest, triangles(patch).squared_distance_to(0.5 * (t[k] + t[(k + 1) % 3]), INFINITY));
  return largest;
}

// Returns whether each sample of the old faces is near a created face: within the sample's tolerance or the
// bound, whichever is larger.
bool SmoothSurfaces::samples_are_near(std::span<const Index> old, std::span<const Face> created,
                                      double least_squared_bound) const {
  std::size_t last = 0;  // the face of the last sample is tried first
  for (const Index face : old) {
    if (!smooth(face)) continue;
    const Index patch = mesh_.face_patch[face];
    const Surface& of = surface(patch);
    const auto has_face = [&](Index s) {
      const Point& sample = of.samples[s];
      const double squared_bound = std::max(squared_tolerance(of, s), least_squared_bound);
      for (std::size_t tried = 0; tried < created.size(); ++tried) {
        const auto& [t, patch_of_face] = created[last];
        if (patch_of_face == patch && is_within(squared_bound, sample, t[0], t[1], t[2])) return true;
        last = last + 1 < created.size() ? last + 1 : 0;
      }
      return false;
    };
    for (Index s = first_sample_[face]; s != none; s = of.next_sample[s])
      if (!has_face(s)) return false;
  }
  return true;
}

// Returns whether the created faces are accepted beyond the tolerance. If the old faces are beyond it, the
// created ones may be up to the accepted ratio times as far from the patches. Otherwise the created ones must
// agree with the patches and be no farther from them than the old ones, and samples must be near them.
bool SmoothSurfaces::are_excused(std::span<const Index> old, std::span<const Face> created,
                                 bool agree) const {
  double farthest = 0;
  for (const Index face : old)
    if (smooth(face)) farthest = std::max(farthest, squared_distance(mesh_.face_patch[face], corners(face)));
  const bool beyond = farthest > tolerance_.largest() * tolerance_.largest();
  if (!beyond && !agree) return false;
  const double accepted = beyond ? accepted_ratio_ * accepted_ratio_ * farthest : farthest;
  const bool near = std::ranges::all_of(created, [&](const Face& face) {
    return !is_smooth(face.patch) || squared_distance(face.patch, face.corners) <= accepted;
  });
  return near && (beyond || samples_are_near(old, created, accepted));
}

double SmoothSurfaces::agreement(Index patch, const Triangle& t, Index triangle) const {
  const Vector n = normal(t), m = normal(triangles(patch).corners(triangle));
  const double lengths = norm(n) * norm(m);
  return lengths > 0 ? dot(n, m) / lengths : 0;
}

double SmoothSurfaces::worst_agreement(std::span<const Index> faces) const {
  double worst = enough_agreement;
  Index near = none, patch_of_near = none;  // the triangle near the last face is tried first
  for (const Index face : faces) {
    if (!smooth(face)) continue;
    const Triangle t = corners(face);
    const Index patch = mesh_.face_patch[face];
    near = triangle_near(patch, centre(t), patch == patch_of_near ? near : none);
    patch_of_near = patch;
    if (near != none) worst = std::min(worst, agreement(patch, t, near));
  }
  return worst;
}

bool SmoothSurfaces::fit(std::span<const Index> old, std::span<const Face> created,
                         double& agreement_of_old) const {
  std::vector<Index> near;
  const bool agree = centres_agree(old, created, agreement_of_old, near);
  if (agree && fit_within(old, created, near)) return true;
  return accepted_ratio_ > 0 && are_excused(old, created, agree);
}

// Returns whether the centres of the created faces are within the tolerance, and the faces agree with the
// orientation of the patch well enough, or at least as well as the old ones. Sets `near`: by created face a
// triangle of the patch near its centre.
bool SmoothSurfaces::centres_agree(std::span<const Index> old, std::span<const Face> created,
                                   double& agreement_of_old, std::vector<Index>& near) const {
  double least = 1;
  near.assign(created.size(), none);
  for (std::size_t i = 0; i < created.size(); ++i) {
    const auto& [corners, patch] = created[i];
    if (!is_smooth(patch)) continue;
    const bool same = i > 0 && created[i - 1].patch == patch;
    near[i] = triangle_near(patch, centre(corners), same ? near[i - 1] : none);
    if (near[i] == none) return false;
    least = std::min(least, agreement(patch, corners, near[i]));
    if (least >= enough_agreement) continue;
    if (std::isnan(agreement_of_old)) agreement_of_old = worst_agreement(old);
    if (least < agreement_of_old) return false;
  }
  return true;
}

bool SmoothSurfaces::fit_within(std::span<const Index> old, std::span<const Face> created,
                                const std::vector<Index>& near) const {
  if (!samples_are_near(old, created, 0)) return false;
  for (std::size_t i = 0; i < created.size(); ++i)
    if (is_smooth(created[i].patch) && !edges_near(old, created, i, near[i])) return false;
  return true;
}

void SmoothSurfaces::prepare() const {
  for (Index patch = 0; patch < plc_.patches.size(); ++patch)
    if (!plc_.patches[patch].planar) surface(patch);
}

void SmoothSurfaces::begin_trial() {
  on_trial_ = true;
  old_first_samples_.begin();
  old_links_.clear();
}

void SmoothSurfaces::undo() {
  on_trial_ = false;
  old_first_samples_.undo();
  for (auto link = old_links_.rbegin(); link != old_links_.rend(); ++link) *link->first = link->second;
}

void SmoothSurfaces::take_samples(std::span<const Index> faces) {
  moving_.clear();
  for (const Index face : faces) {
    if (!smooth(face)) continue;
    const Index patch = mesh_.face_patch[face];
    for (Index s = first_sample_[face]; s != none; s = surfaces_[patch].next_sample[s])
      moving_.push_back({patch, s});
    old_first_samples_.set(face, none);
  }
}

// Gives each sample to a near face that it lies straight above or below, or else to the nearest face. Tries
// the face of the last sample first, which usually fits.
void SmoothSurfaces::give_samples(std::span<const Index> faces) {
  first_sample_.resize(mesh_.faces.size(), none);
  std::size_t last = 0;
  for (const auto& [patch, s] : moving_) {
    Surface& of = surfaces_[patch];
    const Point& sample = of.samples[s];
    Index nearest = none;
    double least = INFINITY;
    for (std::size_t tried = 0; tried < faces.size();
         ++tried, last = last + 1 < faces.size() ? last + 1 : 0) {
      const Index face = faces[last];
      if (mesh_.face_patch[face] != patch) continue;
      const Triangle t = corners(face);
      if (lies_over(sample, t, squared_tolerance(of, s))) {
        nearest = face;
        break;
      }
      const double d = squared_distance_to(sample, t);
      if (d < least) {
        least = d;
        nearest = face;
      }
    }
    assert(nearest != none);  // some created face is on the same patch as the faces that had the samples
    if (on_trial_) old_links_.emplace_back(&of.next_sample[s], of.next_sample[s]);
    of.next_sample[s] = first_sample_[nearest];
    old_first_samples_.set(nearest, s);
  }
}

}  // namespace collarmesh::remeshing
