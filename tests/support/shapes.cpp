#include "support/shapes.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <tuple>

namespace collarmesh::testing {

namespace {

constexpr double pi = std::numbers::pi;

// Makes a soup from positions; equal positions become one point.
class SoupMaker {
 public:
  Index point(const Point& p) {
    const auto [at, is_new] = numbers_.try_emplace({p.x, p.y, p.z}, static_cast<Index>(soup_.points.size()));
    if (is_new) soup_.points.push_back(p);
    return at->second;
  }
  void begin_facet(Tag tag) { soup_.begin_facet(tag); }
  void polygon(std::span<const Point> corners) {
    std::vector<Index> indices;
    for (const Point& p : corners) indices.push_back(point(p));
    soup_.add_polygon(indices);
  }
  void facet(std::span<const Point> corners, Tag tag) {
    begin_facet(tag);
    polygon(corners);
  }
  void facet(std::initializer_list<Point> corners, Tag tag) {
    facet(std::span(corners.begin(), corners.size()), tag);
  }
  void facet_hole(const Point& p) { soup_.facet_holes.push_back({soup_.facet_count() - 1, p}); }

  PolygonSoup soup_;

 private:
  std::map<std::tuple<double, double, double>, Index> numbers_;
};

double between(double a, double b, unsigned i, unsigned n) { return i == n ? b : a + (b - a) * i / n; }

// Adds one side of a box: a grid along the two axes after `axis`, at one end of that axis.
void add_box_side(SoupMaker& maker, const Point& min, const Point& max, std::size_t axis, bool at_max,
                  unsigned n) {
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  const auto corner = [&](unsigned i, unsigned j) {
    Point p;
    p[axis] = at_max ? max[axis] : min[axis];
    p[u] = between(min[u], max[u], i, n);
    p[v] = between(min[v], max[v], j, n);
    return p;
  };
  for (unsigned i = 0; i < n; ++i)
    for (unsigned j = 0; j < n; ++j) {
      std::array quad{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)};
      if (!at_max) std::reverse(quad.begin(), quad.end());
      maker.facet(quad, static_cast<Tag>(2 * axis + (at_max ? 2 : 1)));
    }
}

void add_box(SoupMaker& maker, const Point& min, const Point& max, unsigned n = 1) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool at_max : {false, true}) add_box_side(maker, min, max, axis, at_max, n);
}

std::array<Point, 4> square(const Point& centre, double size) {
  const double h = size / 2;
  return {{{centre.x - h, centre.y - h, centre.z},
           {centre.x + h, centre.y - h, centre.z},
           {centre.x + h, centre.y + h, centre.z},
           {centre.x - h, centre.y + h, centre.z}}};
}

std::vector<Point> circle(double radius, double z, unsigned segments) {
  std::vector<Point> points;
  for (unsigned i = 0; i < segments; ++i) {
    const double angle = 2 * pi * i / segments;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
  }
  return points;
}

// Adds the band of triangles between two rings of a revolution; seen from outside, the second ring is above
// the first.
void add_band(SoupMaker& maker, const std::vector<Point>& low, const std::vector<Point>& high) {
  const std::size_t n = std::max(low.size(), high.size());
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = (i + 1) % n;
    if (low.size() == 1)
      maker.facet({low[0], high[k], high[i]}, 1);
    else if (high.size() == 1)
      maker.facet({low[i], low[k], high[0]}, 1);
    else {
      maker.facet({low[i], low[k], high[k]}, 1);
      maker.facet({low[i], high[k], high[i]}, 1);
    }
  }
}

std::vector<Point> arc(const Point& centre, double radius, double from_degrees, double to_degrees,
                       unsigned n) {
  std::vector<Point> points;
  for (unsigned i = 0; i <= n; ++i) {
    const double angle = between(from_degrees, to_degrees, i, n) * pi / 180;
    points.push_back({centre.x + radius * std::cos(angle), 0, centre.z + radius * std::sin(angle)});
  }
  return points;
}

Vector random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Vector v{normal(random), normal(random), normal(random)};
  return v / norm(v);
}

}  // namespace

PolygonSoup box(const Point& min, const Point& max, unsigned n) {
  SoupMaker maker;
  add_box(maker, min, max, n);
  return maker.soup_;
}

PolygonSoup extrusion(std::span<const Point> polygon, double height) {
  std::vector<Point> low(polygon.begin(), polygon.end()), high = low;
  for (Point& p : low) p.z = 0;
  for (Point& p : high) p.z = height;
  SoupMaker maker;
  for (std::size_t i = 0; i < low.size(); ++i) {
    const std::size_t k = (i + 1) % low.size();
    maker.facet({low[i], low[k], high[k], high[i]}, static_cast<Tag>(3 + i));
  }
  maker.facet(high, 2);
  std::reverse(low.begin(), low.end());
  maker.facet(low, 1);
  return maker.soup_;
}

PolygonSoup l_shape() {
  const std::array<Point, 6> corners{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}};
  return extrusion(corners, 1);
}

PolygonSoup regular_prism(unsigned k, double height) { return extrusion(circle(1, 0, k), height); }

PolygonSoup revolution(std::span<const Point> profile, unsigned segments, bool closed) {
  std::vector<std::vector<Point>> rings;
  for (const Point& p : profile) {
    const bool on_axis = std::fabs(p.x) < 1e-14;
    rings.push_back(on_axis ? std::vector<Point>{{0, 0, p.z}} : circle(p.x, p.z, segments));
  }
  SoupMaker maker;
  for (std::size_t i = 1; i < rings.size(); ++i) add_band(maker, rings[i - 1], rings[i]);
  if (closed) add_band(maker, rings.back(), rings.front());
  return maker.soup_;
}

PolygonSoup icosphere(double radius, unsigned frequency) {
  const double g = std::numbers::phi;
  const std::array<Point, 12> corners{{{-1, g, 0},
                                       {1, g, 0},
                                       {-1, -g, 0},
                                       {1, -g, 0},
                                       {0, -1, g},
                                       {0, 1, g},
                                       {0, -1, -g},
                                       {0, 1, -g},
                                       {g, 0, -1},
                                       {g, 0, 1},
                                       {-g, 0, -1},
                                       {-g, 0, 1}}};
  constexpr std::array<std::array<Index, 3>, 20> faces{
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  // Points are identified by their integer weights of the corners, so that neighbouring faces share them.
  std::map<std::vector<std::array<Index, 2>>, Index> numbers;
  PolygonSoup soup;
  const auto point = [&](const std::array<Index, 3>& face, const std::array<Index, 3>& weights) {
    Index divisor = frequency;
    for (const Index w : weights) divisor = std::gcd(divisor, w);
    std::vector<std::array<Index, 2>> name;
    for (unsigned i = 0; i < 3; ++i)
      if (weights[i] != 0) name.push_back({face[i], weights[i] / divisor});
    std::sort(name.begin(), name.end());
    const auto [at, is_new] = numbers.try_emplace(name, static_cast<Index>(soup.points.size()));
    if (is_new) {
      Point sum;
      for (const auto& [corner, weight] : name) sum = sum + double(weight) * corners[corner];
      soup.points.push_back(radius / norm(sum) * sum);
    }
    return at->second;
  };
  for (const auto& face : faces)
    for (Index i = 0; i < frequency; ++i)
      for (Index j = 0; i + j < frequency; ++j) {
        const auto at = [&](Index u, Index v) { return point(face, {u, v, frequency - u - v}); };
        soup.add_facet(std::array{at(i, j), at(i + 1, j), at(i, j + 1)}, 1);
        if (i + j + 1 < frequency)
          soup.add_facet(std::array{at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, 1);
      }
  return soup;
}

PolygonSoup icosphere_of(double radius, std::size_t triangles) {
  return icosphere(radius,
                   std::max(1U, static_cast<unsigned>(std::lround(std::sqrt(double(triangles) / 20)))));
}

PolygonSoup uv_sphere(double radius, unsigned rings, unsigned segments) {
  auto profile = arc({}, radius, -90, 90, rings);
  profile.front().x = profile.back().x = 0;
  return revolution(profile, segments);
}

PolygonSoup cylinder(double radius, double height, unsigned segments, unsigned rings) {
  std::vector<Point> profile{{0, 0, 0}};
  for (unsigned i = 0; i <= rings; ++i) profile.push_back({radius, 0, between(0, height, i, rings)});
  profile.push_back({0, 0, height});
  return revolution(profile, segments);
}

PolygonSoup torus(double major, double minor, unsigned major_segments, unsigned minor_segments) {
  auto profile = arc({major, 0, 0}, minor, 0, 360, minor_segments);
  profile.pop_back();
  return revolution(profile, major_segments, true);
}

PolygonSoup cone(double radius, double height, unsigned segments, unsigned rings) {
  std::vector<Point> profile{{0, 0, 0}};
  for (unsigned i = 0; i <= rings; ++i)
    profile.push_back({between(radius, 0, i, rings), 0, between(0, height, i, rings)});
  return revolution(profile, segments);
}

PolygonSoup spiked_sphere(double spike_radius, double spike_height, unsigned segments) {
  // The fillet has the spike's radius and touches the sphere from outside, and the spike's side.
  const double fillet_x = 2 * spike_radius;
  const double fillet_z = std::sqrt((1 + spike_radius) * (1 + spike_radius) - fillet_x * fillet_x);
  const double contact = std::atan2(fillet_z, fillet_x) * 180 / pi;
  std::vector<Point> profile = arc({}, 1, -90, contact, 40);
  profile.front().x = 0;
  const auto add = [&](const std::vector<Point>& points) {
    profile.insert(profile.end(), points.begin() + 1, points.end());
  };
  add(arc({fillet_x, 0, fillet_z}, spike_radius, contact + 180, 180, 6));
  const double top = 1 + spike_height - spike_radius;
  std::vector<Point> side;
  for (unsigned i = 0; i <= 4; ++i) side.push_back({spike_radius, 0, between(fillet_z, top, i, 4)});
  add(side);
  add(arc({0, 0, top}, spike_radius, 0, 90, 8));
  profile.back().x = 0;
  return revolution(profile, segments);
}

PolygonSoup box_with_cavity(double size) {
  const Point centre{0.52, 0.47, 0.55};
  const Vector half{size / 2, size / 2, size / 2};
  return joined(box(), inverted(box(centre - half, centre + half)));
}

PolygonSoup box_with_small_facet(double size) {
  const Point centre{0.53, 0.46, 1};
  const auto small = square(centre, size);
  SoupMaker maker;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool at_max : {false, true}) add_box_side(maker, {0, 0, 0}, {1, 1, 1}, axis, at_max, 1);
  maker.polygon(small);  // adds it to the last facet, the top
  maker.facet_hole(centre);
  maker.facet(small, 7);
  return maker.soup_;
}

std::vector<PolygonSoup> boxes_touching_in_an_edge() {
  return {box({0, 0, 0}, {1, 1, 3}), box({1, 1, 0}, {2.3, 1.7, 3})};
}

std::vector<PolygonSoup> rings_touching_in_a_circle() {
  const std::array<Point, 4> lower{{{1, 0, 0}, {1.6, 0, 0}, {1.6, 0, 0.6}, {1, 0, 0.6}}},
      upper{{{1.6, 0, 0.6}, {2.2, 0, 0.6}, {2.2, 0, 1.2}, {1.6, 0, 1.2}}};
  return {revolution(lower, 24, true), revolution(upper, 24, true)};
}

PolygonSoup two_boxes() {
  SoupMaker maker;
  const Point low{0, 0, 0}, high{1, 1, 1}, up{0, 0, 1};
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (const bool at_max : {false, true}) {
      add_box_side(maker, low, high, axis, at_max, 1);
      add_box_side(maker, low + up, high + up, axis, at_max, 1);
    }
  add_box_side(maker, low, high, 2, false, 1);
  add_box_side(maker, low + up, high + up, 2, true, 1);
  maker.facet(square({0.5, 0.5, 1}, 1), 7);
  maker.soup_.region_points = {{{0.5, 0.5, 0.5}, 10, 0}, {{0.5, 0.5, 1.5}, 20, 0}};
  return maker.soup_;
}

std::vector<PolygonSoup> touching_boxes() { return {box(), box({0, 0, 1}, {1, 1, 2})}; }

PolygonSoup box_with_dangling_facet(double size) {
  SoupMaker maker;
  add_box(maker, {0, 0, 0}, {1, 1, 1});
  maker.facet(square({0.5, 0.5, 0.5}, size), 7);
  return maker.soup_;
}

PolygonSoup box_with_skew_lines(unsigned n) {
  PolygonSoup soup = box();
  for (unsigned i = 0; i < n; ++i) soup.points.push_back({between(0.3, 0.7, i, n - 1), 0.5, 0.4});
  for (unsigned i = 0; i < n; ++i) soup.points.push_back({0.5, between(0.3, 0.7, i, n - 1), 0.6});
  soup.region_points = {{{0.1, 0.1, 0.1}, 1, 0}};
  return soup;
}

std::vector<PolygonSoup> nested_boxes(unsigned levels) {
  std::vector<PolygonSoup> boxes;
  for (unsigned i = 0; i < levels; ++i) {
    const double inset = 0.45 * i / levels;
    boxes.push_back(box({inset, inset, inset}, {1 - inset, 1 - inset, 1 - inset}));
  }
  return boxes;
}

PolygonSoup plate_with_hole(double radius, unsigned segments) {
  SoupMaker maker;
  const auto low = circle(radius, 0, segments), high = circle(radius, 1, segments);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool at_max : {false, true}) {
      add_box_side(maker, {-2, -2, 0}, {2, 2, 1}, axis, at_max, 1);
      if (axis != 2) continue;
      maker.polygon(at_max ? high : low);
      maker.facet_hole({0, 0, at_max ? 1.0 : 0.0});
    }
  for (unsigned i = 0; i < segments; ++i) {
    const unsigned k = (i + 1) % segments;
    maker.facet({low[k], low[i], high[i]}, 7);
    maker.facet({low[k], high[i], high[k]}, 7);
  }
  return maker.soup_;
}

PolygonSoup random_prism(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const unsigned k = 6 + random() % 5;
  std::vector<Point> polygon;
  for (unsigned i = 0; i < k; ++i) {
    const double angle = 2 * pi * (i + 0.5 * unit(random)) / k;  // arcs of at most 90 degrees make obtuse
                                                                 // corners
    polygon.push_back({std::cos(angle), std::sin(angle), 0});
  }
  const Vector axis = random_direction(random);
  const double shear = 0.1 * unit(random), degrees = 360 * unit(random);
  const auto sheared = transformed(extrusion(polygon, 0.5 + unit(random)), [&](const Point& p) {
    return Point{p.x + shear * p.z, p.y, p.z};
  });
  return rotated(sheared, axis, degrees);
}

PolygonSoup random_hull(std::uint32_t seed, unsigned points) {
  std::mt19937 random(seed);
  PolygonSoup soup;
  for (unsigned i = 0; i < points; ++i) soup.points.push_back(random_direction(random));
  for (Index a = 0; a < points; ++a)
    for (Index b = a + 1; b < points; ++b)
      for (Index c = a + 1; c < points; ++c) {
        if (c == b) continue;
        bool outermost = true;
        for (Index d = 0; d < points && outermost; ++d)
          outermost = d == a || d == b || d == c ||
                      six_volume(soup.points[a], soup.points[b], soup.points[c], soup.points[d]) < 0;
        if (outermost) soup.add_facet(std::array{a, b, c}, 1);
      }
  return soup;
}

PolygonSoup transformed(const PolygonSoup& soup, const std::function<Point(const Point&)>& map) {
  PolygonSoup result = soup;
  for (Point& p : result.points) p = map(p);
  for (auto& r : result.region_points) r.point = map(r.point);
  for (Point& p : result.hole_points) p = map(p);
  for (auto& h : result.facet_holes) h.point = map(h.point);
  return result;
}

PolygonSoup translated(const PolygonSoup& soup, const Vector& by) {
  return transformed(soup, [&](const Point& p) { return p + by; });
}

PolygonSoup scaled(const PolygonSoup& soup, double by) {
  return transformed(soup, [&](const Point& p) { return by * p; });
}

// Uses Rodrigues' formula.
PolygonSoup rotated(const PolygonSoup& soup, const Vector& axis, double degrees) {
  const Vector k = axis / norm(axis);
  const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
  return transformed(soup, [&](const Point& p) { return c * p + s * cross(k, p) + (1 - c) * dot(k, p) * k; });
}

namespace {

// Returns the soup with its facets in the given order, with renumbered and possibly rotated corners.
PolygonSoup rebuilt(const PolygonSoup& soup, const std::vector<Index>& facets,
                    const std::vector<Index>& number, bool turn) {
  PolygonSoup result;
  result.name = soup.name;
  result.region_points = soup.region_points;
  result.hole_points = soup.hole_points;
  result.points.resize(soup.points.size());
  for (Index i = 0; i < number.size(); ++i) result.points[number[i]] = soup.points[i];
  if (!soup.point_tags.empty()) result.point_tags.resize(soup.points.size());
  for (Index i = 0; i < soup.point_tags.size(); ++i) result.point_tags[number[i]] = soup.point_tags[i];
  for (const auto& s : soup.segments) result.segments.push_back({number[s.a], number[s.b], s.tag});
  std::vector<Index> place(facets.size());
  for (Index i = 0; i < facets.size(); ++i) {
    place[facets[i]] = i;
    result.begin_facet(soup.facet_tag(facets[i]));
    const auto [first, last] = soup.facet_polygons(facets[i]);
    for (Index q = first; q < last; ++q) {
      std::vector<Index> corners;
      for (const Index corner : soup.polygon(q)) corners.push_back(number[corner]);
      if (turn) std::reverse(corners.begin(), corners.end());
      result.add_polygon(corners);
    }
  }
  for (const auto& h : soup.facet_holes) result.facet_holes.push_back({place[h.facet], h.point});
  return result;
}

std::vector<Index> identity(std::size_t n) {
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index{0});
  return order;
}

}  // namespace

PolygonSoup inverted(const PolygonSoup& soup) {
  return rebuilt(soup, identity(soup.facet_count()), identity(soup.points.size()), true);
}

PolygonSoup permuted(const PolygonSoup& soup, std::uint32_t seed) {
  std::mt19937 random(seed);
  auto facets = identity(soup.facet_count()), number = identity(soup.points.size());
  std::shuffle(facets.begin(), facets.end(), random);
  std::shuffle(number.begin(), number.end(), random);
  return rebuilt(soup, facets, number, false);
}

PolygonSoup joined(const PolygonSoup& a, const PolygonSoup& b) {
  PolygonSoup result = a;
  const auto shift = static_cast<Index>(a.points.size());
  const Index facets = a.facet_count();
  result.points.insert(result.points.end(), b.points.begin(), b.points.end());
  for (Index f = 0; f < b.facet_count(); ++f) {
    result.begin_facet(b.facet_tag(f));
    const auto [first, last] = b.facet_polygons(f);
    for (Index q = first; q < last; ++q) {
      std::vector<Index> corners(b.polygon(q).begin(), b.polygon(q).end());
      for (Index& corner : corners) corner += shift;
      result.add_polygon(corners);
    }
  }
  for (const auto& s : b.segments) result.segments.push_back({s.a + shift, s.b + shift, s.tag});
  for (const auto& h : b.facet_holes) result.facet_holes.push_back({h.facet + facets, h.point});
  result.region_points.insert(result.region_points.end(), b.region_points.begin(), b.region_points.end());
  result.hole_points.insert(result.hole_points.end(), b.hole_points.begin(), b.hole_points.end());
  return result;
}

}  // namespace collarmesh::testing
