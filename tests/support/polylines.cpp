#include "support/polylines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>

#include "support/shapes.h"

namespace collarmesh::testing::polylines {

namespace {

constexpr double pi = std::numbers::pi;

// The unit box around the polylines. The region point makes loose segments features.
PolygonSoup room() {
  PolygonSoup soup = box({0, 0, 0}, {1, 1, 1});
  soup.region_points = {{{0.01, 0.013, 0.017}, 1, 0}};
  return soup;
}

Index add_point(PolygonSoup& soup, const Point& p) {
  soup.points.push_back(p);
  return static_cast<Index>(soup.points.size() - 1);
}

void add_segment(PolygonSoup& soup, Index a, Index b) {
  soup.segments.push_back({a, b, static_cast<Tag>(soup.segments.size() + 1)});
}

void add_segment(PolygonSoup& soup, const Point& a, const Point& b) {
  const Index first = add_point(soup, a);
  add_segment(soup, first, add_point(soup, b));
}

void add_polyline(PolygonSoup& soup, const std::vector<Point>& points, bool closed = false) {
  const auto first = static_cast<Index>(soup.points.size());
  soup.points.insert(soup.points.end(), points.begin(), points.end());
  const auto count = static_cast<Index>(points.size());
  for (Index i = 0; i + 1 < count; ++i) add_segment(soup, first + i, first + i + 1);
  if (closed) add_segment(soup, first + count - 1, first);
}

double any(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vector any_direction(std::mt19937& random) {
  const double z = any(random, -1, 1), turn = any(random, 0, 2 * pi), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

Shape shape_of(std::string name, PolygonSoup soup) { return {std::move(name), {std::move(soup)}, 1}; }

// Returns a zigzag between two parallel lines, from 0.2 to 0.8 along them; the first line is the axis.
std::vector<Point> zigzag(unsigned segments, double angle, const std::function<Point(double, double)>& at) {
  const double step = 0.6 / segments, height = step / std::tan(angle / 2 * pi / 180);
  std::vector<Point> points;
  for (unsigned i = 0; i <= segments; ++i) points.push_back(at(0.2 + step * i, i % 2 == 0 ? 0 : height));
  return points;
}

}  // namespace

Shape skew_zigzags(unsigned n, double angle) {
  PolygonSoup soup = room();
  const unsigned half = std::max(1U, n / 2);
  add_polyline(soup, zigzag(half, angle, [](double along, double aside) {
                 return Point{along, 0.5 + aside, 0.35};
               }));
  add_polyline(soup, zigzag(half, angle, [](double along, double aside) {
                 return Point{0.5 + aside, along, 0.65};
               }));
  return shape_of(fmt::format("skew_zigzags({}, {})", n, angle), soup);
}

Shape helices(unsigned n) {
  PolygonSoup soup = room();
  const unsigned half = std::max(1U, n / 2);
  const double turns = half / 16.0;
  for (const double start : {0.0, pi}) {
    std::vector<Point> points;
    for (unsigned i = 0; i <= half; ++i) {
      const double t = static_cast<double>(i) / half, turn = start + 2 * pi * turns * t;
      points.push_back({0.5 + 0.25 * std::cos(turn), 0.5 + 0.25 * std::sin(turn), 0.2 + 0.6 * t});
    }
    add_polyline(soup, points);
  }
  return shape_of(fmt::format("helices({})", n), soup);
}

Shape torus_knot(unsigned n) {
  PolygonSoup soup = room();
  // The number of strands per length with which neighbours are about as far apart as segments are long. The
  // torus is 2 pi 0.28 long and 2 pi 0.12 around.
  const double per_length = std::sqrt(n / (2 * pi * 0.12 * 2 * pi * 0.28));
  const auto around = std::max(2U, static_cast<unsigned>(2 * pi * 0.12 * per_length));
  const unsigned along = around + 1;  // coprime numbers make one strand
  std::vector<Point> points;
  for (unsigned i = 0; i < n; ++i) {
    const double t = 2 * pi * i / n, ring = 0.28 + 0.12 * std::cos(along * t);
    points.push_back({0.5 + ring * std::cos(around * t), 0.5 + ring * std::sin(around * t),
                      0.5 + 0.12 * std::sin(along * t)});
  }
  add_polyline(soup, points, true);
  return shape_of(fmt::format("torus_knot({})", n), soup);
}

Shape random_walk(unsigned n, std::uint32_t seed) {
  std::mt19937 random(seed);
  PolygonSoup soup = room();
  const double step = 0.5 / std::cbrt(n);
  std::vector<Point> points{{0.5, 0.5, 0.5}};
  while (points.size() <= n) {
    const Point p = points.back() + step * any_direction(random);
    const auto inside = [&](double x) { return x > 0.2 && x < 0.8; };
    if (inside(p.x) && inside(p.y) && inside(p.z)) points.push_back(p);
  }
  add_polyline(soup, points);
  return shape_of(fmt::format("random_walk({}, {})", n, seed), soup);
}

Shape box_frames(unsigned n, std::uint32_t seed) {
  std::mt19937 random(seed);
  PolygonSoup soup = room();
  const unsigned frames = std::max(1U, n / 12);
  const auto side = static_cast<unsigned>(std::ceil(std::cbrt(frames) - 1e-9));
  const double pitch = 0.8 / side;
  for (unsigned i = 0; i < frames; ++i) {
    const unsigned row = i / side;
    const Point centre{0.1 + pitch * (i % side + 0.5), 0.1 + pitch * (row % side + 0.5),
                       0.1 + pitch * (row / side + 0.5)};
    const Vector a = any_direction(random), b = cross(a, any_direction(random)), c = cross(a, b);
    const Vector sides[3] = {any(random, 0.05, 0.45) * pitch * a,
                             any(random, 0.05, 0.45) * pitch / norm(b) * b,
                             any(random, 0.05, 0.45) * pitch / norm(c) * c};
    const auto first = static_cast<Index>(soup.points.size());
    for (unsigned k = 0; k < 8; ++k)
      add_point(soup, centre + (static_cast<double>(k & 1U) - 0.5) * sides[0] +
                          (static_cast<double>(k >> 1 & 1U) - 0.5) * sides[1] +
                          (static_cast<double>(k >> 2) - 0.5) * sides[2]);
    for (Index k = 0; k < 8; ++k)
      for (const Index bit : {1U, 2U, 4U})
        if ((k & bit) == 0) add_segment(soup, first + k, first + (k | bit));
  }
  return shape_of(fmt::format("box_frames({}, {})", n, seed), soup);
}

Shape graph(unsigned n, std::uint32_t seed) {
  std::mt19937 random(seed);
  PolygonSoup soup = room();
  const unsigned count = std::max(4U, n / 2);
  // Each cell of a grid has one point, moved at random, so the nearest points are in nearby cells.
  const auto side = static_cast<unsigned>(std::ceil(std::cbrt(count) - 1e-9));
  const double pitch = 0.6 / side;
  std::vector<Point> points;
  for (unsigned i = 0; i < side * side * side; ++i)
    points.push_back(Point{0.2 + pitch * (i % side + any(random, 0.1, 0.9)),
                           0.2 + pitch * (i / side % side + any(random, 0.1, 0.9)),
                           0.2 + pitch * (i / side / side + any(random, 0.1, 0.9))});
  const auto first = static_cast<Index>(soup.points.size());
  soup.points.insert(soup.points.end(), points.begin(), points.end());
  std::set<std::pair<Index, Index>> edges;
  const auto at = [&](unsigned i) {
    return std::array<int, 3>{int(i % side), int(i / side % side), int(i / side / side)};
  };
  for (unsigned i = 0; i < points.size(); ++i) {
    std::vector<std::pair<double, Index>> near;
    const auto [x, y, z] = at(i);
    const int last = static_cast<int>(side) - 1;
    for (int w = std::max(0, z - 2); w <= std::min(last, z + 2); ++w)
      for (int v = std::max(0, y - 2); v <= std::min(last, y + 2); ++v)
        for (int u = std::max(0, x - 2); u <= std::min(last, x + 2); ++u) {
          const auto k = static_cast<Index>(u + static_cast<int>(side) * (v + static_cast<int>(side) * w));
          if (k != i) near.push_back({squared_distance(points[i], points[k]), k});
        }
    std::sort(near.begin(), near.end());
    for (unsigned k = 0; k < std::min<std::size_t>(3, near.size()); ++k)
      edges.insert({std::min<Index>(i, near[k].second), std::max<Index>(i, near[k].second)});
  }
  for (const auto& [a, b] : edges) add_segment(soup, first + a, first + b);
  return shape_of(fmt::format("graph({}, {})", n, seed), soup);
}

Shape crossed_wires(unsigned n, double gap) {
  PolygonSoup soup = room();
  const unsigned half = std::max(1U, n / 2);
  const double pitch = 0.6 / half;
  for (unsigned i = 0; i < half; ++i) {
    const double at = 0.2 + pitch * (i + 0.5);
    add_segment(soup, {0.2, at, 0.5 - gap * pitch / 2}, {0.8, at, 0.5 - gap * pitch / 2});
    add_segment(soup, {at, 0.2, 0.5 + gap * pitch / 2}, {at, 0.8, 0.5 + gap * pitch / 2});
  }
  return shape_of(fmt::format("crossed_wires({}, {})", n, gap), soup);
}

Shape crossed_strips(unsigned n, double gap) {
  PolygonSoup soup = room();
  const unsigned half = std::max(1U, n / 2);
  const double pitch = 0.6 / half, low = 0.5 - gap * pitch / 2, high = 0.5 + gap * pitch / 2;
  const auto add_strip = [&](const std::array<Point, 4>& corners) {
    const auto first = static_cast<Index>(soup.points.size());
    soup.points.insert(soup.points.end(), corners.begin(), corners.end());
    soup.add_facet(std::array<Index, 4>{first, first + 1, first + 2, first + 3},
                   static_cast<Tag>(7 + soup.facet_count()));
  };
  for (unsigned i = 0; i < half; ++i) {
    const double from = 0.2 + pitch * (i + 0.25), to = from + pitch / 2;
    add_strip({Point{0.2, from, low}, {0.8, from, low}, {0.8, to, low}, {0.2, to, low}});
    add_strip({Point{from, 0.2, high}, {to, 0.2, high}, {to, 0.8, high}, {from, 0.8, high}});
  }
  return shape_of(fmt::format("crossed_strips({}, {})", n, gap), soup);
}

Shape welded_mesh(unsigned n) {
  PolygonSoup soup = room();
  const auto side = std::max(1U, static_cast<unsigned>(std::sqrt(n / 2.0)));
  const auto first = static_cast<Index>(soup.points.size());
  for (unsigned j = 0; j <= side; ++j)
    for (unsigned i = 0; i <= side; ++i) add_point(soup, {0.2 + 0.6 * i / side, 0.2 + 0.6 * j / side, 0.5});
  for (Index j = 0; j <= side; ++j)
    for (Index i = 0; i <= side; ++i) {
      const Index at = first + i + (side + 1) * j;
      if (i < side) add_segment(soup, at, at + 1);
      if (j < side) add_segment(soup, at, at + side + 1);
    }
  return shape_of(fmt::format("welded_mesh({})", n), soup);
}

Shape skew_combs(unsigned n) {
  PolygonSoup soup = room();
  const unsigned teeth = std::max(1U, n / 4);
  for (const bool upper : {false, true}) {
    const auto at = [&](double along, double up) {
      return upper ? Point{0.5, along, 0.65 + up} : Point{along, 0.5, 0.35 - up};
    };
    Index before = none;
    for (unsigned i = 0; i < teeth; ++i) {
      const double along = 0.2 + 0.6 * (i + 0.5) / teeth;
      const Index foot = add_point(soup, at(along, 0.2));
      add_segment(soup, foot, add_point(soup, at(along, 0)));
      if (before != none) add_segment(soup, before, foot);
      before = foot;
    }
  }
  return shape_of(fmt::format("skew_combs({})", n), soup);
}

Shape outlines(unsigned n) {
  PolygonSoup soup = room();
  constexpr unsigned corners = 12;
  const unsigned letters = std::max(1U, n / (4 * corners));
  const double pitch = 0.6 / letters;
  for (const bool upper : {false, true})
    for (unsigned i = 0; i < letters; ++i)
      for (const double radius : {0.45 * pitch, 0.3 * pitch}) {
        std::vector<Point> ring;
        for (unsigned k = 0; k < corners; ++k) {
          const double along = 0.2 + pitch * (i + 0.5) + radius * std::cos(2 * pi * k / corners);
          const double aside = 0.5 + 1.3 * radius * std::sin(2 * pi * k / corners);
          ring.push_back(upper ? Point{aside, along, 0.65} : Point{along, aside, 0.35});
        }
        add_polyline(soup, ring, true);
      }
  return shape_of(fmt::format("outlines({})", n), soup);
}

Shape shrinking_spiral(unsigned n, double smallest) {
  PolygonSoup soup = room();
  std::vector<Point> points;
  for (unsigned i = 0; i <= n; ++i) {
    const double share = std::pow(smallest, static_cast<double>(i) / n), turn = 2 * pi * i / 12;
    points.push_back(
        {0.5 + 0.3 * share * std::cos(turn), 0.5 + 0.3 * share * std::sin(turn), 0.5 + 0.25 * share});
  }
  add_polyline(soup, points);
  return shape_of(fmt::format("shrinking_spiral({}, {})", n, smallest), soup);
}

Shape star(unsigned n, std::uint32_t seed) {
  std::mt19937 random(seed);
  PolygonSoup soup = room();
  const Index centre = add_point(soup, {0.51, 0.52, 0.49});
  for (unsigned i = 0; i < n; ++i)
    add_segment(soup, centre,
                add_point(soup, soup.points[centre] + any(random, 0.15, 0.4) * any_direction(random)));
  return shape_of(fmt::format("star({}, {})", n, seed), soup);
}

Shape with_small_copy(const Shape& shape, double small) {
  PolygonSoup soup = shape.soups[0];
  const Point corner{0.03, 0.03, 0.03};
  const std::vector<PolygonSoup::Segment> segments = soup.segments;
  std::map<Index, Index> copies;
  const auto copy_of = [&](Index p) {
    const auto [found, is_new] = copies.insert({p, none});
    if (is_new) found->second = add_point(soup, corner + small * (soup.points[p] - Point{0, 0, 0}));
    return found->second;
  };
  for (const auto& segment : segments) {
    const Index a = copy_of(segment.a), b = copy_of(segment.b);
    add_segment(soup, a, b);
  }
  return shape_of(fmt::format("with_small_copy({}, {})", shape.name, small), soup);
}

}  // namespace collarmesh::testing::polylines
