#include "outline_triangles.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>

namespace collarmesh::brep {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
struct Side {
  bool seen = false, inside = false;
};
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<Side, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_predicates_tag>;
using Ends = std::array<Index, 2>;

Ends sorted(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

/// Counts how often each chord occurs. Crossing a chord that occurs an even number of times does not change
/// the side.
std::map<Ends, int> uses_of(const std::vector<Ends>& chords) {
  std::map<Ends, int> uses;
  for (const auto& [a, b] : chords) ++uses[sorted(a, b)];
  return uses;
}

/// Marks which faces are inside the outline, starting at the infinite face, which is outside.
void mark_sides(Triangulation& plane, const std::map<Ends, int>& uses) {
  std::vector<Triangulation::Face_handle> reached{plane.infinite_face()};
  reached.front()->info().seen = true;
  while (!reached.empty()) {
    const auto face = reached.back();
    reached.pop_back();
    for (int i = 0; i < 3; ++i) {
      const auto next = face->neighbor(i);
      if (next->info().seen) continue;
      const auto found = uses.find(
          sorted(face->vertex(Triangulation::cw(i))->info(), face->vertex(Triangulation::ccw(i))->info()));
      const bool crosses = face->is_constrained(i) && (found == uses.end() || found->second % 2 == 1);
      next->info() = {true, face->info().inside != crosses};
      reached.push_back(next);
    }
  }
}

}  // namespace

OutlineTriangles triangulate_outline(const std::vector<std::array<double, 2>>& nodes,
                                     const std::vector<std::array<Index, 2>>& chords) {
  Triangulation plane;
  std::vector<Triangulation::Vertex_handle> vertices;
  std::vector<Ends> merged = chords;  // nodes at the same place are merged
  for (Index i = 0; i < nodes.size(); ++i) {
    const std::size_t before = plane.number_of_vertices();
    vertices.push_back(plane.insert({nodes[i][0], nodes[i][1]}));
    if (plane.number_of_vertices() > before) vertices.back()->info() = i;
  }
  for (Ends& chord : merged) chord = {vertices[chord[0]]->info(), vertices[chord[1]]->info()};
  const auto crossing = static_cast<Index>(nodes.size());
  std::vector<Triangulation::Vertex_handle> known = vertices;
  for (const Ends& chord : chords)
    if (vertices[chord[0]] != vertices[chord[1]])
      plane.insert_constraint(vertices[chord[0]], vertices[chord[1]]);
  OutlineTriangles result;
  std::sort(known.begin(), known.end());
  for (auto v = plane.finite_vertices_begin(); v != plane.finite_vertices_end(); ++v) {
    if (std::binary_search(known.begin(), known.end(), Triangulation::Vertex_handle(v))) continue;
    v->info() = crossing + static_cast<Index>(result.crossings.size());
    result.crossings.push_back({v->point().x(), v->point().y()});
  }
  if (plane.dimension() < 2) return result;
  mark_sides(plane, uses_of(merged));
  for (auto f = plane.finite_faces_begin(); f != plane.finite_faces_end(); ++f)
    if (f->info().inside)
      result.triangles.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  return result;
}

}  // namespace collarmesh::brep
