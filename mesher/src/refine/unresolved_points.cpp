#include "refine/unresolved_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace collarmesh {

namespace {

// Returns the exponent of a ball's squared radius. It is the stamp of a queued point. An entry is stale if
// the ball now has a smaller exponent.
int exponent(double squared_radius) { return std::ilogb(std::max(squared_radius, 1e-300)); }

}  // namespace

Index UnresolvedPoints::add(Unresolved point, Index near) {
  const auto index = static_cast<Index>(points_.size());
  point.object = objects_.add(index, point.point, 0, mesh_.nearest_vertex(point.point, near));
  points_.push_back(point);
  if (!point.dormant) queue(index);
  return index;
}

void UnresolvedPoints::withdraw(Index point) {
  assert(!resolved(point) && points_[point].object != none);
  objects_.remove(points_[point].object);
  points_[point].object = none;
}

// Returns whether a point is medial. Its second nearest vertex is a neighbour of the nearest one.
bool UnresolvedPoints::medial(Index point) const {
  const double theta_0 = theta_ / (theta_ + 1);
  const Unresolved& p = points_[point];
  const Index nearest = objects_[p.object].vertex;
  double second = INFINITY;
  mesh_.adjacent_vertices(nearest, adjacent_);
  for (const Index v : adjacent_) second = std::min(second, squared_distance(p.point, mesh_.point(v)));
  return squared_distance(p.point, mesh_.point(nearest)) >= theta_0 * theta_0 * second;
}

void UnresolvedPoints::queue(Index point) {
  const double r2 = squared_ball(points_[point]);
  queue_.push(WorkQueue::unresolved_points, r2, {point, static_cast<std::uint32_t>(exponent(r2))});
}

bool UnresolvedPoints::is_due(Index point, std::uint32_t stamp) {
  const Unresolved& p = points_[point];
  if (p.object == none) return false;
  if (exponent(squared_ball(p)) >= static_cast<int>(stamp)) return true;
  queue(point);
  return false;
}

void UnresolvedPoints::resolve(Index point, Index vertex) {
  assert(!resolved(point) && points_[point].object != none);
  objects_.remove(points_[point].object);
  points_[point].object = none;
  points_[point].vertex = vertex;
}

// Returns the point that a candidate warps to. All points near enough lie in the Voronoi cell of one of the
// zone's vertices.
Index UnresolvedPoints::warp_target(const ConflictZone& zone, const Candidate& candidate) const {
  Index best = none;
  double reach = theta_ * theta_ * candidate.squared_radius;
  std::uint8_t dimension = candidate.feature.dimension;
  for (const Index v : zone.vertices)
    objects_.visit_at(v, [&](Index, const LocationObjects::Object& object) {
      const Unresolved& p = points_[object.owner];
      const double d = squared_distance(p.point, candidate.ball_centre);
      if (p.feature.dimension > dimension || (p.feature.dimension == dimension && best == none) || d > reach)
        return;
      if (p.feature.dimension == dimension && best != none &&
          d >= squared_distance(points_[best].point, candidate.ball_centre))
        return;
      best = object.owner;
      dimension = p.feature.dimension;
    });
  return best;
}

Index UnresolvedPoints::only_vertex_at(Index mesh_vertex) const {
  Index only = none;
  for (Index o = objects_.first_at(mesh_vertex); o != none; o = objects_[o].next) {
    const Index point = objects_[o].owner;
    if (points_[point].feature.dimension != 0) continue;
    if (only != none) return none;
    only = point;
  }
  return only;
}

void UnresolvedPoints::cells_made(const ConflictZone& zone, Index vertex) {
  const Point p = mesh_.point(vertex);
  for (const Index neighbour : zone.vertices)
    objects_.visit_at(neighbour, [&](Index o, const LocationObjects::Object& object) {
      if (squared_distance(p, object.centre) < squared_distance(mesh_.point(neighbour), object.centre))
        objects_.move(o, vertex);
    });
}

}  // namespace collarmesh
