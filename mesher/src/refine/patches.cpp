// Patches: the restricted Delaunay triangulation of the mesh to each patch, and the region labels of
// the cells.
#include <algorithm>
#include <cassert>

#include "refine/refinement.h"

namespace collarmesh {

namespace {

constexpr Index unlabelled = none;
constexpr std::size_t seeds_per_closed_patch = 4;
// The cosine between a surface's normal and that of what it faces across a gap; of parts of the surface
// that meet elsewhere only what is almost parallel counts, else the gap would close in a wedge.
constexpr double least_facing = 0.5, least_facing_of_neighbours = 0.966;

bool share(const std::vector<Index>& a, const std::vector<Index>& b) {  // sorted
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (*i == *j) return true;
    *i < *j ? ++i : ++j;
  }
  return false;
}

bool meet(const Plc::Patch& a, const Plc::Patch& b) {
  return share(a.curves, b.curves) || share(a.vertices, b.vertices);
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

// A closed patch has no border to start from: seed it.
void Refinement::prepare_patches() {
  for (Index patch = 0; patch < plc_.patches.size(); ++patch) {
    const Plc::Patch& p = plc_.patches[patch];
    if (!p.curves.empty() || !p.vertices.empty()) continue;
    for (const Index point : spread_points(patch_points_[patch], points_, seeds_per_closed_patch))
      add_unresolved(points_[point], 2, patch);
  }
}

// The box' corners lie outside every region.
void Refinement::label_from_outside(Index cell) {
  const Index root = hierarchy_.root();
  crossings_.clear();
  if (!hierarchy_.empty())
    hierarchy_.crossings(mesh_.point(0), mesh_.circumcentre(cell), {&root, 1}, crossings_);
  labels_[cell].region = region_beyond(0);
}

bool Refinement::on_patch(Index vertex, Index patch) const {
  const MeshVertex& v = vertices_[vertex];
  if (v.dimension == 2) return v.feature == patch;
  if (v.dimension == 1) return plc_.curve_on_patch(v.feature, patch);
  return v.dimension == 0 && plc_.vertex_on_patch(v.feature, patch);
}

// The region at the end of a segment that starts in `region` and has just been intersected
// (crossings_). Each crossing leaves one region and enters another; the one that is entered once
// more than left is where the segment ends, whatever the order of the crossings.
Index Refinement::region_beyond(Index region) const {
  if (crossings_.empty()) return region;
  // The regions that a crossing leaves and enters.
  const auto regions_at = [&](const TriangleHierarchy::Crossing& crossing) {
    auto regions = plc_.patches[plc_.triangles[crossing.triangle].patch].regions;
    if (crossing.direction < 0) std::swap(regions[0], regions[1]);
    return regions;
  };
  if (crossings_.size() == 1) {
    const auto [left, entered] = regions_at(crossings_[0]);
    return left == region ? entered : region;
  }
  std::vector<std::pair<Index, int>> balance{{region, 1}};
  const auto add = [&](Index r, int change) {
    for (auto& [other, count] : balance)
      if (other == r) {
        count += change;
        return;
      }
    balance.push_back({r, change});
  };
  for (const auto& crossing : crossings_) {
    const auto [left, entered] = regions_at(crossing);
    add(entered, 1);
    add(left, -1);
  }
  for (const auto& [r, count] : balance)
    if (count > 0) return r;
  return region;
}

std::span<const Index> Refinement::fewest_nodes(FaceId face) const {
  const auto v = mesh_.face_vertices(face);
  std::span<const Index> best = nodes_of(v[0]);
  for (const Index vertex : {v[1], v[2]})
    if (vertices_[vertex].node_count < best.size()) best = nodes_of(vertex);
  return best;
}

void Refinement::find_crossings(FaceId face, std::span<const Index> nodes) {
  hierarchy_.crossings(mesh_.circumcentre(cell_of(face)), mesh_.circumcentre(cell_of(mesh_.opposite(face))),
                       nodes, crossings_);
}

// Label one of the new cells from across the zone's border, best where no patch can be in between;
// when the zone is the whole box, from the box' corner. Returns its index in the zone.
std::size_t Refinement::first_label() {
  std::size_t seed = zone_.created.size();
  for (std::size_t i = 0; i < zone_.created.size(); ++i) {
    if (zone_.outer[i] == no_face) continue;
    seed = i;
    if (fewest_nodes(zone_.outer[i]).empty()) break;
  }
  if (seed < zone_.created.size()) {
    const FaceId outer = zone_.outer[seed];
    find_crossings(outer, fewest_nodes(outer));
    labels_[zone_.created[seed]].region = region_beyond(labels_[cell_of(outer)].region);
    return seed;
  }
  label_from_outside(zone_.created[0]);
  return 0;
}

// Restricted triangles among the faces between the new cells: their dual edges are those of the new vertex'
// Voronoi cell. What they cross is kept in crossed_faces_ and dual_crossings_.
void Refinement::restrict_created_faces(Index vertex) {
  double largest = 0;
  for (const Index cell : zone_.created) largest = std::max(largest, mesh_.squared_radius(cell));
  dual_edges_.start(mesh_.point(vertex), std::sqrt(largest));
  faces_scratch_.clear();
  for (Index i = 0; i < zone_.created.size(); ++i) {
    const Index cell = zone_.created[i];
    dual_edges_.add_point(mesh_.circumcentre(cell));
    labels_[cell].region = i;  // until it is known
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId face = face_id(cell, corner), other = mesh_.opposite(face);
      if (mesh_.corners(cell)[corner] == vertex || other == no_face) continue;
      const Index j = labels_[cell_of(other)].region;
      if (j >= i) continue;  // its turn comes
      dual_edges_.add_segment(i, j);
      faces_scratch_.push_back(face);
    }
  }
  for (const Index cell : zone_.created) labels_[cell].region = unlabelled;
  hierarchy_.crossings(dual_edges_, nodes_of(vertex), dual_crossings_);
  crossed_faces_.clear();
  for (std::size_t from = 0, to = 0; from < dual_crossings_.size(); from = to) {
    crossings_.clear();
    const Index edge = dual_crossings_[from].segment;
    for (; to < dual_crossings_.size() && dual_crossings_[to].segment == edge; ++to)
      crossings_.push_back(dual_crossings_[to].crossing);
    restrict_face(faces_scratch_[edge]);
    crossed_faces_.push_back({faces_scratch_[edge], from, to});
  }
}

// What the dual edge of a face between new cells crosses on the way out of the face's cell, in crossings_.
void Refinement::recall_crossings(FaceId face) {
  crossings_.clear();
  if (!(labels_[cell_of(face)].marked >> corner_of(face) & 1U)) return;
  const FaceId other = mesh_.opposite(face);
  const auto crossed = std::find_if(crossed_faces_.begin(), crossed_faces_.end(),
                                    [&](const CrossedFace& f) { return f.face == face || f.face == other; });
  for (std::size_t i = crossed->first; i < crossed->end; ++i) {
    auto [triangle, direction] = dual_crossings_[i].crossing;
    crossings_.push_back({triangle, crossed->face == face ? direction : -direction});
  }
}

// Labels of the new cells, and restricted triangles among the faces between them.
void Refinement::label_created_cells(Index vertex) {
  for (const Index cell : zone_.created) labels_[cell] = {.region = unlabelled};
  if (vertices_[vertex].node_count > 0) restrict_created_faces(vertex);
  const std::size_t seed = first_label();
  const Index region = labels_[zone_.created[seed]].region;
  if (vertices_[vertex].node_count == 0) {
    for (const Index cell : zone_.created) labels_[cell].region = region;
    return;
  }
  cells_scratch_.assign(1, zone_.created[seed]);
  while (!cells_scratch_.empty()) {
    const Index cell = cells_scratch_.back();
    cells_scratch_.pop_back();
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId face = face_id(cell, corner), other = mesh_.opposite(face);
      if (mesh_.corners(cell)[corner] == vertex || other == no_face ||
          labels_[cell_of(other)].region != unlabelled)
        continue;
      recall_crossings(face);
      labels_[cell_of(other)].region = region_beyond(labels_[cell].region);
      cells_scratch_.push_back(cell_of(other));
    }
  }
}

// A border face' dual edge has become shorter, so that it crosses what it crossed, or nothing. Does it
// still cross the triangle that it alone crossed, from the one label to the other?
bool Refinement::crosses_as_before(FaceId outer, FaceId face) {
  const RestrictedTriangle& t = restricted(outer);
  // Of a dual edge in the plane of its triangle x may be any point: it is gone when the new vertex has
  // come into the surface gap ball.
  if (t.several_sheets || squared_distance(mesh_.point(last_vertex()), t.x) < t.squared_radius) return false;
  const int direction =
      hierarchy_.crossing(mesh_.circumcentre(cell_of(outer)), mesh_.circumcentre(cell_of(face)), t.triangle);
  if (direction == 0) return false;
  crossings_.assign(1, {t.triangle, direction});
  return region_beyond(labels_[cell_of(outer)].region) == labels_[cell_of(face)].region;
}

// What it alone crossed is beyond the end that is gone: the labels say so, unless the regions on both sides
// of the patch are the same.
bool Refinement::crosses_no_more(FaceId outer, FaceId face) const {
  const RestrictedTriangle& t = restricted(outer);
  const auto& regions = plc_.patches[patch_of(t)].regions;
  return !t.several_sheets && regions[0] != regions[1] &&
         labels_[cell_of(outer)].region == labels_[cell_of(face)].region;
}

// The dual edges of the zone's border faces have become shorter, their ends are rounded anew: look
// again at those that were marked and those whose labels say that they should be.
void Refinement::mark_border_faces() {
  for (std::size_t i = 0; i < zone_.border.size(); ++i) {
    const FaceId outer = zone_.outer[i];
    const FaceId before = zone_.border[i];
    if (outer == no_face) continue;
    labels_[cell_of(outer)].off_collars &= static_cast<std::uint8_t>(~(1U << corner_of(outer)));
    const Index created = zone_.created[i];
    const bool was_marked = labels_[cell_of(outer)].marked >> corner_of(outer) & 1U;
    if (!was_marked && labels_[created].region == labels_[cell_of(outer)].region) continue;
    const FaceId face = face_id(created, corner_of(before));
    if (was_marked && crosses_as_before(outer, face)) {
      labels_[created].marked |= static_cast<std::uint8_t>(1U << corner_of(face));
      marks_[created][corner_of(face)] = marks_[cell_of(outer)][corner_of(outer)];
      restricted(face).judged = false;  // it may have been queued as the destroyed cell's face
      continue;
    }
    const bool known = was_marked && crosses_no_more(outer, face);
    if (was_marked) unmark(outer);
    if (known) continue;
    find_crossings(face, fewest_nodes(face));
    if (!crossings_.empty()) restrict_face(face);
  }
  for (const Index cell : zone_.cells)
    for (unsigned corner = 0; corner < 4; ++corner)
      if (labels_[cell].marked >> corner & 1U) forget_inner_mark(face_id(cell, corner));
  for (const Index cell : zone_.created)
    for (unsigned corner = 0, marked = labels_[cell].marked; marked != 0; ++corner, marked >>= 1) {
      const FaceId face = face_id(cell, corner);
      if ((marked & 1U) && !restricted(face).judged) judge_triangle(face);
    }
}

// Marks of the zone's destroyed cells: the record of a face between two of them is dropped by the
// second; a border face' was dropped or replaced already.
void Refinement::forget_inner_mark(FaceId face) {
  labels_[cell_of(face)].marked &= static_cast<std::uint8_t>(~(1U << corner_of(face)));
  const FaceId other = mesh_.opposite(face);
  if (other == no_face || mesh_.alive(cell_of(other))) return;
  if (!(labels_[cell_of(other)].marked >> corner_of(other) & 1U))
    free_restricted_.push_back(marks_[cell_of(face)][corner_of(face)]);
}

// Drop the mark on the cell's side that is alive; the record goes with it.
void Refinement::unmark(FaceId face) {
  labels_[cell_of(face)].marked &= static_cast<std::uint8_t>(~(1U << corner_of(face)));
  free_restricted_.push_back(marks_[cell_of(face)][corner_of(face)]);
}

void Refinement::restrict_face(FaceId face) {
  Index record;
  if (free_restricted_.empty()) {
    record = static_cast<Index>(restricted_.size());
    restricted_.emplace_back();
  } else {
    record = free_restricted_.back();
    free_restricted_.pop_back();
  }
  for (const FaceId side : {face, mesh_.opposite(face)}) {
    labels_[cell_of(side)].marked |= static_cast<std::uint8_t>(1U << corner_of(side));
    marks_[cell_of(side)][corner_of(side)] = record;
  }
  const auto v = mesh_.face_vertices(face);
  const Point& corner = mesh_.point(v[0]);
  RestrictedTriangle& t = restricted_[record];
  t = {};
  t.several_sheets = crossings_.size() > 1;
  t.squared_radius = -1;
  for (const auto& crossing : crossings_) {
    const Point x = crossing_point(face, crossing.triangle);
    const double r2 = squared_distance(x, corner);
    if (r2 <= t.squared_radius) continue;
    t.x = x;
    t.squared_radius = r2;
    t.triangle = crossing.triangle;
  }
  const Index patch = patch_of(t);
  t.resolved_vertices = on_patch(v[0], patch) && on_patch(v[1], patch) && on_patch(v[2], patch);
  if (t.resolved_vertices && plc_.patches[patch].planar && !t.several_sheets) {
    // A needle's circumcentre is noise; the crossing is not.
    const Point centre = triangle_circumcentre(face);
    if (squared_distance(centre, t.x) < 0.01 * t.squared_radius) {
      t.x = centre;
      t.squared_radius = squared_distance(t.x, corner);
    }
  }
  t.in_collar = vertices_[v[0]].near_collar && collars_.ball_containing(t.x) != none;
}

Point Refinement::crossing_point(FaceId face, Index triangle) const {
  const Point& p = mesh_.circumcentre(cell_of(face));
  const Point& q = mesh_.circumcentre(cell_of(mesh_.opposite(face)));
  const auto t = hierarchy_.corners(triangle);
  const Vector n = cross(t[1] - t[0], t[2] - t[0]);
  const double hp = dot(p - t[0], n), hq = dot(q - t[0], n);
  const double share = hp == hq ? 0.5 : std::clamp(hp / (hp - hq), 0.0, 1.0);
  // A dual edge almost in the triangle's plane crosses it, but where is noise: not beside it.
  return nearest_point_on_triangle(p + share * (q - p), t[0], t[1], t[2]);
}

Point Refinement::triangle_circumcentre(FaceId face) const {
  const auto v = mesh_.face_vertices(face);
  const Point& a = mesh_.point(v[0]);
  const Vector u = mesh_.point(v[1]) - a, w = mesh_.point(v[2]) - a;
  const Vector n = cross(u, w);
  const double nn = squared_norm(n);
  if (nn == 0) return crossing_point(face, restricted(face).triangle);
  return a + (squared_norm(w) * cross(n, u) + squared_norm(u) * cross(w, n)) / (2 * nn);
}

void Refinement::judge_triangle(FaceId face) {
  RestrictedTriangle& t = restricted(face);
  t.judged = true;
  if (t.in_collar) return;
  const WorkQueue::Entry entry{face, mesh_.generation(cell_of(face))};
  if (!t.resolved_vertices || t.several_sheets || too_far(face, t))
    queue_.push(WorkQueue::unresolved_triangles, t.squared_radius, entry);
  else if (too_large(face, t))
    queue_.push(WorkQueue::large_triangles, t.squared_radius, entry);
}

bool Refinement::too_large(FaceId face, const RestrictedTriangle& t) {
  const auto corners = mesh_.face_vertices(face);
  double size = sizing_.triangle_size(patch_of(t), t.triangle, t.x);
  if (const double widest = sizing_.widest_gap(size); widest > 0)
    size = std::min(size, sizing_.gap_size(gap_at(t, widest)));
  const double reach = std::sqrt(t.squared_radius);
  if (gradation_ > 0)
    for (const Index v : corners) target_size_[v] = std::min(target_size_[v], size + gradation_ * reach);
  size = std::min(size, graded_size(corners, reach));
  const double radius = Sizing::triangle_radius(size);
  return t.squared_radius > radius * radius;
}

// How far is the surface that faces this one across a region, if not farther than `widest`?
double Refinement::gap_at(const RestrictedTriangle& t, double widest) {
  const auto corners = hierarchy_.corners(t.triangle);
  Vector normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  normal = normal / norm(normal);
  const Plc::Patch& patch = plc_.patches[patch_of(t)];
  double gap = widest;
  for (unsigned side = 0; side < 2; ++side) {
    if (patch.regions[side] == 0) continue;
    const Vector way = side == 0 ? -1 * normal : normal;
    const Index root = hierarchy_.root();
    // Not from the plane of its own triangle: that would be one tie after the other.
    hierarchy_.crossings(t.x + 1e-6 * widest * way, t.x + widest * way, {&root, 1}, crossings_);
    for (const auto& [triangle, direction] : crossings_) {
      const Index other = plc_.triangles[triangle].patch;
      const auto c = hierarchy_.corners(triangle);
      const Vector n = cross(c[1] - c[0], c[2] - c[0]);
      const double towards = dot(n, way);
      const bool same = other == patch_of(t);
      if (same && dot(n, normal) > 0) continue;
      const bool neighbours = same || meet(patch, plc_.patches[other]);
      if (std::fabs(towards) < (neighbours ? least_facing_of_neighbours : least_facing) * norm(n)) continue;
      gap = std::min(gap, dot(c[0] - t.x, n) / towards);
    }
  }
  return gap;
}

// On a smooth patch: is the triangle's circumcentre farther from the surface than the tolerance?
bool Refinement::too_far(FaceId face, const RestrictedTriangle& t) const {
  if (plc_.patches[patch_of(t)].planar) return false;
  return squared_distance(triangle_circumcentre(face), t.x) > distance_ * distance_;
}

}  // namespace collarmesh
