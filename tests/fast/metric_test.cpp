// Lengths of edges in units of what they should be.
#include "remesh/metric.h"

#include <gtest/gtest.h>

#include "coarsen/coarsening_rule.h"

namespace collarmesh::metric_test {
namespace {

using remeshing::Metric;

constexpr Vector edge{2, 3, 6};  // has length 7

TEST(Metric, MeasuresEdgesByTheMeanOfTheirEnds) {
  Metric metric({2, 5, 4, 3});
  EXPECT_EQ(metric.target(1), 5);
  EXPECT_EQ(metric.length(0, 1, edge), 2);
  EXPECT_EQ(metric.squared_length(0, 1, edge), 4);
  EXPECT_EQ(metric.length({0, 1, 2, 3}, edge), 2);
  EXPECT_EQ(metric.volume({0, 1, 2, 3}, 3.5 * 3.5 * 3.5), 1);
  EXPECT_FALSE(metric.exceeds(2, 0, 1, edge));
  EXPECT_TRUE(metric.exceeds(1.999, 0, 1, edge));
}

TEST(Metric, LearnsAndForgetsVertices) {
  Metric metric({2});
  metric.add(5);
  EXPECT_EQ(metric.length(0, 1, edge), 2);
  metric.resize(1);
  metric.resize(2, 12);
  EXPECT_EQ(metric.length(0, 1, edge), 1);
  metric.set(1, 0.8);
  EXPECT_EQ(metric.length(0, 1, edge), 5);
}

// Coarsening makes no edge that is too long in the metric, unless the edge before was as long.
TEST(Metric, BoundsTheEdgesThatCoarseningMakes) {
  const Plc plc;
  const TetMesh mesh;
  const remeshing::TetBounds bounds{remeshing::ThinShape(plc, mesh, 8, 0, nullptr),
                                    remeshing::CellBounds(plc, mesh, {})};
  const Metric metric({4, 6, 20});
  const remeshing::coarsening::CoarseningRule rule(bounds, 2, metric);
  EXPECT_TRUE(rule.allows_edge(0, 1, edge, {}));
  EXPECT_FALSE(rule.allows_edge(0, 1, 1.1 * edge, {}));
  EXPECT_TRUE(rule.allows_edge(0, 2, 1.1 * edge, {}));
  EXPECT_TRUE(rule.allows_edge(0, 1, {0, 0, 9}, {0, 9, 0}));
  EXPECT_FALSE(rule.allows_edge(0, 1, {0, 0, 9}, {0, 8.9, 0}));
}

}  // namespace
}  // namespace collarmesh::metric_test
