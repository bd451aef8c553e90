#include "refine/trace_recorder.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <utility>

#include "common/traced_mesh.h"

namespace collarmesh {

namespace {

std::string_view name_of(WorkQueue::Priority work) {
  switch (work) {
    case WorkQueue::encroached_subsegments: return "encroached subsegments";
    case WorkQueue::skinny_cells: return "skinny cells";
    case WorkQueue::coarse_subsegments: return "coarse subsegments";
    case WorkQueue::unresolved_points: return "unresolved points";
    case WorkQueue::unresolved_triangles: return "unresolved triangles";
    case WorkQueue::large_triangles: return "large triangles";
    case WorkQueue::large_cells: return "large cells";
    case WorkQueue::exposed_crease_vertices: return "exposed crease vertices";
    case WorkQueue::poor_collar_triangles: return "poor collar triangles";
    case WorkQueue::priority_count: break;
  }
  return {};
}

}  // namespace

void TraceRecorder::record(const std::string& stage, WorkQueue::Priority working_on) {
  const Index vertices = parts_.mesh.vertex_count();
  TraceStep step;
  step.stage = stage;
  step.detail = fmt::format("{} vertices", vertices);
  if (working_on != WorkQueue::priority_count) step.detail += fmt::format(", {}", name_of(working_on));
  for (Index v = 0; v < vertices; ++v) {
    step.points.push_back(parts_.domain.frame.outside(parts_.mesh.point(v)));
    step.dimension.push_back(parts_.mesh.feature(v).dimension);
  }
  add_cells(step);
  add_patches(step);
  add_collar_surface(step);
  add_segments(step);
  add_balls(step);
  trace_.push_back(std::move(step));
  while (next_ <= vertices) next_ *= 2;
}

void TraceRecorder::add_cells(TraceStep& step) const {
  for (Index cell = 0; cell < parts_.mesh.cell_capacity(); ++cell) {
    if (!parts_.mesh.alive(cell)) continue;
    const Index region = parts_.surface.region(cell);
    step.tets.push_back(parts_.mesh.corners(cell));
    step.region.push_back(region);
    step.state.push_back(parts_.collar_cells.inside(cell) ? TraceStep::State::ripped
                         : region == 0                    ? TraceStep::State::outside
                                                          : TraceStep::State::region);
  }
}

void TraceRecorder::add_patches(TraceStep& step) const {
  for (const FaceId face : parts_.surface.marked_faces())
    step.triangles.push_back(
        {parts_.mesh.face_vertices(face), parts_.domain.plc.patches[parts_.surface.patch(face)].tag});
}

// Adds the faces between cells inside the collars and outside.
void TraceRecorder::add_collar_surface(TraceStep& step) const {
  for (Index cell = 0; cell < parts_.mesh.cell_capacity(); ++cell) {
    if (!parts_.mesh.alive(cell) || parts_.collar_cells.inside(cell)) continue;
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId face = face_id(cell, corner), beyond = parts_.mesh.opposite(face);
      if (beyond != no_face && parts_.collar_cells.inside(cell_of(beyond)))
        step.triangles.push_back({parts_.mesh.face_vertices(face), 0, true});
    }
  }
}

// Adds subsegments. An end that is no vertex yet becomes a point of its own.
void TraceRecorder::add_segments(TraceStep& step) const {
  parts_.curves.visit_places([&](const Subsegment& s, const std::array<Point, 2>& places) {
    std::array<Index, 2> ends = s.ends;
    for (std::size_t side = 0; side < 2; ++side) {
      if (ends[side] != none) continue;
      ends[side] = static_cast<Index>(step.points.size());
      step.points.push_back(parts_.domain.frame.outside(places[side]));
      step.dimension.push_back(1);
    }
    step.segments.push_back({ends, parts_.domain.plc.curves[s.curve].tag});
  });
}

void TraceRecorder::add_balls(TraceStep& step) const {
  parts_.curves.visit([&](Index, const Subsegment& s) {
    step.balls.push_back(
        {parts_.domain.frame.outside(s.centre), std::sqrt(s.squared_radius), BallReason::subsegment});
  });
  const auto& balls = parts_.collars.balls();
  for (Index ball = 0; ball < balls.size(); ++ball)
    step.balls.push_back(
        {parts_.domain.frame.outside(balls[ball].centre), balls[ball].radius, parts_.creator.reason(ball)});
}

TraceStep stitched_step(const TetMesh& mesh, const TraceStep& before) {
  TraceStep step = traced_mesh(mesh, "stitch");
  for (const TraceStep::Ball& ball : before.balls)
    if (ball.reason != BallReason::subsegment) step.balls.push_back(ball);
  return step;
}

}  // namespace collarmesh
