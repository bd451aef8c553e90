#include "refine/unresolved_points.h"

#include <algorithm>
#include <cmath>

namespace collarmesh {

namespace {

// The stamp of a queued point is the exponent of its ball, so that a stale entry is noticed.
int exponent(double squared_radius) { return std::ilogb(std::max(squared_radius, 1e-300)); }

}  // namespace

Index UnresolvedPoints::add(const Point& p, const Feature& feature, Index near) {
  const auto index = static_cast<Index>(points_.size());
  points_.push_back({p, feature});
  points_[index].object =
      objects_.add(LocationObjects::Kind::point, index, p, 0, mesh_.nearest_vertex(p, near));
  queue(index);
  return index;
}

void UnresolvedPoints::queue(Index point) {
  const double r2 = squared_ball(points_[point]);
  queue_.push(WorkQueue::unresolved_points, r2, {point, static_cast<std::uint32_t>(exponent(r2))});
}

bool UnresolvedPoints::due(Index point, std::uint32_t stamp) {
  const Unresolved& p = points_[point];
  if (p.vertex != none) return false;
  if (exponent(squared_ball(p)) >= static_cast<int>(stamp)) return true;
  queue(point);
  return false;
}

void UnresolvedPoints::resolve(Index point, Index vertex) {
  objects_.remove(points_[point].object);
  points_[point].vertex = vertex;
}

// Those near enough are in a list of the zone's vertices.
Index UnresolvedPoints::warp_target(const ConflictZone& zone, const Candidate& candidate) const {
  Index best = none;
  double reach = theta_ * theta_ * candidate.squared_radius;
  std::uint8_t dimension = candidate.feature.dimension;
  for (const Index v : zone.vertices)
    for (Index o = objects_.first_at(v); o != none; o = objects_[o].next) {
      const Index point = objects_[o].owner;
      const Unresolved& p = points_[point];
      const double d = squared_distance(p.point, candidate.ball_centre);
      if (p.feature.dimension > dimension || (p.feature.dimension == dimension && best == none) || d > reach)
        continue;
      if (p.feature.dimension == dimension && best != none &&
          d >= squared_distance(points_[best].point, candidate.ball_centre))
        continue;
      best = point;
      dimension = p.feature.dimension;
    }
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
    for (Index o = objects_.first_at(neighbour), next = none; o != none; o = next) {
      const auto& object = objects_[o];
      next = object.next;
      if (squared_distance(p, object.centre) < squared_distance(mesh_.point(neighbour), object.centre))
        objects_.move(o, vertex);
    }
}

}  // namespace collarmesh
