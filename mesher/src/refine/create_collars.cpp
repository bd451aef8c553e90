// Collars that are created in the pass (paper, section 3.2 and Procedures 3 and 4): a vertex ball when the
// vertex is inserted or, still uninserted, isolated and medial; the balls along a crease curve, which is
// refined like other curves until then, when all cells that it crosses outside its ends' balls are isolated
// with respect to it.
#include <algorithm>

#include "refine/refinement.h"

namespace collarmesh {

// The mesh has changed around the vertex inserted last: what may be isolated now?
void Refinement::look_for_isolated_creases(Index vertex) {
  for (const Index v : zone_.vertices)
    if (vertices_[v].dimension == 1) touch_crease(vertices_[v].feature);
  create_collar_if_isolated(vertex);
  for (const Index v : zone_.vertices) create_collar_if_isolated(v);
}

void Refinement::touch_crease(Index curve) {
  const auto found = open_creases_.find(curve);
  if (found == open_creases_.end() || found->second.touched) return;
  found->second.touched = true;
  touched_creases_.push_back(curve);
}

// Does the cell hold one crease vertex that is not in the mesh, theta_0-medial and isolated (paper, appendix
// A)?
void Refinement::create_collar_if_isolated(Index at) {
  Index only = none;
  for (Index o = objects_.first_at(at); o != none; o = objects_[o].next) {
    if (objects_[o].kind != LocationObjects::Kind::point) continue;
    const Index point = objects_[o].owner;
    if (unresolved_[point].dimension != 0) continue;
    if (only != none) return;
    only = point;
  }
  if (only == none || !waits_for_ball(only)) return;
  const Point p = unresolved_[only].point;
  double second = INFINITY;
  mesh_.adjacent_vertices(at, cells_scratch_);
  for (const Index v : cells_scratch_) second = std::min(second, squared_distance(p, mesh_.point(v)));
  const double theta_0 = 2 * options_.theta / (2 * options_.theta + 1);
  if (squared_distance(p, mesh_.point(at)) < theta_0 * theta_0 * second) return;
  if (gap_size().isolated({0, only}, at)) create_collar_at_vertex(only, at);
}

bool Refinement::waits_for_ball(Index vertex) const {
  return placement_ && collars_.is_crease_vertex(vertex) && collars_.ball_at_vertex(vertex) == none;
}

// The curves that end at the vertex do not reach beyond its ball's sphere any more.
void Refinement::create_collar_at_vertex(Index vertex, Index near) {
  gap_size().start_near(near);
  placement_->place_at_vertex(vertex);
  for (const Index curve : plc_.vertices[vertex].curves)
    for (const bool at_start : {true, false})
      if (plc_.curves[curve].ends[at_start ? 0 : 1] == vertex) clip_curve(curve, at_start, near);
  take_up_balls(near, {none, none});
}

void Refinement::clip_curve(Index c, bool at_start, Index near) {
  const unsigned side = at_start ? 0 : 1;
  const Index vertex = plc_.curves[c].ends[side], ball = collars_.ball_at_vertex(vertex);
  const CollarBall& b = collars_.balls()[ball];
  const double end = at_start ? 0 : paths_.length(c);
  auto& waiting = unresolved_[vertex].pending;
  const auto found = std::find_if(waiting.begin(), waiting.end(), [&](Index index) {
    const PendingSubsegment& p = pending_[index];
    return p.curve == c && p.points[side] == vertex && p.parameters[side] == end;
  });
  if (found == waiting.end()) return;
  const Index index = *found;
  waiting.erase(found);
  const auto crease = open_creases_.find(c);
  double parameter = at_start ? b.radius : end - b.radius;
  if (crease == open_creases_.end()) parameter = leaving_parameter(c, b, at_start);
  const Index point = add_unresolved(paths_.point(c, parameter), 1, c, near);
  if (crease == open_creases_.end())
    clipped_ends_.push_back({c, ball, point});
  else
    crease->second.ends[side] = point;
  PendingSubsegment& p = pending_[index];
  p.points[side] = point;
  p.parameters[side] = parameter;
  unresolved_[point].pending.push_back(index);
  objects_.remove(p.object);
  guard(index, near);
  const LocationObjects::Object& object = objects_[p.object];
  if (squared_distance(mesh_.point(object.vertex), object.centre) <= object.squared_radius) hurry_ends(p);
}

// Every cell that a subsegment crosses is that of one of its ends, as its protective ball is empty.
void Refinement::create_collars_on_touched_creases() {
  while (!touched_creases_.empty()) {
    const Index curve = touched_creases_.back();
    touched_creases_.pop_back();
    const auto found = open_creases_.find(curve);
    if (found == open_creases_.end()) continue;
    OpenCrease& crease = found->second;
    crease.touched = false;
    if (crease.pending > 0) continue;
    std::vector<CollarBall> at_ends;
    for (const Index end : plc_.curves[curve].ends)
      if (end != none) at_ends.push_back(collars_.balls()[collars_.ball_at_vertex(end)]);
    for (; crease.isolated < crease.subsegments.size(); ++crease.isolated) {
      const auto [index, stamp] = crease.subsegments[crease.isolated];
      const Subsegment& s = subsegments_[index];
      if (!s.alive || s.stamp != stamp) continue;
      if (std::any_of(s.ends.begin(), s.ends.end(), [&](Index end) {
            return !gap_size().isolated({1, curve}, end, at_ends);
          }))
        break;
    }
    if (crease.isolated == crease.subsegments.size()) create_collar_on_curve(curve);
  }
}

// What refinement has come to an end without. False when there is nothing.
bool Refinement::create_remaining_collars() {
  std::vector<Index> curves;
  for (const auto& [curve, crease] : open_creases_) curves.push_back(curve);
  std::sort(curves.begin(), curves.end());
  for (const Index curve : curves) create_collar_on_curve(curve);
  return !curves.empty();
}

void Refinement::create_collar_on_curve(Index curve) {
  const OpenCrease crease = std::move(open_creases_.at(curve));
  open_creases_.erase(curve);
  Index near = last_vertex();
  for (const auto& [index, stamp] : crease.subsegments) {
    if (!subsegments_[index].alive || subsegments_[index].stamp != stamp) continue;
    near = subsegments_[index].ends[0];
    remove_subsegment(index);
  }
  gap_size().start_near(near);
  placement_->place_on_curve(curve);
  take_up_balls(near, crease.ends);
}

// Of the balls placed last the first and the last one may have their centres among the unresolved points
// already.
void Refinement::take_up_balls(Index near, const std::array<Index, 2>& ends) {
  const auto first = static_cast<Index>(ball_points_.size());
  const auto count = static_cast<Index>(collars_.balls().size());
  for (Index b = first; b < count; ++b) {
    const CollarBall& ball = collars_.balls()[b];
    Index point = ball.feature;
    if (ball.dimension == 1) {
      point = b == first ? ends[0] : b + 1 == count ? ends[1] : none;
      if (point == none) point = add_unresolved(ball.centre, 1, ball.feature, near);
    }
    ball_points_.push_back(point);
    near = unresolved_[point].vertex != none ? unresolved_[point].vertex
                                             : objects_[unresolved_[point].object].vertex;
    if (placement_) find_inside(ball, near);
  }
  for (; corners_taken_up_ < collars_.corners().size(); ++corners_taken_up_) {
    const CornerPoint& corner = collars_.corners()[corners_taken_up_];
    const bool planar = corner.dimension == 2 && plc_.patches[corner.feature].planar;
    add_unresolved(planar ? on_plane(corner.feature, corner.point) : corner.point, corner.dimension,
                   corner.feature, near);
  }
  if (collar_observer_)
    for (Index b = first; b < count; ++b) collar_observer_(collars_.balls()[b]);
}

// The cells and restricted triangles that a new ball takes away from the refinement.
void Refinement::find_inside(const CollarBall& ball, Index near) {
  const double squared = ball.radius * ball.radius * (1 + 1e-9);
  const auto holds = [&](const Point& p) {
    return squared_distance(p, ball.centre) < ball.radius * ball.radius;
  };
  walk_.visit_ball(ball.centre, walk_.nearest(ball.centre, near), squared, [&](Index vertex) {
    vertices_[vertex].near_collar = true;
    mesh_.incident_cells(vertex, cells_scratch_);
    for (const Index cell : cells_scratch_) {
      if (holds(mesh_.circumcentre(cell))) labels_[cell].in_collar = true;
      for (unsigned corner = 0, marked = labels_[cell].marked; marked != 0; ++corner, marked >>= 1) {
        if (!(marked & 1U)) continue;
        RestrictedTriangle& t = restricted(face_id(cell, corner));
        if (holds(t.x)) t.in_collar = true;
      }
    }
  });
}

}  // namespace collarmesh
