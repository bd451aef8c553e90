// Parts of repair, each on its own.
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "collarmesh/repair.h"
#include "facets/edges.h"
#include "repair/arrangement.h"
#include "repair/better_places.h"
#include "repair/changes.h"
#include "repair/duplicate_triangles.h"
#include "repair/holes.h"
#include "repair/inside.h"
#include "repair/repeated.h"
#include "repair/snapping.h"
#include "repair/winding_number.h"
#include "support/expected_counts.h"
#include "support/repair_drafts.h"
#include "support/repair_shapes.h"
#include "support/sanitized.h"
#include "support/shapes.h"

namespace collarmesh::repairing::repair_parts_test {
namespace {

using namespace facets;
using namespace testing::faulty;

double volume_of(const ComplexDraft& draft) {
  double six = 0;
  for (Index t = 0; t < draft.triangles.size(); ++t)
    six += dot(draft.corner(t, 0), cross(draft.corner(t, 1), draft.corner(t, 2)));
  return six / 6;
}

double area_of(const ComplexDraft& draft) {
  double twice = 0;
  for (Index t = 0; t < draft.triangles.size(); ++t)
    twice += norm(cross(draft.corner(t, 1) - draft.corner(t, 0), draft.corner(t, 2) - draft.corner(t, 0)));
  return twice / 2;
}

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;

struct MeetingPoints : boost::static_visitor<std::vector<Exact::Point_3>> {
  result_type operator()(const Exact::Point_3& p) const { return {p}; }
  result_type operator()(const Exact::Segment_3& s) const { return {s.source(), s.target()}; }
  result_type operator()(const Exact::Triangle_3& t) const { return {t[0], t[1], t[2]}; }
  result_type operator()(const result_type& polygon) const { return polygon; }
};

// Returns the number of pairs of triangles that meet in more than a common corner or edge and are no copies.
std::size_t brute_force_intersections(const ComplexDraft& draft) {
  std::vector<Exact::Triangle_3> triangles;
  for (Index t = 0; t < draft.triangles.size(); ++t) {
    std::array<Exact::Point_3, 3> p;
    for (unsigned i = 0; i < 3; ++i)
      p[i] = {draft.corner(t, i).x, draft.corner(t, i).y, draft.corner(t, i).z};
    triangles.emplace_back(p[0], p[1], p[2]);
  }
  std::size_t count = 0;
  for (Index s = 0; s < triangles.size(); ++s)
    for (Index t = 0; t < s; ++t) {
      if (!CGAL::do_intersect(triangles[s].bbox(), triangles[t].bbox())) continue;
      const auto met = CGAL::intersection(triangles[s], triangles[t]);
      if (!met) continue;
      const auto common = [&](const Exact::Point_3& p) {
        for (unsigned i = 0; i < 3; ++i)
          for (unsigned j = 0; j < 3; ++j)
            if (draft.triangles[s][i] == draft.triangles[t][j] && triangles[s][static_cast<int>(i)] == p)
              return true;
        return false;
      };
      const auto points = boost::apply_visitor(MeetingPoints(), *met);
      count += std::all_of(points.begin(), points.end(), common) ? 0 : 1;
    }
  return count;
}

// WindingNumber

WindingNumber winding_of(const PolygonSoup& soup, int weight = 1) {
  const PolygonSoup flat = triangulated(soup);
  std::vector<WeightedTriangle> triangles;
  for (Index f = 0; f < flat.facet_count(); ++f) {
    const auto c = flat.polygon(f);
    triangles.push_back({{flat.points[c[0]], flat.points[c[1]], flat.points[c[2]]}, weight, f});
  }
  return WindingNumber(std::move(triangles));
}

TEST(WindingNumber, OfNothingIsZero) { EXPECT_EQ(WindingNumber({}).at({1, 2, 3}), 0); }

// The error of two terms of the expansion of far triangles falls with the square of their distance in radii:
// even from 4 radii on, instead of 3, the sum would be off by up to 0.03. Decisions are made at 1/2, so 0.05
// is close enough.
TEST(WindingNumber, IsTheDirectSum) {
  Random random(1);
  for (unsigned member = 0; member < members(12); ++member) {
    SCOPED_TRACE(member);
    const PolygonSoup soup = member % 3 == 0   ? folded_terrain(random, 12, 0.4)
                             : member % 3 == 1 ? sphere_with_holes(random, 8, 3).soup
                                               : triangulated(twisted_prism(6, 150, false));
    const WindingNumber winding = winding_of(soup);
    for (int i = 0; i < 200; ++i) {
      const Point p{uniform(random, -2, 2), uniform(random, -2, 2), uniform(random, -2, 2)};
      EXPECT_NEAR(winding.at(p), direct_winding_number(soup, p), 0.05);
    }
  }
}

TEST(WindingNumber, OfClosedSurfacesIsWhole) {
  Random random(2);
  const WindingNumber sphere = winding_of(testing::icosphere(1, 20)),
                      twice = winding_of(testing::icosphere(1, 20), 2),
                      inverted = winding_of(testing::inverted(testing::icosphere(1, 20)));
  for (int i = 0; i < 500; ++i) {
    const double radius = uniform(random, 0, 2);
    if (std::fabs(radius - 1) < 0.01) continue;
    const Point p = radius * random_direction(random);
    const double inside = radius < 1 ? 1 : 0;
    EXPECT_NEAR(sphere.at(p), inside, 0.05);
    EXPECT_NEAR(twice.at(p), 2 * inside, 0.1);
    EXPECT_NEAR(inverted.at(p), -inside, 0.05);
  }
}

TEST(WindingNumber, OnATriangleLeftOutIsTheMeanOfItsSides) {
  const PolygonSoup sphere = testing::icosphere(1, 10);
  const WindingNumber winding = winding_of(sphere);
  for (Index f = 0; f < sphere.facet_count(); f += 17) {
    const auto c = sphere.polygon(f);
    const Point centre = (1.0 / 3) * (sphere.points[c[0]] + sphere.points[c[1]] + sphere.points[c[2]]);
    EXPECT_NEAR(winding.at(centre, f), 0.5, 0.02);
  }
}

// Triangles that are far from the point are left out, too.
TEST(WindingNumber, LeavesOutAllTrianglesOfANumber) {
  const std::array<PolygonSoup, 2> spheres{testing::icosphere(1, 10), testing::icosphere(2, 10)};
  std::vector<WeightedTriangle> triangles;
  for (Index number = 0; number < 2; ++number)
    for (Index f = 0; f < spheres[number].facet_count(); ++f) {
      const auto c = spheres[number].polygon(f);
      const std::vector<Point>& points = spheres[number].points;
      triangles.push_back({{points[c[0]], points[c[1]], points[c[2]]}, 1, number});
    }
  const WindingNumber winding(std::move(triangles));
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Vector direction = random_direction(random);
    for (const double radius : {0.5, 1.0, 1.5, 2.0, 2.5}) {
      if (radius != 1) {
        EXPECT_NEAR(winding.at(radius * direction, 1), radius < 1 ? 1 : 0, 0.05);
      }
      if (radius != 2) {
        EXPECT_NEAR(winding.at(radius * direction, 0), radius < 2 ? 1 : 0, 0.05);
      }
    }
  }
}

// arrange

ComplexDraft pair_of(const std::array<Point, 3>& a, const std::array<Point, 3>& b, bool two_soups = false) {
  std::array<PolygonSoup, 2> soups;
  const std::array<std::array<Point, 3>, 2> triangles{a, b};
  for (std::size_t i = 0; i < 2; ++i) {
    soups[i].points.assign(triangles[i].begin(), triangles[i].end());
    soups[i].add_facet(std::array<Index, 3>{0, 1, 2}, 1 + static_cast<Tag>(i));
  }
  if (two_soups) return draft_of(soups);
  return draft_of(joined(soups));
}

// Returns areas by tag, which cutting must not change.
std::map<Tag, double> areas(const ComplexDraft& draft) {
  std::map<Tag, double> result;
  for (Index t = 0; t < draft.triangles.size(); ++t)
    result[draft.origins[t].tag] +=
        0.5 * norm(cross(draft.corner(t, 1) - draft.corner(t, 0), draft.corner(t, 2) - draft.corner(t, 0)));
  return result;
}

void expect_arranged(ComplexDraft draft, bool meets, double slack = 1e-12) {
  const auto before = areas(draft);
  const ArrangementReport report = arrange(draft, 0);
  EXPECT_TRUE(report.clean);
  EXPECT_EQ(report.intersecting_pairs > 0, meets);
  EXPECT_EQ(brute_force_intersections(draft), 0U);
  const auto after = areas(draft);
  ASSERT_EQ(after.size(), before.size());
  for (const auto& [tag, a] : before) EXPECT_NEAR(after.at(tag), a, slack);
  if (!meets) {
    EXPECT_EQ(draft.triangles.size(), 2U);
  }
}

TEST(Arrangement, SinglePairsOfEveryKind) {
  const std::array<Point, 3> flat{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
  struct Case {
    const char* name;
    std::array<Point, 3> second;
    bool meets;
  };
  for (const Case& c :
       {Case{"apart", {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}}, false},
        {"crossing inside", {{{1, 1, -1}, {1, 1, 1}, {1.5, 1, 1}}}, true},
        {"crossing through an edge", {{{1, -1, -1}, {1, 1, 1}, {1.5, 1, 1}}}, true},
        {"crossing through both", {{{-1, 1, -1}, {-1, 1, 1}, {9, 1, 0}}}, true},
        {"touching with a corner inside", {{{1, 1, 0}, {1, 1, 1}, {2, 1, 1}}}, true},
        {"touching with a corner on an edge", {{{1, 0, 0}, {1, 0, 1}, {2, 0, 1}}}, true},
        {"touching with an edge inside", {{{1, 1, 0}, {2, 1, 0}, {1, 1, 1}}}, true},
        {"touching with an edge over a corner", {{{-1, 1, 0}, {1, -1, 0}, {0, 0, 1}}}, true},
        {"edge across an edge", {{{2, -1, -1}, {2, 1, 1}, {2, -3, 1}}}, true},
        {"part of an edge in common", {{{1, 0, 0}, {3, 0, 0}, {2, 0, 1}}}, true},
        {"an edge in common", {{{0, 0, 0}, {4, 0, 0}, {2, 0, 1}}}, false},
        {"a corner in common", {{{0, 0, 0}, {-1, 0, 1}, {0, -1, 1}}}, false},
        {"a corner in common and crossing", {{{0, 0, 0}, {2, 2, 1}, {2, 2, -1}}}, true},
        {"coplanar, inside", {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}, true},
        {"coplanar, crossing", {{{1, 1, 0}, {5, 1, 0}, {1, 5, 0}}}, true},
        {"coplanar, a star", {{{3, 3, 0}, {-1, 3, 0}, {3, -1, 0}}}, true},
        {"coplanar, an edge in common, beside", {{{0, 0, 0}, {2, -2, 0}, {4, 0, 0}}}, false},
        {"coplanar, an edge in common, folded", {{{0, 0, 0}, {4, 0, 0}, {2, 1, 0}}}, true},
        {"coplanar, an edge in common, folded over", {{{0, 0, 0}, {4, 0, 0}, {3, 3, 0}}}, true},
        {"coplanar, a corner in common", {{{0, 0, 0}, {3, 1, 0}, {1, 3, 0}}}, true},
        {"coplanar, part of an edge in common", {{{1, 0, 0}, {2, 0, 0}, {1, -1, 0}}}, true},
        {"coplanar, apart", {{{5, 5, 0}, {6, 5, 0}, {5, 6, 0}}}, false}}) {
    SCOPED_TRACE(c.name);
    for (const bool two_soups : {false, true})
      for (unsigned turn = 0; turn < 6; ++turn) {
        std::array<Point, 3> second = c.second;
        std::rotate(second.begin(), second.begin() + turn % 3, second.end());
        if (turn >= 3) std::swap(second[1], second[2]);
        expect_arranged(pair_of(flat, second, two_soups), c.meets);
        expect_arranged(pair_of(second, flat, two_soups), c.meets);
      }
  }
}

TEST(Arrangement, CopiesStay) {
  const std::array<Point, 3> a{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
      turned_a{{{0, 0, 0}, {0, 4, 0}, {4, 0, 0}}};
  for (const auto& b : {a, turned_a}) {
    ComplexDraft draft = pair_of(a, b);
    EXPECT_TRUE(arrange(draft, 0).clean);
    EXPECT_EQ(draft.triangles.size(), 2U);
  }
}

TEST(Arrangement, RandomPairsAndHandfuls) {
  Random random(3);
  for (unsigned member = 0; member < members(150); ++member) {
    SCOPED_TRACE(member);
    // On a lattice most intersections are degenerate; elsewhere few are.
    const bool lattice = member % 2 == 0;
    std::vector<PolygonSoup> soups;
    for (unsigned i = 0; i < 2 + member % 5; ++i) {
      PolygonSoup soup;
      do {
        soup.points.clear();
        for (int k = 0; k < 3; ++k) {
          Point p;
          for (std::size_t axis = 0; axis < 3; ++axis)
            p[axis] = lattice ? static_cast<double>(random() % (axis == 2 ? 2 : 5)) : uniform(random, 0, 4);
          soup.points.push_back(p);
        }
      } while (!(norm(cross(soup.points[1] - soup.points[0], soup.points[2] - soup.points[0])) > 0.01));
      soup.add_facet(std::array<Index, 3>{0, 1, 2}, 1 + static_cast<Tag>(i));
      soups.push_back(soup);
    }
    ComplexDraft draft = draft_of(joined(soups));
    const auto before = areas(draft);
    EXPECT_TRUE(arrange(draft, 0).clean);
    EXPECT_EQ(brute_force_intersections(draft), 0U);
    const auto after = areas(draft);
    for (const auto& [tag, a] : before) EXPECT_NEAR(after.at(tag), a, 1e-10);
  }
}

// Spheres turned by tiny angles: their cuts are slivers. Merging corners of slivers can make facets intersect
// again and again, so only merges after which nothing intersects are kept.
TEST(Arrangement, EndsWhereSheetsNearlyCoincide) {
  for (unsigned member = 0; member < members(6); ++member) {
    const double angle = std::pow(0.1, 2 + member % 3), grain = member % 2 == 0 ? 1e-3 : 1e-2;
    SCOPED_TRACE(fmt::format("angle {}, grain {}", angle, grain));
    std::vector<PolygonSoup> soups;
    for (unsigned i = 0; i < 4; ++i) {
      PolygonSoup sphere = testing::icosphere(1, 1);
      const double c = std::cos(i * angle), s = std::sin(i * angle);
      for (Point& p : sphere.points) {
        p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
        p = {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
      }
      soups.push_back(sphere);
    }
    ComplexDraft draft = draft_of(joined(soups));
    const ArrangementReport arranged =
        arrange(draft, grain * angle, nullptr, true, KeptMerges::where_nothing_meets);
    EXPECT_TRUE(arranged.clean);
    EXPECT_GT(arranged.intersecting_pairs, 0U);
    EXPECT_EQ(arrange(draft, 0).intersecting_pairs, 0U);
  }
}

// snap_near_features

// Returns whether each soup uses every edge equally often in both directions.
bool balanced(const ComplexDraft& draft) { return count_open_edges(draft) == 0; }

TEST(Snapping, ClosesTJunctionsThatAreOpen) {
  Random random(4);
  for (unsigned member = 0; member < members(30); ++member) {
    SCOPED_TRACE(member);
    ComplexDraft draft = draft_of(turned(box_with_t_junctions(random, 2 + member % 4), random));
    EXPECT_FALSE(balanced(draft));
    const double before = volume_of(draft);
    snap_near_features(draft, 1e-6, member % 2 == 0 ? SnapWhat::borders : SnapWhat::all);
    EXPECT_TRUE(balanced(draft));
    EXPECT_NEAR(volume_of(draft), before, 1e-5);
  }
}

TEST(Snapping, KeepsClosedSurfacesClosed) {
  Random random(5);
  for (unsigned member = 0; member < members(40); ++member) {
    const double distance_limit = std::pow(10, uniform(random, -4, -1));
    SCOPED_TRACE(fmt::format("member {}: {}", member, distance_limit));
    PolygonSoup soup;
    switch (member % 4) {
      case 0: soup = turned(finned_box(uniform(random, 0, 2) * distance_limit), random); break;
      case 1: soup = turned(slotted_box(uniform(random, 0, 2) * distance_limit), random); break;
      case 2: soup = turned(spiked_box(uniform(random, 0, 2) * distance_limit), random); break;
      default: soup = testing::icosphere(1, 6);
    }
    ComplexDraft draft = draft_of(soup);
    ASSERT_TRUE(balanced(draft));
    const double before = volume_of(draft);
    const SnapReport report = snap_near_features(draft, distance_limit);
    EXPECT_TRUE(balanced(draft));
    EXPECT_LE(report.largest_distance, distance_limit);
    EXPECT_NEAR(volume_of(draft), before, 2 * distance_limit * area(soup));
  }
}

TEST(Snapping, LeavesWhatIsFarApart) {
  Random random(6);
  for (const PolygonSoup& soup :
       {testing::box(), testing::icosphere(1, 5), testing::torus(1, 0.3, 20, 10), finned_box(0.1)}) {
    ComplexDraft draft = draft_of(turned(soup, random));
    const auto triangles = draft.triangles;
    const auto points = draft.points;
    EXPECT_FALSE(snap_near_features(draft, 1e-5).changed());
    EXPECT_EQ(draft.triangles, triangles);
    EXPECT_EQ(draft.points, points);
  }
}

// Returns the number of corners that are closer than the limit to others, or to edges that they do not end.
std::size_t near_corners(const ComplexDraft& draft, double limit) {
  std::size_t count = 0;
  std::set<Index> used;
  for (const Corners& t : draft.triangles) used.insert(t.begin(), t.end());
  const EdgeTable edges(draft.triangles, draft.points.size());
  for (const Index p : used) {
    for (const Index q : used) count += p < q && distance(draft.points[p], draft.points[q]) < limit ? 1 : 0;
    for (Index e = 0; e < edges.size(); ++e) {
      const auto [a, b] = edges.ends(e);
      if (p == a || p == b) continue;
      const Vector d = draft.points[b] - draft.points[a];
      const double t = std::clamp(dot(draft.points[p] - draft.points[a], d) / squared_norm(d), 0.0, 1.0);
      count += distance(draft.points[p], draft.points[a] + t * d) < limit ? 1 : 0;
    }
  }
  return count;
}

ComplexDraft arranged_spheres(Random& random) {
  ComplexDraft draft = draft_of(
      joined(std::array{turned(testing::icosphere(1, 3), random),
                        testing::translated(turned(testing::icosphere(1, 3), random), {0.5, 0.2, 0})}));
  EXPECT_TRUE(arrange(draft, 0).clean);
  return draft;
}

// Snapping does not settle at some places, which stay as they are.
TEST(Snapping, LeavesLittleNear) {
  Random random(7);
  constexpr unsigned spheres =
      testing::sanitized ? 4 : 20;  // few spheres prove nothing about the share that settles
  std::size_t before = 0, after = 0;
  for (unsigned member = 0; member < spheres; ++member) {
    ComplexDraft draft = arranged_spheres(random);
    before += near_corners(draft, 0.99e-3);
    snap_near_features(draft, 1e-3);
    after += near_corners(draft, 0.99e-3);
  }
  EXPECT_GE(before, spheres);
  if (!testing::sanitized) {
    testing::expect_count("snapping/corners that stay near",
                          100 * static_cast<double>(after) / static_cast<double>(before));
  }
}

// No corners are near each other before snapping, and none afterwards.
TEST(Snapping, BringsNothingNear) {
  Random random(7);
  std::size_t near = 0;
  for (unsigned member = 0; member < members(20); ++member) {
    ComplexDraft draft = arranged_spheres(random);
    snap_near_features(draft, 1e-5);
    near += near_corners(draft, 0.99e-5);
  }
  EXPECT_EQ(near, 0U);
}

// The apex of a cone beside the edges of a fan: each edge near it is found once, not once for each triangle
// at the apex and at the edge.
TEST(Snapping, WorkGrowsWithCornersAndEdges) {
  std::array<std::size_t, 2> spent{};
  for (const unsigned double_size : {0U, 1U}) {
    const unsigned n = 100U << double_size;
    PolygonSoup soup;
    const auto fan = [&](const Point& apex, const auto& rim) {
      const auto first = static_cast<Index>(soup.points.size());
      soup.points.push_back(apex);
      for (unsigned i = 0; i < n; ++i) soup.points.push_back(rim(static_cast<double>(i) / (n - 1)));
      for (Index i = 1; i < n; ++i) soup.add_facet(std::array<Index, 3>{first, first + i, first + i + 1}, 1);
    };
    fan({0, 0, 1e-4}, [](double x) { return Point{std::cos(6 * x), std::sin(6 * x), 0.5}; });
    fan({-2, 0, 0}, [](double x) { return Point{2, 0.001 * (x - 0.5), 0}; });
    ComplexDraft draft = draft_of({&soup, 1}, true);
    const Execution execution;
    constexpr std::size_t most = 1'000'000'000;
    Work work(most, execution);
    snap_near_features(draft, 2e-3, SnapWhat::corners, &work);
    spent[double_size] = most - work.left();
  }
  EXPECT_LE(spent[1], 3 * spent[0]);
}

// The long sides of needles along one line would all be cut at the corners of all others: nothing is snapped
// there. Elsewhere two corners merge as usual.
TEST(Snapping, IsTakenBackOnlyWhereItDoesNotSettle) {
  constexpr Index needles = 80;
  constexpr double limit = 1e-3;
  PolygonSoup soup;
  for (Index i = 0; i < needles; ++i) {
    const double angle = 0.07 * i, x = 0.02 * i, off = 0.1 * limit;
    const auto first = static_cast<Index>(soup.points.size());
    soup.points.push_back({x, off * std::cos(angle), off * std::sin(angle)});
    soup.points.push_back({20 - 1.01 * x, off * std::cos(angle), off * std::sin(angle)});
    soup.points.push_back({10, std::cos(angle), std::sin(angle)});
    soup.add_facet(std::array<Index, 3>{first, first + 1, first + 2}, 1);
  }
  const auto first = static_cast<Index>(soup.points.size());
  soup.points.insert(soup.points.end(),
                     {{50, 0, 0}, {51, 0, 0}, {50, 1, 0}, {50, 0, 0.1 * limit}, {49, 0, 2}, {49, 1, 3}});
  soup.add_facet(std::array<Index, 3>{first, first + 1, first + 2}, 1);
  soup.add_facet(std::array<Index, 3>{first + 3, first + 4, first + 5}, 1);
  ComplexDraft draft = draft_of({&soup, 1}, true);
  const std::vector<Corners> before(draft.triangles.begin(), draft.triangles.begin() + needles);
  const SnapReport report = snap_near_features(draft, limit);
  EXPECT_EQ(report.changes(), 1U);
  EXPECT_EQ(report.merged_points, 1U);
  ASSERT_EQ(draft.triangles.size(), needles + 2);
  for (const Corners& t : before)
    EXPECT_NE(std::find(draft.triangles.begin(), draft.triangles.end(), t), draft.triangles.end());
}

TEST(Snapping, CancelsDuplicates) {
  const PolygonSoup ball = testing::icosphere(1, 2);
  ComplexDraft draft = draft_of(joined(std::array{ball, testing::inverted(ball), ball}));
  EXPECT_EQ(draft.triangles.size(), 3U * ball.facet_count());
  EXPECT_EQ(cancel_duplicates(draft), 2U * ball.facet_count());
  EXPECT_NEAR(volume_of(draft), signed_volume(ball), 1e-12);
  // Duplicates of different soups stay.
  ComplexDraft two = draft_of(std::array{ball, testing::inverted(ball)});
  EXPECT_EQ(cancel_duplicates(two), 0U);
}

TEST(Snapping, OppositeDuplicatesCancelInPairs) {
  PolygonSoup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  using Facet = std::array<Index, 3>;
  for (const Facet& facet : {Facet{0, 1, 2}, Facet{1, 2, 0}, Facet{2, 1, 0}, Facet{0, 1, 3}, Facet{1, 3, 0},
                             Facet{1, 2, 3}, Facet{3, 2, 1}})
    soup.add_facet(facet, 1);
  const ComplexDraft draft = draft_of({&soup, 1});
  EXPECT_EQ(cancelled_among(draft, {0, 2, 3, 4, 5}), (std::vector<Index>{0, 2})) << "not 3 and 4: same side";
  EXPECT_EQ(cancelled_among(draft, {0, 1, 2}).size(), 2U);
  EXPECT_EQ(cancelled_among(draft, {5, 6}).size(), 2U);
  ComplexDraft complex = draft_of({&soup, 1});
  complex.soup_is_complex.assign(complex.soup_is_complex.size(), true);
  EXPECT_EQ(cancelled_among(complex, {0, 1, 2, 3, 4, 5, 6}).size(), 4U) << "all but one of each";
  EXPECT_EQ(cancelled_among(complex, {3, 4}).size(), 1U);
}

// drop_repeated

TEST(Repeated, FacetsAreDropped) {
  Random random(8);
  for (unsigned member = 0; member < members(20); ++member) {
    const auto count = static_cast<unsigned>(1 + random() % 8);
    const PolygonSoup ball = testing::icosphere(1, 3);
    ComplexDraft draft = draft_of(with_repeated_facets(ball, random, count, false));
    const RepeatedReport report = drop_repeated(draft);
    EXPECT_EQ(report.count, count);
    EXPECT_EQ(report.where.size(), count);
    EXPECT_EQ(draft.triangles.size(), ball.facet_count());
    EXPECT_TRUE(balanced(draft));
  }
}

TEST(Repeated, ACopyOfAWholeSurfaceIsDropped) {
  const PolygonSoup ball = testing::icosphere(1, 2);
  ComplexDraft draft = draft_of(joined(std::array{ball, ball}));
  const auto report = drop_repeated(draft);
  EXPECT_TRUE(balanced(draft));
  EXPECT_TRUE(report.count == 0 || draft.triangles.size() == ball.facet_count());
}

TEST(Repeated, ThoseOfOtherSoupsAndOrientationsStay) {
  const PolygonSoup ball = testing::icosphere(1, 2);
  ComplexDraft two = draft_of(std::array{ball, ball});
  EXPECT_EQ(drop_repeated(two).count, 0U);
  ComplexDraft inverted = draft_of(joined(std::array{ball, testing::inverted(ball)}));
  EXPECT_EQ(drop_repeated(inverted).count, 0U);
  EXPECT_EQ(inverted.triangles.size(), 2U * ball.facet_count());
}

// fill_holes

TEST(Holes, AreFilledWithATagOfTheirOwn) {
  Random random(9);
  for (unsigned member = 0; member < members(20); ++member) {
    SCOPED_TRACE(member);
    const OpenSphere open = sphere_with_holes(random, 8, 1 + member % 5);
    ComplexDraft draft = draft_of(open.soup);
    std::size_t around = 0;
    for (const std::size_t edges : open.edges) around += edges;
    EXPECT_EQ(count_open_edges(draft), around);
    const std::size_t before = draft.triangles.size();
    const auto filled = fill_holes(draft, 7);
    ASSERT_EQ(filled.size(), open.holes.size());
    EXPECT_TRUE(balanced(draft));
    EXPECT_EQ(draft.triangles.size(), before + around - 2 * filled.size());
    std::set<Tag> tags;
    for (const FilledHole& hole : filled) tags.insert(hole.tag);
    EXPECT_EQ(tags.size(), filled.size());
    EXPECT_EQ(tags.count(1), 0U);
    EXPECT_GT(volume_of(draft), 0.9 * signed_volume(testing::icosphere(1, 8)));
  }
}

TEST(Holes, OfAPlaneSideHaveItsArea) {
  Random random(10);
  for (Tag side = 1; side <= 6; ++side) {
    const PolygonSoup cube = testing::box({0, 0, 0}, {1, 1, 1}, 3);
    ComplexDraft draft = draft_of(filtered(cube, [&](Index f) { return cube.facet_tag(f) != side; }));
    const auto filled = fill_holes(draft, 7);
    ASSERT_EQ(filled.size(), 1U);
    EXPECT_EQ(filled[0].edges, 12U);
    EXPECT_EQ(filled[0].tag, 7);
    EXPECT_NEAR(filled[0].area, 1, 1e-12);
    EXPECT_NEAR(filled[0].length, 4, 1e-12);
    EXPECT_NEAR(volume_of(draft), 1, 1e-12);
    EXPECT_TRUE(balanced(draft));
  }
}

// Returns the facets and holes by their coordinates.
std::map<std::array<std::array<double, 3>, 3>, Tag> facets_by_place(const ComplexDraft& draft) {
  std::map<std::array<std::array<double, 3>, 3>, Tag> facets;
  for (Index t = 0; t < draft.triangles.size(); ++t) {
    std::array<std::array<double, 3>, 3> key;
    for (unsigned i = 0; i < 3; ++i)
      key[i] = {draft.corner(t, i).x, draft.corner(t, i).y, draft.corner(t, i).z};
    std::sort(key.begin(), key.end());
    facets[key] = draft.origins[t].tag;
  }
  return facets;
}

// Holes of random shapes, some of which touch in a point.
TEST(Holes, DoNotDependOnTheOrderOfFacets) {
  Random random(12);
  for (unsigned member = 0; member < members(20); ++member) {
    SCOPED_TRACE(member);
    const PolygonSoup ball = jittered(testing::icosphere(1, 6), random, 0.01);
    const PolygonSoup open = filtered(ball, [&](Index) { return random() % 12 != 0; });
    ComplexDraft draft = draft_of(open);
    const std::size_t holes = fill_holes(draft, 7).size();
    ASSERT_GT(holes, 1U);
    const auto expected = facets_by_place(draft);
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
      ComplexDraft other = draft_of(corners_rotated(testing::permuted(open, seed), random));
      EXPECT_EQ(fill_holes(other, 7).size(), holes);
      EXPECT_EQ(facets_by_place(other), expected);
    }
  }
}

TEST(Holes, SheetsAreNoHoles) {
  PolygonSoup sheet;
  sheet.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.add_facet(std::array<Index, 4>{0, 1, 2, 3}, 1);
  ComplexDraft draft = draft_of(sheet);
  EXPECT_TRUE(fill_holes(draft, 7).empty());
  EXPECT_EQ(draft.triangles.size(), 2U);
}

// keep_one_side, drop_flakes

// A box of two-sided faces: each has a reversed copy that is cut along the other diagonal.
PolygonSoup two_sided_box() {
  const PolygonSoup box = soup_of({{0, 0, 0}, {1, 2, 3}});
  PolygonSoup soup;
  soup.points = box.points;
  for (Index f = 0; f < box.facet_count(); ++f) {
    const auto c = box.polygon(box.facet_polygons(f)[0]);
    soup.add_facet(std::array{c[0], c[1], c[2]}, 1);
    soup.add_facet(std::array{c[0], c[2], c[3]}, 1);
    soup.add_facet(std::array{c[3], c[1], c[0]}, 1);
    soup.add_facet(std::array{c[3], c[2], c[1]}, 1);
  }
  return soup;
}

TEST(KeepOneSide, OfABoxIsTheBox) {
  const PolygonSoup soup = two_sided_box();
  ComplexDraft draft = draft_of(soup);
  EXPECT_TRUE(is_two_sided(draft));
  arrange(draft, 0, nullptr, false);
  const std::size_t both = draft.triangles.size();
  EXPECT_EQ(keep_one_side(draft), both / 2);
  EXPECT_NEAR(volume_of(draft), 6, 1e-12);
  EXPECT_TRUE(balanced(draft));
  EXPECT_FALSE(is_two_sided(draft));
  const RepairedPlc repaired = build_repaired_plc({&soup, 1});
  ASSERT_EQ(repaired.plc.regions.size(), 2U);
  EXPECT_NEAR(repaired.plc.regions[1].volume, 6, 1e-9);
  EXPECT_GT(repaired.report.second_sides, 0U);
}

// All faces but one are cut at the middles of their sides. Only that one's corners meet corners of the
// others.
TEST(KeepOneSide, OfFacesThatMeetInNoCommonEdgeIsTheBox) {
  const PolygonSoup box = soup_of({{0, 0, 0}, {1, 2, 3}});
  PolygonSoup soup;
  const auto add = [&](const Point& a, const Point& b, const Point& c) {
    const auto first = static_cast<Index>(soup.points.size());
    soup.points.insert(soup.points.end(), {a, b, c});
    soup.add_facet(std::array{first, first + 1, first + 2}, 1);
    soup.add_facet(std::array{first + 2, first + 1, first}, 1);
  };
  for (Index f = 0; f < box.facet_count(); ++f) {
    const auto c = box.polygon(box.facet_polygons(f)[0]);
    const auto at = [&](Index i) { return box.points[c[i % 4]]; };
    const Point centre = 0.5 * (at(0) + at(2));
    for (Index i = 0; i < 4 && f > 0; ++i) {
      const Point middle = 0.5 * (at(i) + at(i + 1));
      add(at(i), middle, centre);
      add(middle, at(i + 1), centre);
    }
    for (Index i = 0; i < 3 && f == 0; i += 2) add(at(i), at(i + 1), at(i + 2));
  }
  const RepairedPlc repaired = build_repaired_plc({&soup, 1});
  ASSERT_EQ(repaired.plc.regions.size(), 2U);
  EXPECT_NEAR(repaired.plc.regions[1].volume, 6, 1e-9);
  EXPECT_EQ(repaired.report.flakes.count, 0U);
}

// A sheet with two sides encloses nothing, and neither would one side of it.
TEST(KeepOneSide, SheetsAreLeft) {
  PolygonSoup pillow;
  pillow.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  pillow.add_facet(std::array<Index, 3>{0, 1, 2}, 1);
  pillow.add_facet(std::array<Index, 3>{0, 2, 3}, 1);
  pillow.add_facet(std::array<Index, 3>{3, 2, 0}, 1);
  pillow.add_facet(std::array<Index, 3>{2, 1, 0}, 1);
  ComplexDraft draft = draft_of(pillow);
  EXPECT_EQ(keep_one_side(draft), 0U);
  EXPECT_EQ(draft.triangles.size(), 4U);
}

TEST(DropFlakes, WhatIsThinAndSmallGoes) {
  const PolygonSoup box = soup_of({{0, 0, 0}, {1, 1, 1}});
  const auto flake = [](double thickness, double width) {
    return testing::translated(soup_of({{0, 0, 0}, {width, width, thickness}}), {2, 0, 0});
  };
  const auto dropped = [&](const std::vector<PolygonSoup>& soups) {
    ComplexDraft draft = draft_of(joined(soups));
    const double before = volume_of(draft);
    const FlakeReport report = drop_flakes(draft, 1e-3);
    EXPECT_NEAR(volume_of(draft), before - report.volume, 1e-12);
    return report.places.size();
  };
  EXPECT_EQ(dropped({box, flake(5e-4, 0.5)}), 1U);
  EXPECT_EQ(dropped({box, flake(5e-3, 0.5)}), 0U) << "thicker than the tolerance";
  EXPECT_EQ(dropped({box, flake(9e-4, 3)}), 0U) << "with too much of the volume";
  EXPECT_EQ(dropped({flake(5e-4, 0.5)}), 0U) << "all that there is";
}

// Changes

// Two boxes far apart, each with one corner moved: the change at either place can be undone alone.
TEST(Changes, ArePlacesThatCanBeTakenBackAlone) {
  const std::vector<PolygonSoup> soups{soup_of({{0, 0, 0}, {1, 1, 1}}), soup_of({{5, 0, 0}, {6, 1, 1}})};
  const ComplexDraft before = draft_of(joined(soups));
  const ComplexDraft after = with_moved_corners(before);
  const Changes changes(before, after);
  ASSERT_EQ(changes.places(), 2U);
  const double whole = volume_of(before), less = volume_of(after);
  std::vector<Index> place;
  EXPECT_NEAR(volume_of(changes.without({false, false}, place)), less, 1e-12);
  EXPECT_NEAR(volume_of(changes.without({true, true}, place)), whole, 1e-12);
  std::vector<double> volumes;
  for (const bool first : {false, true}) {
    const ComplexDraft mixed = changes.without({first, !first}, place);
    EXPECT_EQ(mixed.triangles.size(), 24U);
    EXPECT_TRUE(balanced(mixed));
    volumes.push_back(volume_of(mixed));
    EXPECT_GT(volumes.back(), less + 0.01);
    EXPECT_LT(volumes.back(), whole - 0.01);
  }
  EXPECT_NEAR(volumes[0] + volumes[1], whole + less, 1e-12);
}

// The same boxes: the corner whose move causes trouble moves back; the other one stays moved.
TEST(Changes, ThatMakeTroubleAreTakenBack) {
  const std::vector<PolygonSoup> soups{soup_of({{0, 0, 0}, {1, 1, 1}}), soup_of({{5, 0, 0}, {6, 1, 1}})};
  const ComplexDraft before = draft_of(joined(soups));
  const ComplexDraft after = with_moved_corners(before);
  const double whole = volume_of(before), less = volume_of(after);
  const Trouble first{{0, 0.1, 0.2}, 3}, second{{6, 0.1, 0.2}, 3}, worse{{6, 0, 0}, 5},
      elsewhere{{3, 3, 3}, 50};
  const BetterPlaces better =
      better_places(before, {worse, elsewhere}, after, {first, second, elsewhere}, 0.5);
  EXPECT_EQ(better.places, 2U);
  ASSERT_EQ(better.taken_back.size(), 1U);
  EXPECT_LE(better.taken_back[0].x, 1);
  EXPECT_TRUE(balanced(better.draft));
  EXPECT_GT(volume_of(better.draft), less + 0.01);
  EXPECT_LT(volume_of(better.draft), whole - 0.01);
  EXPECT_TRUE(better_places(before, {}, after, {}, 0.5).taken_back.empty());
}

// The same boxes, with a triangle inside of the second one, which the moved corner would cut off: this move
// is taken back.
TEST(Changes, ThatMakeFacetsMeetAreTakenBack) {
  PolygonSoup sheet;
  sheet.points = {{5.9, 0.01, 0.01}, {5.99, 0.01, 0.01}, {5.9, 0.3, 0.3}};
  sheet.add_facet(std::array<Index, 3>{0, 1, 2}, 7);
  std::vector<PolygonSoup> soups{soup_of({{0, 0, 0}, {1, 1, 1}}), soup_of({{5, 0, 0}, {6, 1, 1}})};
  for (const bool with_sheet : {false, true}) {
    if (with_sheet) soups.push_back(sheet);
    const ComplexDraft before = draft_of(joined(soups));
    const ComplexDraft after = with_moved_corners(before);
    std::vector<bool> taken_back(2, false);
    const ComplexDraft mixed = without_what_meets(Changes(before, after), taken_back);
    EXPECT_EQ(std::count(taken_back.begin(), taken_back.end(), true), with_sheet ? 1 : 0);
    EXPECT_EQ(brute_force_intersections(mixed), 0U);
    EXPECT_LT(volume_of(mixed), volume_of(before) - 0.01);
    if (with_sheet) {
      EXPECT_GT(volume_of(mixed), volume_of(after) + 0.01);
    }
  }
}

// turn_components

TEST(TurnComponents, WhatIsInsideOutIsTurned) {
  const PolygonSoup ball = testing::icosphere(1, 2), small = testing::icosphere(0.4, 2);
  const double large = signed_volume(ball), little = signed_volume(small);
  const auto turned_volume = [](const std::vector<PolygonSoup>& soups, std::size_t turned) {
    ComplexDraft draft = draft_of(joined(soups));
    EXPECT_EQ(turn_components(draft).turned_components, turned);
    return volume_of(draft);
  };
  using testing::inverted;
  EXPECT_NEAR(turned_volume({ball}, 0), large, 1e-12);
  EXPECT_NEAR(turned_volume({inverted(ball)}, 1), large, 1e-12);
  EXPECT_NEAR(turned_volume({ball, inverted(small)}, 0), large - little, 1e-12);
  EXPECT_NEAR(turned_volume({ball, small}, 0), large + little, 1e-12);
  EXPECT_NEAR(turned_volume({inverted(ball), small}, 2), large - little, 1e-12);
  EXPECT_NEAR(turned_volume({inverted(ball), inverted(small)}, 2), large + little, 1e-12);
  EXPECT_NEAR(turned_volume({ball, testing::translated(inverted(small), {5, 0, 0})}, 1), large + little,
              1e-12);
}

// keep_boundaries

TEST(KeepBoundaries, OfLatticeBoxesIsTheBoundaryOfTheirUnion) {
  Random random(11);
  for (unsigned member = 0; member < members(60); ++member) {
    SCOPED_TRACE(member);
    const auto boxes = random_boxes(random, 2 + member % 3, 2 + member % 3);
    std::vector<PolygonSoup> soups;
    for (const Box& box : boxes) soups.push_back(soup_of(box));
    // All in one soup.
    ComplexDraft one = draft_of(joined(soups));
    // Clusters without any tangle stay as they are, so all of them must be tangled to be compared.
    const bool meet = arrange(one, 0).intersecting_pairs > 0;
    cancel_duplicates(one);
    const InsideReport report = keep_boundaries(one, 0);
    EXPECT_TRUE(balanced(one));
    double all = 0;
    for (const auto& [tag, volumes] : piece_volumes(boxes, std::vector<Tag>(boxes.size(), 1)))
      for (const double v : volumes) all += v;
    if (meet && boxes.size() == 2) {
      EXPECT_NEAR(volume_of(one), all, 1e-12);
    }
    if (!meet) {
      EXPECT_EQ(report.removed_triangles, 0U);
    }
    // In several soups.
    ComplexDraft several = draft_of(soups);
    const bool touch = arrange(several, 0).intersecting_pairs > 0;
    keep_boundaries(several, 0);
    EXPECT_TRUE(balanced(several));
    if (!touch || boxes.size() > 2) continue;
    EXPECT_NEAR(volume_of(several), all, 1e-12);
    EXPECT_EQ(brute_force_intersections(several), 0U);
  }
}

TEST(KeepBoundaries, CleanSurfacesStay) {
  for (const PolygonSoup& soup :
       {testing::box(), testing::icosphere(1, 3), nested_spheres(0.5, false, true)}) {
    ComplexDraft draft = draft_of(soup);
    const auto before = draft.triangles;
    keep_boundaries(draft, 0);
    EXPECT_EQ(draft.triangles, before);
  }
}

TEST(KeepBoundaries, WallInsideStaysAndOutsideGoes) {
  ComplexDraft draft = draft_of(box_with_wall(0.5, 0.5, 0.25));
  ASSERT_TRUE(arrange(draft, 0).clean);
  const InsideReport report = keep_boundaries(draft, 0);
  double inside = 0;
  for (Index t = 0; t < draft.triangles.size(); ++t)
    if (draft.origins[t].tag == 7)
      inside +=
          0.5 * norm(cross(draft.corner(t, 1) - draft.corner(t, 0), draft.corner(t, 2) - draft.corner(t, 0)));
  EXPECT_NEAR(inside, 0.5, 1e-12);
  EXPECT_GT(report.internal_facets, 0U);
  EXPECT_GT(report.dropped_sheets, 0U);
  EXPECT_NEAR(area_of(draft), 6.5, 1e-12);
}

}  // namespace
}  // namespace collarmesh::repairing::repair_parts_test
