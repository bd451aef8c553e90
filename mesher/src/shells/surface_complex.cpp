#include "shells/surface_complex.h"

#include <algorithm>
#include <cassert>

#include "common/sort_uniquely.h"
#include "shells/triangle_shape.h"

namespace collarmesh::shells {

namespace {

void erase_one(std::vector<Index>& all, Index one) {
  const auto found = std::find(all.begin(), all.end(), one);
  assert(found != all.end());
  *found = all.back();
  all.pop_back();
}

}  // namespace

Index SurfaceComplex::add_vertex(const Point& point, const TetMesh::VertexFeature& feature, double size,
                                 double asked) {
  vertices.push_back({point, feature, size, asked, {}, {}, 0});
  return static_cast<Index>(vertices.size() - 1);
}

bool SurfaceComplex::consistent(Index vertex) const {
  const auto has_triangle = [&](Index t) { return triangles[t].alive() && triangles[t].has(vertex); };
  const auto has_edge = [&](Index e) {
    return edges[e].alive() && (edges[e].ends[0] == vertex) != (edges[e].ends[1] == vertex);
  };
  return std::ranges::all_of(vertices[vertex].triangles, has_triangle) &&
         std::ranges::all_of(vertices[vertex].edges, has_edge);
}

bool SurfaceComplex::consistent() const {
  std::size_t listed_triangles = 0, listed_edges = 0;
  const auto all_differ = [](std::vector<Index> listed) {
    std::ranges::sort(listed);
    return std::ranges::adjacent_find(listed) == listed.end();
  };
  for (Index v = 0; v < vertices.size(); ++v) {
    if (!consistent(v) || !all_differ(vertices[v].triangles) || !all_differ(vertices[v].edges)) return false;
    listed_triangles += vertices[v].triangles.size();
    listed_edges += vertices[v].edges.size();
  }
  const auto alive = [](const auto& each) { return each.alive(); };
  return listed_triangles == 3 * static_cast<std::size_t>(std::ranges::count_if(triangles, alive)) &&
         listed_edges == 2 * static_cast<std::size_t>(std::ranges::count_if(edges, alive));
}

Index SurfaceComplex::add_triangle(const std::array<Index, 3>& corners, Index patch) {
  assert(corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]);
  const auto number = static_cast<Index>(triangles.size());
  triangles.push_back({corners, patch, shape_of(this->corners(corners))});
  for (const Index v : corners) {
    vertices[v].triangles.push_back(number);
    ++vertices[v].changes;
  }
  return number;
}

void SurfaceComplex::remove_triangle(Index triangle) {
  assert(triangles[triangle].alive());
  const std::array<Index, 3> corners = triangles[triangle].corners;
  for (const Index v : corners) erase_one(vertices[v].triangles, triangle);
  triangles[triangle] = {};
}

void SurfaceComplex::move_vertex(Index vertex, const Point& to) {
  vertices[vertex].point = to;
  for (const Index t : vertices[vertex].triangles) triangles[t].shape = shape_of(corners(t));
}

Index SurfaceComplex::add_edge(const std::array<Index, 2>& ends, Index curve,
                               const std::array<double, 2>& at) {
  assert(ends[0] < vertices.size() && ends[1] < vertices.size());
  const auto number = static_cast<Index>(edges.size());
  edges.push_back({ends, curve, at});
  for (const Index v : ends) vertices[v].edges.push_back(number);
  return number;
}

void SurfaceComplex::remove_edge(Index edge) {
  assert(edges[edge].alive());
  const std::array<Index, 2> ends = edges[edge].ends;
  for (const Index v : ends) erase_one(vertices[v].edges, edge);
  edges[edge] = {};
}

std::vector<Index> SurfaceComplex::triangles_at(Index a, Index b) const {
  std::vector<Index> found;
  for (const Index t : vertices[a].triangles)
    if (triangles[t].has(b)) found.push_back(t);
  return found;
}

std::optional<std::array<Index, 2>> SurfaceComplex::two_triangles_at(Index a, Index b) const {
  std::array<Index, 2> two{};
  unsigned count = 0;
  for (const Index t : vertices[a].triangles) {
    if (!triangles[t].has(b)) continue;
    if (count == 2) return std::nullopt;
    two[count++] = t;
  }
  if (count != 2) return std::nullopt;
  return two;
}

bool SurfaceComplex::have_triangle(Index a, Index b) const {
  return std::any_of(vertices[a].triangles.begin(), vertices[a].triangles.end(),
                     [&](Index t) { return triangles[t].has(b); });
}

Index SurfaceComplex::edge_at(Index a, Index b) const {
  for (const Index e : vertices[a].edges)
    if (edges[e].other(a) == b) return e;
  return none;
}

std::vector<Index> SurfaceComplex::neighbours(Index v) const {
  std::vector<Index> found;
  for (const Index t : vertices[v].triangles)
    for (const Index c : triangles[t].corners)
      if (c != v) found.push_back(c);
  for (const Index e : vertices[v].edges) found.push_back(edges[e].other(v));
  sort_uniquely(found);
  return found;
}

Index SurfaceComplex::across(Index triangle, Index a, Index b) const {
  if (!vertices[a].edges.empty() && edge_at(a, b) != none) return none;
  for (const Index t : vertices[a].triangles)
    if (t != triangle && triangles[t].has(b)) return t;
  return none;
}

}  // namespace collarmesh::shells
