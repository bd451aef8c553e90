#include "conforming_triangles.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

namespace collarmesh::testing {

namespace {

// The kernel is exact, so that triangles made by rounding errors beside a facet do not count as parts of it.
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>,
                                         CGAL::Constrained_triangulation_face_base_2<Kernel>>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;
using Triangle = std::array<Index, 3>;
using Edge = std::array<Index, 2>;  // the lower number comes first

constexpr double relative_tolerance = 1e-12;
constexpr double relative_width = 1e-6;

Edge edge_of(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

struct Facet {
  std::vector<Index> outline;
  Vector normal;  // normal; its length is twice the facet's area
};

// All soups in one, with equal points merged.
struct Input {
  std::vector<Point> points;
  std::vector<Facet> facets;
  std::set<Edge> edges;        // edges of facets, and segments
  std::vector<Edge> segments;  // segments that are no edge of a facet
  double tolerance = 0;
};

class InputReader {
 public:
  explicit InputReader(std::span<const PolygonSoup> soups) {
    Box box;
    for (const PolygonSoup& soup : soups)
      for (const Point& p : soup.points) box.add(p);
    input_.tolerance = relative_tolerance * box.diagonal();
    for (const PolygonSoup& soup : soups) add(soup);
  }
  Input take() { return std::move(input_); }

 private:
  void add(const PolygonSoup& soup) {
    std::vector<Index> numbers;
    for (const Point& p : soup.points) numbers.push_back(number_of(p));
    for (Index f = 0; f < soup.facet_count(); ++f) {
      const auto [first, last] = soup.facet_polygons(f);
      for (Index q = first; q < last; ++q) {
        std::vector<Index> corners;
        for (const Index i : soup.polygon(q)) corners.push_back(numbers[i]);
        if ((q == first) != (corners.size() >= 3))
          throw std::runtime_error(fmt::format("facet {} is not one outline with marks inside", f));
        for (std::size_t i = 0; i < corners.size() && corners.size() > 1; ++i)
          input_.edges.insert(edge_of(corners[i], corners[(i + 1) % corners.size()]));
        if (q == first) input_.facets.push_back({corners, area_vector(corners)});
      }
    }
    for (const auto& [a, b, tag] : soup.segments) {
      input_.segments.push_back(edge_of(numbers[a], numbers[b]));
      input_.edges.insert(input_.segments.back());
    }
  }

  Index number_of(const Point& p) {
    const auto found = std::find_if(input_.points.begin(), input_.points.end(), [&](const Point& other) {
      return distance(p, other) <= input_.tolerance;
    });
    const auto number = static_cast<Index>(found - input_.points.begin());
    if (found == input_.points.end()) input_.points.push_back(p);
    return number;
  }

  Vector area_vector(const std::vector<Index>& outline) const {
    const auto& points = input_.points;
    Vector sum;
    for (std::size_t i = 1; i + 1 < outline.size(); ++i)
      sum = sum + cross(points[outline[i]] - points[outline[0]], points[outline[i + 1]] - points[outline[0]]);
    return sum;
  }

  Input input_;
};

// The plane of a facet. Points are projected along the largest component of its normal, which needs no
// rounding.
class Plane {
 public:
  Plane(const Point& origin, const Vector& normal) : origin_(origin), normal_(normal / norm(normal)) {
    for (std::size_t axis = 1; axis < 3; ++axis)
      if (std::fabs(normal[axis]) > std::fabs(normal[axis_])) axis_ = axis;
  }
  double distance_to(const Point& p) const { return std::fabs(dot(p - origin_, normal_)); }
  Kernel::Point_2 projected(const Point& p) const { return {p[(axis_ + 1) % 3], p[(axis_ + 2) % 3]}; }
  bool counterclockwise(const Facet& facet) const { return facet.normal[axis_] > 0; }

 private:
  Point origin_;
  Vector normal_;
  std::size_t axis_ = 0;
};

class PlaneTriangulator {
 public:
  PlaneTriangulator(const Input& input, const Plane& plane, const std::vector<Facet>& facets)
      : input_(input), plane_(plane) {
    for (const Facet& facet : facets) {
      std::vector<Kernel::Point_2> outline;
      for (const Index i : facet.outline) outline.push_back(plane.projected(input.points[i]));
      outlines_.push_back({outline, plane.counterclockwise(facet)});
    }
  }

  // Appends the triangles inside the facets to `triangles`.
  void add_triangles(std::vector<Triangle>& triangles) {
    insert();
    for (const auto& face : triangulation_.finite_face_handles()) {
      const auto middle =
          CGAL::centroid(face->vertex(0)->point(), face->vertex(1)->point(), face->vertex(2)->point());
      const auto outline = std::find_if(outlines_.begin(), outlines_.end(), [&](const Outline& one) {
        return CGAL::bounded_side_2(one.corners.begin(), one.corners.end(), middle) == CGAL::ON_BOUNDED_SIDE;
      });
      if (outline == outlines_.end()) continue;
      Triangle triangle{face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
      if (!outline->counterclockwise) std::swap(triangle[1], triangle[2]);
      require_no_flat(triangle);
      triangles.push_back(triangle);
    }
  }

 private:
  struct Outline {
    std::vector<Kernel::Point_2> corners;
    bool counterclockwise;
  };

  void insert() {
    std::vector<Triangulation::Vertex_handle> handles(input_.points.size());
    for (Index i = 0; i < handles.size(); ++i) {
      if (plane_.distance_to(input_.points[i]) > input_.tolerance) continue;
      handles[i] = triangulation_.insert(plane_.projected(input_.points[i]));
      handles[i]->info() = i;
    }
    const Triangulation::Vertex_handle elsewhere;
    for (const auto& [a, b] : input_.edges)
      if (handles[a] != elsewhere && handles[b] != elsewhere)
        triangulation_.insert_constraint(handles[a], handles[b]);
  }

  void require_no_flat(const Triangle& triangle) const {
    const Point &a = input_.points[triangle[0]], &b = input_.points[triangle[1]],
                &c = input_.points[triangle[2]];
    const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
    if (norm(cross(b - a, c - a)) <= input_.tolerance * longest)
      throw std::runtime_error(fmt::format(
          "a triangle would be flat, as where a corner is within an edge: ({}, {}, {})", a.x, a.y, a.z));
  }

  const Input& input_;
  const Plane& plane_;
  std::vector<Outline> outlines_;
  Triangulation triangulation_;
};

// Begins with large facets, because rounding turns their planes least.
std::vector<Triangle> triangles_of_facets(const Input& input) {
  std::vector<Facet> facets = input.facets;
  std::stable_sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
    return squared_norm(a.normal) > squared_norm(b.normal);
  });
  std::vector<Triangle> triangles;
  while (!facets.empty()) {
    const Plane plane(input.points[facets.front().outline[0]], facets.front().normal);
    const auto others = std::stable_partition(facets.begin(), facets.end(), [&](const Facet& facet) {
      return std::all_of(facet.outline.begin(), facet.outline.end(),
                         [&](Index i) { return plane.distance_to(input.points[i]) <= input.tolerance; });
    });
    PlaneTriangulator(input, plane, {facets.begin(), others}).add_triangles(triangles);
    facets.erase(facets.begin(), others);
  }
  return triangles;
}

std::map<Edge, unsigned> edge_uses(const std::vector<Triangle>& triangles) {
  std::map<Edge, unsigned> uses;
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) ++uses[edge_of(t[i], t[(i + 1) % 3])];
  return uses;
}

// Adds a triangle with a corner at `end`, along half of the segment to `other`.
void add_segment_end(TriangleComplex& complex, Index end, Index other) {
  const Vector half = 0.5 * (complex.points[other] - complex.points[end]);
  const Vector sideways =
      std::fabs(half.x) < 0.5 * norm(half) ? cross(half, {1, 0, 0}) : cross(half, {0, 1, 0});
  const Vector offset = relative_width * norm(half) / norm(sideways) * sideways;
  const Point middle = complex.points[end] + half;
  const auto first = static_cast<Index>(complex.points.size());
  complex.points.insert(complex.points.end(), {middle - offset, middle + offset});
  complex.triangles.push_back({end, first, first + 1});
}

void add_segments(TriangleComplex& complex, std::vector<Edge> segments) {
  const auto edges = edge_uses(complex.triangles);
  const auto in_facet = [&](const Edge& segment) { return edges.contains(segment); };
  segments.erase(std::remove_if(segments.begin(), segments.end(), in_facet), segments.end());
  std::vector<unsigned> uses(complex.points.size());
  for (const auto& [edge, count] : edges)
    for (const Index end : edge) ++uses[end];
  for (const Edge& segment : segments)
    for (const Index end : segment) ++uses[end];
  for (const auto& [a, b] : segments) {
    if (uses[a] > 1) add_segment_end(complex, a, b);
    if (uses[b] > 1) add_segment_end(complex, b, a);
  }
}

}  // namespace

TriangleComplex conforming_triangles(std::span<const PolygonSoup> soups) {
  Input input = InputReader(soups).take();
  TriangleComplex complex{{}, triangles_of_facets(input)};
  complex.points = std::move(input.points);
  add_segments(complex, std::move(input.segments));
  return complex;
}

bool is_closed(const TriangleComplex& complex) {
  const auto uses = edge_uses(complex.triangles);
  return std::all_of(uses.begin(), uses.end(), [](const auto& edge) { return edge.second % 2 == 0; });
}

}  // namespace collarmesh::testing
