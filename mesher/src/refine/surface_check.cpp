// What is looked at when the work queue has run empty: whether the restricted triangles of each
// patch form a manifold that ends at the patch's curves, whether any part of a smooth patch was
// missed, and flat cells. What is wrong goes back into the queue.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "refine/refinement.h"

namespace collarmesh {

namespace {

constexpr unsigned most_rounds = 60;
constexpr std::size_t seeds_per_missed_patch = 8;

// An edge of a patch's triangle, or of a curve that bounds the patch.
struct EdgeUse {
  std::uint64_t edge;  // its two mesh vertices
  Index patch;
  FaceId face;  // or the subsegment

  friend bool operator<(const EdgeUse& a, const EdgeUse& b) {
    if (a.edge != b.edge) return a.edge < b.edge;
    if (a.patch != b.patch) return a.patch < b.patch;
    return a.face < b.face;
  }
  bool same_place(const EdgeUse& other) const { return edge == other.edge && patch == other.patch; }
};

std::uint64_t edge_between(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

bool has_use(const std::vector<EdgeUse>& sorted, const EdgeUse& wanted) {
  const auto first = std::lower_bound(sorted.begin(), sorted.end(), EdgeUse{wanted.edge, wanted.patch, 0});
  return first != sorted.end() && first->same_place(wanted);
}

// By counting the lower ends, then within each.
void sort_by_edge(std::vector<EdgeUse>& uses, std::size_t vertex_count) {
  std::vector<std::size_t> next(vertex_count + 1, 0);
  for (const EdgeUse& use : uses) ++next[(use.edge >> 32) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<EdgeUse> sorted(uses.size());
  for (const EdgeUse& use : uses) sorted[next[use.edge >> 32]++] = use;
  auto first = sorted.begin();
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const auto last = sorted.begin() + static_cast<std::ptrdiff_t>(next[v]);
    std::sort(first, last);
    first = last;
  }
  uses.swap(sorted);
}

}  // namespace

bool Refinement::check_surface() {
  if (!message_.empty()) return false;
  const std::vector<FaceId> faces = marked_faces();
  bool found = check_patch_topology(faces);
  found |= refine_distant_triangles(faces);
  found |= resolve_distant_points(faces);
  found |= check_flat_cells();
  return found && another_surface_round();
}

bool Refinement::another_surface_round() {
  if (++surface_rounds_ <= most_rounds) return true;
  give_up(mesh_.point(last_vertex()),
          fmt::format("the surface did not settle in {} rounds of repairs; the last vertex is", most_rounds),
          "raise distance, or try a smaller size or another seed");
  return false;
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
  t.surface_needs_it = true;
  queue_.push(WorkQueue::unresolved_triangles, t.squared_radius, {face, mesh_.generation(cell_of(face))});
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
bool Refinement::check_patch_topology(const std::vector<FaceId>& faces) {
  std::vector<EdgeUse> uses, on_curves;
  uses.reserve(3 * faces.size());
  for (const FaceId face : faces) {
    const auto v = mesh_.face_vertices(face);
    const Index patch = patch_of(restricted(face));
    for (unsigned i = 0; i < 3; ++i) uses.push_back({edge_between(v[i], v[(i + 1) % 3]), patch, face});
  }
  sort_by_edge(uses, mesh_.vertex_count());
  bool found = false;
  for (Index s = 0; s < subsegments_.size(); ++s) {
    const Subsegment& subsegment = subsegments_[s];
    if (!subsegment.alive) continue;
    for (const Index patch : plc_.curves[subsegment.curve].patches) {
      on_curves.push_back({edge_between(subsegment.ends[0], subsegment.ends[1]), patch, s});
      if (has_use(uses, on_curves.back())) continue;
      encroach(s);
      found = true;
    }
  }
  std::sort(on_curves.begin(), on_curves.end());
  const std::vector<bool> at_collars = vertices_at_collars();
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    for (j = i; j < uses.size() && uses[j].same_place(uses[i]);) ++j;
    if (j - i == 2 || has_use(on_curves, uses[i])) continue;
    // The patch goes on inside a collar.
    if (at_collars[uses[i].edge >> 32] && at_collars[uses[i].edge & 0xffffffff]) continue;
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
bool Refinement::refine_distant_triangles(const std::vector<FaceId>& faces) {
  const double tolerance = distance_ * distance_;
  // Edges found near a patch, of which two triangles share most. What takes a place here is only looked at
  // again.
  struct NearEdge {
    std::uint64_t edge;
    Index patch;
  };
  std::vector<NearEdge> near_edges(std::bit_ceil(faces.size() + 1), {0, none});
  bool found = false;
  for (const FaceId face : faces) {
    RestrictedTriangle& t = restricted(face);
    const Index patch = patch_of(t);
    if (plc_.patches[patch].planar || t.in_collar || t.given_up || t.known_near) continue;
    Index near = t.triangle;  // the next sample is often near the same triangle
    const auto is_near = [&](const Point& p) {
      const Index other = hierarchy_.triangle_within(p, tolerance, near, [&](Index triangle) {
        return triangle < plc_.triangles.size() && plc_.triangles[triangle].patch == patch;
      });
      if (other != none) near = other;
      return other != none;
    };
    const auto v = mesh_.face_vertices(face);
    t.known_near = is_near((mesh_.point(v[0]) + mesh_.point(v[1]) + mesh_.point(v[2])) / 3);
    for (unsigned k = 0; k < 3 && t.known_near; ++k) {
      const std::uint64_t edge = edge_between(v[k], v[(k + 1) % 3]);
      NearEdge& known = near_edges[edge * 0x9e3779b97f4a7c15 >> 32 & (near_edges.size() - 1)];
      if (known.edge == edge && known.patch == patch) continue;
      const Point &a = mesh_.point(v[k]), &b = mesh_.point(v[(k + 1) % 3]);
      t.known_near = is_near((2 * a + b) / 3) && is_near(0.5 * (a + b)) && is_near((a + 2 * b) / 3);
      if (t.known_near) known = {edge, patch};
    }
    if (t.known_near) continue;
    refine_triangle(face);
    found = true;
  }
  return found;
}

// A patch that no triangle was found of: its dual edges cross it back and forth.
void Refinement::seed_missed_patch(Index patch) {
  const std::size_t seeds = seeds_per_missed_patch << std::min(surface_rounds_, 16U);
  for (const Index point : spread_points(patch_points_[patch], points_, seeds))
    add_unresolved(points_[point], 2, patch);
}

void Refinement::prepare_tessellation() {
  for (Index patch = 0; patch < plc_.patches.size(); ++patch) {
    first_tessellation_point_.push_back(tessellation_.size());
    if (plc_.patches[patch].planar) continue;
    for (const Index point : patch_points_[patch])
      if (collars_.ball_containing(points_[point]) == none) tessellation_.push_back({point, no_face, 0});
  }
  first_tessellation_point_.push_back(tessellation_.size());
}

// Is the triangle that the point was near to when last looked at still there?
bool Refinement::still_near(const TessellationPoint& p, Index patch) const {
  if (p.near == no_face) return false;
  const Index cell = cell_of(p.near);
  return mesh_.alive(cell) && mesh_.generation(cell) == p.generation &&
         (labels_[cell].marked >> corner_of(p.near) & 1U) && patch_of(restricted(p.near)) == patch;
}

// A tessellation point of a smooth patch that is farther than the tolerance from the patch's
// triangles becomes an unresolved point: the farthest one at each triangle, so that one insertion
// serves all its neighbours.
bool Refinement::resolve_distant_points(const std::vector<FaceId>& faces) {
  const double tolerance = distance_ * distance_;
  if (first_tessellation_point_.empty()) prepare_tessellation();
  std::vector<std::vector<FaceId>> faces_of(plc_.patches.size());
  for (const FaceId face : faces)
    if (const Index patch = patch_of(restricted(face)); !plc_.patches[patch].planar)
      faces_of[patch].push_back(face);
  std::vector<Point> positions;
  bool found = false;
  for (Index patch = 0; patch < plc_.patches.size(); ++patch) {
    if (plc_.patches[patch].planar) continue;
    if (faces_of[patch].empty()) {
      seed_missed_patch(patch);
      found = true;
      continue;
    }
    std::vector<TessellationPoint*> lost;
    for (std::size_t i = first_tessellation_point_[patch]; i < first_tessellation_point_[patch + 1]; ++i)
      if (!still_near(tessellation_[i], patch)) lost.push_back(&tessellation_[i]);
    if (lost.empty()) continue;
    if (positions.empty())
      for (Index v = 0; v < mesh_.vertex_count(); ++v) positions.push_back(mesh_.point(v));
    std::vector<std::array<Index, 3>> corners;
    for (const FaceId face : faces_of[patch]) corners.push_back(mesh_.face_vertices(face));
    const TriangleHierarchy surface(positions, std::move(corners));
    std::vector<std::pair<double, Index>> farthest(faces_of[patch].size(), {0, none});
    Index near = none;  // the next point is often near the same triangle
    for (TessellationPoint* p : lost) {
      const Point& at = points_[p->point];
      near = surface.triangle_within(at, tolerance, near);
      if (near != none) {
        p->near = faces_of[patch][near];
        p->generation = mesh_.generation(cell_of(p->near));
        continue;
      }
      Index nearest = none;
      const double d = surface.squared_distance_to(at, INFINITY, &nearest);
      if (d > farthest[nearest].first) farthest[nearest] = {d, p->point};
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
    if (!mesh_.alive(cell) || labels_[cell].region == 0 || labels_[cell].marked == 0 ||
        labels_[cell].in_collar || !flat_on_patch(cell))
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
bool Refinement::relabel_flat_cells() {
  bool found = false;
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    if (!mesh_.alive(cell) || labels_[cell].region == 0 || labels_[cell].marked == 0 ||
        labels_[cell].in_collar || !flat_on_patch(cell))
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
    found = true;
  }
  return found;
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
