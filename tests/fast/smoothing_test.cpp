// Vertices inside regions move to where the tets around have better shapes; everything else stays.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "adapt/smoothing.h"
#include "collarmesh/mesh_measures.h"
#include "common/cell_shapes.h"
#include "common/thread_limit.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::smoothing_test {
namespace {

using namespace testing;

constexpr double size = 0.15;

/// A box whose vertices inside are pushed aside by up to a tenth of the size.
struct Pushed {
  Plc plc;
  TetMesh mesh;
  std::vector<double> sizes;
};

Pushed pushed_box() {
  Meshed made = mesh_of(box({0, 0, 0}, {1, 1, 1}), with_size(size));
  EXPECT_EQ(faults(made), "");
  Pushed pushed{std::move(made.plc), std::move(made.result.mesh), {}};
  TetMesh& mesh = pushed.mesh;
  for (Index v = 0; v < mesh.points.size(); ++v)
    if (mesh.features[v].dimension == 3) {
      const double turn = static_cast<double>(v);
      mesh.points[v] =
          mesh.points[v] + 0.1 * size * Vector{std::cos(turn), std::sin(turn), std::cos(2 * turn)};
    }
  pushed.sizes.assign(mesh.points.size(), size);
  return pushed;
}

/// Returns the mean over all tets of the mean ratio to the power of 3/2.
double mean_shape(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& tet : mesh.tets) {
    double squares = 0;
    for (const auto& [i, j] : cell_shapes::corner_pairs)
      squares += squared_distance(mesh.points[tet[i]], mesh.points[tet[j]]);
    sum += 12 * std::sqrt(3) *
           six_volume(mesh.points[tet[0]], mesh.points[tet[1]], mesh.points[tet[2]], mesh.points[tet[3]]) /
           std::pow(squares, 1.5);
  }
  return sum / static_cast<double>(mesh.tets.size());
}

std::size_t smoothed(Pushed& pushed, unsigned threads = 1) {
  std::size_t moves = 0;
  ThreadLimit(threads).run([&] {
    moves =
        remeshing::adapting::smooth(pushed.mesh, pushed.plc, Bounds{}, remeshing::Metric(pushed.sizes), {});
  });
  return moves;
}

TEST(Smoothing, GivesTetsBetterShapes) {
  Pushed pushed = pushed_box();
  const double before = mean_shape(pushed.mesh);
  EXPECT_GT(smoothed(pushed), 10U);
  EXPECT_GT(mean_shape(pushed.mesh), before + 0.01);
}

TEST(Smoothing, KeepsTheBoundsOnTets) {
  Pushed pushed = pushed_box();
  const auto least_angle = [&] {
    double least = 180;
    for (const auto& [a, b, c, d] : pushed.mesh.tets) {
      const auto& p = pushed.mesh.points;
      least = std::min(least, measure(p[a], p[b], p[c], p[d]).min_dihedral);
    }
    return least;
  };
  const double before = least_angle();
  smoothed(pushed);
  EXPECT_GE(least_angle(), std::min(before, Bounds{}.thin_angle));
}

TEST(Smoothing, LeavesBoundariesAndConnections) {
  Pushed pushed = pushed_box();
  const TetMesh before = pushed.mesh;
  smoothed(pushed);
  EXPECT_EQ(pushed.mesh.tets, before.tets);
  for (Index v = 0; v < before.points.size(); ++v)
    if (before.features[v].dimension < 3) {
      EXPECT_EQ(pushed.mesh.points[v], before.points[v]);
    }
}

TEST(Smoothing, MakesNoLongEdgeLonger) {
  Pushed pushed = pushed_box();
  // By these sizes all edges are too long, so a move must shorten all edges of its vertex; none can.
  std::ranges::fill(pushed.sizes, 0.01 * size);
  EXPECT_EQ(smoothed(pushed), 0U);
}

TEST(Smoothing, IsTheSameForAnyNumberOfThreads) {
  Pushed one = pushed_box(), four = pushed_box();
  smoothed(one, 1);
  smoothed(four, 4);
  EXPECT_EQ(one.mesh.points, four.mesh.points);
}

TEST(Smoothing, EndsWhenItIsCancelled) {
  Pushed pushed = pushed_box();
  const std::atomic<bool> cancel = true;
  EXPECT_EQ(remeshing::adapting::smooth(pushed.mesh, pushed.plc, Bounds{}, remeshing::Metric(pushed.sizes),
                                        {{}, &cancel}),
            0U);
}

}  // namespace
}  // namespace collarmesh::smoothing_test
