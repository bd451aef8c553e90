#include "refine/collar_cells.h"

#include <algorithm>
#include <cmath>

namespace collarmesh {

namespace {

// If fewer balls than this are near a vertex, they are tested one by one; otherwise the hierarchy of all
// balls is searched.
constexpr std::size_t most_nearby_balls = 24;

}  // namespace

bool CollarCells::any_near(const ConflictZone& zone) const {
  return !collars_.empty() && std::ranges::any_of(zone.vertices, [&](Index v) { return near(v); });
}

bool CollarCells::holds(const std::array<Index, 3>& vertices, const Point& p) const {
  if (!near(vertices[0])) return false;
  if (last_vertex_ == none || std::ranges::find(vertices, last_vertex_) == vertices.end())
    return collars_.ball_containing(p) != none;
  return std::ranges::any_of(balls_, [&](Index ball) { return collars_.contains(ball, p); });
}

void CollarCells::fit_mesh() {
  inside_.resize(mesh_.cell_capacity(), 0);
  near_.resize(mesh_.vertex_count(), 0);
}

void CollarCells::cells_made(const ConflictZone& zone, Index vertex) {
  if (collars_.empty()) return;
  fit_mesh();
  for (const Index cell : zone.created) inside_[cell] = 0;
  if (!any_near(zone)) return;
  double largest = 0;
  for (const Index cell : zone.created) largest = std::max(largest, mesh_.squared_radius(cell));
  collars_.balls_meeting(mesh_.point(vertex), std::sqrt(largest), most_nearby_balls, balls_);
  const bool all_known = balls_.size() < most_nearby_balls;
  last_vertex_ = all_known ? vertex : none;
  if (balls_.empty()) return;
  near_[vertex] = 1;
  for (const Index cell : zone.created) {
    const Point& centre = mesh_.circumcentre(cell);
    const auto holds_centre = [&](Index ball) { return collars_.contains(ball, centre); };
    const bool held =
        all_known ? std::ranges::any_of(balls_, holds_centre) : collars_.ball_containing(centre) != none;
    inside_[cell] = held ? 1 : 0;
  }
}

void CollarCells::note_near(Index vertex) {
  last_vertex_ = none;
  fit_mesh();
  near_[vertex] = 1;
}

void CollarCells::note_inside(Index cell) {
  fit_mesh();
  inside_[cell] = 1;
}

void CollarCells::forget_far_vertices() {
  last_vertex_ = none;
  for (Index v = 0; v < near_.size(); ++v) {
    if (near_[v] == 0) continue;
    mesh_.incident_cells(v, cells_);
    double largest = 0;
    for (const Index cell : cells_) largest = std::max(largest, mesh_.squared_radius(cell));
    collars_.balls_meeting(mesh_.point(v), std::sqrt(largest), 1, balls_);
    near_[v] = balls_.empty() ? 0 : 1;
  }
}

void CollarCells::take_in(Index cell, Index ball) {
  note_inside(cell);
  taken_in_[cell] = {ball, mesh_.generation(cell)};
}

Index CollarCells::taken_in_by(Index cell) const {
  const auto taken = taken_in_.find(cell);
  return taken != taken_in_.end() && taken->second.generation == mesh_.generation(cell) ? taken->second.ball
                                                                                        : none;
}

}  // namespace collarmesh
