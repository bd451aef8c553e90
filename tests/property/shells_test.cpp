// Surfaces on their own: conforming triangles within the bounds on angles, judged by formulas of this file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/shells.h"
#include "support/any_complex.h"
#include "support/expected_counts.h"
#include "support/shapes.h"

namespace collarmesh::shells_test {
namespace {

using namespace testing;

PipelineResult shells_of(const PolygonSoup& soup, double size, unsigned order = 1) {
  PipelineOptions options;
  options.mesh.size = size;
  options.order = order;
  return mesh_shells(complex_of(soup), options);
}

/// Returns the smallest and the largest angle, ignoring triangles at the point `without`.
std::pair<double, double> angles_of(const TetMesh& mesh, const Point& without = {INFINITY, 0, 0}) {
  double least = 180, most = 0;
  for (const auto& f : mesh.faces) {
    if (std::any_of(f.begin(), f.end(), [&](Index v) { return mesh.points[v] == without; })) continue;
    for (unsigned i = 0; i < 3; ++i) {
      const Vector u = mesh.points[f[(i + 1) % 3]] - mesh.points[f[i]],
                   v = mesh.points[f[(i + 2) % 3]] - mesh.points[f[i]];
      const double angle = std::acos(dot(u, v) / norm(u) / norm(v)) * 180 / std::numbers::pi;
      least = std::min(least, angle);
      most = std::max(most, angle);
    }
  }
  return {least, most};
}

double area_of(const TetMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.faces)
    area += 0.5 * norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
  return area;
}

/// Returns the number of sides for each number of occurrences; a side that occurs twice in the same direction
/// counts under 0.
std::map<int, std::size_t> sides_of(const TetMesh& mesh) {
  std::map<std::pair<Index, Index>, std::pair<int, int>> sides;
  for (const auto& f : mesh.faces)
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = f[i], b = f[(i + 1) % 3];
      auto& [up, down] = sides[std::minmax(a, b)];
      ++(a < b ? up : down);
    }
  std::map<int, std::size_t> counts;
  for (const auto& [side, both] : sides)
    ++counts[both.first > 1 || both.second > 1 ? 0 : both.first + both.second];
  return counts;
}

void expect_good(const PipelineResult& made) {
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  const auto [least, most] = angles_of(made.result.mesh);
  EXPECT_GE(least, 20);
  EXPECT_LE(most, 120);
  EXPECT_TRUE(made.result.mesh.tets.empty());
}

PolygonSoup without_facets(const PolygonSoup& soup, const std::set<Tag>& tags) {
  PolygonSoup rest;
  rest.points = soup.points;
  for (Index f = 0; f < soup.facet_count(); ++f)
    if (tags.count(soup.facet_tag(f)) == 0)
      rest.add_facet(soup.polygon(soup.facet_polygons(f)[0]), soup.facet_tag(f));
  return rest;
}

TEST(Shells, ClosedSurfacesAreClosedAndLookOutwards) {
  for (const double size : {0.5, 0.2, 0.07}) {
    const PipelineResult made = shells_of(box({0, 0, 0}, {1, 1, 1}, 3), size);
    expect_good(made);
    EXPECT_EQ(sides_of(made.result.mesh).size(), 1U);
    EXPECT_NEAR(area_of(made.result.mesh), 6, 1e-9);
    double volume = 0;
    for (const auto& [a, b, c] : made.result.mesh.faces)
      volume +=
          six_volume({}, made.result.mesh.points[a], made.result.mesh.points[b], made.result.mesh.points[c]) /
          6;
    EXPECT_NEAR(volume, 1, 1e-9);
  }
}

TEST(Shells, SmoothSurfacesKeepTheirAreaAndLengths) {
  for (const PolygonSoup& soup :
       {icosphere(1, 12), cylinder(1, 2, 60), torus(2, 0.7, 60, 30), cone(1, 2, 40, 5)}) {
    const PipelineResult made = shells_of(soup, 0.2);
    EXPECT_TRUE(made.guarantees_hold()) << made.missed();
    const std::size_t triangles = made.result.mesh.faces.size();
    EXPECT_LT(static_cast<double>(triangles) * 0.433 * 0.2 * 0.2, 1.6 * area_of(made.result.mesh));
    EXPECT_GT(made.check.median_edge, 0.15);
    EXPECT_LT(made.check.median_edge, 0.25);
    EXPECT_EQ(sides_of(made.result.mesh).count(0), 0U);
  }
}

TEST(Shells, OpenSurfacesAndJunctions) {
  const PipelineResult open = shells_of(without_facets(box(), {6}), 0.2);
  expect_good(open);
  EXPECT_NEAR(area_of(open.result.mesh), 5, 1e-9);
  EXPECT_EQ(sides_of(open.result.mesh).count(0), 0U);
  EXPECT_GT(sides_of(open.result.mesh).at(1), 16U);
  const PipelineResult junction = shells_of(two_boxes(), 0.25);
  expect_good(junction);
  EXPECT_NEAR(area_of(junction.result.mesh), 11, 1e-9);
}

TEST(Shells, SizesOfPatchesHold) {
  const Plc plc = complex_of(box());
  PipelineOptions options;
  options.mesh.size = 0.3;
  options.mesh.patch_size = {{6, 0.05}};
  const PipelineResult made = mesh_shells(plc, options);
  expect_good(made);
  std::size_t fine = 0;
  for (const Tag tag : made.result.mesh.face_tag) fine += tag == 6 ? 1 : 0;
  EXPECT_GT(fine, 600U);
  EXPECT_GT(fine, made.result.mesh.faces.size() / 4);
  options.mesh.patch_size = {{99, 0.05}};
  EXPECT_THROW(mesh_shells(plc, options), OptionError);
}

TEST(Shells, TheSecondOrderFollowsCurves) {
  const PipelineResult made = shells_of(cylinder(1, 2, 400), 0.5, 2);
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  const TetMesh& mesh = made.result.mesh;
  ASSERT_EQ(mesh.order(), 2);
  ASSERT_EQ(mesh.face_mid_nodes.size(), mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (std::fabs(mesh.points[mesh.faces[f][0]].z - mesh.points[mesh.faces[f][1]].z) < 1e-9) continue;
    for (const Index v : mesh.faces[f]) {
      const double radius = std::hypot(mesh.points[v].x, mesh.points[v].y);
      if (radius > 0.9) {
        EXPECT_NEAR(radius, 1, 1e-3);
      }
    }
  }
  EXPECT_NEAR(made.check.of_mesh.areas[0] + made.check.of_mesh.areas[1] + made.check.of_mesh.areas[2],
              made.check.of_input.areas[0] + made.check.of_input.areas[1] + made.check.of_input.areas[2],
              0.05);
}

TEST(Shells, TheCertificateFindsFaults) {
  const Plc plc = complex_of(box());
  PipelineOptions options;
  options.mesh.size = 0.3;
  const PipelineResult made = mesh_shells(plc, options);
  ASSERT_TRUE(made.guarantees_hold());
  const auto found = [&](const TetMesh& mesh, const char* guarantee) {
    const CheckReport report = check_shells(mesh, plc);
    return std::any_of(report.findings.begin(), report.findings.end(),
                       [&](const Finding& finding) { return finding.guarantee == guarantee; });
  };
  TetMesh hole = made.result.mesh;
  for (auto* const list : {&hole.face_patch}) list->pop_back();
  hole.faces.pop_back(), hole.face_tag.pop_back(), hole.face_regions.pop_back();
  EXPECT_TRUE(found(hole, "patch_border") || found(hole, "patch_area"));
  TetMesh turned = made.result.mesh;
  std::swap(turned.faces[0][0], turned.faces[0][1]);
  EXPECT_TRUE(found(turned, "patch_orientation"));
  TetMesh inside_out = made.result.mesh;
  for (auto& face : inside_out.faces) std::swap(face[0], face[1]);
  EXPECT_TRUE(found(inside_out, "shell_orientation"));
  TetMesh moved = made.result.mesh;
  for (std::size_t v = 0; v < moved.points.size(); ++v)
    if (moved.features[v].dimension == 2) {
      moved.points[v] = moved.points[v] + Vector{0.01, 0.01, 0.01};
      break;
    }
  EXPECT_TRUE(found(moved, "patch_plane"));
  TetMesh tags = made.result.mesh;
  tags.face_tag[0] += 1;
  EXPECT_TRUE(found(tags, "patch_tag"));
  TetMesh edges = made.result.mesh;
  edges.edges.pop_back(), edges.edge_tag.pop_back(), edges.edge_curve.pop_back();
  EXPECT_TRUE(found(edges, "curve_cover") || found(edges, "curve_present"));
}

/// Returns the squares between successive points of a polyline in the plane y = 0, which is moved by 1 in y.
/// Each one has a tag of its own, from 1; every second one is turned over if asked.
PolygonSoup squares_along(const std::vector<Point>& line, bool alternating = false) {
  PolygonSoup soup;
  for (const Point& p : line) soup.points.insert(soup.points.end(), {p, p + Vector{0, 1, 0}});
  for (Index i = 0; i + 1 < line.size(); ++i) {
    std::vector<Index> square{2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2};
    if (alternating && i % 2 == 1) std::reverse(square.begin(), square.end());
    soup.add_facet(square, 1 + static_cast<Tag>(i));
  }
  return soup;
}

/// Returns a ring of strips, each with a tag of its own, that turns once on its way.
PolygonSoup twisted_ring() {
  constexpr Index strips = 24;
  PolygonSoup ring;
  for (Index i = 0; i < strips; ++i) {
    const double way = 2 * std::numbers::pi * i / strips;
    for (const double side : {-0.5, 0.5}) {
      const double radius = 3 + side * std::cos(way);
      ring.points.push_back({radius * std::cos(way), radius * std::sin(way), side * std::sin(way)});
    }
  }
  for (Index i = 0; i < strips; ++i) {
    const Index next = 2 * ((i + 1) % strips);
    ring.add_facet(std::vector<Index>{2 * i, next, next + 1}, 1 + static_cast<Tag>(i));
    ring.add_facet(std::vector<Index>{2 * i, next + 1, 2 * i + 1}, 1 + static_cast<Tag>(i));
  }
  return ring;
}

TetMesh with_tag_turned(TetMesh mesh, Tag tag) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (mesh.face_tag[f] == tag) std::swap(mesh.faces[f][0], mesh.faces[f][1]);
  return mesh;
}

/// Returns the places where a mesh is said to be turned.
std::vector<Point> turned_places(const TetMesh& mesh, const Plc& plc) {
  std::vector<Point> places;
  for (const Finding& finding : check_shells(mesh, plc).findings) {
    EXPECT_EQ(finding.guarantee, "shell_orientation") << finding.message;
    places.push_back(finding.where);
  }
  return places;
}

PipelineResult shells_of(const Plc& plc, double size) {
  PipelineOptions options;
  options.mesh.size = size;
  return mesh_shells(plc, options);
}

TEST(Shells, TheCertificateFindsPatchesTurnedAgainstTheirNeighbours) {
  const std::vector<Point> line{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {2, 0, 1}, {2, 0, 2}, {3, 0, 2}};
  for (const std::size_t count : {2U, 5U})
    for (const bool alternating : {false, true}) {
      const Plc plc =
          complex_of(squares_along({line.begin(), line.begin() + static_cast<long>(count) + 1}, alternating));
      const PipelineResult made = shells_of(plc, 0.4);
      expect_good(made);
      for (std::size_t i = 0; i < count; ++i) {
        const auto places = turned_places(with_tag_turned(made.result.mesh, 1 + static_cast<Tag>(i)), plc);
        const bool at_end = i == 0 || i + 1 == count;
        EXPECT_EQ(places.size(), at_end ? 1U : 2U);
        for (const Point& p : places)
          EXPECT_TRUE((p.x == line[i].x && p.z == line[i].z) ||
                      (p.x == line[i + 1].x && p.z == line[i + 1].z));
      }
    }
}

TEST(Shells, RingsThatTurnOnceAreOrientedAlike) {
  const Plc plc = complex_of(twisted_ring());
  const PipelineResult made = shells_of(plc, 0.4);
  expect_good(made);
  EXPECT_EQ(sides_of(made.result.mesh).count(0), 0U);
  EXPECT_EQ(turned_places(with_tag_turned(made.result.mesh, 5), plc).size(), 2U);
}

TEST(Shells, PatchesAtAJunctionOfThreeMayBeOrientedInAnyWay) {
  PolygonSoup soup = squares_along({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  soup.points.insert(soup.points.end(), {{1, 0, 1}, {1, 1, 1}});
  soup.add_facet(std::vector<Index>{2, 3, 7, 6}, 3);
  const Plc plc = complex_of(soup);
  const PipelineResult made = shells_of(plc, 0.4);
  expect_good(made);
  for (const Tag tag : {1, 2, 3})
    EXPECT_TRUE(turned_places(with_tag_turned(made.result.mesh, tag), plc).empty());
}

TEST(Shells, SharpCornersAreTold) {
  PolygonSoup triangle;
  triangle.points = {{0, 0, 0}, {1, 0, 0}, {1, 0.1, 0}};
  triangle.add_facet(std::vector<Index>{0, 1, 2}, 1);
  const PipelineResult made = shells_of(triangle, 0.1);
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  ASSERT_TRUE(made.check.triangles);
  EXPECT_GT(made.check.triangles->at_sharp_corners, 0U);
  EXPECT_LT(made.check.triangles->at_sharp_corners, 6U);
}

/// Returns the number of triangles in a strip of a length and a width, with the largest permitted bases and
/// angles of 30 degrees.
double fewest_in_strip(double length, double width) { return 2 * length / (2 * std::sqrt(3) * width); }

TEST(Shells, NarrowFacesHaveGoodAngles) {
  constexpr double length = 2;
  for (const double width : {0.1, 0.02, 0.004}) {
    PolygonSoup plates;
    for (const double y : {0.0, 1.0, 1 + width, 2 + width})
      for (const double x : {0.0, length}) plates.points.push_back({x, y, 0});
    for (const Index i : {0U, 2U, 4U})
      plates.add_facet(std::vector<Index>{i, i + 1, i + 3, i + 2}, 1 + static_cast<Tag>(i));
    const PipelineResult made = shells_of(plates, 0.4);
    expect_good(made);
    EXPECT_NEAR(area_of(made.result.mesh), length * (2 + width), 1e-9);
    EXPECT_LT(static_cast<double>(made.result.mesh.faces.size()), 8 * fewest_in_strip(length, width) + 200);
  }
}

TEST(Shells, StripsHaveHardlyMoreTrianglesThanAnglesNeed) {
  constexpr double length = 10;
  for (const double width : {0.3, 0.1, 0.03}) {
    PolygonSoup strip;
    strip.points = {{0, 0, 0}, {length, 0, 0}, {length, width, 0}, {0, width, 0}};
    strip.add_facet(std::vector<Index>{0, 1, 2, 3}, 1);
    const PipelineResult made = shells_of(strip, 2);
    expect_good(made);
    EXPECT_LT(static_cast<double>(made.result.mesh.faces.size()), 1.25 * fewest_in_strip(length, width) + 4);
  }
}

TEST(Shells, LengthsGrowAsFastAsAnglesPermitUnlessAGradationIsGiven) {
  PolygonSoup plate = box({0, 0, 0}, {10, 10, 0.05}, 1);
  PipelineOptions options;
  options.mesh.size = 2;
  const Plc plc = complex_of(plate);
  const PipelineResult fast = mesh_shells(plc, options);
  options.mesh.gradation = 0.3;
  const PipelineResult slow = mesh_shells(plc, options);
  expect_good(fast);
  expect_good(slow);
  EXPECT_LT(1.3 * static_cast<double>(fast.result.mesh.faces.size()),
            static_cast<double>(slow.result.mesh.faces.size()));
}

TEST(Shells, CurvesNearToEachOtherDoNotCross) {
  constexpr double width = 0.006;
  constexpr unsigned segments = 180;
  PolygonSoup ring;
  ring.begin_facet(1);
  for (const double radius : {1.0, 1 - width}) {
    std::vector<Index> circle;
    for (unsigned i = 0; i < segments; ++i) {
      const double angle = 2 * std::numbers::pi * i / segments;
      circle.push_back(static_cast<Index>(ring.points.size()));
      ring.points.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    ring.add_polygon(circle);
  }
  ring.facet_holes.push_back({0, {0, 0, 0}});
  const PipelineResult made = shells_of(ring, 0.5);
  expect_good(made);
  EXPECT_EQ(sides_of(made.result.mesh).count(0), 0U);
  EXPECT_LT(static_cast<double>(made.result.mesh.faces.size()),
            4 * fewest_in_strip(2 * std::numbers::pi, width));
}

TEST(Shells, OneTriangleClosesACuspOfALineAndAnArc) {
  constexpr double radius = 2, end = 0.5;
  constexpr unsigned segments = 40;
  PolygonSoup cusp;
  for (unsigned i = 0; i <= segments; ++i) {
    const double angle = end * i / segments;
    cusp.points.push_back({radius * std::sin(angle), radius * (1 - std::cos(angle)), 0});
  }
  cusp.points.push_back({1, 0, 0});
  std::vector<Index> corners(cusp.points.size());
  std::iota(corners.begin(), corners.end(), Index{0});
  std::reverse(corners.begin(), corners.end());
  cusp.add_facet(corners, 1);
  const PipelineResult made = shells_of(cusp, 0.3);
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  ASSERT_TRUE(made.check.triangles);
  EXPECT_LE(made.check.triangles->at_sharp_corners, 1U);
  const auto [least, most] = angles_of(made.result.mesh, {0, 0, 0});
  EXPECT_GE(least, 20);
  EXPECT_LE(most, 120);
  expect_count("shells/cusp", made.result.mesh.faces.size());
}

TEST(Shells, TheTriangleInACuspCrossesNoCurveBesideIt) {
  constexpr double radius = 2, end = 0.5, width = 0.01;
  constexpr unsigned segments = 40, hole_segments = 10;
  PolygonSoup faces;
  const auto at = [](double from_centre, double angle) {
    return Point{from_centre * std::sin(angle), radius - from_centre * std::cos(angle), 0};
  };
  std::vector<Index> arc, hole;
  for (unsigned i = 0; i <= segments; ++i) {
    arc.push_back(static_cast<Index>(faces.points.size()));
    faces.points.push_back(at(radius, end * i / segments));
  }
  const auto first = static_cast<Index>(faces.points.size());
  faces.points.insert(faces.points.end(), {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  for (unsigned i = 0; i <= hole_segments; ++i)  // along the arc, nearer to it than the cusp's chord
    faces.points.push_back(at(radius - width, 0.05 + 0.1 * i / hole_segments));
  faces.points.insert(faces.points.end(), {at(radius - 0.2, 0.15), at(radius - 0.2, 0.05)});
  for (auto i = static_cast<Index>(first + 3); i < faces.points.size(); ++i) hole.push_back(i);
  std::vector<Index> cusp(arc.rbegin(), arc.rend()), beside = arc;
  cusp.push_back(first);
  beside.insert(beside.end(), {first + 1, first + 2});
  faces.add_facet(cusp, 1);
  faces.begin_facet(2);
  faces.add_polygon(beside);
  faces.add_polygon(hole);
  faces.facet_holes.push_back({1, at(radius - 0.1, 0.1)});
  PipelineOptions options;
  options.mesh.size = 0.5;
  options.mesh.bounds.distance = 0.04;
  const PipelineResult made = mesh_shells(complex_of(faces), options);
  EXPECT_TRUE(made.guarantees_hold()) << made.missed();
  expect_count("shells/curve beside a cusp", made.result.mesh.faces.size());
}

}  // namespace
}  // namespace collarmesh::shells_test
