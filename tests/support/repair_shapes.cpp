#include "support/repair_shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <set>

#include "common/disjoint_sets.h"
#include "support/plc_shapes.h"
#include "support/shapes.h"

namespace collarmesh::testing::faulty {

namespace {

using std::numbers::pi;

// Visits the triangles of fans; with their signs, these also cover polygons that are not convex.
template <class Visit>
void for_each_triangle(const PolygonSoup& soup, const Visit& visit) {
  for (Index q = 0; q < soup.polygon_count(); ++q) {
    const auto corners = soup.polygon(q);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      visit(soup.points[corners[0]], soup.points[corners[i]], soup.points[corners[i + 1]]);
  }
}

PolygonSoup frame_of(const PolygonSoup& soup) {
  PolygonSoup frame;
  frame.name = soup.name;
  frame.points = soup.points;
  frame.region_tag = soup.region_tag;
  return frame;
}

void add_inverted(PolygonSoup& result, const PolygonSoup& soup, Index facet) {
  const auto corners = soup.polygon(soup.facet_polygons(facet)[0]);
  result.add_facet(std::vector<Index>(corners.rbegin(), corners.rend()), soup.facet_tag(facet));
}

void add_same(PolygonSoup& result, const PolygonSoup& soup, Index facet) {
  result.add_facet(soup.polygon(soup.facet_polygons(facet)[0]), soup.facet_tag(facet));
}

std::vector<Index> random_facets(const PolygonSoup& soup, Random& random, unsigned count) {
  std::vector<Index> facets(soup.facet_count());
  std::iota(facets.begin(), facets.end(), Index{0});
  std::shuffle(facets.begin(), facets.end(), random);
  facets.resize(std::min<std::size_t>(count, facets.size()));
  return facets;
}

Point nearest_on_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
  // Follows Ericson, Real-Time Collision Detection, 5.1.5.
  const Vector ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + (d1 / (d1 - d3)) * ab;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
  return a + (vb / (va + vb + vc)) * ab + (vc / (va + vb + vc)) * ac;
}

// Cuts a polygon into triangles, one ear after the other.
std::vector<std::array<Index, 3>> ears(const std::vector<Point>& points, std::span<const Index> polygon) {
  std::vector<Index> rest(polygon.begin(), polygon.end());
  Vector normal;
  for (std::size_t i = 1; i + 1 < rest.size(); ++i)
    normal = normal + cross(points[rest[i]] - points[rest[0]], points[rest[i + 1]] - points[rest[0]]);
  const auto left = [&](Index a, Index b, Index c) {
    return dot(normal, cross(points[b] - points[a], points[c] - points[a]));
  };
  const double rounding = 1e-9 * squared_norm(normal);
  std::vector<std::array<Index, 3>> triangles;
  while (rest.size() > 3) {
    const std::size_t n = rest.size();
    std::size_t ear = n;
    for (std::size_t i = 0; i < n && ear == n; ++i) {
      const Index a = rest[(i + n - 1) % n], b = rest[i], c = rest[(i + 1) % n];
      const bool free = std::none_of(rest.begin(), rest.end(), [&](Index p) {
        return p != a && p != b && p != c && left(a, b, p) > -rounding && left(b, c, p) > -rounding &&
               left(c, a, p) > -rounding;
      });
      if (left(a, b, c) > rounding && free) ear = i;
    }
    if (ear == n) ear = 1;
    triangles.push_back({rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({rest[0], rest[1], rest[2]});
  return triangles;
}

}  // namespace

unsigned members(unsigned count) {
  const char* share = std::getenv("COLLARMESH_FAMILY_SHARE");
  return std::max(1U,
                  share == nullptr ? count : static_cast<unsigned>(std::lround(count * std::atof(share))));
}

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vector random_direction(Random& random) {
  for (;;) {
    const Vector v{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    const double length = norm(v);
    if (length > 0.1 && length < 1) return v / length;
  }
}

PolygonSoup turned(const PolygonSoup& soup, Random& random) {
  const Vector axis = random_direction(random);
  return rotated(soup, axis, uniform(random, 0, 360));
}

PolygonSoup jittered(const PolygonSoup& soup, Random& random, double by) {
  PolygonSoup result = soup;
  for (Point& p : result.points)
    p = p + Vector{uniform(random, -by, by), uniform(random, -by, by), uniform(random, -by, by)};
  return result;
}

PolygonSoup triangulated(const PolygonSoup& soup) {
  PolygonSoup result = frame_of(soup);
  for (Index f = 0; f < soup.facet_count(); ++f)
    for (const auto& t : ears(soup.points, soup.polygon(soup.facet_polygons(f)[0])))
      result.add_facet(t, soup.facet_tag(f));
  return result;
}

PolygonSoup corners_rotated(const PolygonSoup& soup, Random& random) {
  PolygonSoup result = frame_of(soup);
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto span = soup.polygon(soup.facet_polygons(f)[0]);
    std::vector<Index> corners(span.begin(), span.end());
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(random() % corners.size()),
                corners.end());
    result.add_facet(corners, soup.facet_tag(f));
  }
  return result;
}

PolygonSoup joined(std::span<const PolygonSoup> soups) {
  PolygonSoup result;
  for (const PolygonSoup& soup : soups) {
    const auto first = static_cast<Index>(result.points.size());
    result.points.insert(result.points.end(), soup.points.begin(), soup.points.end());
    for (Index f = 0; f < soup.facet_count(); ++f) {
      std::vector<Index> corners;
      for (const Index c : soup.polygon(soup.facet_polygons(f)[0])) corners.push_back(first + c);
      result.add_facet(corners, soup.facet_tag(f));
    }
  }
  return result;
}

std::vector<Box> random_boxes(Random& random, unsigned count, unsigned grid) {
  std::vector<Box> boxes;
  while (boxes.size() < count) {
    Box box;
    for (unsigned corner = 0; corner < 2; ++corner)
      box.add(0.25 * Point{static_cast<double>(random() % (grid + 1)),
                           static_cast<double>(random() % (grid + 1)),
                           static_cast<double>(random() % (grid + 1))});
    const Vector size = box.max - box.min;
    if (size.x == 0 || size.y == 0 || size.z == 0) continue;
    if (std::any_of(boxes.begin(), boxes.end(),
                    [&](const Box& b) { return b.min == box.min && b.max == box.max; }))
      continue;
    boxes.push_back(box);
  }
  return boxes;
}

PolygonSoup soup_of(const Box& b) { return box(b.min, b.max, 1); }

PolygonSoup box_with_wall(double height, double share, double overhang) {
  PolygonSoup soup = box({0, 0, 0}, {1, 1, 1}, 1);
  const auto first = static_cast<Index>(soup.points.size());
  const double low = -overhang, high = share < 1 ? share : 1 + overhang;
  for (const Point& p : {Point{low, low, height},
                         {high, low, height},
                         {high, 1 + overhang, height},
                         {low, 1 + overhang, height}})
    soup.points.push_back(p);
  soup.add_facet(std::array{first, first + 1, first + 2, first + 3}, 7);
  return soup;
}

PolygonSoup twisted_prism(unsigned k, double degrees, bool quadrangles) {
  PolygonSoup soup;
  std::vector<Index> bottom, top;
  for (unsigned level = 0; level < 2; ++level)
    for (unsigned i = 0; i < k; ++i) {
      const double t = 2 * pi * i / k + level * degrees * pi / 180;
      soup.points.push_back({std::cos(t), std::sin(t), static_cast<double>(level)});
    }
  for (Index i = 0; i < k; ++i) {
    bottom.push_back(k - 1 - i);
    top.push_back(k + i);
  }
  soup.add_facet(bottom, 1);
  soup.add_facet(top, 2);
  for (Index i = 0; i < k; ++i) {
    const Index n = (i + 1) % k;
    if (quadrangles) {
      soup.add_facet(std::array{i, n, k + n, k + i}, 3 + static_cast<Tag>(i));
    } else {
      soup.add_facet(std::array{i, n, k + n}, 3 + static_cast<Tag>(i));
      soup.add_facet(std::array{i, k + n, k + i}, 3 + static_cast<Tag>(i));
    }
  }
  return soup;
}

PolygonSoup nested_spheres(double inner, bool outer_inverted, bool inner_inverted) {
  PolygonSoup large = icosphere(1, 3), small = icosphere(inner, 2);
  if (outer_inverted) large = inverted(large);
  if (inner_inverted) small = inverted(small);
  return joined(std::array{large, small});
}

OpenSphere sphere_with_holes(Random& random, unsigned frequency, unsigned holes) {
  const PolygonSoup sphere = icosphere(1, frequency);
  OpenSphere open;
  std::vector<Index> centres;
  while (centres.size() < holes) {
    const auto p = static_cast<Index>(random() % sphere.points.size());
    if (std::all_of(centres.begin(), centres.end(),
                    [&](Index c) { return distance(sphere.points[c], sphere.points[p]) > 5.0 / frequency; }))
      centres.push_back(p);
  }
  const auto has = [&](Index f, Index p) {
    const auto corners = sphere.polygon(f);
    return std::find(corners.begin(), corners.end(), p) != corners.end();
  };
  open.soup = filtered(sphere, [&](Index f) {
    return std::none_of(centres.begin(), centres.end(), [&](Index c) { return has(f, c); });
  });
  for (const Index c : centres) {
    open.holes.push_back(sphere.points[c]);
    std::size_t edges = 0;
    for (Index f = 0; f < sphere.facet_count(); ++f) edges += has(f, c) ? 1 : 0;
    open.edges.push_back(edges);
  }
  return open;
}

PolygonSoup with_repeated_facets(const PolygonSoup& soup, Random& random, unsigned count,
                                 bool inverted_ones) {
  PolygonSoup result = filtered(soup, [](Index) { return true; });
  for (const Index f : random_facets(soup, random, count)) {
    if (inverted_ones)
      add_inverted(result, soup, f);
    else
      add_same(result, soup, f);
  }
  return result;
}

PolygonSoup with_inverted_facets(const PolygonSoup& soup, Random& random, unsigned count) {
  const auto chosen = random_facets(soup, random, count);
  const std::set<Index> facets(chosen.begin(), chosen.end());
  PolygonSoup result = frame_of(soup);
  for (Index f = 0; f < soup.facet_count(); ++f) {
    if (facets.count(f) > 0)
      add_inverted(result, soup, f);
    else
      add_same(result, soup, f);
  }
  return result;
}

PolygonSoup box_with_t_junctions(Random& random, unsigned n) {
  const PolygonSoup whole = triangulated(box({0, 0, 0}, {1, 1, 1}, 1)),
                    fine = triangulated(box({0, 0, 0}, {1, 1, 1}, n));
  std::set<Tag> cut;
  const auto sides = 1 + random() % 5;
  while (cut.size() < sides) cut.insert(static_cast<Tag>(1 + random() % 6));
  return joined(std::array{filtered(whole, [&](Index f) { return cut.count(whole.facet_tag(f)) == 0; }),
                           filtered(fine, [&](Index f) { return cut.count(fine.facet_tag(f)) > 0; })});
}

PolygonSoup slotted_box(double width) {
  const double l = 0.5 - width / 2, r = 0.5 + width / 2;
  const std::array<Point, 8> outline{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {r, 1, 0}, {r, 0.5, 0}, {l, 0.5, 0}, {l, 1, 0}, {0, 1, 0}}};
  return extrusion(outline, 1);
}

PolygonSoup finned_box(double width) {
  const double l = 0.5 - width / 2, r = 0.5 + width / 2;
  const std::array<Point, 8> outline{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {r, 1, 0}, {r, 1.5, 0}, {l, 1.5, 0}, {l, 1, 0}, {0, 1, 0}}};
  return extrusion(outline, 1);
}

PolygonSoup spiked_box(double width) {
  const PolygonSoup cube = box({0, 0, 0}, {1, 1, 1}, 1);
  PolygonSoup soup = filtered(cube, [&](Index f) { return cube.facet_tag(f) != 6; });
  const auto first = static_cast<Index>(soup.points.size());
  const double l = 0.5 - width / 2, r = 0.5 + width / 2;
  for (const Point& p :
       {Point{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {l, l, 1}, {r, l, 1}, {r, r, 1}, {l, r, 1}})
    soup.points.push_back(p);
  soup.points.push_back({0.5, 0.5, 1.5});
  for (Index i = 0; i < 4; ++i) {
    const Index n = (i + 1) % 4;
    soup.add_facet(std::array{first + i, first + n, first + 4 + n, first + 4 + i}, 6);
    soup.add_facet(std::array{first + 4 + i, first + 4 + n, first + 8}, 7);
  }
  return triangulated(soup);
}

PolygonSoup folded_terrain(Random& random, unsigned n, double fold) {
  PolygonSoup soup;
  const double phase = uniform(random, 0, 2 * pi), wave = uniform(random, 1.5, 2.5);
  const auto upper = [&](unsigned i, unsigned j) { return static_cast<Index>(i * (n + 1) + j); };
  for (unsigned i = 0; i <= n; ++i)
    for (unsigned j = 0; j <= n; ++j) {
      const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
      const double inside = std::pow(16 * x * (1 - x) * y * (1 - y), 2);  // 0 on the border
      const double s = std::sin(2 * pi * wave * x + phase), c = std::cos(2 * pi * wave * x + phase);
      soup.points.push_back({x + fold * inside * c, y + 0.2 * fold * inside * s,
                             1 + 0.25 * inside * s + 0.02 * inside * uniform(random, -1, 1)});
    }
  for (unsigned i = 0; i < n; ++i)
    for (unsigned j = 0; j < n; ++j) {
      soup.add_facet(std::array{upper(i, j), upper(i + 1, j), upper(i + 1, j + 1)}, 1);
      soup.add_facet(std::array{upper(i, j), upper(i + 1, j + 1), upper(i, j + 1)}, 1);
    }
  const auto low = static_cast<Index>(soup.points.size());
  std::vector<Index> rim;
  for (unsigned i = 0; i < n; ++i) rim.push_back(upper(i, 0));
  for (unsigned j = 0; j < n; ++j) rim.push_back(upper(n, j));
  for (unsigned i = n; i > 0; --i) rim.push_back(upper(i, n));
  for (unsigned j = n; j > 0; --j) rim.push_back(upper(0, j));
  for (const Index p : rim) soup.points.push_back({soup.points[p].x, soup.points[p].y, 0});
  const auto count = static_cast<Index>(rim.size());
  for (Index i = 0; i < count; ++i) {
    const Index k = (i + 1) % count;
    soup.add_facet(std::array{low + i, low + k, rim[k]}, 2);
    soup.add_facet(std::array{low + i, rim[k], rim[i]}, 2);
  }
  std::vector<Index> bottom;
  for (Index i = count; i > 0; --i) bottom.push_back(low + i - 1);
  soup.add_facet(bottom, 3);
  return soup;
}

PolygonSoup in_single_precision(const PolygonSoup& soup, const Vector& offset) {
  PolygonSoup result = soup;
  for (Point& p : result.points)
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = static_cast<double>(static_cast<float>(p[axis] + offset[axis]));
  return result;
}

double signed_volume(const PolygonSoup& soup) {
  double six = 0;
  const Point o = soup.points.empty() ? Point() : soup.points[0];
  for_each_triangle(
      soup, [&](const Point& a, const Point& b, const Point& c) { six += dot(a - o, cross(b - o, c - o)); });
  return six / 6;
}

double area(const PolygonSoup& soup) {
  double twice = 0;
  for_each_triangle(
      soup, [&](const Point& a, const Point& b, const Point& c) { twice += norm(cross(b - a, c - a)); });
  return twice / 2;
}

Box bounds(std::span<const PolygonSoup> soups) {
  Box box;
  for (const PolygonSoup& soup : soups)
    for (Index q = 0; q < soup.polygon_count(); ++q)
      for (const Index p : soup.polygon(q)) box.add(soup.points[p]);
  return box;
}

double direct_winding_number(const PolygonSoup& soup, const Point& p) {
  double sum = 0;
  for_each_triangle(soup, [&](const Point& p0, const Point& p1, const Point& p2) {
    const Vector a = p0 - p, b = p1 - p, c = p2 - p;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    sum +=
        2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  });
  return sum / (4 * pi);
}

Sampled sampled_volume(const PolygonSoup& soup, Random& random, unsigned n) {
  const Box box = bounds({&soup, 1});
  const Vector size = (1.0 / n) * (box.max - box.min);
  double inside = 0, squares = 0;
  for (unsigned i = 0; i < n; ++i)
    for (unsigned j = 0; j < n; ++j)
      for (unsigned k = 0; k < n; ++k) {
        std::array<bool, 2> in;
        for (bool& b : in) {
          const Point p{box.min.x + (i + uniform(random, 0, 1)) * size.x,
                        box.min.y + (j + uniform(random, 0, 1)) * size.y,
                        box.min.z + (k + uniform(random, 0, 1)) * size.z};
          b = direct_winding_number(soup, p) > 0.5;
        }
        inside += 0.5 * (int{in[0]} + int{in[1]});
        squares += in[0] == in[1] ? 0 : 0.25;  // variance of the mean of two: (a - b)^2 / 4
      }
  const double cell = size.x * size.y * size.z;
  return {inside * cell, (std::sqrt(squares) + 1) * cell};
}

std::map<Tag, std::vector<double>> piece_volumes(std::span<const Box> boxes, std::span<const Tag> labels) {
  std::array<std::vector<double>, 3> steps;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Box& box : boxes) {
      steps[axis].push_back(box.min[axis]);
      steps[axis].push_back(box.max[axis]);
    }
    std::sort(steps[axis].begin(), steps[axis].end());
    steps[axis].erase(std::unique(steps[axis].begin(), steps[axis].end()), steps[axis].end());
  }
  const std::array<std::size_t, 3> n{steps[0].size() - 1, steps[1].size() - 1, steps[2].size() - 1};
  const auto number = [&](std::size_t i, std::size_t j, std::size_t k) {
    return static_cast<Index>((i * n[1] + j) * n[2] + k);
  };
  std::vector<Tag> label(n[0] * n[1] * n[2], 0);
  std::vector<double> volume(label.size());
  DisjointSets sets(static_cast<Index>(label.size()));
  for (std::size_t i = 0; i < n[0]; ++i)
    for (std::size_t j = 0; j < n[1]; ++j)
      for (std::size_t k = 0; k < n[2]; ++k) {
        const Point low{steps[0][i], steps[1][j], steps[2][k]},
            high{steps[0][i + 1], steps[1][j + 1], steps[2][k + 1]};
        const Index cell = number(i, j, k);
        volume[cell] = (high.x - low.x) * (high.y - low.y) * (high.z - low.z);
        for (std::size_t b = boxes.size(); b-- > 0;) {
          bool in = true;
          for (std::size_t axis = 0; axis < 3; ++axis)
            in = in && boxes[b].min[axis] <= low[axis] && high[axis] <= boxes[b].max[axis];
          if (in) label[cell] = labels[b];
        }
        for (const auto& [before, there] : {std::pair{i > 0, number(i - 1, j, k)},
                                            {j > 0, number(i, j - 1, k)},
                                            {k > 0, number(i, j, k - 1)}})
          if (before && label[there] == label[cell]) sets.unite(there, cell);
      }
  std::map<Index, double> pieces;
  for (Index cell = 0; cell < label.size(); ++cell)
    if (label[cell] != 0) pieces[sets.find(cell)] += volume[cell];
  std::map<Tag, std::vector<double>> result;
  for (const auto& [cell, v] : pieces) result[label[cell]].push_back(v);
  for (auto& [tag, volumes] : result) std::sort(volumes.begin(), volumes.end());
  return result;
}

Convex convex_of(const PolygonSoup& soup) {
  Convex body;
  for (Index q = 0; q < soup.polygon_count(); ++q) {
    body.emplace_back();
    for (const Index p : soup.polygon(q)) body.back().push_back(soup.points[p]);
  }
  return body;
}

Convex clipped(const Convex& body, const Point& origin, const Vector& normal) {
  Convex result;
  std::vector<Point> cut;
  bool has_cap = false;  // whether a polygon lies in the plane
  const auto height = [&](const Point& p) { return dot(p - origin, normal); };
  for (const auto& polygon : body) {
    has_cap = has_cap ||
              std::all_of(polygon.begin(), polygon.end(), [&](const Point& p) { return height(p) == 0; });
    std::vector<Point> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double hp = height(p), hq = height(q);
      if (hp <= 0) kept.push_back(p);
      if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) {
        kept.push_back(p + (hp / (hp - hq)) * (q - p));
        cut.push_back(kept.back());
      } else if (hp == 0) {
        cut.push_back(p);
      }
    }
    if (kept.size() >= 3) result.push_back(kept);
  }
  if (has_cap || cut.size() < 3) return result;
  Point centre;
  for (const Point& p : cut) centre = centre + (1.0 / static_cast<double>(cut.size())) * p;
  const Vector along = std::fabs(normal.x) < 0.6 * norm(normal) ? Vector{1, 0, 0} : Vector{0, 1, 0};
  const Vector u = cross(along, normal), v = cross(normal, u);
  const double nu = norm(u), nv = norm(v);
  std::sort(cut.begin(), cut.end(), [&](const Point& p, const Point& q) {
    return std::atan2(dot(p - centre, v) / nv, dot(p - centre, u) / nu) <
           std::atan2(dot(q - centre, v) / nv, dot(q - centre, u) / nu);
  });
  result.push_back(cut);  // repeated points do no harm
  return result;
}

Convex intersection(Convex a, const Convex& b) {
  for (const auto& polygon : b)
    a = clipped(a, polygon[0], cross(polygon[1] - polygon[0], polygon[2] - polygon[0]));
  return a;
}

double volume(const Convex& body) {
  if (body.empty()) return 0;
  double six = 0;
  const Point o = body[0][0];
  for (const auto& polygon : body)
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      six += dot(polygon[0] - o, cross(polygon[i] - o, polygon[i + 1] - o));
  return six / 6;
}

double union_volume(std::span<const Convex> bodies) {
  const std::vector<double> parts = places(bodies);
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

std::vector<double> places(std::span<const Convex> bodies) {
  std::vector<double> result;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    double sum = 0;
    for (unsigned subset = 0; subset < 1U << b; ++subset) {
      Convex common = bodies[b];
      int sign = 1;
      for (std::size_t a = 0; a < b; ++a)
        if ((subset >> a & 1U) != 0) {
          common = intersection(std::move(common), bodies[a]);
          sign = -sign;
        }
      sum += sign * volume(common);
    }
    result.push_back(sum);
  }
  return result;
}

double total_volume(const Plc& plc) {
  double sum = 0;
  for (std::size_t r = 1; r < plc.regions.size(); ++r) sum += plc.regions[r].volume;
  return sum;
}

std::map<Tag, std::vector<double>> region_volumes(const Plc& plc) {
  std::map<Tag, std::vector<double>> result;
  for (std::size_t r = 1; r < plc.regions.size(); ++r)
    result[plc.regions[r].tag].push_back(plc.regions[r].volume);
  for (auto& [tag, volumes] : result) std::sort(volumes.begin(), volumes.end());
  return result;
}

std::vector<std::string> faults_of(const RepairedPlc& repaired, std::span<const PolygonSoup> input,
                                   double reach) {
  std::vector<std::string> faults = findings(repaired.plc);
  std::set<Tag> known, filled;
  for (const PolygonSoup& soup : input)
    for (Index f = 0; f < soup.facet_count(); ++f) known.insert(soup.facet_tag(f));
  for (const FilledHole& hole : repaired.report.filled) filled.insert(hole.tag);
  std::vector<std::array<Point, 3>> triangles;
  for (const PolygonSoup& soup : input)
    for_each_triangle(soup, [&](const Point& a, const Point& b, const Point& c) {
      triangles.push_back({a, b, c});
    });
  for (const PolygonSoup& soup : repaired.soups)
    for (Index f = 0; f < soup.facet_count(); ++f) {
      const Tag tag = soup.facet_tag(f);
      if (filled.count(tag) > 0) continue;
      if (known.count(tag) == 0) faults.push_back(fmt::format("tag {} comes from nowhere", tag));
      for (const Index c : soup.polygon(f)) {
        const Point& p = soup.points[c];
        double least = INFINITY;
        for (const auto& t : triangles) {
          least = std::min(least, distance(p, nearest_on_triangle(p, t[0], t[1], t[2])));
          if (least <= reach) break;
        }
        if (least > reach)
          faults.push_back(
              fmt::format("corner ({}, {}, {}) is {} away from the input", p.x, p.y, p.z, least));
      }
    }
  if (faults.size() > 5) faults.resize(5);
  return faults;
}

RepairedPlc repaired(std::span<const PolygonSoup> soups, const RepairOptions& options) {
  try {
    return build_repaired_plc(soups, {}, options);
  } catch (const Error& error) {
    ADD_FAILURE() << error.what();
    return {};
  }
}

}  // namespace collarmesh::testing::faulty
