// The restricted Delaunay triangulation of the mesh to each patch, and the region labels of the cells.
#include "refine/restricted_surface.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/found_in_ranges.h"

namespace collarmesh {

namespace {

constexpr Index unlabelled = none;

}  // namespace

std::vector<FaceId> RestrictedSurface::marked_faces() const {
  return found_in_ranges<FaceId>(mesh_.cell_capacity(), [&](std::size_t i, std::vector<FaceId>& faces) {
    const auto cell = static_cast<Index>(i);
    if (!mesh_.alive(cell)) return;
    visit_marked(cell, [&](FaceId face) {
      if (cell < cell_of(mesh_.opposite(face))) faces.push_back(face);
    });
  });
}

// Labels a cell by the patches between its circumcentre and a corner of the box, which lies outside every
// region.
void RestrictedSurface::label_from_outside(Index cell, Workspace& w) {
  w.crossings_.clear();
  if (!nodes_.hierarchy().empty()) nodes_.crossings(mesh_.point(0), mesh_.circumcentre(cell), w.crossings_);
  labels_[cell].region = region_beyond(0, w);
}

// Returns the region at the end of a segment that starts in `region` and has just been intersected
// (crossings_). Each crossing leaves one region and enters another; the segment ends in the region that is
// entered once more than left, whatever the order of the crossings.
Index RestrictedSurface::region_beyond(Index region, const Workspace& w) const {
  if (w.crossings_.empty()) return region;
  // Returns the regions that a crossing leaves and enters.
  const auto regions_at = [&](const TriangleHierarchy::Crossing& crossing) {
    auto regions = domain_.plc.patches[domain_.plc.triangles[crossing.triangle].patch].regions;
    if (crossing.direction < 0) std::swap(regions[0], regions[1]);
    return regions;
  };
  if (w.crossings_.size() == 1) {
    const auto [left, entered] = regions_at(w.crossings_[0]);
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
  for (const auto& crossing : w.crossings_) {
    const auto [left, entered] = regions_at(crossing);
    add(entered, 1);
    add(left, -1);
  }
  for (const auto& [r, count] : balance)
    if (count > 0) return r;
  return region;
}

// Labels one of the new cells from across the zone's border, preferably where no patch can be in between. If
// the zone fills the whole box, starts from the box's corner. Returns the cell's index in `created`.
std::size_t RestrictedSurface::first_label(const ConflictZone& zone, Workspace& w) {
  std::size_t seed = zone.created.size();
  for (std::size_t i = 0; i < zone.created.size(); ++i) {
    if (zone.outer[i] == no_face) continue;
    seed = i;
    if (nodes_.fewest(zone.outer[i]).empty()) break;
  }
  if (seed < zone.created.size()) {
    const FaceId outer = zone.outer[seed];
    nodes_.crossings_of_dual_edge(outer, w.crossings_);
    labels_[zone.created[seed]].region = region_beyond(labels_[cell_of(outer)].region, w);
    return seed;
  }
  label_from_outside(zone.created[0], w);
  return 0;
}

// Finds restricted triangles among the faces between the new cells. The dual edges of these faces are edges
// of the new vertex's Voronoi cell. Stores their crossings in crossed_faces_ and dual_crossings_.
void RestrictedSurface::restrict_created_faces(const ConflictZone& zone, Index vertex, Workspace& w) {
  double largest = 0;
  for (const Index cell : zone.created) largest = std::max(largest, mesh_.squared_radius(cell));
  w.dual_edges_.start(mesh_.point(vertex), std::sqrt(largest));
  w.faces_.clear();
  for (Index i = 0; i < zone.created.size(); ++i) {
    const Index cell = zone.created[i];
    w.dual_edges_.add_point(mesh_.circumcentre(cell));
    labels_[cell].region = i;  // a temporary label
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId face = face_id(cell, corner), other = mesh_.opposite(face);
      if (mesh_.corners(cell)[corner] == vertex || other == no_face) continue;
      const Index j = labels_[cell_of(other)].region;
      if (j >= i) continue;  // each pair is handled once
      w.dual_edges_.add_segment(i, j);
      w.faces_.push_back(face);
    }
  }
  for (const Index cell : zone.created) labels_[cell].region = unlabelled;
  nodes_.hierarchy().crossings(w.dual_edges_, nodes_.at(vertex), w.dual_crossings_);
  w.crossed_faces_.clear();
  for (std::size_t from = 0, to = 0; from < w.dual_crossings_.size(); from = to) {
    w.crossings_.clear();
    const Index edge = w.dual_crossings_[from].segment;
    for (; to < w.dual_crossings_.size() && w.dual_crossings_[to].segment == edge; ++to)
      w.crossings_.push_back(w.dual_crossings_[to].crossing);
    restrict_face(w.faces_[edge], w);
    w.crossed_faces_.push_back({w.faces_[edge], from, to});
  }
}

// Puts the crossings of the dual edge of a face between new cells into crossings_, in the direction out of
// the face's cell.
void RestrictedSurface::recall_crossings(FaceId face, Workspace& w) const {
  w.crossings_.clear();
  if (!is_marked(face)) return;
  const FaceId other = mesh_.opposite(face);
  const auto crossed = std::ranges::find_if(w.crossed_faces_,
                                            [&](const auto& f) { return f.face == face || f.face == other; });
  for (std::size_t i = crossed->first; i < crossed->end; ++i) {
    auto [triangle, direction] = w.dual_crossings_[i].crossing;
    w.crossings_.push_back({triangle, crossed->face == face ? direction : -direction});
  }
}

// Labels the new cells, and finds restricted triangles among the faces between them.
void RestrictedSurface::label_created_cells(const ConflictZone& zone, Index vertex, Workspace& w) {
  for (const Index cell : zone.created) labels_[cell] = {.region = unlabelled};
  if (nodes_.any_at(vertex)) restrict_created_faces(zone, vertex, w);
  const std::size_t seed = first_label(zone, w);
  const Index region = labels_[zone.created[seed]].region;
  if (!nodes_.any_at(vertex)) {
    for (const Index cell : zone.created) labels_[cell].region = region;
    return;
  }
  w.cells_.assign(1, zone.created[seed]);
  while (!w.cells_.empty()) {
    const Index cell = w.cells_.back();
    w.cells_.pop_back();
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId face = face_id(cell, corner), other = mesh_.opposite(face);
      if (mesh_.corners(cell)[corner] == vertex || other == no_face ||
          labels_[cell_of(other)].region != unlabelled)
        continue;
      recall_crossings(face, w);
      labels_[cell_of(other)].region = region_beyond(labels_[cell].region, w);
      w.cells_.push_back(cell_of(other));
    }
  }
}

// Returns whether a border face's dual edge still crosses the single triangle that it crossed before, and the
// crossing agrees with the labels of both cells. The insertion shortened the edge, so it can only lose
// crossings.
bool RestrictedSurface::crosses_as_before(FaceId outer, FaceId face, Index vertex, Workspace& w) const {
  const RestrictedTriangle& t = triangle(outer);
  // If the new vertex lies in the surface gap ball, x is no longer on the dual edge. An edge that lies almost
  // in the plane of the complex's triangle may still cross the triangle then, because x may be any point of
  // such an edge; the face needs another x.
  if (t.several_sheets || squared_distance(mesh_.point(vertex), t.x) < t.squared_radius) return false;
  const int direction = nodes_.hierarchy().crossing(mesh_.circumcentre(cell_of(outer)),
                                                    mesh_.circumcentre(cell_of(face)), t.triangle);
  if (direction == 0) return false;
  w.crossings_.assign(1, {t.triangle, direction});
  return region_beyond(labels_[cell_of(outer)].region, w) == labels_[cell_of(face)].region;
}

// Returns whether a border face's dual edge has lost its single crossing, which is then beyond the end that
// was cut off. The labels show that. If the regions on both sides of the patch are the same, they cannot, and
// the result is false.
bool RestrictedSurface::crosses_no_more(FaceId outer, FaceId face) const {
  const RestrictedTriangle& t = triangle(outer);
  const auto& regions = domain_.plc.patches[patch_of(t)].regions;
  return !t.several_sheets && regions[0] != regions[1] &&
         labels_[cell_of(outer)].region == labels_[cell_of(face)].region;
}

// Checks the border faces again that were marked or whose two cells have different labels: their dual edges
// have become shorter, and the edges' ends are rounded anew.
void RestrictedSurface::mark_border_faces(const ConflictZone& zone, Index vertex, Workspace& w) {
  for (std::size_t i = 0; i < zone.border.size(); ++i) {
    const FaceId outer = zone.outer[i];
    if (outer == no_face) continue;
    const Index created = zone.created[i];
    const bool was_marked = is_marked(outer);
    if (!was_marked && labels_[created].region == labels_[cell_of(outer)].region) continue;
    const FaceId face = face_id(created, corner_of(zone.border[i]));
    if (was_marked && crosses_as_before(outer, face, vertex, w)) {
      mark(face, record_of(outer));
      own_notes(face).judged = false;  // its queue entry may name the destroyed cell
      continue;
    }
    const bool known = was_marked && crosses_no_more(outer, face);
    if (was_marked) unmark(outer, w);
    if (known) continue;
    nodes_.crossings_of_dual_edge(face, w.crossings_);
    if (!w.crossings_.empty()) restrict_face(face, w);
  }
}

void RestrictedSurface::cells_vanish(const ConflictZone& zone, Workspace& w) {
  assert(std::ranges::all_of(zone.cells, [this](Index cell) { return mesh_.alive(cell); }));
  assert(&w == &workspace_ || has_room(zone, w));
  const auto has_marks = [&](Index cell) { return labels_[cell].marked != 0; };
  if (std::ranges::none_of(zone.cells, has_marks)) return;
  // The record of a border face stays, because the cell beyond uses it, too.
  for (const FaceId border : zone.border)
    labels_[cell_of(border)].marked &= static_cast<std::uint8_t>(~(1U << corner_of(border)));
  for (const Index cell : zone.cells)
    visit_marked(cell, [&](FaceId face) {
      const FaceId other = mesh_.opposite(face);
      labels_[cell_of(other)].marked &= static_cast<std::uint8_t>(~(1U << corner_of(other)));
      unmark(face, w);
    });
}

// Returns whether the marks of the cell's faces agree with its neighbours': a face is marked in both of its
// cells, with one record, or in neither.
[[maybe_unused]] static bool consistent(const RestrictedSurface& surface, const RefinedMesh& mesh,
                                        Index cell) {
  for (unsigned corner = 0; corner < 4; ++corner) {
    const FaceId face = face_id(cell, corner), other = mesh.opposite(face);
    const bool marked = surface.is_marked(face), marked_beyond = other != no_face && surface.is_marked(other);
    if (marked != marked_beyond || (marked && &surface.triangle(face) != &surface.triangle(other)))
      return false;
  }
  return true;
}

void RestrictedSurface::cells_made(const ConflictZone& zone, Index vertex) {
  fit_mesh();
  cells_made(zone, vertex, workspace_);
}

void RestrictedSurface::cells_made(const ConflictZone& zone, Index vertex, Workspace& w) {
  label_created_cells(zone, vertex, w);
  mark_border_faces(zone, vertex, w);
  assert(std::ranges::all_of(zone.created, [&](Index cell) { return consistent(*this, mesh_, cell); }));
}

void RestrictedSurface::fit_mesh() {
  labels_.extend(mesh_.cell_capacity());
  marks_.extend(mesh_.cell_capacity());
}

// Gives free records to the workspaces of blocks.
void RestrictedSurface::divide(std::span<const std::size_t> records, std::span<Workspace> of_blocks) {
  fit_mesh();
  std::vector<Index>& free = workspace_.free_records_;
  for (std::size_t i = 0; i < of_blocks.size(); ++i) {
    std::vector<Index>& of_block = of_blocks[i].free_records_;
    while (of_block.size() < records[i] && !free.empty()) {
      of_block.push_back(free.back());
      free.pop_back();
    }
    for (auto next = static_cast<Index>(records_.size()); of_block.size() < records[i]; ++next)
      of_block.push_back(next);
    records_.extend(std::max<std::size_t>(records_.size(), of_block.empty() ? 0 : of_block.back() + 1U));
  }
}

void RestrictedSurface::join(std::span<Workspace> of_blocks) {
  for (Workspace& workspace : of_blocks) {
    auto& free = workspace.free_records_;
    workspace_.free_records_.insert(workspace_.free_records_.end(), free.begin(), free.end());
    free.clear();
  }
}

// Returns whether enough records are free: every face of a new cell may need one.
bool RestrictedSurface::has_room(const ConflictZone& zone, const Workspace& w) const {
  return w.free_records_.size() >= zone.border.size() / 2 * 5;
}

Index RestrictedSurface::new_record(Workspace& w) {
  if (w.free_records_.empty()) {
    records_.push_back({});
    return static_cast<Index>(records_.size() - 1);
  }
  const Index record = w.free_records_.back();
  w.free_records_.pop_back();
  records_[record] = {};
  return record;
}

void RestrictedSurface::mark(FaceId face, Index record) {
  labels_[cell_of(face)].marked |= static_cast<std::uint8_t>(1U << corner_of(face));
  marks_[cell_of(face)][corner_of(face)] = record;
}

// Removes the mark of a face on this side, and its record.
void RestrictedSurface::unmark(FaceId face, Workspace& w) {
  labels_[cell_of(face)].marked &= static_cast<std::uint8_t>(~(1U << corner_of(face)));
  w.free_records_.push_back(record_of(face));
}

// Marks a face and makes its record. Precondition: crossings_ are those of its dual edge, at least one.
void RestrictedSurface::restrict_face(FaceId face, Workspace& w) {
  assert(!w.crossings_.empty());
  const Index record = new_record(w);
  mark(face, record);
  mark(mesh_.opposite(face), record);
  const auto v = mesh_.face_vertices(face);
  const Point& corner = mesh_.point(v[0]);
  RestrictedTriangle& t = records_[record].triangle;
  t.several_sheets = w.crossings_.size() > 1;
  t.squared_radius = -1;
  for (const auto& crossing : w.crossings_) {
    const Point x = crossing_point(face, crossing.triangle);
    const double r2 = squared_distance(x, corner);
    if (r2 <= t.squared_radius) continue;
    t.x = x;
    t.squared_radius = r2;
    t.triangle = crossing.triangle;
  }
  const Index patch = patch_of(t);
  t.resolved_vertices =
      mesh_.on_patch(v[0], patch) && mesh_.on_patch(v[1], patch) && mesh_.on_patch(v[2], patch);
  if (t.resolved_vertices && domain_.plc.patches[patch].planar && !t.several_sheets) {
    // The circumcentre of a needle is inaccurate; the crossing is not.
    const Point centre = circumcentre(face);
    if (squared_distance(centre, t.x) < 0.01 * t.squared_radius) {
      t.x = centre;
      t.squared_radius = squared_distance(t.x, corner);
    }
  }
  t.in_collar = collar_cells_.holds(v, t.x);
}

Point RestrictedSurface::crossing_point(FaceId face, Index triangle) const {
  const Point& p = mesh_.circumcentre(cell_of(face));
  const Point& q = mesh_.circumcentre(cell_of(mesh_.opposite(face)));
  const auto t = nodes_.hierarchy().corners(triangle);
  const Vector n = cross(t[1] - t[0], t[2] - t[0]);
  const double hp = dot(p - t[0], n), hq = dot(q - t[0], n);
  const double share = hp == hq ? 0.5 : std::clamp(hp / (hp - hq), 0.0, 1.0);
  // If a dual edge lies almost in the triangle's plane, the place where it crosses the plane is inaccurate,
  // so move it to the nearest point of the triangle.
  return nearest_point_on_triangle(p + share * (q - p), t[0], t[1], t[2]);
}

Point RestrictedSurface::circumcentre(FaceId face) const {
  const auto v = mesh_.face_vertices(face);
  const Point& a = mesh_.point(v[0]);
  const Vector u = mesh_.point(v[1]) - a, w = mesh_.point(v[2]) - a;
  const Vector n = cross(u, w);
  const double nn = squared_norm(n);
  if (nn == 0) return crossing_point(face, triangle(face).triangle);
  return a + (squared_norm(w) * cross(n, u) + squared_norm(u) * cross(w, n)) / (2 * nn);
}

void RestrictedSurface::note_ball(Index cell, const CollarBall& ball) {
  visit_marked(cell, [&](FaceId face) {
    RestrictedTriangle& t = records_[record_of(face)].triangle;
    if (squared_distance(t.x, ball.centre) < ball.radius * ball.radius) t.in_collar = true;
  });
}

void RestrictedSurface::give_outside(Index cell) {
  assert(labels_[cell].marked != 0);
  Record boundary;
  visit_marked(cell, [&](FaceId face) { boundary = record(face); });
  labels_[cell].region = 0;
  for (unsigned corner = 0; corner < 4; ++corner) {
    const FaceId face = face_id(cell, corner), other = mesh_.opposite(face);
    if (is_marked(face)) {
      unmark(face, workspace_);
      labels_[cell_of(other)].marked &= static_cast<std::uint8_t>(~(1U << corner_of(other)));
      continue;
    }
    records_.push_back(boundary);
    mark(face, static_cast<Index>(records_.size() - 1));
    mark(other, static_cast<Index>(records_.size() - 1));
  }
}

}  // namespace collarmesh
