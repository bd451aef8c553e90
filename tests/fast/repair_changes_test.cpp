// Changes of a draft that are taken back with their segments, and triangles that are replaced one by one,
// compared with searches through all triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "repair/changes.h"
#include "repair/changing_triangles.h"
#include "support/plc_shapes.h"
#include "support/repair_drafts.h"
#include "support/shapes.h"

namespace collarmesh::repairing::repair_changes_test {
namespace {

using namespace facets;
using testing::polygonal_box;
using testing::faulty::draft_of;
using testing::faulty::with_moved_corners;

// Edges of the boxes at the moved corners are segments, too, and one far from all changes.
TEST(Changes, SegmentsAreThoseOfTheirPlaces) {
  const std::vector<PolygonSoup> soups{polygonal_box({0, 0, 0}, {1, 1, 1}),
                                       polygonal_box({5, 0, 0}, {6, 1, 1})};
  ComplexDraft before = draft_of(soups);
  const auto at = [](const ComplexDraft& draft, const Point& p) {
    return static_cast<Index>(std::ranges::find(draft.points, p) - draft.points.begin());
  };
  const auto add = [&](ComplexDraft& draft, const Point& a, const Point& b, Tag tag) {
    draft.segments.push_back({.a = at(draft, a), .b = at(draft, b), .tag = tag});
  };
  ComplexDraft after = with_moved_corners(before);
  for (ComplexDraft* const draft : {&before, &after}) {
    const bool moved = draft == &after;
    add(*draft, moved ? Point{0, 0.1, 0.2} : Point{0, 0, 0}, {1, 0, 0}, 1);
    add(*draft, moved ? Point{6, 0.1, 0.2} : Point{6, 0, 0}, {5, 0, 0}, 2);
    add(*draft, {0, 1, 1}, {1, 1, 1}, 3);
  }
  before.loose_points = {at(before, {0, 0, 0}), at(before, {1, 1, 1})};
  after.loose_points = {at(after, {0, 0.1, 0.2}), at(after, {1, 1, 1})};
  const Changes changes(before, after);
  ASSERT_EQ(changes.places(), 2U);
  for (const bool first : {false, true})
    for (const bool second : {false, true}) {
      std::vector<Index> place;
      const ComplexDraft mixed = changes.without({first, second}, place);
      ASSERT_EQ(mixed.segments.size(), 3U);
      std::size_t at_old = 0;
      for (const Tag tag : {1, 2, 3}) {
        const auto segment = std::ranges::find(mixed.segments, tag, &facets::Segment::tag);
        ASSERT_NE(segment, mixed.segments.end());
        for (const Index end : {segment->a, segment->b})
          at_old += mixed.points[end] == Point{0, 0, 0} || mixed.points[end] == Point{6, 0, 0} ? 1 : 0;
        // Each segment is an edge of the triangles.
        EXPECT_TRUE(std::ranges::any_of(mixed.triangles, [&](const Corners& t) {
          return std::ranges::count(t, segment->a) + std::ranges::count(t, segment->b) == 2;
        })) << tag;
      }
      EXPECT_EQ(at_old, (first ? 1U : 0U) + (second ? 1U : 0U));
      ASSERT_EQ(mixed.loose_points.size(), 2U);
      EXPECT_EQ(mixed.points[mixed.loose_points[1]], (Point{1, 1, 1}));
      EXPECT_TRUE(std::ranges::any_of(mixed.triangles, [&](const Corners& t) {
        return std::ranges::count(t, mixed.loose_points[0]) == 1;
      }));
    }
}

// ChangingTriangles

/// Expects the lists of sides that a search through all triangles finds.
void expect_lists(const ChangingTriangles& triangles, const ComplexDraft& draft) {
  std::vector<std::set<Index>> at(draft.points.size());
  std::size_t count = 0;
  for (Index t = 0; t < triangles.end(); ++t) {
    if (!triangles.alive(t)) continue;
    ++count;
    EXPECT_TRUE(triangles.consistent(draft.triangles[t]));
    for (unsigned i = 0; i < 3; ++i) at[draft.triangles[t][i]].insert(3 * t + i);
    const Index least = triangles.least_busy(draft.triangles[t]);
    EXPECT_EQ(std::ranges::count(draft.triangles[t], least), 1);
  }
  EXPECT_EQ(triangles.count(), count);
  for (Index p = 0; p < draft.points.size(); ++p) {
    std::set<Index> found;
    triangles.for_each_at(p, [&](Index side) { EXPECT_TRUE(found.insert(side).second); });
    EXPECT_EQ(found, at[p]);
    EXPECT_EQ(triangles.uses(p), !at[p].empty());
  }
}

TEST(ChangingTriangles, ListsAreThoseOfASearchThroughAll) {
  std::mt19937 random(3);
  ComplexDraft draft = draft_of(testing::icosphere(1, 3));
  Work work;
  ChangingTriangles triangles(draft, 0.01, work);
  expect_lists(triangles, draft);
  for (int step = 0; step < 120; ++step) {
    const Index t = random() % triangles.end();
    const Corners corners = draft.triangles[t];
    const Origin origin = draft.origins[t];
    if (triangles.alive(t)) triangles.remove(t);
    if (step % 3 == 0) {  // divides the triangle
      const auto middle = static_cast<Index>(draft.points.size());
      draft.points.push_back(
          (draft.points[corners[0]] + draft.points[corners[1]] + draft.points[corners[2]]) / 3);
      draft.point_tags.push_back(0);
      for (unsigned i = 0; i < 3; ++i) {
        const Index made = triangles.add({corners[i], corners[(i + 1) % 3], middle}, origin);
        EXPECT_EQ(made + 1, triangles.end());
      }
    }
    if (step % 20 == 0) expect_lists(triangles, draft);
  }
  expect_lists(triangles, draft);
  for (Index t = 0; t < triangles.end(); ++t)
    for (unsigned i = 0; i < 3; ++i) {
      const Edge edge = edge_key(draft.triangles[t][i], draft.triangles[t][(i + 1) % 3]);
      std::vector<Index> sides;
      for (Index side = 0; side < 3 * triangles.end(); ++side) {
        const Corners& c = draft.triangles[side / 3];
        if (triangles.alive(side / 3) && edge_key(c[side % 3], c[(side % 3 + 1) % 3]) == edge)
          sides.push_back(side);
      }
      EXPECT_EQ(triangles.sides(edge).size(), sides.size());
    }
  const ComplexDraft compacted = triangles.compacted();
  EXPECT_EQ(compacted.triangles.size(), triangles.count());
}

}  // namespace
}  // namespace collarmesh::repairing::repair_changes_test
