#include "report/shown_trace.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace collarmesh::report {

namespace {

using State = TraceStep::State;

/// Makes a mesh from the tets of a step, and from its triangles on patches whose corners are corners of these
/// tets. Leaves out tets outside all regions, unless there are no others. Marks tets about to be ripped out
/// as both in a collar and thin, a combination that no other tet has.
TetMesh mesh_of(const TraceStep& step) {
  TetMesh mesh;
  mesh.points = step.points;
  const bool only_outside =
      std::all_of(step.state.begin(), step.state.end(), [](State s) { return s == State::outside; });
  std::vector<bool> used(step.points.size(), false);
  for (std::size_t t = 0; t < step.tets.size(); ++t) {
    if (step.state[t] == State::outside && !only_outside) continue;
    const State state = step.state[t];
    mesh.tets.push_back(step.tets[t]);
    mesh.tet_region.push_back(step.region[t]);
    mesh.tet_collar.push_back(state == State::star || state == State::book || state == State::ripped);
    mesh.tet_thin.push_back(state == State::thin || state == State::ripped);
    for (const Index p : step.tets[t]) used[p] = true;
  }
  for (const TraceStep::Triangle& triangle : step.triangles) {
    if (triangle.collar ||
        !std::all_of(triangle.corners.begin(), triangle.corners.end(), [&](Index p) { return used[p]; }))
      continue;
    mesh.faces.push_back(triangle.corners);
    mesh.face_tag.push_back(triangle.tag);
  }
  return mesh;
}

/// Makes the faces of `cells` refer to the face tags of `mesh`. Removes faces whose tag is not among these,
/// and faces with corners that are not shown.
void use_tags_of(const ShownMesh& mesh, ShownMesh& cells) {
  std::vector<std::uint32_t> faces;
  for (std::size_t f = 0; f < cells.faces.size(); f += 4) {
    const Tag tag = cells.face_tags[cells.faces[f + 3]];
    const auto known = std::lower_bound(mesh.face_tags.begin(), mesh.face_tags.end(), tag);
    const std::array corners{cells.faces[f], cells.faces[f + 1], cells.faces[f + 2]};
    if (known == mesh.face_tags.end() || *known != tag ||
        std::find(corners.begin(), corners.end(), none) != corners.end())
      continue;
    faces.insert(faces.end(), corners.begin(), corners.end());
    faces.push_back(static_cast<std::uint32_t>(known - mesh.face_tags.begin()));
  }
  cells.faces = std::move(faces);
  cells.face_tags = mesh.face_tags;
}

void move_to(const Point& centre, ShownMesh& cells) {
  const Vector way = cells.centre - centre;
  for (std::size_t i = 0; i < cells.points.size(); ++i)
    cells.points[i] = static_cast<float>(static_cast<double>(cells.points[i]) + way[i % 3]);
  cells.centre = centre;
}

ShownStep shown_step(const TraceStep& step, const ShownMesh& mesh, std::size_t most) {
  ShownStep shown{step.stage, step.detail, shown_mesh(mesh_of(step), {}, most), {}, {}};
  constexpr std::uint8_t both = 3, ripped = 4;
  std::replace(shown.cells.marks.begin(), shown.cells.marks.end(), both, ripped);
  use_tags_of(mesh, shown.cells);
  move_to(mesh.centre, shown.cells);
  const auto add = [&](std::vector<float>& to, const Point& p) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      to.push_back(static_cast<float>(p[axis] - mesh.centre[axis]));
  };
  for (const TraceStep::Segment& segment : step.segments)
    for (const Index end : segment.ends) add(shown.lines, step.points[end]);
  for (const TraceStep::Ball& ball : step.balls) {
    if (ball.reason == BallReason::subsegment) continue;
    add(shown.balls, ball.centre);
    shown.balls.push_back(static_cast<float>(ball.radius));
  }
  return shown;
}

}  // namespace

std::vector<ShownStep> shown_trace(const Trace& trace, const ShownMesh& mesh, std::size_t most) {
  std::vector<ShownStep> steps;
  for (const TraceStep& step : trace) {
    ShownStep shown = shown_step(step, mesh, most);
    if (shown.cells.region.size() <= most) steps.push_back(std::move(shown));
  }
  return steps;
}

}  // namespace collarmesh::report
