#include "refine/surface_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <tuple>

#include "common/edge_key.h"
#include "common/flat_table.h"
#include "common/found_in_ranges.h"
#include "common/sort_by_vertex.h"
#include "tolerance/triangle_within_tolerance.h"

namespace collarmesh {

namespace {

constexpr unsigned most_rounds = 240;  // sheets of one patch near each other settle slowly
// A cell may be flat except for rounding if six times its volume is at most this share of its longest edge
// cubed.
constexpr double rounded_volume = 1e-13;
constexpr std::size_t seeds_per_closed_patch = 4, seeds_per_missed_patch = 8;

// An edge of a patch's triangle, or of a curve that bounds the patch.
struct EdgeUse {
  std::uint64_t edge;  // its two mesh vertices
  Index patch;
  FaceId face;  // the triangle's face, or the subsegment

  friend bool operator<(const EdgeUse& a, const EdgeUse& b) {
    return std::tie(a.edge, a.patch, a.face) < std::tie(b.edge, b.patch, b.face);
  }
  bool same_place(const EdgeUse& other) const { return edge == other.edge && patch == other.patch; }
};

bool has_use(const std::vector<EdgeUse>& sorted, const EdgeUse& wanted) {
  const auto first = std::lower_bound(sorted.begin(), sorted.end(), EdgeUse{wanted.edge, wanted.patch, 0});
  return first != sorted.end() && first->same_place(wanted);
}

}  // namespace

std::vector<Index> spread_points(std::span<const Index> candidates, const std::vector<Point>& points,
                                 std::size_t count) {
  std::vector<Index> chosen{candidates[0]};
  std::vector<double> gap(candidates.size(), INFINITY);
  while (chosen.size() < std::min(count, candidates.size())) {
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      gap[i] = std::min(gap[i], squared_distance(points[candidates[i]], points[chosen.back()]));
      if (gap[i] > gap[farthest]) farthest = i;
    }
    if (gap[farthest] == 0) break;
    chosen.push_back(candidates[farthest]);
  }
  return chosen;
}

void SurfaceCheck::seed_closed_patches() {
  for (Index patch = 0; patch < domain_.plc.patches.size(); ++patch) {
    const Plc::Patch& p = domain_.plc.patches[patch];
    if (!p.curves.empty() || !p.vertices.empty()) continue;
    for (const Index point :
         spread_points(domain_.patch_points[patch], domain_.points, seeds_per_closed_patch))
      seed(patch, domain_.points[point]);
  }
}

bool SurfaceCheck::check() {
  if (outcome_.given_up()) return false;
  const std::vector<FaceId> faces = surface_.marked_faces();
  bool found = check_patch_topology(faces);
  found |= refine_distant_triangles(faces);
  found |= resolve_distant_points(faces);
  found |= check_flat_cells();
  return found && another_round();
}

bool SurfaceCheck::another_round() {
  if (++rounds_ <= most_rounds) return true;
  outcome_.give_up(
      mesh_.point(mesh_.last_vertex()),
      fmt::format("the surface still had to be repaired after {} rounds of repairs; the last vertex is",
                  most_rounds),
      "raise distance, or try a smaller size or another seed");
  return false;
}

// Returns which mesh vertices belong to a cell inside the collars.
std::vector<bool> SurfaceCheck::vertices_at_collars() const {
  std::vector<bool> at(mesh_.vertex_count(), false);
  if (collars_.empty()) return at;
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell)
    if (mesh_.alive(cell) && collar_cells_.inside(cell))
      for (const Index v : mesh_.corners(cell)) at[v] = true;
  return at;
}

// Checks that every edge of a patch's triangles lies in two of them or on one of the patch's curves, and that
// every subsegment has triangles of all the patches that its curve bounds.
bool SurfaceCheck::check_patch_topology(const std::vector<FaceId>& faces) {
  std::vector<EdgeUse> uses, on_curves;
  uses.reserve(3 * faces.size());
  for (const FaceId face : faces) {
    const auto v = mesh_.face_vertices(face);
    const Index patch = surface_.patch(face);
    for (unsigned i = 0; i < 3; ++i) uses.push_back({edge_key(v[i], v[(i + 1) % 3]), patch, face});
  }
  sort_by_vertex(uses, mesh_.vertex_count(), [](const EdgeUse& use) { return use.edge >> 32; });
  bool found = false;
  curves_.visit([&](Index s, const Subsegment& subsegment) {
    for (const Index patch : domain_.plc.curves[subsegment.curve].patches) {
      on_curves.push_back({edge_key(subsegment.ends[0], subsegment.ends[1]), patch, s});
      if (has_use(uses, on_curves.back())) continue;
      curves_.encroach(s);
      found = true;
    }
  });
  std::sort(on_curves.begin(), on_curves.end());
  const std::vector<bool> at_collars = vertices_at_collars();
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    for (j = i; j < uses.size() && uses[j].same_place(uses[i]);) ++j;
    if (j - i == 2 || has_use(on_curves, uses[i])) continue;
    // The patch continues inside a collar, so there are no triangles to count.
    if (at_collars[uses[i].edge >> 32] && at_collars[uses[i].edge & 0xffffffff]) continue;
    std::size_t largest = i;
    for (std::size_t k = i; k < j; ++k)
      if (surface_.triangle(uses[k].face).squared_radius >
          surface_.triangle(uses[largest].face).squared_radius)
        largest = k;
    triangles_.split(uses[largest].face);
    found = true;
  }
  return found;
}

// Returns whether p is within the tolerance of the patch. The search starts at triangle `near`; sets `near`
// to the triangle found within the tolerance.
bool SurfaceCheck::is_near_patch(const Point& p, Index patch, Index& near) const {
  const SurfaceTolerance& tolerance = domain_.tolerance;
  const Index found = triangle_within_tolerance(
      nodes_.hierarchy(), p, tolerance.least_on_patch(patch), tolerance.largest_on_patch(patch),
      [&](Index triangle) { return tolerance.at_triangle(triangle); }, near,
      [&](Index triangle) {
        return triangle < domain_.plc.triangles.size() && domain_.plc.triangles[triangle].patch == patch;
      });
  if (found != none) near = found;
  return found != none;
}

// Queues triangles on smooth patches whose edges or middle leave the patch by more than the tolerance.
bool SurfaceCheck::refine_distant_triangles(const std::vector<FaceId>& faces) {
  // A cache of edges that were found to be near a patch, as two triangles share most edges. An edge whose
  // entry was replaced is tested again.
  struct NearEdge {
    std::uint64_t edge;
    Index patch;
  };
  std::vector<NearEdge> near_edges(std::bit_ceil(faces.size() + 1), {0, none});
  bool found = false;
  for (const FaceId face : faces) {
    const RestrictedTriangle& t = surface_.triangle(face);
    const TriangleNotes& notes = surface_.notes(face);
    const Index patch = surface_.patch(face);
    if (domain_.plc.patches[patch].planar || t.in_collar || notes.given_up || notes.known_near) continue;
    Index near = t.triangle;  // try first the triangle of the last sample
    const auto is_near = [&](const Point& p) { return is_near_patch(p, patch, near); };
    const auto v = mesh_.face_vertices(face);
    bool near_there = is_near((mesh_.point(v[0]) + mesh_.point(v[1]) + mesh_.point(v[2])) / 3);
    for (unsigned k = 0; k < 3 && near_there; ++k) {
      const std::uint64_t edge = edge_key(v[k], v[(k + 1) % 3]);
      NearEdge& known = near_edges[spread(edge) & (near_edges.size() - 1)];
      if (known.edge == edge && known.patch == patch) continue;
      const Point &a = mesh_.point(v[k]), &b = mesh_.point(v[(k + 1) % 3]);
      near_there = is_near((2 * a + b) / 3) && is_near(0.5 * (a + b)) && is_near((a + 2 * b) / 3);
      if (near_there) known = {edge, patch};
    }
    if (near_there) {
      surface_.note_known_near(face);
      continue;
    }
    triangles_.split(face);
    found = true;
  }
  return found;
}

// Seeds a patch for which no triangle was found, because dual edges cross it back and forth.
void SurfaceCheck::seed_missed_patch(Index patch) {
  const std::size_t seeds = seeds_per_missed_patch << std::min(rounds_, 16U);
  for (const Index point : spread_points(domain_.patch_points[patch], domain_.points, seeds))
    seed(patch, domain_.points[point]);
}

// Adds a point of a patch as an unresolved point. Where the patch faces another sheet, a vertex of the patch
// may be at the point already, up to rounding; because of `apart` it takes the point's place.
void SurfaceCheck::seed(Index patch, const Point& at) {
  points_.add({.point = at, .feature = {2, patch}, .apart = domain_.floor_at(at)}, none);
}

void SurfaceCheck::prepare_tessellation() {
  for (Index patch = 0; patch < domain_.plc.patches.size(); ++patch) {
    first_tessellation_point_.push_back(tessellation_.size());
    const Plc::Patch& p = domain_.plc.patches[patch];
    if (p.planar) continue;
    const auto add = [&](const Point& at, double tolerance) {
      if (collars_.ball_containing(at) == none) tessellation_.push_back({at, tolerance});
    };
    for (const Index point : domain_.patch_points[patch])
      add(domain_.points[point], domain_.tolerance.at_point(point));
    for (Index t = p.first_triangle; t < p.first_triangle + p.triangle_count; ++t) {
      const auto& [a, b, c] = domain_.plc.triangles[t].points;
      add((domain_.points[a] + domain_.points[b] + domain_.points[c]) / 3, domain_.tolerance.at_triangle(t));
    }
  }
  first_tessellation_point_.push_back(tessellation_.size());
}

// Returns whether the face that the point was near to at the last check is still a triangle of the patch.
bool SurfaceCheck::still_near(const TessellationPoint& p, Index patch) const {
  if (p.near == no_face) return false;
  const Index cell = cell_of(p.near);
  return mesh_.alive(cell, p.generation) && surface_.is_marked(p.near) && surface_.patch(p.near) == patch;
}

// Brings the surface nearer to a point of a patch; `nearest` is the patch's nearest triangle in the mesh.
void SurfaceCheck::resolve(const TessellationPoint& p, Index patch, FaceId nearest) {
  constexpr double same_place = 0.1;  // share of the tolerance
  const Index vertex = mesh_.nearest_vertex(p.at, mesh_.face_vertices(nearest)[0]);
  const double apart = same_place * p.tolerance;
  // If the vertex is not on the surface yet, a second vertex beside it would not be on the surface either.
  if (distance(mesh_.point(vertex), p.at) < apart)
    triangles_.split(nearest);
  else
    points_.add({.point = p.at, .feature = {2, patch}, .apart = apart}, vertex);
}

// Finds the tessellation points of smooth patches that are farther from the patch's restricted triangles than
// the tolerance. Resolves only the farthest one at each triangle, because one insertion also brings the
// surface nearer to the points around.
bool SurfaceCheck::resolve_distant_points(const std::vector<FaceId>& faces) {
  if (first_tessellation_point_.empty()) prepare_tessellation();
  std::vector<std::vector<FaceId>> faces_of(domain_.plc.patches.size());
  for (const FaceId face : faces)
    if (const Index patch = surface_.patch(face); !domain_.plc.patches[patch].planar)
      faces_of[patch].push_back(face);
  std::vector<Point> positions;
  bool found = false;
  for (Index patch = 0; patch < domain_.plc.patches.size(); ++patch) {
    if (domain_.plc.patches[patch].planar) continue;
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
    struct Farthest {
      double squared_distance = 0;
      const TessellationPoint* point = nullptr;
    };
    std::vector<Farthest> farthest(faces_of[patch].size());
    Index near = none;  // try first the triangle of the last point
    for (TessellationPoint* p : lost) {
      near = surface.triangle_within(p->at, p->tolerance * p->tolerance, near);
      if (near != none) {
        p->near = faces_of[patch][near];
        p->generation = mesh_.generation(cell_of(p->near));
        continue;
      }
      Index nearest = none;
      const double d = surface.squared_distance_to(p->at, INFINITY, &nearest);
      if (d > farthest[nearest].squared_distance) farthest[nearest] = {d, p};
    }
    for (Index i = 0; i < farthest.size(); ++i) {
      if (farthest[i].point == nullptr) continue;
      resolve(*farthest[i].point, patch, faces_of[patch][i]);
      found = true;
    }
  }
  return found;
}

// Returns the cells in regions and outside the collars whose vertices all lie on features: they may be flat
// on a patch.
std::vector<Index> SurfaceCheck::cells_on_surface() const {
  return found_in_ranges<Index>(mesh_.cell_capacity(), [&](std::size_t i, std::vector<Index>& cells) {
    const auto cell = static_cast<Index>(i);
    if (!mesh_.alive(cell) || surface_.region(cell) == 0 || collar_cells_.inside(cell)) return;
    const auto& corners = mesh_.corners(cell);
    if (std::ranges::all_of(corners, [&](Index v) { return mesh_.feature(v).dimension < 3; }))
      cells.push_back(cell);
  });
}

// Returns whether a cell is flat on a patch. Precondition: it is one of `cells_on_surface`.
bool SurfaceCheck::flat_on_patch(Index cell) const {
  assert(mesh_.alive(cell));
  const auto& corners = mesh_.corners(cell);
  const bool without_volume = has_no_volume(cell);
  bool found = false;
  surface_.visit_marked(cell, [&](FaceId face) {
    const Index patch = surface_.patch(face);
    found = found || ((domain_.plc.patches[patch].planar || without_volume) &&
                      std::ranges::all_of(corners, [&](Index v) { return mesh_.on_patch(v, patch); }));
  });
  return found;
}

// Returns whether a cell has no volume except by rounding. Such cells arise where vertices that face each
// other on two curves of a smooth patch form rectangles; two of their faces then lie on the patch.
bool SurfaceCheck::has_no_volume(Index cell) const {
  if (std::popcount(surface_.marked(cell)) != 2) return false;
  const auto& v = mesh_.corners(cell);
  const Point &a = mesh_.point(v[0]), &b = mesh_.point(v[1]), &c = mesh_.point(v[2]), &d = mesh_.point(v[3]);
  const double longest =
      std::sqrt(std::max({squared_distance(a, b), squared_distance(a, c), squared_distance(a, d),
                          squared_distance(b, c), squared_distance(b, d), squared_distance(c, d)}));
  return std::fabs(six_volume(a, b, c, d)) <= rounded_volume * longest * longest * longest;
}

// Returns whether the face lies on the domain's boundary: one region beside it is the outside.
bool SurfaceCheck::at_boundary(FaceId face) const {
  const auto& regions = domain_.plc.patches[surface_.patch(face)].regions;
  return regions[0] != regions[1] && (regions[0] == 0 || regions[1] == 0);
}

// Queues a triangle of each cell that is flat on a patch between two regions or inside one, because the cell
// cannot stay there. relabel_flat_cells handles flat cells at the domain's boundary.
bool SurfaceCheck::check_flat_cells() {
  bool found = false;
  for (const Index cell : cells_on_surface()) {
    if (!flat_on_patch(cell)) continue;
    FaceId inside = no_face;
    surface_.visit_marked(cell, [&](FaceId face) {
      if (inside == no_face && !at_boundary(face) && !surface_.notes(face).given_up) inside = face;
    });
    if (inside == no_face) continue;
    triangles_.split(inside);
    found = true;
  }
  return found;
}

// Gives flat cells just inside a boundary facet to the outside. Four cocircular vertices can form such a
// cell.
bool SurfaceCheck::relabel_flat_cells() {
  bool found = false;
  for (const Index cell : cells_on_surface()) {
    if (!flat_on_patch(cell)) continue;
    bool boundary = false;
    surface_.visit_marked(cell, [&](FaceId face) { boundary = at_boundary(face); });
    if (!boundary) continue;
    surface_.give_outside(cell);
    found = true;
  }
  return found;
}

}  // namespace collarmesh
