// Points that are not in the mesh yet: the vertices they are found from, when they are due, and which
// candidates warp to them.
#include "refine/unresolved_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace collarmesh::unresolved_points_test {
namespace {

class UnresolvedPointsTest : public ::testing::Test {
 protected:
  static Box box() {
    Box b;
    b.add(Point{0, 0, 0});
    b.add(Point{1, 1.1, 1.2});
    return b;
  }

  void find_zone(const Point& p) {
    mesh_.find_conflict_zone(p, mesh_.conflicting_cell_around(mesh_.nearest_vertex(p), p), zone_);
  }
  Index insert(const Point& p) {
    find_zone(p);
    const Index vertex = mesh_.insert(zone_, {3, none});
    points_.cells_made(zone_, vertex);
    return vertex;
  }
  /// Returns the point to which a candidate would warp if it destroyed a ball of this radius.
  Index target(const Point& centre, double radius, std::uint8_t dimension = 3) {
    find_zone(centre);
    return points_.warp_target(zone_, {centre, radius * radius, centre, {dimension, 0}, none});
  }

  Plc plc_;
  WorkQueue queue_{1.0};
  RefinedMesh mesh_{plc_, box()};
  UnresolvedPoints points_{mesh_, 0.25, queue_};
  ConflictZone zone_;
};

TEST_F(UnresolvedPointsTest, EachIsFoundFromTheNearestVertex) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0.01, 0.99);
  const auto next = [&] { return Point{unit(random), unit(random), unit(random)}; };
  for (int k = 0; k < 100; ++k) {
    points_.add(next(), {2, 0});
    insert(next());
  }
  for (Index point = 0; point < points_.size(); ++point)
    EXPECT_EQ(points_.vertex_near(point), mesh_.nearest_vertex(points_[point].point));
}

TEST_F(UnresolvedPointsTest, OneIsDueWhenItsBallHasNotShrunk) {
  insert({0.5, 0.5, 0.5});
  const Index point = points_.add({0.5, 0.5, 0.9}, {0, 0});
  WorkQueue::Item item;
  ASSERT_TRUE(queue_.pop(item));
  EXPECT_EQ(item.priority, WorkQueue::unresolved_points);
  EXPECT_TRUE(points_.is_due(point, item.entry.stamp));
  EXPECT_FALSE(queue_.pop(item));
  insert({0.5, 0.5, 0.8});
  EXPECT_FALSE(points_.is_due(point, item.entry.stamp));  // other points come first now
  ASSERT_TRUE(queue_.pop(item));
  EXPECT_TRUE(points_.is_due(point, item.entry.stamp));
  points_.resolve(point, 9);
  EXPECT_TRUE(points_.resolved(point));
  EXPECT_EQ(points_.vertex_near(point), 9U);
  EXPECT_FALSE(points_.is_due(point, item.entry.stamp));
}

TEST_F(UnresolvedPointsTest, ACandidateWarpsToTheLowestDimensionWithinTheta) {
  insert({0.5, 0.5, 0.5});
  const Point centre{0.5, 0.5, 0.7};
  EXPECT_EQ(target(centre, 0.2), none);
  const Index on_patch = points_.add({0.5, 0.5, 0.71}, {2, 0});
  EXPECT_EQ(target(centre, 0.2), on_patch);
  EXPECT_EQ(target(centre, 0.2, 2), none);  // none of its own dimension
  const Index on_curve = points_.add({0.5, 0.5, 0.74}, {1, 0});
  EXPECT_EQ(target(centre, 0.2), on_curve);
  EXPECT_EQ(target(centre, 0.2, 2), on_curve);
  EXPECT_EQ(target(centre, 0.1), on_patch);  // 0.04 is farther than theta r
  const Index nearer = points_.add({0.5, 0.5, 0.68}, {1, 1});
  EXPECT_EQ(target(centre, 0.2), nearer);
  points_.resolve(nearer, 0);
  EXPECT_EQ(target(centre, 0.2), on_curve);
}

TEST_F(UnresolvedPointsTest, ADormantOneComesInOnlyWhenACandidateWarpsToIt) {
  insert({0.5, 0.5, 0.5});
  UnresolvedPoints::Unresolved dormant{{0.5, 0.5, 0.74}, {1, 0}};
  dormant.dormant = true;
  const Index point = points_.add(dormant, none);
  WorkQueue::Item item;
  EXPECT_FALSE(queue_.pop(item));
  EXPECT_EQ(target({0.5, 0.5, 0.7}, 0.2), point);
}

TEST_F(UnresolvedPointsTest, OneThatIsWithdrawnIsFoundNoMore) {
  const Index v = insert({0.5, 0.5, 0.5});
  const Index point = points_.add({0.5, 0.5, 0.55}, {1, 0});
  EXPECT_TRUE(points_.any_at(v));
  WorkQueue::Item item;
  ASSERT_TRUE(queue_.pop(item));
  points_.withdraw(point);
  EXPECT_FALSE(points_.any_at(v));
  EXPECT_FALSE(points_.is_due(point, item.entry.stamp));
  EXPECT_FALSE(points_.resolved(point));
  EXPECT_EQ(target({0.5, 0.5, 0.56}, 0.2), none);
}

// Near one vertex of a coarse mesh a point is not medial, between several it is. Compared with a search over
// all vertices.
TEST_F(UnresolvedPointsTest, MedialOnesHaveASecondVertexHardlyFarther) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(0.01, 0.99);
  const double theta_0 = 0.25 / 1.25;
  std::size_t medial = 0, others = 0;
  for (int k = 0; k < 200; ++k) {
    const Point v{unit(random), unit(random), unit(random)};
    insert(v);
    const Point p =
        k % 2 == 0 ? Point{unit(random), unit(random), unit(random)} : v + Vector{0.01, 0.005, 0.002};
    std::vector<double> distances;
    for (Index w = 0; w < mesh_.vertex_count(); ++w) distances.push_back(distance(p, mesh_.point(w)));
    std::sort(distances.begin(), distances.end());
    const Index point = points_.add(p, {0, 0});
    EXPECT_EQ(points_.medial(point), distances[0] >= theta_0 * distances[1]);
    ++(points_.medial(point) ? medial : others);
  }
  EXPECT_GT(medial, 50U);
  EXPECT_GT(others, 50U);
}

TEST_F(UnresolvedPointsTest, OfSeveralVerticesOfTheComplexInACellNoneIsTheOnlyOne) {
  const Index v = insert({0.5, 0.5, 0.5});
  EXPECT_EQ(points_.only_vertex_at(v), none);
  points_.add({0.51, 0.5, 0.5}, {1, 0});
  EXPECT_EQ(points_.only_vertex_at(v), none);
  const Index first = points_.add({0.5, 0.52, 0.5}, {0, 0});
  EXPECT_EQ(points_.only_vertex_at(v), first);
  const Index second = points_.add({0.5, 0.5, 0.53}, {0, 1});
  EXPECT_EQ(points_.only_vertex_at(v), none);
  points_.resolve(second, v);
  EXPECT_EQ(points_.only_vertex_at(v), first);
}

}  // namespace
}  // namespace collarmesh::unresolved_points_test
