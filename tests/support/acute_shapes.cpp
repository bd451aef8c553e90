#include "support/acute_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "support/shapes.h"

namespace collarmesh::testing::acute {

namespace {

constexpr double pi = std::numbers::pi;
double radians(double degrees) { return degrees * pi / 180; }

Point on_circle(double degrees, double radius, double z = 0) {
  return {radius * std::cos(radians(degrees)), radius * std::sin(radians(degrees)), z};
}

std::vector<Point> regular_polygon(unsigned k, double radius, double z = 0) {
  std::vector<Point> corners;
  for (unsigned i = 0; i < k; ++i) corners.push_back(on_circle(360.0 * i / k, radius, z));
  return corners;
}

double area(const std::vector<Point>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return std::fabs(twice) / 2;
}

Index add_point(PolygonSoup& soup, const Point& p) {
  soup.points.push_back(p);
  return static_cast<Index>(soup.points.size() - 1);
}

void add_facet(PolygonSoup& soup, const std::vector<Point>& corners, Tag tag) {
  std::vector<Index> indices;
  for (const Point& p : corners) {
    const auto found = std::find(soup.points.begin(), soup.points.end(), p);
    indices.push_back(found == soup.points.end() ? add_point(soup, p)
                                                 : static_cast<Index>(found - soup.points.begin()));
  }
  soup.add_facet(indices, tag);
}

// Makes the cone over a polygon, with tags from 1. The polygon is counterclockwise as seen from the apex.
PolygonSoup cone_over(std::vector<Point> base, const Point& apex) {
  PolygonSoup soup;
  for (std::size_t i = 0; i < base.size(); ++i)
    add_facet(soup, {base[i], base[(i + 1) % base.size()], apex}, static_cast<Tag>(2 + i));
  std::reverse(base.begin(), base.end());
  add_facet(soup, base, 1);
  return soup;
}

PolygonSoup tetrahedron(const Point& a, const Point& b, const Point& c, const Point& d) {
  return six_volume(a, b, c, d) > 0 ? cone_over({a, b, c}, d) : cone_over({a, c, b}, d);
}

std::vector<Point> triangle_with_angle(double angle) {
  return {{0, 0, 0}, on_circle(-angle / 2, 1), on_circle(angle / 2, 1)};
}

// Rotates around the z axis.
PolygonSoup about_axis(const PolygonSoup& soup, double degrees) { return rotated(soup, {0, 0, 1}, degrees); }

// A unit box for other contents: the region point makes loose segments and points features.
PolygonSoup room(const Point& min, const Point& max) {
  PolygonSoup soup = box(min, max);
  soup.region_points = {{min + Vector{0.01, 0.013, 0.017}, 1, 0}};
  return soup;
}

// A box whose bottom side contains a point, or a segment between points that the box already has.
PolygonSoup room_with_mark(const Point& min, const Point& max, const std::vector<Point>& mark) {
  const PolygonSoup plain = box(min, max);
  PolygonSoup soup;
  for (Index f = 0; f < plain.facet_count(); ++f) {
    std::vector<Point> corners;
    for (const Index i : plain.polygon(plain.facet_polygons(f)[0])) corners.push_back(plain.points[i]);
    add_facet(soup, corners, plain.facet_tag(f));
    if (!std::all_of(corners.begin(), corners.end(), [&](const Point& p) { return p.z == min.z; })) continue;
    std::vector<Index> indices;
    for (const Point& p : mark) indices.push_back(add_point(soup, p));
    soup.add_polygon(indices);
  }
  soup.region_points = {{min + Vector{0.01, 0.013, 0.017}, 1, 0}};
  return soup;
}

double random_in(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// Returns a random number with equal chances for every order of magnitude.
double random_log(std::mt19937& random, double low, double high) {
  return std::exp(random_in(random, std::log(low), std::log(high)));
}

Vector random_direction(std::mt19937& random) {
  for (;;) {
    const Vector v{random_in(random, -1, 1), random_in(random, -1, 1), random_in(random, -1, 1)};
    if (squared_norm(v) < 1 && squared_norm(v) > 0.01) return v / norm(v);
  }
}

Shape prism_over_star(const std::vector<double>& radii, const std::string& name) {
  std::vector<Point> polygon;
  for (std::size_t i = 0; i < radii.size(); ++i)
    polygon.push_back(
        on_circle(360.0 * static_cast<double>(i) / static_cast<double>(radii.size()), radii[i]));
  return {name, {extrusion(polygon, 0.5)}, 0.5 * area(polygon)};
}

}  // namespace

Shape wedge(double angle, double length) {
  const auto triangle = triangle_with_angle(angle);
  return {
      fmt::format("wedge({}, {})", angle, length), {extrusion(triangle, length)}, length * area(triangle)};
}

Shape wedge_on_a_large_one(double angle, double small) {
  const Shape large = wedge(angle);
  PolygonSoup tiny = large.soups[0];
  for (Point& p : tiny.points) p = Point{0.7, 0, 1 + small} + small * p;
  return {fmt::format("wedge_on_a_large_one({}, {})", angle, small),
          {large.soups[0], tiny},
          large.volume * (1 + small * small * small)};
}

Shape fan(unsigned k, std::uint32_t seed) {
  PolygonSoup soup = room({-1, -1, -0.5}, {1, 1, 0.5});
  std::mt19937 random(seed);
  std::vector<double> gaps;
  for (unsigned i = 0; i < k; ++i) gaps.push_back(seed == 0 ? 1 : random_in(random, 1, 3));
  double sum = 0, angle = 7;
  for (const double gap : gaps) sum += gap;
  const Point low{0.03, 0.02, -0.22}, high{0.03, 0.02, 0.21};
  for (unsigned i = 0; i < k; ++i) {
    const Vector outwards = on_circle(angle, seed == 0 ? 0.6 : random_in(random, 0.4, 0.7));
    add_facet(soup, {low, low + outwards, high + outwards, high}, static_cast<Tag>(10 + i));
    angle += 360 * gaps[i] / sum;
  }
  return {fmt::format("fan({}, {})", k, seed), {soup}, 4};
}

Shape sectors(unsigned k) {
  Shape shape{fmt::format("sectors({})", k), {}, 0.5 * area(regular_polygon(k, 1))};
  const auto corners = regular_polygon(k, 1);
  for (unsigned i = 0; i < k; ++i)
    shape.soups.push_back(extrusion(std::vector<Point>{{0, 0, 0}, corners[i], corners[(i + 1) % k]}, 0.5));
  return shape;
}

Shape pyramid(unsigned k, double apex_angle) {
  const auto base = regular_polygon(k, std::tan(radians(apex_angle / 2)));
  return {fmt::format("pyramid({}, {})", k, apex_angle), {cone_over(base, {0, 0, 1})}, area(base) / 3};
}

Shape random_pyramid(std::uint32_t seed) {
  std::mt19937 random(seed);
  const unsigned k = 3 + random() % 6;
  std::vector<Point> base;
  for (unsigned i = 0; i < k; ++i)
    base.push_back(on_circle(360 * (i + random_in(random, 0, 0.6)) / k, random_in(random, 0.4, 1)));
  const double height = random_in(random, 0.3, 2);
  const Point apex{random_in(random, -1, 1), random_in(random, -1, 1), height};
  return {fmt::format("random_pyramid({})", seed), {cone_over(base, apex)}, area(base) * height / 3};
}

Shape star_prism(unsigned points, double inner_radius) {
  std::vector<double> radii;
  for (unsigned i = 0; i < points; ++i) radii.insert(radii.end(), {1, inner_radius});
  return prism_over_star(radii, fmt::format("star_prism({}, {})", points, inner_radius));
}

Shape random_star_prism(unsigned points, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<double> radii;
  for (unsigned i = 0; i < points; ++i)
    radii.insert(radii.end(), {random_in(random, 0.7, 1.2), random_in(random, 0.2, 0.5)});
  return prism_over_star(radii, fmt::format("random_star_prism({}, {})", points, seed));
}

Shape spiked_octahedron(double height) {
  const double a = 0.4;
  PolygonSoup soup;
  Tag tag = 1;
  for (const double x : {-a, a})
    for (const double y : {-a, a})
      for (const double z : {-a, a}) {
        std::array<Point, 3> corners{{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
        if (x * y * z < 0) std::swap(corners[1], corners[2]);
        const Point middle = (corners[0] + corners[1] + corners[2]) / 3;
        const Point tip = middle + height / norm(middle) * middle;
        for (std::size_t i = 0; i < 3; ++i) add_facet(soup, {corners[i], corners[(i + 1) % 3], tip}, tag++);
      }
  const double side = std::sqrt(3.0) / 4 * 2 * a * a;
  return {fmt::format("spiked_octahedron({})", height), {soup}, 4 * a * a * a / 3 + 8 * side * height / 3};
}

Shape knife(double angle) {
  const double half = 0.4 * std::tan(radians(angle / 2));
  const Point heel{0, 0, 0}, tip{1, 0.1, 0}, left{0, 0.4, half}, right{0, 0.4, -half};
  return {fmt::format("knife({})", angle),
          {tetrahedron(heel, tip, left, right)},
          std::fabs(six_volume(heel, tip, left, right)) / 6};
}

Shape two_knives(double angle, double gap_angle) {
  const Point low{0, 0, 0}, high{0, 0, 1};
  Shape shape{fmt::format("two_knives({}, {})", angle, gap_angle), {}, 0};
  for (const double from : {0.0, angle + gap_angle}) {
    const Point p = on_circle(from, 0.5, 0.2), q = on_circle(from + angle, 0.5, 0.2);
    shape.soups.push_back(tetrahedron(low, high, p, q));
    shape.volume += std::fabs(six_volume(low, high, p, q)) / 6;
  }
  return shape;
}

Shape wedges_touching_in_an_edge(double angle, double gap_angle) {
  const Shape one = wedge(angle);
  return {fmt::format("wedges_touching_in_an_edge({}, {})", angle, gap_angle),
          {one.soups[0], about_axis(one.soups[0], angle + gap_angle)},
          2 * one.volume};
}

Shape cubes_touching_in_an_edge(double gap_angle) {
  return {
      fmt::format("cubes_touching_in_an_edge({})", gap_angle), {box(), about_axis(box(), 90 + gap_angle)}, 2};
}

Shape pyramids_tip_to_tip(unsigned k, double apex_angle) {
  const Shape one = pyramid(k, apex_angle);
  const PolygonSoup tip_down = rotated(translated(one.soups[0], {0, 0, -1}), {1, 0, 0}, 180);
  return {fmt::format("pyramids_tip_to_tip({}, {})", k, apex_angle),
          {translated(one.soups[0], {0, 0, -1}), tip_down},
          2 * one.volume};
}

Shape cubes_touching_in_a_corner() {
  return {"cubes_touching_in_a_corner()", {box(), box({-1, -1, -1}, {0, 0, 0})}, 2};
}

Shape pyramid_on_a_box(double apex_angle) {
  const Shape one = pyramid(5, apex_angle);
  // The tip is a point of the side z = 0.
  PolygonSoup base = room_with_mark({-1, -1, 0}, {1, 1, 0.5}, {{0, 0, 0}});
  base.region_points.clear();
  PolygonSoup standing = translated(one.soups[0], {0, 0, -1});
  for (Point& p : standing.points)
    if (norm(p) < 1e-12) p = {0, 0, 0};
  return {fmt::format("pyramid_on_a_box({})", apex_angle), {base, standing}, 2 + one.volume};
}

Shape facet_ending_inside(double angle) {
  const Point a{0.5, 0.3, 0}, b{0.5, 0.7, 0};
  PolygonSoup soup = room_with_mark({0, 0, 0}, {2, 1, 1}, {a, b});
  const Vector up = 0.8 * Vector{std::cos(radians(angle)), 0, std::sin(radians(angle))};
  add_facet(soup, {a, b, b + up, a + up}, 7);
  return {fmt::format("facet_ending_inside({})", angle), {soup}, 2};
}

Shape segment_meeting_a_facet(double angle) {
  const Point foot{0.5, 0.4, 0};
  PolygonSoup soup = room_with_mark({0, 0, 0}, {2, 1, 1}, {foot});
  const auto from =
      static_cast<Index>(std::find(soup.points.begin(), soup.points.end(), foot) - soup.points.begin());
  const Index to =
      add_point(soup, foot + 0.9 * Vector{std::cos(radians(angle)), 0, std::sin(radians(angle))});
  soup.segments.push_back({from, to, 5});
  return {fmt::format("segment_meeting_a_facet({})", angle), {soup}, 2};
}

Shape segments_from_a_point(unsigned count, std::uint32_t seed) {
  std::mt19937 random(seed);
  PolygonSoup soup = room({-1, -1, -1}, {1, 1, 1});
  const Index centre = add_point(soup, {0.02, 0.05, -0.03});
  for (unsigned i = 0; i < count; ++i) {
    const Point end = soup.points[centre] + random_in(random, 0.3, 0.8) * random_direction(random);
    soup.segments.push_back({centre, add_point(soup, end), static_cast<Tag>(i + 1)});
  }
  return {fmt::format("segments_from_a_point({}, {})", count, seed), {soup}, 8};
}

Shape pairs_in_a_box(unsigned count, double size, std::uint32_t seed) {
  std::mt19937 random(seed);
  PolygonSoup soup = room({0, 0, 0}, {1, 1, 1});
  for (unsigned i = 0; i < count; ++i) {
    const Point from{random_in(random, 0.2, 0.8), random_in(random, 0.2, 0.8), random_in(random, 0.2, 0.8)};
    const Vector along = random_direction(random);
    Vector across = cross(along, random_direction(random));
    across = across / norm(across);
    const Vector up = cross(along, across);
    const Point to = from + size * along;
    for (const double turn : {0.0, radians(20)}) {
      const Vector side = size * (std::cos(turn) * across + std::sin(turn) * up);
      add_facet(soup, {from, to, to + side}, 7);  // as triangles, because rounding keeps these planar
      add_facet(soup, {from, to + side, from + side}, 7);
    }
  }
  return {fmt::format("pairs_in_a_box({}, {}, {})", count, size, seed), {soup}, 1};
}

Shape segment_near_a_crease(double angle, double distance, bool askew) {
  Shape shape = wedge(angle);
  shape.name = fmt::format("segment_near_a_crease({}, {}, {})", angle, distance, askew);
  PolygonSoup& soup = shape.soups[0];
  soup.region_points = {{{0.9, 0, 0.5}, 1, 0}};
  const Index from = add_point(soup, {distance, 0, 0.2});
  const Index to = add_point(soup, {askew ? 0.6 : distance, 0, 0.8});
  soup.segments.push_back({from, to, 5});
  return shape;
}

Shape facet_near_a_crease(double angle, double distance) {
  Shape shape = wedge(angle);
  shape.name = fmt::format("facet_near_a_crease({}, {})", angle, distance);
  PolygonSoup& soup = shape.soups[0];
  soup.region_points = {{{0.9, 0, 0.5}, 1, 0}};
  add_facet(soup, {{distance, 0, 0.2}, {0.6, 0, 0.25}, {0.6, 0, 0.75}, {distance, 0, 0.8}}, 7);
  return shape;
}

Shape comb(unsigned teeth, double angle) {
  const double width = 2 * std::tan(radians(angle / 2)), length = teeth * 1.2 * width;
  std::vector<Point> outline{{0, 0, 0}, {length, 0, 0}};
  for (unsigned i = teeth; i-- > 0;) {
    const double left = 1.2 * width * i + 0.1 * width;
    outline.insert(outline.end(), {{left + width, 0.3, 0}, {left + width / 2, 1.3, 0}, {left, 0.3, 0}});
  }
  outline[2].x = length;
  outline.back().x = 0;
  return {fmt::format("comb({}, {})", teeth, angle), {extrusion(outline, 0.3)}, 0.3 * area(outline)};
}

Shape random_tetrahedron(std::uint32_t seed) {
  std::mt19937 random(seed);
  for (;;) {
    std::array<Point, 4> p;
    for (Point& q : p) q = {random_in(random, 0, 1), random_in(random, 0, 1), random_in(random, 0, 1)};
    const double volume = std::fabs(six_volume(p[0], p[1], p[2], p[3])) / 6;
    if (volume < 0.01) continue;
    return {fmt::format("random_tetrahedron({})", seed), {tetrahedron(p[0], p[1], p[2], p[3])}, volume};
  }
}

Shape turned(Shape shape, std::uint32_t seed) {
  std::mt19937 random(seed);
  const Vector axis = random_direction(random);
  const double degrees = random_in(random, 0, 360);
  for (PolygonSoup& soup : shape.soups) soup = rotated(soup, axis, degrees);
  shape.name = fmt::format("turned({}, {})", shape.name, seed);
  return shape;
}

std::vector<Shape> random_members(std::uint32_t seed) {
  std::mt19937 random(seed);
  const auto count = [&](unsigned low, unsigned high) {
    return low + static_cast<unsigned>(random() % (high - low + 1));
  };
  std::vector<Shape> shapes;
  shapes.push_back(wedge(random_log(random, 1, 80), random_in(random, 0.3, 1.5)));
  shapes.push_back(fan(count(3, 14), seed));
  shapes.push_back(sectors(count(6, 14)));
  shapes.push_back(pyramid(count(3, 8), random_log(random, 2, 60)));
  shapes.push_back(random_pyramid(seed));
  shapes.push_back(random_star_prism(count(4, 12), seed));
  shapes.push_back(spiked_octahedron(random_in(random, 0.3, 1.5)));
  shapes.push_back(knife(random_log(random, 2, 60)));
  shapes.push_back(two_knives(random_in(random, 10, 50), random_in(random, 10, 50)));
  shapes.push_back(wedges_touching_in_an_edge(random_in(random, 10, 60), random_in(random, 10, 60)));
  shapes.push_back(cubes_touching_in_an_edge(random_in(random, 10, 60)));
  shapes.push_back(pyramids_tip_to_tip(count(3, 6), random_log(random, 10, 60)));
  shapes.push_back(pyramid_on_a_box(random_in(random, 20, 120)));
  shapes.push_back(facet_ending_inside(random_log(random, 3, 70)));
  shapes.push_back(segment_meeting_a_facet(random_log(random, 3, 70)));
  shapes.push_back(segments_from_a_point(count(2, 7), seed));
  shapes.push_back(
      segment_near_a_crease(random_in(random, 10, 60), random_in(random, 0.02, 0.3), seed % 2 == 0));
  shapes.push_back(facet_near_a_crease(random_in(random, 10, 60), random_in(random, 0.02, 0.3)));
  shapes.push_back(comb(count(2, 6), random_in(random, 8, 40)));
  shapes.push_back(random_tetrahedron(seed));
  for (Shape& shape : shapes) shape = turned(std::move(shape), seed);
  return shapes;
}

Shape round_cone(double half_angle) {
  const double radius = std::tan(radians(half_angle));
  return {fmt::format("round_cone({})", half_angle), {cone(radius, 1, 48, 8)}, pi * radius * radius / 3, 30};
}

Shape lens(double rim_angle) {
  // Two caps of a sphere whose tangents at the rim (radius 1) form this angle.
  const double half = radians(rim_angle / 2), radius = 1 / std::sin(half), depth = radius * std::cos(half);
  std::vector<Point> profile;
  constexpr int n = 16;
  const auto add = [&](int i, double sign) {
    const double t = half * i / n;
    profile.push_back({i == 0   ? 0
                       : i == n ? 1
                                : radius * std::sin(t),
                       0, i == n ? 0 : sign * (radius * std::cos(t) - depth)});
  };
  for (int i = 0; i <= n; ++i) add(i, -1);
  for (int i = n - 1; i >= 0; --i) add(i, 1);
  const double height = radius - depth;
  return {fmt::format("lens({})", rim_angle),
          {revolution(profile, 64)},
          2 * pi * height * height * (3 * radius - height) / 3,
          30};
}

Shape cut_torus(double plane) {
  const double major = 1, minor = 0.25, from = std::asin(plane);
  std::vector<Point> profile;
  constexpr int n = 16;
  for (int i = 0; i <= n; ++i) {
    const double t = from + (pi - 2 * from) * i / n;
    const double z = i == 0 || i == n ? minor * plane : minor * std::sin(t);
    profile.push_back({major + minor * std::cos(t), 0, z});
  }
  const double segment = minor * minor * (std::acos(plane) - plane * std::sqrt(1 - plane * plane));
  return {fmt::format("cut_torus({})", plane), {revolution(profile, 64, true)}, 2 * pi * major * segment, 30};
}

Shape long_lens(double rim_angle, double width) {
  constexpr int around = 12, along = 10, rows = 8;
  const double half = radians(rim_angle / 2), radius = 0.5 * width / std::sin(half);
  struct Rib {
    Point middle, rim;
  };
  std::vector<Rib> ribs;
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i < along; ++i) {
      const Point middle{side * (2.0 * i / along - 1), 0, 0};
      ribs.push_back({middle, middle + Vector{0, side * -0.5 * width, 0}});
    }
    for (int i = 0; i < around; ++i)
      ribs.push_back(
          {{side, 0, 0}, Point{side, 0, 0} + side * on_circle(180.0 * i / around - 90, 0.5 * width)});
  }
  PolygonSoup soup;
  const auto at = [&](std::size_t rib, int row, double side) {
    const Rib& r = ribs[rib % ribs.size()];
    if (row == rows) return r.rim;
    const double t = half * row / rows, share = std::sin(t) / std::sin(half);
    return r.middle + share * (r.rim - r.middle) +
           Vector{0, 0, side * radius * (std::cos(t) - std::cos(half))};
  };
  const auto add = [&](Point a, Point b, Point c, bool turned) {
    if (a == b || b == c || c == a) return;
    if (turned) std::swap(b, c);
    add_facet(soup, {a, b, c}, 1);
  };
  for (const double side : {1.0, -1.0})
    for (std::size_t i = 0; i < ribs.size(); ++i)
      for (int row = 0; row < rows; ++row) {
        add(at(i, row, side), at(i, row + 1, side), at(i + 1, row + 1, side), side < 0);
        add(at(i, row, side), at(i + 1, row + 1, side), at(i + 1, row, side), side < 0);
      }
  return {fmt::format("long_lens({}, {})", rim_angle, width), {soup}, 0, 30};
}

namespace {

// Two tangents from a tip, where they meet at this angle, to a circle around the origin. The tip comes first.
std::vector<Point> drop(double angle, double radius) {
  constexpr int n = 20;
  std::vector<Point> outline{{-radius / std::sin(radians(angle / 2)), 0, 0}};
  for (int i = 0; i <= n; ++i) outline.push_back(on_circle(-90 - angle / 2 + (180 + angle) * i / n, radius));
  return outline;
}

// The side of a cone of height 1.
void add_cone(PolygonSoup& soup, const std::vector<Point>& outline, Tag tag) {
  for (std::size_t i = 0; i < outline.size(); ++i)
    add_facet(soup, {outline[i], outline[(i + 1) % outline.size()], {0, 0, 1}}, tag);
}

}  // namespace

Shape drop_bar(double angle) {
  std::vector<Point> outline = drop(angle, 0.4);
  PolygonSoup soup;
  const Vector up{0, 0, 1};
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Point &a = outline[i], &b = outline[(i + 1) % outline.size()];
    add_facet(soup, {a, b, b + up}, 1);
    add_facet(soup, {a, b + up, a + up}, 1);
  }
  std::vector<Point> top;
  for (const Point& p : outline) top.push_back(p + up);
  add_facet(soup, top, 2);
  std::reverse(outline.begin(), outline.end());
  add_facet(soup, outline, 3);
  return {fmt::format("drop_bar({})", angle), {soup}, 0, 30};
}

Shape drop_cone(double angle, double apex_angle) {
  std::vector<Point> outline = drop(angle, std::tan(radians(apex_angle / 2)));
  PolygonSoup soup;
  add_cone(soup, outline, 1);
  std::reverse(outline.begin(), outline.end());
  add_facet(soup, outline, 2);
  return {fmt::format("drop_cone({}, {})", angle, apex_angle), {soup}, 0, 30};
}

Shape drop_cone_in_a_room(double angle, double apex_angle) {
  PolygonSoup soup = room({-3, -3, -3}, {3, 3, 3});
  add_cone(soup, drop(angle, std::tan(radians(apex_angle / 2))), 7);
  return {fmt::format("drop_cone_in_a_room({}, {})", angle, apex_angle), {soup}, 0, 30};
}

Shape curved_facet_ending_inside(double angle) {
  const Point a{0.5, 0.3, 0}, b{0.5, 0.7, 0};
  PolygonSoup soup = room_with_mark({0, 0, 0}, {2, 1, 1}, {a, b});
  constexpr int n = 12;
  Vector risen;
  for (int i = 0; i < n; ++i) {
    const double direction = radians(angle + 60.0 * i / n);
    const Vector higher = risen + 0.8 / n * Vector{std::cos(direction), 0, std::sin(direction)};
    add_facet(soup, {a + risen, b + risen, b + higher, a + higher}, 7);
    risen = higher;
  }
  return {fmt::format("curved_facet_ending_inside({})", angle), {soup}, 0, 30};
}

}  // namespace collarmesh::testing::acute
