#pragma once

#include <array>
#include <cassert>
#include <optional>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::shells {

/// The triangles of all patches and the edges of their curves, for editing. Any number of triangles may meet
/// at an edge on a curve.
class SurfaceComplex {
 public:
  struct Triangle {
    std::array<Index, 3> corners{none, none, none};  ///< oriented like the patch; none: the triangle is
                                                     ///< removed
    Index patch = none;
    double shape = 0;  ///< its quality, see shape_of

    bool alive() const { return corners[0] != none; }
    bool has(Index v) const { return corners[0] == v || corners[1] == v || corners[2] == v; }
    /// Returns the third corner. Precondition: the triangle has both a and b.
    Index third(Index a, Index b) const {
      assert(a != b && has(a) && has(b));
      for (const Index c : corners)
        if (c != a && c != b) return c;
      return none;
    }
  };
  struct Edge {
    std::array<Index, 2> ends{none, none};  ///< none: the edge is removed
    Index curve = none;
    std::array<double, 2> at{};  ///< arc lengths of the ends on the curve, ascending; on a closed curve the
                                 ///< second one may exceed the curve's length
    Index tip = none;            ///< if the edge is a tip (`SharpCorners`): its end at the corner; else none;
                                 ///< all tips at a corner are equally long

    bool alive() const { return ends[0] != none; }
    /// Return the other end, and the arc length of an end. Precondition: v is an end.
    Index other(Index v) const {
      assert(v == ends[0] || v == ends[1]);
      return ends[0] == v ? ends[1] : ends[0];
    }
    double at_end(Index v) const {
      assert(v == ends[0] || v == ends[1]);
      return at[ends[0] == v ? 0 : 1];
    }
  };
  struct Vertex {
    Point point;
    TetMesh::VertexFeature feature;
    double size = 0;   ///< target edge length
    double asked = 0;  ///< the same, but without regard to short curves and narrow places
    std::vector<Index> triangles, edges;
    Index changes = 0;  ///< number of changes of its triangles so far
  };

  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::vector<Edge> edges;

  std::array<Point, 3> corners(const std::array<Index, 3>& t) const {
    return {vertices[t[0]].point, vertices[t[1]].point, vertices[t[2]].point};
  }
  std::array<Point, 3> corners(Index triangle) const { return corners(triangles[triangle].corners); }

  Index add_vertex(const Point& point, const TetMesh::VertexFeature& feature, double size, double asked);
  Index add_triangle(const std::array<Index, 3>& corners, Index patch);
  void remove_triangle(Index triangle);
  void move_vertex(Index vertex, const Point& to);
  Index add_edge(const std::array<Index, 2>& ends, Index curve, const std::array<double, 2>& at);
  void remove_edge(Index edge);

  /// Returns the triangles that have both vertices.
  std::vector<Index> triangles_at(Index a, Index b) const;
  /// Returns the triangles that have both vertices; nothing unless there are exactly two.
  std::optional<std::array<Index, 2>> two_triangles_at(Index a, Index b) const;
  bool have_triangle(Index a, Index b) const;
  /// Returns the edge of a curve between the vertices, or none.
  Index edge_at(Index a, Index b) const;
  /// Returns the vertices that share a triangle or edge with v, sorted.
  std::vector<Index> neighbours(Index v) const;
  /// Returns whether the triangles and edges of a vertex exist and have it as a corner or end.
  bool consistent(Index vertex) const;
  /// Returns whether all vertices are consistent, and every triangle and edge is listed exactly once at each
  /// of its corners or ends. Cost: near linear.
  bool consistent() const;
  /// Returns the neighbour of a triangle across its side ab; none if the side is on a curve or border.
  Index across(Index triangle, Index a, Index b) const;
};

}  // namespace collarmesh::shells
