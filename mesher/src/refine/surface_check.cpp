// What is looked at when the work queue has run empty: whether the restricted triangles of each
// patch form a manifold that ends at the patch's curves, whether any part of a smooth patch was
// missed, and flat cells (DESIGN sections 7 and 11). What is wrong goes back into the queue.
#include <fmt/format.h>

#include <algorithm>

#include "refine/refinement.h"

namespace collarmesh {

namespace {

constexpr unsigned most_rounds = 60;
constexpr std::size_t seeds_per_missed_patch = 8;

struct EdgeUse {
  Index patch;
  std::array<Index, 2> edge;
  FaceId face;

  friend bool operator<(const EdgeUse& a, const EdgeUse& b) {
    if (a.patch != b.patch) return a.patch < b.patch;
    if (a.edge != b.edge) return a.edge < b.edge;
    return a.face < b.face;
  }
};

std::array<Index, 2> sorted(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

bool Refinement::check_surface() {
  if (!message_.empty()) return false;
  const bool found = check_patch_topology() | check_patch_distance() | check_flat_cells();
  if (found && ++surface_rounds_ > most_rounds) {
    give_up(points_[plc_.triangles[0].points[0]],
            fmt::format("the surface did not settle in {} rounds; the first point of the input is",
                        most_rounds));
    return false;
  }
  return found;
}

std::vector<FaceId> Refinement::marked_faces() const {
  std::vector<FaceId> faces;
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    if (!mesh_.alive(cell)) continue;
    for (unsigned corner = 0, marked = labels_[cell].marked; marked != 0; ++corner, marked >>= 1) {
      const FaceId face = face_id(cell, corner);
      if ((marked & 1U) && cell < cell_of(mesh_.opposite(face))) faces.push_back(face);
    }
  }
  return faces;
}

void Refinement::refine_triangle(FaceId face) {
  RestrictedTriangle& t = restricted(face);
  if (t.given_up) return;
  queue_.push(WorkQueue::unresolved_triangles, t.squared_radius,
              {face, mesh_.generation(cell_of(face))});
}

// Which mesh vertices belong to a cell inside the collars.
std::vector<bool> Refinement::vertices_at_collars() const {
  std::vector<bool> at(mesh_.vertex_count(), false);
  if (collars_.empty()) return at;
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell)
    if (mesh_.alive(cell) && labels_[cell].in_collar)
      for (const Index v : mesh_.corners(cell)) at[v] = true;
  return at;
}

// Every edge of a patch's triangles lies in two of them, or on one of the patch's curves; every
// subsegment has triangles of all the patches that its curve bounds.
bool Refinement::check_patch_topology() {
  std::vector<EdgeUse> uses;
  for (const FaceId face : marked_faces()) {
    const auto v = mesh_.face_vertices(face);
    const Index patch = patch_of(restricted(face));
    for (unsigned i = 0; i < 3; ++i) uses.push_back({patch, sorted(v[i], v[(i + 1) % 3]), face});
  }
  std::sort(uses.begin(), uses.end());
  std::vector<EdgeUse> on_curves;
  const std::vector<bool> at_collars = vertices_at_collars();
  bool found = false;
  for (Index s = 0; s < subsegments_.size(); ++s) {
    const Subsegment& subsegment = subsegments_[s];
    if (!subsegment.alive) continue;
    const auto edge = sorted(subsegment.ends[0], subsegment.ends[1]);
    for (const Index patch : plc_.curves[subsegment.curve].patches) {
      on_curves.push_back({patch, edge, s});
      const auto first = std::lower_bound(uses.begin(), uses.end(), EdgeUse{patch, edge, 0});
      if (first != uses.end() && first->patch == patch && first->edge == edge) continue;
      encroach(s);
      found = true;
    }
  }
  std::sort(on_curves.begin(), on_curves.end());
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    for (j = i; j < uses.size() && uses[j].patch == uses[i].patch && uses[j].edge == uses[i].edge;) ++j;
    if (j - i == 2) continue;
    const auto curve = std::lower_bound(on_curves.begin(), on_curves.end(),
                                        EdgeUse{uses[i].patch, uses[i].edge, 0});
    if (curve != on_curves.end() && curve->patch == uses[i].patch && curve->edge == uses[i].edge)
      continue;
    // The patch goes on inside a collar.
    const auto at_collar = [&](Index v) { return at_collars[v]; };
    if (std::all_of(uses[i].edge.begin(), uses[i].edge.end(), at_collar)) continue;
    std::size_t largest = i;
    for (std::size_t k = i; k < j; ++k)
      if (restricted(uses[k].face).squared_radius > restricted(uses[largest].face).squared_radius)
        largest = k;
    refine_triangle(uses[largest].face);
    found = true;
  }
  return found;
}

// Triangles on smooth patches whose edges or middle leave the patch by more than the tolerance.
bool Refinement::refine_distant_triangles() {
  const double tolerance = distance_ * distance_;
  bool found = false;
  for (const FaceId face : marked_faces()) {
    const RestrictedTriangle& t = restricted(face);
    const Index patch = patch_of(t);
    if (plc_.patches[patch].planar || t.in_collar || t.given_up) continue;
    const auto v = mesh_.face_vertices(face);
    const Point &a = mesh_.point(v[0]), &b = mesh_.point(v[1]), &c = mesh_.point(v[2]);
    const std::array<Point, 10> samples{
        (a + b + c) / 3, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (2 * a + b) / 3, (a + 2 * b) / 3,
        (2 * b + c) / 3, (b + 2 * c) / 3, (2 * c + a) / 3, (c + 2 * a) / 3};
    const bool distant = std::any_of(samples.begin(), samples.end(), [&](const Point& p) {
      return hierarchy_.squared_distance_to(p, tolerance, nullptr, [&](Index triangle) {
        return plc_.triangles[triangle].patch == patch;
      }) >= tolerance;
    });
    if (!distant) continue;
    refine_triangle(face);
    found = true;
  }
  return found;
}

// A tessellation point of a smooth patch that is farther than the tolerance from the patch's
// triangles becomes an unresolved point: the farthest one at each triangle, so that one insertion
// serves all its neighbours.
bool Refinement::check_patch_distance() {
  std::vector<std::vector<std::array<Index, 3>>> triangles(plc_.patches.size());
  for (const FaceId face : marked_faces()) {
    const Index patch = patch_of(restricted(face));
    if (!plc_.patches[patch].planar) triangles[patch].push_back(mesh_.face_vertices(face));
  }
  std::vector<Point> positions;
  bool found = refine_distant_triangles();
  for (Index patch = 0; patch < plc_.patches.size(); ++patch) {
    const Plc::Patch& p = plc_.patches[patch];
    if (p.planar) continue;
    const auto triangle_count = triangles[patch].size();
    if (triangle_count == 0) {  // missed as a whole: its dual edges cross it back and forth
      const std::size_t seeds = seeds_per_missed_patch << std::min(surface_rounds_, 16U);
      for (const Index point : spread_points(tessellation_points(p), points_, seeds))
        add_unresolved(points_[point], 2, patch);
      found = true;
      continue;
    }
    if (positions.empty())
      for (Index v = 0; v < mesh_.vertex_count(); ++v) positions.push_back(mesh_.point(v));
    const TriangleHierarchy surface(positions, std::move(triangles[patch]));
    std::vector<std::pair<double, Index>> farthest(triangle_count + 1, {0, none});
    for (const Index point : tessellation_points(p)) {
      auto nearest = static_cast<Index>(triangle_count);
      const double d = surface.squared_distance_to(points_[point], INFINITY, &nearest);
      if (d > distance_ * distance_ && collars_.ball_containing(points_[point]) == none && d > farthest[nearest].first) farthest[nearest] = {d, point};
    }
    for (const auto& [d, point] : farthest) {
      if (point == none) continue;
      add_unresolved(points_[point], 2, patch);
      found = true;
    }
  }
  return found;
}

bool Refinement::flat_on_patch(Index cell) const {
  for (const Index v : mesh_.corners(cell))
    if (vertices_[v].dimension == 3) return false;
  for (unsigned corner = 0; corner < 4; ++corner) {
    if (!(labels_[cell].marked >> corner & 1U)) continue;
    const Index patch = patch_of(restricted(face_id(cell, corner)));
    const auto& v = mesh_.corners(cell);
    if (plc_.patches[patch].planar && on_patch(v[0], patch) && on_patch(v[1], patch) &&
        on_patch(v[2], patch) && on_patch(v[3], patch))
      return true;
  }
  return false;
}

// A cell with all vertices on one planar patch cannot stay between two regions or inside one: its
// centre goes in. At a domain boundary relabel_flat_cells sees to it.
bool Refinement::check_flat_cells() {
  bool found = false;
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    if (!mesh_.alive(cell) || labels_[cell].region == 0 || labels_[cell].marked == 0 || labels_[cell].in_collar ||
        !flat_on_patch(cell))
      continue;
    for (unsigned corner = 0; corner < 4; ++corner) {
      if (!(labels_[cell].marked >> corner & 1U)) continue;
      const FaceId face = face_id(cell, corner);
      const auto& regions = plc_.patches[patch_of(restricted(face))].regions;
      if (regions[0] != regions[1] && (regions[0] == 0 || regions[1] == 0)) continue;
      if (restricted(face).given_up) continue;
      refine_triangle(face);
      found = true;
      break;
    }
  }
  return found;
}

// Four cocircular vertices of a boundary facet can make a flat cell just inside: it belongs outside.
void Refinement::relabel_flat_cells() {
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    if (!mesh_.alive(cell) || labels_[cell].region == 0 || labels_[cell].marked == 0 || labels_[cell].in_collar ||
        !flat_on_patch(cell))
      continue;
    RestrictedTriangle record;
    bool boundary = false;
    for (unsigned corner = 0; corner < 4; ++corner) {
      if (!(labels_[cell].marked >> corner & 1U)) continue;
      record = restricted(face_id(cell, corner));
      const auto& regions = plc_.patches[patch_of(record)].regions;
      boundary = regions[0] != regions[1] && (regions[0] == 0 || regions[1] == 0);
    }
    if (!boundary) continue;
    labels_[cell].region = 0;
    for (unsigned corner = 0; corner < 4; ++corner) toggle_mark(face_id(cell, corner), record);
  }
}

void Refinement::toggle_mark(FaceId face, const RestrictedTriangle& record) {
  const FaceId other = mesh_.opposite(face);
  const bool marked = labels_[cell_of(face)].marked >> corner_of(face) & 1U;
  if (marked) {
    unmark(face);
    labels_[cell_of(other)].marked &= static_cast<std::uint8_t>(~(1U << corner_of(other)));
    return;
  }
  restricted_.push_back(record);
  for (const FaceId side : {face, other}) {
    labels_[cell_of(side)].marked |= static_cast<std::uint8_t>(1U << corner_of(side));
    marks_[cell_of(side)][corner_of(side)] = static_cast<Index>(restricted_.size() - 1);
  }
}

}  // namespace collarmesh
