#include "support/plc_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

namespace collarmesh::testing {

namespace {

using std::numbers::pi;

void add(PolygonSoup& soup, std::initializer_list<Index> corners) {
  soup.add_facet(std::span<const Index>(corners.begin(), corners.size()));
}

// Calls visit(facet, polygon) for every polygon.
template <class Visit>
void for_each_polygon(const PolygonSoup& soup, const Visit& visit) {
  for (Index f = 0; f < soup.facet_count(); ++f) {
    const auto [first, last] = soup.facet_polygons(f);
    for (Index q = first; q < last; ++q) visit(f, soup.polygon(q));
  }
}

// Returns the soup without its facets.
PolygonSoup shell_of(const PolygonSoup& soup) {
  PolygonSoup result;
  result.name = soup.name;
  result.points = soup.points;
  result.point_tags = soup.point_tags;
  result.segments = soup.segments;
  result.region_points = soup.region_points;
  result.hole_points = soup.hole_points;
  return result;
}

Point circle_point(Index i, Index n, double radius, double z) {
  const double t = 2 * pi * i / n;
  return {radius * std::cos(t), radius * std::sin(t), z};
}

}  // namespace

PolygonSoup polygonal_box(const Point& min, const Point& max) {
  PolygonSoup soup;
  for (unsigned i = 0; i < 8; ++i)
    soup.points.push_back({i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z});
  for (const auto& q : {std::array<Index, 4>{0, 2, 3, 1},
                        {4, 5, 7, 6},
                        {0, 1, 5, 4},
                        {2, 6, 7, 3},
                        {0, 4, 6, 2},
                        {1, 3, 7, 5}})
    soup.add_facet(q);
  return soup;
}

PolygonSoup subdivided_box(const Point& min, const Point& max, Index n) {
  PolygonSoup soup;
  std::map<std::array<Index, 3>, Index> points;
  const auto point = [&](std::array<Index, 3> g) {
    const auto [at, added] = points.try_emplace(g, static_cast<Index>(soup.points.size()));
    if (added) {
      Point p;
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[axis] = min[axis] + (max[axis] - min[axis]) * g[axis] / n;
      soup.points.push_back(p);
    }
    return at->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const Index side : {Index{0}, n})
      for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) {
          const auto corner = [&](Index di, Index dj) {
            std::array<Index, 3> g{};
            g[axis] = side;
            g[(axis + 1) % 3] = i + di;
            g[(axis + 2) % 3] = j + dj;
            return point(g);
          };
          const Index a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          if (side > 0) {
            add(soup, {a, b, c});
            add(soup, {a, c, d});
          } else {
            add(soup, {a, c, b});
            add(soup, {a, d, c});
          }
        }
  return soup;
}

PolygonSoup polygonal_cylinder(Index n, double radius, double height) {
  PolygonSoup soup;
  std::vector<Index> bottom, top;
  for (Index i = 0; i < n; ++i) {
    soup.points.push_back(circle_point(i, n, radius, 0));
    soup.points.push_back(circle_point(i, n, radius, height));
    bottom.push_back(2 * (n - 1 - i));
    top.push_back(2 * i + 1);
  }
  for (Index i = 0; i < n; ++i) {
    const Index j = (i + 1) % n;
    add(soup, {2 * i, 2 * j, 2 * j + 1, 2 * i + 1});
  }
  soup.add_facet(bottom);
  soup.add_facet(top);
  return soup;
}

PolygonSoup polygonal_cone(Index n, double aperture_degrees, double height) {
  PolygonSoup soup;
  const double radius = height * std::tan(aperture_degrees * pi / 360);
  std::vector<Index> bottom;
  for (Index i = 0; i < n; ++i) {
    soup.points.push_back(circle_point(i, n, radius, 0));
    bottom.push_back(n - 1 - i);
  }
  soup.points.push_back({0, 0, height});
  for (Index i = 0; i < n; ++i) add(soup, {i, (i + 1) % n, n});
  soup.add_facet(bottom);
  return soup;
}

PolygonSoup wedge(double angle_degrees, double length) {
  PolygonSoup soup;
  const double t = angle_degrees * pi / 180;
  for (const double z : {0.0, length})
    for (const Point& p : {Point{0, 0, z}, Point{1, 0, z}, Point{std::cos(t), std::sin(t), z}})
      soup.points.push_back(p);
  add(soup, {0, 2, 1});
  add(soup, {3, 4, 5});
  add(soup, {0, 1, 4, 3});
  add(soup, {1, 2, 5, 4});
  add(soup, {2, 0, 3, 5});
  return soup;
}

PolygonSoup sphere(Index n, double radius, const Point& centre) {
  PolygonSoup soup;
  std::map<std::array<int, 3>, Index> points;
  const auto point = [&](const std::array<int, 3>& g) {
    const auto [at, added] = points.try_emplace(g, static_cast<Index>(soup.points.size()));
    const Vector d{static_cast<double>(g[0]), static_cast<double>(g[1]), static_cast<double>(g[2])};
    if (added) soup.points.push_back(centre + (radius / norm(d)) * d);
    return at->second;
  };
  const int m = static_cast<int>(n);
  for (int octant = 0; octant < 8; ++octant) {
    const int sx = octant & 1 ? 1 : -1, sy = octant & 2 ? 1 : -1, sz = octant & 4 ? 1 : -1;
    const auto at = [&](int i, int j) { return point({sx * i, sy * j, sz * (m - i - j)}); };
    const auto triangle = [&](Index a, Index b, Index c) {
      if (sx * sy * sz > 0)
        add(soup, {a, b, c});
      else
        add(soup, {a, c, b});
    };
    for (int i = 0; i < m; ++i)
      for (int j = 0; i + j < m; ++j) {
        triangle(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < m) triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
      }
  }
  return soup;
}

PolygonSoup moebius_strip(Index n) {
  PolygonSoup soup;
  for (Index i = 0; i < n; ++i) {
    const double t = 2 * pi * i / n;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1 + side * std::cos(t / 2);
      soup.points.push_back({r * std::cos(t), r * std::sin(t), side * std::sin(t / 2)});
    }
  }
  for (Index i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    const Index a = 2 * i, b = 2 * i + 1, c = last ? 0 : 2 * i + 3, d = last ? 1 : 2 * i + 2;
    add(soup, {a, d, c});
    add(soup, {a, c, b});
  }
  return soup;
}

PolygonSoup reversed(const PolygonSoup& soup) {
  PolygonSoup result = shell_of(soup);
  for_each_polygon(soup, [&](Index f, std::span<const Index> polygon) {
    result.add_facet(std::vector<Index>(polygon.rbegin(), polygon.rend()), soup.facet_tag(f));
  });
  return result;
}

PolygonSoup without_facet(const PolygonSoup& soup, Index facet) {
  PolygonSoup result = shell_of(soup);
  for_each_polygon(soup, [&](Index f, std::span<const Index> polygon) {
    if (f != facet) result.add_facet(polygon, soup.facet_tag(f));
  });
  return result;
}

PolygonSoup joined(const std::vector<PolygonSoup>& soups) {
  PolygonSoup result;
  for (const PolygonSoup& soup : soups) {
    const auto first = static_cast<Index>(result.points.size());
    result.points.insert(result.points.end(), soup.points.begin(), soup.points.end());
    for_each_polygon(soup, [&](Index f, std::span<const Index> polygon) {
      std::vector<Index> corners(polygon.begin(), polygon.end());
      for (Index& c : corners) c += first;
      result.add_facet(corners, soup.facet_tag(f));
    });
  }
  return result;
}

PolygonSoup torn_apart(const PolygonSoup& soup) {
  PolygonSoup result;
  for_each_polygon(soup, [&](Index f, std::span<const Index> polygon) {
    std::vector<Index> corners;
    for (const Index c : polygon) {
      corners.push_back(static_cast<Index>(result.points.size()));
      result.points.push_back(soup.points[c]);
    }
    result.add_facet(corners, soup.facet_tag(f));
  });
  return result;
}

PolygonSoup shuffled(const PolygonSoup& soup, std::uint64_t seed, bool turn) {
  std::mt19937_64 random(seed);
  std::vector<Index> to(soup.points.size()), facets(soup.facet_count());
  std::iota(to.begin(), to.end(), Index{0});
  std::iota(facets.begin(), facets.end(), Index{0});
  std::shuffle(to.begin(), to.end(), random);
  std::shuffle(facets.begin(), facets.end(), random);
  PolygonSoup result;
  result.points.resize(soup.points.size());
  for (std::size_t i = 0; i < to.size(); ++i) result.points[to[i]] = soup.points[i];
  for (const Index f : facets) {
    const auto polygon = soup.polygon(soup.facet_polygons(f)[0]);
    std::vector<Index> corners;
    for (const Index c : polygon) corners.push_back(to[c]);
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(random() % corners.size()),
                corners.end());
    if (turn && random() % 3 == 0) std::reverse(corners.begin(), corners.end());
    result.add_facet(corners, soup.facet_tag(f));
  }
  return result;
}

PolygonSoup moved(const PolygonSoup& soup, std::uint64_t seed, double scale, double offset) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto unit = [&] {
    const Vector v{normal(random), normal(random), normal(random)};
    return v / norm(v);
  };
  const Vector u = unit(), helper = unit();
  const Vector v = cross(u, helper) / norm(cross(u, helper)), w = cross(u, v);
  const Vector shift = offset * unit();
  PolygonSoup result = soup;
  const auto move = [&](const Point& p) { return scale * (p.x * u + p.y * v + p.z * w) + shift; };
  for (Point& p : result.points) p = move(p);
  for (Point& p : result.hole_points) p = move(p);
  for (auto& p : result.region_points) p.point = move(p.point);
  for (auto& h : result.facet_holes) h.point = move(h.point);
  return result;
}

namespace {

class Findings {
 public:
  explicit Findings(const Plc& plc) : plc_(plc) {}

  std::vector<std::string> run() {
    check_ranges();
    check_mutual();
    check_patches();
    check_curves();
    check_regions();
    return std::move(list_);
  }

 private:
  void expect(bool condition, const std::string& message) {
    if (!condition) list_.push_back(message);
  }
  static bool holds(const std::vector<Index>& list, Index i) {
    return std::binary_search(list.begin(), list.end(), i);
  }

  void check_ranges() {
    Index next = 0;
    for (Index p = 0; p < plc_.patches.size(); ++p) {
      const Plc::Patch& patch = plc_.patches[p];
      expect(patch.first_triangle == next && patch.triangle_count > 0,
             fmt::format("patch {} is not contiguous", p));
      next = patch.first_triangle + patch.triangle_count;
      for (Index t = patch.first_triangle; t < next; ++t)
        expect(plc_.triangles[t].patch == p, fmt::format("triangle {} is not of patch {}", t, p));
      for (const Index r : patch.regions)
        expect(r < plc_.regions.size(), fmt::format("patch {} has no region {}", p, r));
    }
    expect(next == plc_.triangles.size(), "triangles without a patch");
  }

  void check_mutual() {
    for (Index p = 0; p < plc_.patches.size(); ++p) {
      for (const Index c : plc_.patches[p].curves)
        expect(holds(plc_.curves[c].patches, p), fmt::format("curve {} does not know patch {}", c, p));
      for (const Index v : plc_.patches[p].vertices)
        expect(plc_.vertex_on_patch(v, p), fmt::format("vertex {} does not know patch {}", v, p));
    }
    for (Index c = 0; c < plc_.curves.size(); ++c)
      for (const Index p : plc_.curves[c].patches)
        expect(holds(plc_.patches[p].curves, c), fmt::format("patch {} does not know curve {}", p, c));
    for (Index v = 0; v < plc_.vertices.size(); ++v) {
      for (const Index p : plc_.vertices[v].patches)
        expect(holds(plc_.patches[p].vertices, v), fmt::format("patch {} does not know vertex {}", p, v));
      for (const Index c : plc_.vertices[v].curves) {
        expect(plc_.curves[c].ends[0] == v || plc_.curves[c].ends[1] == v,
               fmt::format("curve {} does not end in vertex {}", c, v));
        for (const Index p : plc_.curves[c].patches)
          expect(plc_.vertex_on_patch(v, p), fmt::format("vertex {} is on a curve of patch {} only", v, p));
      }
    }
  }

  // Checks patches: two triangles inside a patch that share an edge use it in opposite directions.
  void check_patches() {
    std::set<std::array<Index, 2>> on_curve;
    for (const Plc::Curve& curve : plc_.curves)
      for_each_segment(curve, [&](Index a, Index b) {
        on_curve.insert({a, b});
        on_curve.insert({b, a});
      });
    std::map<std::array<Index, 3>, int> directed;  // patch, edge
    for (const Plc::Triangle& t : plc_.triangles)
      for (std::size_t i = 0; i < 3; ++i) ++directed[{t.patch, t.points[i], t.points[(i + 1) % 3]}];
    for (const auto& [key, count] : directed) {
      const auto [p, a, b] = key;
      if (on_curve.count({a, b}) > 0) continue;
      expect(count == 1 && directed.count({p, b, a}) > 0,
             fmt::format("patch {} is no oriented manifold at {} {}", p, a, b));
    }
    for (Index p = 0; p < plc_.patches.size(); ++p) {
      const Plc::Patch& patch = plc_.patches[p];
      if (!patch.planar) continue;
      for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t)
        for (const Index q : plc_.triangles[t].points)
          expect(std::fabs(dot(patch.normal, plc_.points[q] - patch.origin)) <=
                     std::max(plc_.planar_tolerance, 1e-13 * norm(plc_.points[q])),
                 fmt::format("point {} is not in the plane of patch {}", q, p));
    }
  }

  template <class Visit>
  static void for_each_segment(const Plc::Curve& curve, const Visit& visit) {
    for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) visit(curve.points[i], curve.points[i + 1]);
    if (curve.closed) visit(curve.points.back(), curve.points.front());
  }

  // Checks curves: the patches of a curve are those with each of its segments as an edge.
  void check_curves() {
    std::map<std::array<Index, 2>, std::set<Index>> patches_at;
    for (const Plc::Triangle& t : plc_.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [a, b] = std::minmax(t.points[i], t.points[(i + 1) % 3]);
        patches_at[{a, b}].insert(t.patch);
      }
    for (Index c = 0; c < plc_.curves.size(); ++c) {
      const Plc::Curve& curve = plc_.curves[c];
      for_each_segment(curve, [&](Index a, Index b) {
        const auto& at = patches_at[{std::min(a, b), std::max(a, b)}];
        expect(std::vector<Index>(at.begin(), at.end()) == curve.patches,
               fmt::format("curve {} is not on its patches", c));
      });
      if (curve.closed) continue;
      expect(plc_.vertices[curve.ends[0]].point == curve.points.front() &&
                 plc_.vertices[curve.ends[1]].point == curve.points.back(),
             fmt::format("curve {} does not end in its vertices", c));
    }
  }

  // Checks regions: the area vectors of a closed surface cancel, and all volumes are positive.
  void check_regions() {
    std::vector<Vector> sums(plc_.regions.size());
    double area = 0;
    for (const Plc::Triangle& t : plc_.triangles) {
      const Point& a = plc_.points[t.points[0]];
      const Vector n = cross(plc_.points[t.points[1]] - a, plc_.points[t.points[2]] - a);
      sums[plc_.patches[t.patch].regions[0]] = sums[plc_.patches[t.patch].regions[0]] + n;
      sums[plc_.patches[t.patch].regions[1]] = sums[plc_.patches[t.patch].regions[1]] - n;
      area += norm(n);
    }
    for (std::size_t r = 0; r < sums.size(); ++r) {
      expect(norm(sums[r]) <= 1e-9 * area, fmt::format("the border of region {} does not close", r));
      if (r > 0) expect(plc_.regions[r].volume > 0, fmt::format("region {} has no volume", r));
    }
  }

  const Plc& plc_;
  std::vector<std::string> list_;
};

}  // namespace

std::vector<std::string> findings(const Plc& plc) { return Findings(plc).run(); }

}  // namespace collarmesh::testing
