#include "refine/triangle_quality.h"

#include <algorithm>
#include <cmath>

#include "tolerance/facing.h"

namespace collarmesh {

namespace {

// A centre is inserted with a pseudo-random offset of up to this share of its ball's radius.
constexpr double triangle_offset = 0.1;

}  // namespace

// Finds an encroached triangle. A surface gap ball lies in the union of its two cells' balls, so the
// candidate can only encroach marked faces of the zone.
FaceId TriangleQuality::encroached(const ConflictZone& zone, const Candidate& candidate) const {
  FaceId best = no_face;
  if (candidate.feature.dimension < 3) return best;
  double deepest = 0;
  for (const Index cell : zone.cells)
    surface_.visit_marked(cell, [&](FaceId face) {
      const RestrictedTriangle& t = surface_.triangle(face);
      const double depth = t.squared_radius - squared_distance(candidate.point, t.x);
      if (depth <= deepest || surface_.notes(face).given_up || t.in_collar) return;
      best = face;
      deepest = depth;
    });
  return best;
}

std::optional<Candidate> TriangleQuality::candidate(FaceId face) {
  if (auto across = facing_sheets_.candidate_across(face)) return across;
  const RestrictedTriangle& t = surface_.triangle(face);
  const Point p = place(face, random_);
  const FaceId other = mesh_.opposite(face);
  Index start = none;
  if (mesh_.in_conflict(cell_of(face), p))
    start = cell_of(face);
  else if (other != no_face && mesh_.in_conflict(cell_of(other), p))
    start = cell_of(other);
  else
    start = mesh_.conflicting_cell_around(mesh_.face_vertices(face)[0], p);
  if (start == none) return std::nullopt;
  return Candidate{p, t.squared_radius, t.x, {2, surface_.patch(face)}, start};
}

std::optional<Candidate> TriangleQuality::candidate_beside(FaceId face, RandomOffsets& random) const {
  if (has_vertex_on_another_sheet(face)) return std::nullopt;
  const RestrictedTriangle& t = surface_.triangle(face);
  const Point p = place(face, random);
  for (const FaceId side : {face, mesh_.opposite(face)})
    if (side != no_face && mesh_.in_conflict(cell_of(side), p))
      return Candidate{p, t.squared_radius, t.x, {2, surface_.patch(face)}, cell_of(side)};
  return std::nullopt;
}

// Returns whether a vertex of the triangle lies on another sheet; it may face the triangle across a gap.
bool TriangleQuality::has_vertex_on_another_sheet(FaceId face) const {
  if (surface_.triangle(face).resolved_vertices) return false;
  const auto v = mesh_.face_vertices(face);
  return std::ranges::any_of(v, [&](Index vertex) {
    return mesh_.feature(vertex).dimension < 3 && !mesh_.on_patch(vertex, surface_.patch(face));
  });
}

// Returns the point to insert: the centre of the triangle's ball, or a point near it.
Point TriangleQuality::place(FaceId face, RandomOffsets& random) const {
  const RestrictedTriangle& t = surface_.triangle(face);
  const Index patch = surface_.patch(face);
  Point p = t.x;
  if (domain_.plc.patches[patch].planar && t.resolved_vertices) {
    const auto v = mesh_.face_vertices(face);
    const Vector n = cross(mesh_.point(v[1]) - mesh_.point(v[0]), mesh_.point(v[2]) - mesh_.point(v[0]));
    if (squared_norm(n) > 0)
      p = p + random.outside_collars(p, triangle_offset * std::sqrt(t.squared_radius / 3), n);
  }
  if (domain_.plc.patches[patch].planar) p = domain_.on_plane(patch, p);
  return domain_.frame.rounded(p);
}

bool TriangleQuality::is_due(const WorkQueue::Entry& entry) const {
  const FaceId face = entry.id;
  if (!mesh_.alive(cell_of(face), entry.stamp) || !surface_.is_marked(face)) return false;
  const TriangleNotes& notes = surface_.notes(face);
  return !notes.given_up && (!surface_.triangle(face).in_collar || notes.surface_needs_it);
}

void TriangleQuality::queue_again(const WorkQueue::Item& item, double squared_radius) {
  if (mesh_.alive(cell_of(item.entry.id), item.entry.stamp) && surface_.is_marked(item.entry.id))
    queue_.push(item.priority, squared_radius, item.entry);
}

void TriangleQuality::cells_made(const ConflictZone& zone) {
  for (const Index cell : zone.created)
    surface_.visit_marked(cell, [&](FaceId face) {
      if (!surface_.notes(face).judged) judge(face);
    });
}

void TriangleQuality::cells_made(const ConflictZone& zone, WorkQueue& queue) const {
  const Sizing& sizing = sizes_.asked();
  for (const Index cell : zone.created)
    surface_.visit_marked(cell, [&](FaceId face) {
      if (surface_.notes(face).judged) return;
      judge(face, queue, [&](const RestrictedTriangle& t) {
        return sizing.triangle_size(surface_.patch(face), t.triangle, t.x);
      });
    });
}

void TriangleQuality::judge_all() {
  for (const FaceId face : surface_.marked_faces())
    if (!surface_.notes(face).given_up) judge(face);
}

void TriangleQuality::split(FaceId face) {
  if (surface_.notes(face).given_up) return;
  surface_.note_needed(face);
  queue_.push(WorkQueue::unresolved_triangles, surface_.triangle(face).squared_radius, entry(face));
}

void TriangleQuality::judge(FaceId face) {
  judge(face, queue_, [&](const RestrictedTriangle& t) { return target_size(face, t); });
}

template <class TargetSize>
void TriangleQuality::judge(FaceId face, WorkQueue& queue, const TargetSize& target_size) const {
  surface_.note_judged(face);
  const RestrictedTriangle& t = surface_.triangle(face);
  if (t.in_collar) return;
  if (!t.resolved_vertices || t.several_sheets || too_far(face, t)) {
    queue.push(WorkQueue::unresolved_triangles, t.squared_radius, entry(face));
    return;
  }
  const double radius = Sizing::triangle_radius(target_size(t));
  if (t.squared_radius > radius * radius)
    queue.push(WorkQueue::large_triangles, t.squared_radius, entry(face));
}

double TriangleQuality::target_size(FaceId face, const RestrictedTriangle& t) {
  const Sizing& sizing = sizes_.asked();
  const auto corners = mesh_.face_vertices(face);
  double size = sizing.triangle_size(surface_.patch(face), t.triangle, t.x);
  if (const double widest = sizing.widest_gap(size); widest > 0)
    size = std::min(size, sizing.gap_size(gap_at(t, widest)));
  const double reach = std::sqrt(t.squared_radius);
  sizes_.impose(corners, size, reach);
  return std::min(size, sizes_.graded(corners, reach));
}

// Returns the distance from x to the nearest part of the surface that faces the triangle's patch across a
// region, but at most `widest`.
double TriangleQuality::gap_at(const RestrictedTriangle& t, double widest) {
  const auto corners = nodes_.hierarchy().corners(t.triangle);
  Vector normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  normal = normal / norm(normal);
  const Plc& plc = domain_.plc;
  const Index own = plc.triangles[t.triangle].patch;
  const Plc::Patch& patch = plc.patches[own];
  double gap = widest;
  for (unsigned side = 0; side < 2; ++side) {
    if (patch.regions[side] == 0) continue;
    const Vector way = side == 0 ? -1 * normal : normal;
    // The ray starts at a small distance from the triangle, because a start in its plane would cause ties.
    nodes_.crossings(t.x + 1e-6 * widest * way, t.x + widest * way, crossings_);
    for (const auto& [triangle, direction] : crossings_)
      gap = std::min(
          gap, facing_distance(plc, own, t.x, normal, way, triangle, nodes_.hierarchy().corners(triangle)));
  }
  return gap;
}

// Returns whether the circumcentre of a triangle on a smooth patch is farther than the tolerance from the
// place where the dual edge crosses the patch.
bool TriangleQuality::too_far(FaceId face, const RestrictedTriangle& t) const {
  if (domain_.plc.patches[surface_.patch(face)].planar) return false;
  const double tolerance = domain_.tolerance.at_triangle(t.triangle);
  return squared_distance(surface_.circumcentre(face), t.x) > tolerance * tolerance;
}

}  // namespace collarmesh
