#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/surface_tolerance.h"
#include "shells/patch_surfaces.h"
#include "shells/surface_complex.h"
#include "shells/surface_sizes.h"

namespace collarmesh::shells {

/// Local operations on the triangles of a complex. Each keeps its topology, and the triangles within the
/// tolerance of their patch and turned like it, or at least as near to it and as well turned as before.
class SurfaceEditor {
 public:
  /// Keeps all by reference. `most_excess`: share of the tolerance that triangles and edges may take.
  SurfaceEditor(SurfaceComplex& complex, const Plc& plc, const CurvePaths& paths,
                const PatchSurfaces& surfaces, const SurfaceSizes& sizes, SurfaceTolerance tolerance,
                double most_excess);

  /// Which contractions are wanted.
  struct Contraction {
    double longest = INFINITY;  ///< edge afterwards, relative to the target edge length
    double least_shape = 0;     ///< afterwards, or not less than before
    bool better = false;        ///< the least shape must become larger
  };

  /// Replaces the edge ab inside a patch by the other diagonal, if the least shape becomes larger.
  bool flip(Index a, Index b);
  /// Contracts the edge to its vertex `to`.
  bool contract(Index from, Index to, const Contraction& rule);
  /// Divides an edge inside a patch in its middle. Returns the new vertex, none if that is not possible.
  Index divide(Index a, Index b);
  /// Divides the edge of a curve at an arc length, in all patches there.
  Index divide_curve_edge(Index edge, double at);
  Index divide_curve_edge(Index edge) {
    const auto& [from, to] = complex_.edges[edge].at;
    return divide_curve_edge(edge, 0.5 * (from + to));
  }
  /// Puts a vertex near p into a triangle or, where p is near a side, onto that.
  Index insert(Index triangle, const Point& p);
  /// Flips edges opposite to a new vertex, and so on.
  void flip_around(Index vertex);
  /// Moves a vertex in its patch to near p, if the least shape around it does not fall below `least`.
  bool move(Index vertex, const Point& p, double least);
  /// Moves a vertex along its curve.
  bool slide(Index vertex, double at, double least);
  /// Puts a vertex exactly at p, which is on the exact geometry of its feature.
  bool put(Index vertex, const Point& p, double least);
  /// The place on the curve of a vertex, by arc length. Precondition: it is on one curve alone.
  Point place_on_curve(Index vertex, double at) const {
    return paths_.point(complex_.vertices[vertex].feature.feature, at);
  }

  void set_most_excess(double share) { most_excess_ = share; }

  double shape(Index triangle) const { return complex_.triangles[triangle].shape; }
  /// Of its triangles; ends early where one is below a bound.
  double least_shape_at(Index vertex, double bound = 0) const;
  /// Returns the side of a triangle, by its first corner's place, to divide where the triangle is farther
  /// from its patch than it may be; 3 where it is not.
  unsigned side_too_far(Index triangle) const;
  /// Points of smooth patches that are too far from the triangles, and the triangles to divide there.
  std::vector<std::pair<Index, Point>> far_points() const;
  double size_of_edge(Index a, Index b) const {
    return 0.5 * (complex_.vertices[a].size + complex_.vertices[b].size);
  }
  double length(Index a, Index b) const {
    return distance(complex_.vertices[a].point, complex_.vertices[b].point);
  }
  /// The edges of a vertex's curve, before and behind it. Precondition: it is on one curve alone.
  std::optional<std::array<Index, 2>> edges_around(Index vertex) const;
  /// Is the vertex the end of a tip? Such vertices stay where they are.
  bool ends_tip(Index vertex) const {
    const auto& v = complex_.vertices[vertex];
    return v.feature.dimension == 1 && std::any_of(v.edges.begin(), v.edges.end(),
                                                   [&](Index e) { return complex_.edges[e].tip != none; });
  }

 private:
  struct Created {
    std::array<Index, 3> corners;
    Index patch;
  };

  bool fit(std::span<const Created> created, std::span<const Index> removed, Index centre) const;
  PatchSurfaces::Fit misfit_around(Index vertex) const;
  PatchSurfaces::Fit worst_fit(std::span<const Index> triangles) const;
  bool can_contract(Index from, Index to) const;
  bool shapes_permit(Index from, Index to, const Contraction& rule) const;
  bool lengths_permit(Index from, Index to, const Contraction& rule) const;
  bool curve_permits(Index from, Index to, const Contraction& rule) const;
  void merge_edges(Index from, Index to);
  Index new_vertex(const Point& p, Index patch, std::span<const Index> around);
  Index divide_at(Index a, Index b, std::span<const Index> triangles, const Point& p);
  double size_near(const Point& p, std::span<const Index> around, double asked) const;

  SurfaceComplex& complex_;
  const Plc& plc_;
  const CurvePaths& paths_;
  const PatchSurfaces& surfaces_;
  const SurfaceSizes& sizes_;
  SurfaceTolerance tolerance_;
  double most_excess_;
};

}  // namespace collarmesh::shells
