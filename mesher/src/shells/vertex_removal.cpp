#include "shells/vertex_removal.h"

#include <algorithm>
#include <utility>

#include "shells/triangle_shape.h"

namespace collarmesh::shells {

namespace {

// Longest new edges, relative to the length that the options ask for.
constexpr double longest = 1.25;

}  // namespace

VertexRemoval::VertexRemoval(const SurfaceComplex& complex, SurfaceEditor& editor, ShapeRepair& repair,
                             const Execution& execution)
    : complex_(complex), editor_(editor), repair_(repair), execution_(execution) {}

/// Returns the vertices to try, those with the shortest edges first.
std::vector<Index> VertexRemoval::candidates() {
  constexpr double long_enough = 0.9;  // relative to the length that the options ask for
  tried_.resize(complex_.vertices.size(), 0);
  std::vector<std::pair<double, Index>> by_length;
  for (Index v = 0; v < complex_.vertices.size(); ++v) {
    const auto& vertex = complex_.vertices[v];
    if (vertex.triangles.empty() || vertex.feature.dimension == 0 || tried_[v] == vertex.changes + 1)
      continue;
    double shortest = INFINITY;
    for (const Index n : complex_.neighbours(v))
      shortest = std::min(shortest, editor_.length(v, n) / editor_.asked_of_edge(v, n));
    if (shortest < long_enough) by_length.emplace_back(shortest, v);
  }
  std::sort(by_length.begin(), by_length.end());
  std::vector<Index> vertices;
  vertices.reserve(by_length.size());
  for (const auto& [length, v] : by_length) vertices.push_back(v);
  return vertices;
}

/// Returns the least shape allowed around a vertex: the bound and a margin, which is larger on curved
/// patches, because vertices will move onto the exact geometry.
double VertexRemoval::least_shape_beside(Index vertex) const {
  constexpr double planar_margin = 0.3, curved_margin = 1;
  for (const Index t : complex_.vertices[vertex].triangles)
    if (!editor_.planar(complex_.triangles[t].patch)) return least_angle + curved_margin;
  return least_angle + planar_margin;
}

/// Returns whether all shapes around the former neighbours of a vertex are good enough, or no worse than
/// before, and all edges there short enough.
bool VertexRemoval::acceptable(const SurfaceEditor::Surroundings& before, double least_shape) const {
  for (const auto& n : before.neighbours) {
    if (editor_.least_shape_at(n.vertex) < std::min(n.least_shape, least_shape)) return false;
    if (complex_.vertices[n.vertex].point == n.point) continue;
    for (const Index other : complex_.neighbours(n.vertex))
      if (editor_.length(n.vertex, other) > longest * editor_.asked_of_edge(n.vertex, other)) return false;
  }
  return true;
}

/// Removes a vertex and moves its former neighbours to improve the shapes. Restores everything and returns
/// false if the shapes do not become good.
bool VertexRemoval::remove_and_move(Index vertex, const SurfaceEditor::Filling& filling, double least_shape) {
  constexpr unsigned rounds = 3;
  const SurfaceEditor::Surroundings before = editor_.surroundings(vertex);
  editor_.remove(vertex, filling);
  for (unsigned round = 0; round < rounds; ++round) {
    bool moved = false;
    for (const auto& n : before.neighbours)
      if (editor_.least_shape_at(n.vertex) < std::min(n.least_shape, least_shape))
        moved |= repair_.move_best(n.vertex);
    if (!moved) break;
  }
  if (acceptable(before, least_shape)) return true;
  editor_.restore(before);
  return false;
}

bool VertexRemoval::remove(Index vertex) {
  constexpr double least_before_moves = 0.6;  // relative to the least shape that is required after moves
  const double least_shape = least_shape_beside(vertex);
  const auto filling =
      editor_.filling_without(vertex, {.longest = longest, .least_shape = least_before_moves * least_shape});
  if (!filling) return false;
  if (filling->least_shape < least_shape) return remove_and_move(vertex, *filling, least_shape);
  editor_.remove(vertex, *filling);
  return true;
}

std::size_t VertexRemoval::run() {
  std::size_t removed = 0;
  for (const Index v : candidates()) {
    if (execution_.cancelled()) break;
    if (remove(v))
      ++removed;
    else
      tried_[v] = complex_.vertices[v].changes + 1;
  }
  return removed;
}

}  // namespace collarmesh::shells
