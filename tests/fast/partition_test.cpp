// Dividing a mesh among ranks: balanced, with few cut faces, and reproducible. Compared with counts over all
// pairs of tets.
#include "collarmesh/partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/pipeline.h"
#include "io/cell_partitions.h"
#include "partition/level_partitions.h"
#include "support/sample_mesh.h"
#include "support/second_order.h"
#include "support/shapes.h"

namespace collarmesh::partition_test {
namespace {

using namespace testing;

/// Returns the error of a build without Scotch; empty if Scotch is there.
std::string reason_against() {
  try {
    require_partitioner();
  } catch (const OptionError& error) {
    return error.what();
  }
  return {};
}

std::size_t common_corners(const std::array<Index, 4>& a, const std::array<Index, 4>& b) {
  return static_cast<std::size_t>(std::count_if(
      a.begin(), a.end(), [&](Index v) { return std::find(b.begin(), b.end(), v) != b.end(); }));
}

std::size_t cut_of_all_pairs(const TetMesh& mesh) {
  std::size_t cut = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t u = 0; u < t; ++u)
      if (mesh.tet_partition[t] != mesh.tet_partition[u] && common_corners(mesh.tets[t], mesh.tets[u]) == 3)
        ++cut;
  return cut;
}

TetMesh partitioned(TetMesh mesh, unsigned partitions) {
  partition(mesh, partitions);
  return mesh;
}

std::vector<std::size_t> sizes(const std::vector<Index>& partition_of, std::size_t partitions) {
  std::vector<std::size_t> count(partitions, 0);
  for (const Index p : partition_of) ++count.at(p);
  return count;
}

TEST(Partition, IsBalancedAndItsCutIsThatOfAllPairs) {
  if (!reason_against().empty()) GTEST_SKIP() << reason_against();
  for (const Index n : {1U, 2U, 3U, 4U}) {
    const TetMesh mesh = sample_mesh(n);
    const std::size_t tets = mesh.tets.size();
    for (const std::size_t partitions : std::set<std::size_t>{1, 2, 3, 5, 8, 12, tets / 3, tets - 1, tets}) {
      SCOPED_TRACE(std::to_string(tets) + " tets in " + std::to_string(partitions));
      const TetMesh divided = partitioned(mesh, static_cast<unsigned>(partitions));
      ASSERT_EQ(divided.tet_partition.size(), tets);
      EXPECT_EQ(divided.tets, mesh.tets);
      const std::vector<std::size_t> count = sizes(divided.tet_partition, partitions);
      const auto [smallest, largest] = std::minmax_element(count.begin(), count.end());
      EXPECT_GE(*smallest, 1U);
      EXPECT_LE(static_cast<double>(*largest),
                std::max(1.03 * static_cast<double>(tets) / static_cast<double>(partitions),
                         std::ceil(static_cast<double>(tets) / static_cast<double>(partitions))));
      const PartitionMeasures measures = measure_partitions(divided);
      EXPECT_EQ(measures.partitions, partitions);
      EXPECT_EQ(measures.smallest, *smallest);
      EXPECT_EQ(measures.largest, *largest);
      EXPECT_NEAR(measures.imbalance,
                  static_cast<double>(*largest * partitions) / static_cast<double>(tets) - 1, 1e-12);
      EXPECT_EQ(measures.cut_faces, cut_of_all_pairs(divided));
    }
  }
}

// The box is twice as high as it is deep and wide: a plane across it cuts two triangles of each square.
TEST(Partition, HalvesABoxAlmostAsAPlaneDoes) {
  if (!reason_against().empty()) GTEST_SKIP() << reason_against();
  for (const Index n : {4U, 8U, 12U})
    EXPECT_LE(measure_partitions(partitioned(sample_mesh(n), 2)).cut_faces, 5 * n * n / 2) << n;
}

TEST(Partition, IsTheSameInEveryThread) {
  if (!reason_against().empty()) GTEST_SKIP() << reason_against();
  const TetMesh mesh = sample_mesh(6);
  const std::vector<Index> first = partitioned(mesh, 7).tet_partition;
  std::array<std::vector<Index>, 4> results;
  std::vector<std::jthread> threads;
  for (std::vector<Index>& result : results)
    threads.emplace_back([&] { result = partitioned(mesh, 7).tet_partition; });
  threads.clear();
  for (const std::vector<Index>& result : results) EXPECT_EQ(result, first);
}

TEST(Partition, SecondOrderIsDividedLikeFirst) {
  if (!reason_against().empty()) GTEST_SKIP() << reason_against();
  EXPECT_EQ(partitioned(second_order(sample_mesh(2)), 4).tet_partition,
            partitioned(sample_mesh(2), 4).tet_partition);
}

TEST(Partition, IsAStageOfARun) {
  if (!reason_against().empty()) GTEST_SKIP() << reason_against();
  PipelineOptions options;
  options.mesh.size = 0.5;
  options.partitions = 3;
  const PolygonSoup soup = testing::box();
  const SoupPipelineResult made = run_pipeline({&soup, 1}, options);
  EXPECT_EQ(made.missed(), "");
  const std::vector<Index>& parts = made.result.mesh.tet_partition;
  ASSERT_EQ(parts.size(), made.result.mesh.tets.size());
  EXPECT_EQ(std::set<Index>(parts.begin(), parts.end()), (std::set<Index>{0, 1, 2}));
}

TEST(DistanceOfARun, IsTheGivenOneElseTheDefaultOfTheSize) {
  PipelineOptions options;
  options.mesh.size = 0.2;
  EXPECT_DOUBLE_EQ(distance_of(options, 100), 0.02) << "a tenth of the size";
  EXPECT_DOUBLE_EQ(distance_of(options, 1), 1.0 / 200) << "a share of the diagonal";
  options.order = 2;
  EXPECT_DOUBLE_EQ(distance_of(options, 1), 1.0 / 550);
  options.mesh.bounds.distance = 0.125;
  EXPECT_EQ(distance_of(options, 1), 0.125);
}

TEST(Partition, NumbersOutOfRangeAreErrors) {
  if (!reason_against().empty()) GTEST_SKIP() << reason_against();
  TetMesh mesh = sample_mesh(1);
  for (const unsigned partitions : {0U, 13U, 4'000'000'000U}) {
    try {
      partition(mesh, partitions);
      ADD_FAILURE() << partitions;
    } catch (const OptionError& error) {
      EXPECT_NE(std::string(error.what()).find("12 tets"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(mesh.tet_partition.empty());
  }
}

TEST(Partition, WithoutScotchSaysWhatToInstall) {
  const std::string reason = reason_against();
  if (reason.empty()) GTEST_SKIP() << "Scotch is there";
  EXPECT_NE(reason.find("libscotch-dev"), std::string::npos) << reason;
}

TEST(Partition, MeasuresOfAMeshThatIsNotPartitioned) {
  EXPECT_EQ(measure_partitions(sample_mesh(1)).partitions, 0U);
}

/// Returns rows of tets, each tet beside the next one; rows do not touch each other.
DualGraph rows(std::initializer_list<GraphIndex> lengths) {
  DualGraph graph;
  graph.starts.push_back(0);
  GraphIndex first = 0;
  for (const GraphIndex length : lengths) {
    for (GraphIndex t = first; t < first + length; ++t) {
      if (t > first) graph.neighbours.push_back(t - 1);
      if (t + 1 < first + length) graph.neighbours.push_back(t + 1);
      graph.starts.push_back(static_cast<GraphIndex>(graph.neighbours.size()));
    }
    first += length;
  }
  return graph;
}

TEST(LevelPartitions, WhateverTheyWere) {
  struct Case {
    DualGraph graph;
    std::vector<GraphIndex> before;
    std::size_t partitions, most;
  };
  const std::vector<GraphIndex> all_in_one(12, 0);
  std::vector<GraphIndex> uneven(20, 2);
  uneven[3] = 0;
  uneven[17] = 1;
  for (const auto& [graph, before, partitions, most] :
       {Case{rows({12}), all_in_one, 12, 1}, Case{rows({12}), all_in_one, 3, 4},
        Case{rows({3, 3, 3, 3}), all_in_one, 5, 3}, Case{rows({5, 7}), all_in_one, 1, 12},
        Case{rows({20}), uneven, 3, 7}, Case{rows({10, 10}), uneven, 4, 5}}) {
    std::vector<GraphIndex> after = before;
    level_partitions(graph, partitions, most, after);
    std::map<GraphIndex, std::size_t> count;
    for (const GraphIndex p : after) ++count[p];
    EXPECT_EQ(count.size(), partitions);
    for (const auto& [part, tets] : count) {
      EXPECT_LE(tets, most);
      EXPECT_GE(part, 0);
      EXPECT_LT(part, static_cast<GraphIndex>(partitions));
    }
  }
}

// A partition that is balanced enough stays as it is: 0 0 0 1 1 1 2 2 2.
TEST(LevelPartitions, MoveNoMoreThanNeeded) {
  const std::vector<GraphIndex> even{0, 0, 0, 1, 1, 1, 2, 2, 2};
  std::vector<GraphIndex> after = even;
  level_partitions(rows({9}), 3, 3, after);
  EXPECT_EQ(after, even);
  std::vector<GraphIndex> one_too_many{0, 0, 0, 0, 1, 1, 1, 2, 2};  // partition 0 passes a tet to 1, and 1
                                                                    // passes one to 2
  level_partitions(rows({9}), 3, 3, one_too_many);
  EXPECT_EQ(one_too_many, even);
}

TetMesh striped(TetMesh mesh) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    mesh.tet_partition.push_back(static_cast<Index>(t / 7 % 4 + 2));
  return mesh;
}

template <class Cell>
Index lowest_around(const TetMesh& mesh, const Cell& corners) {
  Index lowest = none;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (std::all_of(corners.begin(), corners.end(), [&](Index v) {
          return std::find(mesh.tets[t].begin(), mesh.tets[t].end(), v) != mesh.tets[t].end();
        }))
      lowest = std::min(lowest, mesh.tet_partition[t]);
  return lowest;
}

TEST(CellPartitions, OfFacesEdgesAndPoints) {
  const TetMesh mesh = striped(sample_mesh(2));
  const std::vector<Index> faces = io::partitions_of_faces(mesh), edges = io::partitions_of_edges(mesh),
                           points = io::partitions_of_points(mesh);
  ASSERT_EQ(faces.size(), mesh.faces.size());
  ASSERT_EQ(edges.size(), mesh.edges.size());
  ASSERT_EQ(points.size(), mesh.points.size());
  for (std::size_t f = 0; f < faces.size(); ++f) EXPECT_EQ(faces[f], lowest_around(mesh, mesh.faces[f]));
  for (std::size_t e = 0; e < edges.size(); ++e) EXPECT_EQ(edges[e], lowest_around(mesh, mesh.edges[e]));
  for (Index v = 0; v < points.size(); ++v) EXPECT_EQ(points[v], lowest_around(mesh, std::array{v}));
  EXPECT_EQ(io::partition_numbers(mesh), (std::vector<Index>{2, 3, 4, 5}));
}

TEST(CellPartitions, GhostsShareAVertex) {
  const TetMesh mesh = striped(sample_mesh(2));
  const std::vector<std::vector<Index>> ghosts = io::ghost_tets(mesh);
  ASSERT_EQ(ghosts.size(), 4U);
  for (Index k = 0; k < 4; ++k) {
    std::vector<Index> expected;
    for (Index t = 0; t < mesh.tets.size(); ++t) {
      bool touches = false;
      for (std::size_t u = 0; u < mesh.tets.size(); ++u)
        touches =
            touches || (mesh.tet_partition[u] == k + 2 && common_corners(mesh.tets[t], mesh.tets[u]) > 0);
      if (touches && mesh.tet_partition[t] != k + 2) expected.push_back(t);
    }
    EXPECT_EQ(ghosts[k], expected);
  }
}

}  // namespace
}  // namespace collarmesh::partition_test
