#pragma once

#include <algorithm>
#include <cassert>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/surface_tolerance.h"
#include "shells/patch_surfaces.h"
#include "shells/surface_complex.h"
#include "shells/surface_sizes.h"

namespace collarmesh::shells {

/// Local operations on the triangles of a complex. Each operation keeps the topology. Triangles stay within
/// the tolerance of their patch and oriented like it, or at least fit as well as before.
class SurfaceEditor {
 public:
  /// Keeps references to the first five arguments. `most_excess`: share of the tolerance that triangles and
  /// edges may use.
  SurfaceEditor(SurfaceComplex& complex, const Plc& plc, const CurvePaths& paths,
                const PatchSurfaces& surfaces, const SurfaceSizes& sizes, SurfaceTolerance tolerance,
                double most_excess);

  /// Conditions for an edge collapse.
  struct CollapseRule {
    double longest = INFINITY;  ///< bound on edge lengths afterwards, relative to the target edge length
    double least_shape = 0;  ///< bound on shapes afterwards, degrees; the least shape before, if that is less
    bool better = false;     ///< whether the least shape must increase
  };

  /// Conditions for removing a vertex.
  struct Removal {
    double longest;      ///< bound on lengths of new edges, relative to the length that the options ask for
    double least_shape;  ///< bound on the shapes of new triangles, degrees
  };
  /// A triangle that does not exist yet.
  struct Created {
    std::array<Index, 3> corners;
    Index patch;
  };
  /// Triangles that can replace those around a vertex, and the least of their shapes.
  struct Filling {
    std::vector<Created> triangles;
    double least_shape = INFINITY;
  };

  /// Replaces the edge ab inside a patch by the other diagonal of its two triangles, if that increases the
  /// least shape. Returns whether it did.
  bool flip(Index a, Index b);
  /// Collapses an edge onto its vertex `to`. Returns false if that is impossible or against the rule.
  bool collapse(Index from, Index to, const CollapseRule& rule);
  /// Returns the triangles with the largest least shape that can take the place of a vertex and its
  /// triangles; nothing if the vertex cannot be removed.
  std::optional<Filling> filling_without(Index vertex, const Removal& rule) const;
  /// Removes a vertex. Precondition: filling_without returned `filling`, and nothing has changed since then.
  void remove(Index vertex, const Filling& filling) { replace_vertex(vertex, filling.triangles); }
  /// The state of a vertex and its neighbours before the vertex is removed.
  struct Surroundings {
    Index vertex = none;
    std::vector<SurfaceComplex::Triangle> triangles;
    std::vector<SurfaceComplex::Edge> edges;
    Index first_triangle = 0, first_edge = 0;  ///< triangles and edges from these numbers on are new
    struct Neighbour {
      Index vertex;
      Point point;
      double least_shape;
    };
    std::vector<Neighbour> neighbours;
    std::vector<std::pair<Index, Index>> changes;  ///< numbers of changes of vertices up to two edges away
    /// Edges at the neighbours, except those at the vertex, with the arc lengths of their ends (`Edge::at`).
    std::vector<std::pair<Index, std::array<double, 2>>> places;
  };
  Surroundings surroundings(Index vertex) const;
  /// Undoes the removal of a vertex and the moves of its neighbours since then. Precondition: nothing else
  /// has changed.
  void restore(const Surroundings& before);
  /// Divides an edge inside a patch in its middle. Returns the new vertex, or none if that is not possible.
  Index divide(Index a, Index b);
  /// Divides the edge of a curve at an arc length, in all patches there. Returns the new vertex, or none.
  Index divide_curve_edge(Index edge, double at);
  Index divide_curve_edge(Index edge) {
    const auto& [from, to] = complex_.edges[edge].at;
    return divide_curve_edge(edge, 0.5 * (from + to));
  }
  /// Inserts a vertex near p into a triangle or, if p is near a side, into that side. Returns the vertex, or
  /// none.
  Index insert(Index triangle, const Point& p);
  /// Flips edges opposite a new vertex, and then those opposite it in the new triangles.
  void flip_around(Index vertex);
  /// Moves a vertex to the place of its patch nearest to p, if the least shape around it is then at least
  /// `least`. Returns whether it moved.
  bool move(Index vertex, const Point& p, double least);
  /// Moves a vertex along its curve to an arc length, under the condition of `move`.
  bool slide(Index vertex, double at, double least);
  /// Moves a vertex exactly to p, which lies on its feature, under the condition of `move`.
  bool put(Index vertex, const Point& p, double least);
  /// Returns the point at an arc length of a vertex's curve. Precondition: the vertex is on one curve only.
  Point place_on_curve(Index vertex, double at) const {
    assert(complex_.vertices[vertex].feature.dimension == 1);
    return paths_.point(complex_.vertices[vertex].feature.feature, at);
  }

  void set_most_excess(double share) { most_excess_ = share; }

  bool planar(Index patch) const { return surfaces_.planar(patch); }
  double shape(Index triangle) const { return complex_.triangles[triangle].shape; }
  /// Returns the least shape of a vertex's triangles; if that is below `bound`, any of the shapes below it.
  double least_shape_at(Index vertex, double bound = 0) const;
  /// Returns the side to divide (0 to 2: the place of its first corner in the triangle) if a triangle is
  /// farther from its patch than allowed, else 3.
  unsigned side_too_far(Index triangle) const;
  /// Returns points of smooth patches that are too far from the triangles, with the triangles to divide
  /// there.
  std::vector<std::pair<Index, Point>> far_points() const;
  double size_of_edge(Index a, Index b) const {
    return 0.5 * (complex_.vertices[a].size + complex_.vertices[b].size);
  }
  /// Returns the edge length that the options ask for: with a gradation among them, the target edge length;
  /// else the one without regard to short curves and narrow places.
  double asked_of_edge(Index a, Index b) const {
    return sizes_.gradation_is_given() ? size_of_edge(a, b)
                                       : 0.5 * (complex_.vertices[a].asked + complex_.vertices[b].asked);
  }
  double length(Index a, Index b) const {
    return distance(complex_.vertices[a].point, complex_.vertices[b].point);
  }
  /// Returns the edges before and behind a vertex on its curve; nothing unless the vertex is inside a curve.
  std::optional<std::array<Index, 2>> edges_around(Index vertex) const;
  /// Returns whether the vertex is the outer end of a tip (`SharpCorners`), the one away from the sharp
  /// corner. Such vertices stay where they are.
  bool ends_tip(Index vertex) const {
    const auto& v = complex_.vertices[vertex];
    return v.feature.dimension == 1 && std::any_of(v.edges.begin(), v.edges.end(),
                                                   [&](Index e) { return complex_.edges[e].tip != none; });
  }

 private:
  bool fit(std::span<const Created> created, std::span<const Index> removed, Index centre) const;
  PatchSurfaces::Fit misfit_around(Index vertex) const;
  PatchSurfaces::Fit worst_fit(std::span<const Index> triangles) const;
  bool can_collapse(Index from, Index to) const;
  bool shapes_permit(Index from, Index to, const CollapseRule& rule) const;
  bool lengths_permit(Index from, Index to, const CollapseRule& rule) const;
  bool curve_permits(Index from, Index to, const CollapseRule& rule) const;
  double sag_across(const std::array<Index, 2>& two) const;
  void merge_edges(Index middle);
  void replace_vertex(Index vertex, std::span<const Created> created);
  /// The hole that removing a vertex leaves in a patch: the other corners of the removed triangles, in order.
  /// At an interior vertex the polygon is closed; at a vertex of a curve it begins and ends with the
  /// neighbours on the curve.
  struct Hole {
    Index patch;
    std::vector<Index> border;
  };
  std::optional<std::vector<Hole>> holes_around(Index vertex) const;
  std::optional<Hole> hole_from(Index vertex, Index triangle, std::vector<Index>& seen) const;
  bool fill(const Hole& hole, const Removal& rule, std::vector<Created>& created) const;
  bool filling_fits(Index vertex, const Hole& hole, std::span<const Created> created) const;
  bool chord_permits(Index vertex, std::span<const Hole> holes, const Removal& rule) const;
  bool may_join(Index a, Index b, const Removal& rule) const;
  Index add_vertex(const Point& p, const TetMesh::VertexFeature& feature, std::span<const Index> around,
                   double size, double asked);
  Index new_vertex(const Point& p, Index patch, std::span<const Index> around);
  Index divide_at(Index a, Index b, std::span<const Index> triangles, const Point& p);

  SurfaceComplex& complex_;
  const Plc& plc_;
  const CurvePaths& paths_;
  const PatchSurfaces& surfaces_;
  const SurfaceSizes& sizes_;
  SurfaceTolerance tolerance_;
  double most_excess_;
};

}  // namespace collarmesh::shells
