// Traces of runs, by sums over the cells of each step.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "collarmesh/pipeline.h"
#include "support/acute_shapes.h"
#include "support/shapes.h"

namespace collarmesh::trace_test {
namespace {

using namespace testing;

using State = TraceStep::State;

SoupPipelineResult traced(const std::vector<PolygonSoup>& soups, double size, bool coarsen = true) {
  PipelineOptions options;
  options.mesh.size = size;
  options.coarsen = coarsen;
  options.trace = true;
  return run_pipeline(soups, options);
}

std::vector<std::string> stages_of(const Trace& trace) {
  std::vector<std::string> stages;
  for (const TraceStep& step : trace)
    if (stages.empty() || stages.back() != step.stage) stages.push_back(step.stage);
  return stages;
}

double volume_of(const TraceStep& step, std::size_t tet) {
  const auto& [a, b, c, d] = step.tets[tet];
  return six_volume(step.points[a], step.points[b], step.points[c], step.points[d]) / 6;
}

double volume_of(const TraceStep& step) {
  double volume = 0;
  for (std::size_t t = 0; t < step.tets.size(); ++t) volume += volume_of(step, t);
  return volume;
}

std::size_t count(const TraceStep& step, State state) {
  return static_cast<std::size_t>(std::ranges::count(step.state, state));
}

/// Expects the sizes of all arrays, and indices within them.
void expect_whole(const TraceStep& step) {
  EXPECT_EQ(step.dimension.size(), step.points.size());
  EXPECT_EQ(step.region.size(), step.tets.size());
  EXPECT_EQ(step.state.size(), step.tets.size());
  const auto below = [&](Index v) { return v < step.points.size(); };
  for (const auto& tet : step.tets) EXPECT_TRUE(std::ranges::all_of(tet, below));
  for (const TraceStep::Triangle& triangle : step.triangles)
    EXPECT_TRUE(std::ranges::all_of(triangle.corners, below));
  for (const TraceStep::Segment& segment : step.segments)
    EXPECT_TRUE(std::ranges::all_of(segment.ends, below));
}

TEST(Trace, HasTheStagesOfARunAndEndsWithTheMesh) {
  const SoupPipelineResult made = traced(acute::wedge(25).soups, 0.3);
  ASSERT_EQ(made.missed(), "");
  EXPECT_EQ(stages_of(made.trace),
            (std::vector<std::string>{"box", "refine", "rip", "stitch", "coarsen", "improve"}));
  for (const TraceStep& step : made.trace) expect_whole(step);
  EXPECT_EQ(made.trace.back().tets, made.result.mesh.tets);
  EXPECT_EQ(made.trace.back().points, made.result.mesh.points);
  EXPECT_EQ(made.trace.back().segments.size(), made.result.mesh.edges.size());
  EXPECT_LT(made.trace.back().tets.size(), made.trace[made.trace.size() - 3].tets.size()) << "coarsened";
}

// All cells of a refinement fill the same box, and those of the regions have the shape's volume in the end.
TEST(Trace, StepsOfTheRefinementFillTheSameBox) {
  const acute::Shape shape = acute::wedge(25);
  const SoupPipelineResult made = traced(shape.soups, 0.3);
  const double box = volume_of(made.trace.front());
  EXPECT_GT(box, shape.volume);
  std::size_t vertices = 0;
  for (const TraceStep& step : made.trace) {
    if (step.stage == "refine" || step.stage == "rip") {
      EXPECT_NEAR(volume_of(step), box, 1e-9 * box);
    }
    if (step.stage == "refine") {
      const std::size_t now = std::stoul(step.detail);
      EXPECT_GT(now, vertices);
      EXPECT_NE(step.detail.find(" vertices, "), std::string::npos) << step.detail;
      vertices = now;
    }
  }
  const TraceStep& stitched = made.trace[made.trace.size() - 3];
  ASSERT_EQ(stitched.stage, "stitch");
  EXPECT_NEAR(volume_of(stitched), shape.volume, 1e-9);
}

// The wedge's crease is the line x = y = 0.
TEST(Trace, RippedCellsAreThoseInTheBallsOfTheCollar) {
  const SoupPipelineResult made = traced(acute::wedge(25).soups, 0.3);
  const auto step = std::ranges::find(made.trace, "rip", &TraceStep::stage), after = step + 1;
  ASSERT_NE(after, made.trace.end());
  EXPECT_GT(count(*step, State::ripped), 0U);
  EXPECT_GT(count(*step, State::outside), 0U);
  EXPECT_EQ(count(*step, State::star) + count(*step, State::book), 0U);
  EXPECT_EQ(count(*after, State::ripped) + count(*after, State::outside), 0U);
  EXPECT_GT(count(*after, State::star), 0U);
  EXPECT_GT(count(*after, State::book), 0U);
  EXPECT_EQ(count(*step, State::region), count(*after, State::region));
  std::set<BallReason> reasons;
  std::size_t of_collars = 0;
  for (const TraceStep::Ball& ball : step->balls) {
    EXPECT_GT(ball.radius, 0);
    reasons.insert(ball.reason);
    if (ball.reason == BallReason::subsegment) continue;
    ++of_collars;
    EXPECT_LT(std::hypot(ball.centre.x, ball.centre.y), 1e-9);
  }
  EXPECT_GT(of_collars, 2U);
  EXPECT_GT(reasons.size(), 1U);
  EXPECT_EQ(after->balls.size(), of_collars);
  // The collar surface is what has a ripped cell on one side only.
  std::map<std::array<Index, 3>, unsigned> ripped;
  for (std::size_t t = 0; t < step->tets.size(); ++t)
    if (step->state[t] == State::ripped)
      for (unsigned k = 0; k < 4; ++k) {
        std::array<Index, 3> side;
        for (unsigned i = 0; i < 3; ++i) side[i] = step->tets[t][(k + i) % 4];
        std::ranges::sort(side);
        ++ripped[side];
      }
  std::set<std::array<Index, 3>> once, surface;
  for (const auto& [side, times] : ripped)
    if (times == 1) once.insert(side);
  for (const TraceStep::Triangle& triangle : step->triangles) {
    if (!triangle.collar) continue;
    std::array<Index, 3> side = triangle.corners;
    std::ranges::sort(side);
    surface.insert(side);
  }
  EXPECT_EQ(surface, once);
}

TEST(Trace, FirstStepHasSegmentsWhoseEndsAreNoVerticesYet) {
  const SoupPipelineResult made = traced({box()}, 0.4, false);
  const TraceStep& first = made.trace.front();
  ASSERT_FALSE(first.segments.empty());
  double length = 0;
  for (const TraceStep::Segment& segment : first.segments)
    length += distance(first.points[segment.ends[0]], first.points[segment.ends[1]]);
  EXPECT_NEAR(length, 12, 1e-9);
  const std::vector<std::string> stages = stages_of(made.trace);
  EXPECT_EQ(std::ranges::count(stages, "coarsen"), 0);
  EXPECT_EQ(stages.back(), "improve");
}

}  // namespace
}  // namespace collarmesh::trace_test
