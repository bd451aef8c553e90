// Overlapping boxes, whose unions are known exactly.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <vector>

#include "support/meshing.h"
#include "support/repair_shapes.h"
#include "support/shapes.h"

namespace collarmesh::repair_boxes_test {
namespace {

using namespace testing::faulty;
using testing::faults;
using testing::mesh_of;
using testing::with_size;
using Volumes = std::map<Tag, std::vector<double>>;

double total_area(std::span<const PolygonSoup> soups) {
  double sum = 0;
  for (const PolygonSoup& soup : soups) sum += area(soup);
  return sum;
}

// Returns the allowed error of volumes: the area times the tolerance.
double slack(const RepairedPlc& repaired, std::span<const PolygonSoup> soups) {
  return repaired.report.tolerance * total_area(soups) + 1e-9;
}

void expect_volumes(const RepairedPlc& repaired, std::span<const PolygonSoup> soups,
                    const Volumes& expected) {
  const Volumes actual = region_volumes(repaired.plc);
  ASSERT_EQ(actual.size(), expected.size());
  for (const auto& [tag, volumes] : expected) {
    ASSERT_TRUE(actual.count(tag) > 0) << "region " << tag;
    ASSERT_EQ(actual.at(tag).size(), volumes.size()) << "region " << tag;
    for (std::size_t i = 0; i < volumes.size(); ++i)
      EXPECT_NEAR(actual.at(tag)[i], volumes[i], slack(repaired, soups)) << "region " << tag;
  }
}

std::vector<PolygonSoup> soups_of(std::span<const Box> boxes) {
  std::vector<PolygonSoup> soups;
  for (const Box& box : boxes) {
    soups.push_back(soup_of(box));
    soups.back().region_tag = 11 + static_cast<Tag>(soups.size());
  }
  return soups;
}

std::string text(std::span<const Box> boxes) {
  std::string text;
  for (const Box& b : boxes)
    text += fmt::format("({}, {}, {})-({}, {}, {}) ", b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z);
  return text;
}

std::vector<Tag> labels_of(std::span<const PolygonSoup> soups) {
  std::vector<Tag> labels;
  for (const PolygonSoup& soup : soups) labels.push_back(*soup.region_tag);
  return labels;
}

// Returns whether a box is inside another one, away from all sides: that is no fault, and makes a region of
// its own.
bool is_nested(std::span<const Box> boxes, const Box& box) {
  bool inside_any = false;
  for (const Box& other : boxes) {
    if (&other == &box) continue;
    bool inside = true, apart = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      inside = inside && other.min[axis] < box.min[axis] && box.max[axis] < other.max[axis];
      apart = apart || box.max[axis] < other.min[axis] || other.max[axis] < box.min[axis];
    }
    if (!inside && !apart) return false;
    inside_any = inside_any || inside;
  }
  return inside_any;
}

// Boxes with corners on a small lattice: they share faces and edges, overlap in faces, touch, or contain each
// other.
TEST(RepairBoxes, OnALatticeInOneSoupAreTheirUnion) {
  Random random(1);
  unsigned judged = 0;
  for (unsigned member = 0; member < members(120); ++member) {
    const auto boxes = random_boxes(random, 2 + member % 3, 2 + member % 4);
    SCOPED_TRACE(fmt::format("member {}: {}", member, text(boxes)));
    const auto soups = soups_of(boxes);
    PolygonSoup soup = joined(soups);
    soup.region_tag = 12;
    // Input that is no fault for the builder keeps its meaning.
    const RepairedPlc r = repaired(soup);
    if (!r.report.repaired) continue;
    if (std::any_of(boxes.begin(), boxes.end(), [&](const Box& b) { return is_nested(boxes, b); })) continue;
    ++judged;
    EXPECT_EQ(faults_of(r, {&soup, 1}, r.report.tolerance), std::vector<std::string>{});
    expect_volumes(r, soups, piece_volumes(boxes, std::vector<Tag>(boxes.size(), 12)));
    if (member % 24 == 0) {
      EXPECT_EQ(faults(mesh_of(r.plc, with_size(0.3))), "");
    }
  }
  EXPECT_GT(judged, members(120) / 4);
}

TEST(RepairBoxes, OnALatticeInSeveralSoupsTheFirstHasThePlace) {
  Random random(2);
  unsigned judged = 0;
  for (unsigned member = 0; member < members(120); ++member) {
    const auto boxes = random_boxes(random, 2 + member % 3, 2 + member % 4);
    SCOPED_TRACE(fmt::format("member {}: {}", member, text(boxes)));
    const auto soups = soups_of(boxes);
    const RepairedPlc r = repaired(soups);
    if (!r.report.repaired) continue;
    ++judged;
    EXPECT_EQ(faults_of(r, soups, r.report.tolerance), std::vector<std::string>{});
    expect_volumes(r, soups, piece_volumes(boxes, labels_of(soups)));
    if (member % 24 == 0) {
      EXPECT_EQ(faults(mesh_of(r.plc, with_size(0.3))), "");
    }
  }
  EXPECT_GT(judged, members(120) / 4);
}

// Two boxes, each turned about one axis through both, so that two facets of each are coplanar.
TEST(RepairBoxes, CoplanarOverlapsOfTurnedFacets) {
  Random random(3);
  for (unsigned member = 0; member < members(40); ++member) {
    const double height = member % 2 == 0 ? 1 : 0.5;
    std::vector<PolygonSoup> soups{
        testing::rotated(testing::box({-0.5, -0.5, 0}, {0.5, 0.5, 1}, 1), {0, 0, 1}, uniform(random, 0, 90)),
        testing::translated(
            testing::rotated(testing::box({-0.5, -0.5, 0}, {0.5, 0.5, height}, 1), {0, 0, 1},
                             uniform(random, 0, 90)),
            {uniform(random, -0.4, 0.4), uniform(random, -0.4, 0.4), member % 4 < 2 ? 0 : 1 - height})};
    SCOPED_TRACE(member);
    const std::array bodies{convex_of(soups[0]), convex_of(soups[1])};
    const PolygonSoup one = joined(soups);
    const RepairedPlc r = repaired(one);
    EXPECT_TRUE(r.report.repaired);
    EXPECT_EQ(faults_of(r, {&one, 1}, 2 * r.report.tolerance), std::vector<std::string>{});
    EXPECT_EQ(r.plc.regions.size(), 2U);
    EXPECT_NEAR(total_volume(r.plc), union_volume(bodies), slack(r, soups));
    if (member % 10 == 0) {
      EXPECT_EQ(faults(mesh_of(r.plc, with_size(0.3))), "");
    }
  }
}

std::vector<PolygonSoup> turned_cubes(Random& random, unsigned count) {
  std::vector<PolygonSoup> soups;
  for (unsigned i = 0; i < count; ++i) {
    const PolygonSoup cube = turned(testing::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 1), random);
    soups.push_back(testing::translated(cube, uniform(random, 0, 0.6) * random_direction(random)));
    soups.back().region_tag = 12 + i;
  }
  return soups;
}

std::vector<Convex> convexes_of(std::span<const PolygonSoup> soups) {
  std::vector<Convex> bodies;
  for (const PolygonSoup& soup : soups) bodies.push_back(convex_of(soup));
  return bodies;
}

TEST(RepairBoxes, TurnedInOneSoupAreTheirUnion) {
  Random random(4);
  for (unsigned member = 0; member < members(60); ++member) {
    SCOPED_TRACE(member);
    const auto soups = turned_cubes(random, 2 + member % 2);
    const PolygonSoup one = joined(soups);
    const RepairedPlc r = repaired(one);
    EXPECT_TRUE(r.report.repaired);
    EXPECT_GT(r.report.cut.count, 0U);
    EXPECT_EQ(faults_of(r, {&one, 1}, 2 * r.report.tolerance), std::vector<std::string>{});
    EXPECT_EQ(r.plc.regions.size(), 2U);
    EXPECT_NEAR(total_volume(r.plc), union_volume(convexes_of(soups)), slack(r, soups));
    if (member % 12 == 0) {
      EXPECT_EQ(faults(mesh_of(r.plc, with_size(0.3))), "");
    }
  }
}

TEST(RepairBoxes, TurnedInSeveralSoupsTheFirstHasThePlace) {
  Random random(5);
  for (unsigned member = 0; member < members(60); ++member) {
    SCOPED_TRACE(member);
    const auto soups = turned_cubes(random, 2 + member % 2);
    const RepairedPlc r = repaired(soups);
    EXPECT_TRUE(r.report.repaired);
    EXPECT_EQ(faults_of(r, soups, 2 * r.report.tolerance), std::vector<std::string>{});
    const auto expected = places(convexes_of(soups));
    const Volumes actual = region_volumes(r.plc);
    for (std::size_t i = 0; i < soups.size(); ++i) {
      const auto found = actual.find(12 + static_cast<Tag>(i));
      const double volume =
          found == actual.end() ? 0 : std::accumulate(found->second.begin(), found->second.end(), 0.0);
      EXPECT_NEAR(volume, expected[i], slack(r, soups)) << "soup " << i;
    }
    if (member % 12 == 0) {
      EXPECT_EQ(faults(mesh_of(r.plc, with_size(0.3))), "");
    }
  }
}

// Names the edges of each soup by segments, with tags that no other soup has. Returns the ends of each.
std::map<Tag, std::array<Point, 2>> name_edges(std::vector<PolygonSoup>& soups) {
  std::map<Tag, std::array<Point, 2>> ends;
  for (PolygonSoup& soup : soups) {
    soup.given_features = true;
    for (Index f = 0; f < soup.facet_count(); ++f) {
      const auto corners = soup.polygon(soup.facet_polygons(f)[0]);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Index a = corners[i], b = corners[(i + 1) % corners.size()];
        if (a > b) continue;
        const auto tag = static_cast<Tag>(ends.size() + 1);
        soup.segments.push_back({a, b, tag});
        ends[tag] = {soup.points[a], soup.points[b]};
      }
    }
  }
  return ends;
}

double distance_from_line(const Point& p, const std::array<Point, 2>& line) {
  return norm(cross(p - line[0], line[1] - line[0])) / distance(line[0], line[1]);
}

TEST(RepairBoxes, NewEdgesHaveNoTagOfAnother) {
  Random random(8);
  for (unsigned member = 0; member < members(12); ++member) {
    SCOPED_TRACE(member);
    auto soups = turned_cubes(random, 2);
    const auto edges = name_edges(soups);
    const RepairedPlc r = repaired(soups);
    bool any_new = false;
    for (const Plc::Curve& curve : r.plc.curves) {
      any_new = any_new || curve.tag == 0;
      if (curve.tag == 0) continue;
      ASSERT_TRUE(edges.count(curve.tag) > 0) << "curve " << curve.tag;
      for (const Index v : curve.points)
        EXPECT_LE(distance_from_line(r.plc.points[v], edges.at(curve.tag)), 2 * r.report.tolerance)
            << "curve " << curve.tag;
    }
    EXPECT_TRUE(any_new);
  }
}

// Named kinds of intersections, as one soup and as two.
TEST(RepairBoxes, SpecialMeetings) {
  struct Case {
    const char* name;
    Box second;
    double common;
    std::size_t regions_of_one;
  };
  const Point o{0, 0, 0};
  for (const Case& c : {Case{"share a facet", {{1, 0, 0}, {2, 1, 1}}, 0, 1},
                        {"share part of a facet", {{1, 0.25, 0.25}, {2, 0.75, 0.75}}, 0, 1},
                        {"share an edge", {{1, 1, 0}, {2, 2, 1}}, 0, 2},
                        {"share part of an edge", {{1, 1, 0.25}, {2, 2, 0.75}}, 0, 2},
                        {"share a corner", {{1, 1, 1}, {2, 2, 2}}, 0, 2},
                        {"coplanar sides", {{0.5, 0, 0}, {1.5, 1, 1}}, 0.5, 1},
                        {"one coplanar side", {{0.5, 0.25, 0}, {1.5, 0.75, 0.5}}, 0.125, 1},
                        {"one through the other", {{-0.5, 0.25, 0.25}, {1.5, 0.75, 0.75}}, 0.25, 1},
                        {"an edge in a facet", {{1, 0.25, 0.25}, {1.5, 0.75, 1}}, 0, 1}}) {
    SCOPED_TRACE(c.name);
    const std::array soups{soup_of({o, {1, 1, 1}}), soup_of(c.second)};
    const Vector d = c.second.max - c.second.min;
    const double second = d.x * d.y * d.z;
    const PolygonSoup one = joined(soups);
    const RepairedPlc u = repaired(one);
    EXPECT_NEAR(total_volume(u.plc), 1 + second - c.common, 1e-9);
    if (u.report.repaired) {
      EXPECT_EQ(u.plc.regions.size(), c.regions_of_one + 1);
    }
    const RepairedPlc two = repaired(soups);
    const auto volumes = region_volumes(two.plc);
    EXPECT_NEAR(total_volume(two.plc), 1 + second - c.common, 1e-9);
    ASSERT_GE(two.plc.regions.size(), 3U);
    EXPECT_NEAR(two.plc.regions[1].volume, 1, 1e-9);
    EXPECT_EQ(faults(mesh_of(u.plc, with_size(0.4))), "");
    EXPECT_EQ(faults(mesh_of(two.plc, with_size(0.4))), "");
  }
}

}  // namespace
}  // namespace collarmesh::repair_boxes_test
