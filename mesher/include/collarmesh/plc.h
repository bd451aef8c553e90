#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/tag_names.h"

namespace collarmesh {

/// A piecewise-linear complex: the features that a mesh has to conform to, and the regions they
/// bound. Points that are not features (the tessellation of smooth curves and patches, collinear
/// and coplanar points of the input) are in `points` only.
///
/// Vertices, curves and patches are closed under taking boundaries. Features meet only in common
/// features. Made by `build_plc`.
struct Plc {
  /// A feature of dimension 0: a point that the mesh must have as a vertex.
  struct Vertex {
    Index point = none;
    Tag tag = 0;
    std::vector<Index> curves;   ///< sorted; the curves that contain it
    std::vector<Index> patches;  ///< sorted; the patches that contain it
  };

  /// A feature of dimension 1: a chain of segments that one straight or smooth edge was cut into.
  /// Mesh vertices may lie anywhere on its polyline.
  struct Curve {
    std::vector<Index> points;  ///< the polyline, 2 or more points; a closed curve does not repeat the first
    std::array<Index, 2> ends{none, none};  ///< the vertices at its ends; both none for a closed curve
                                            ///< without a vertex; equal for a loop at one vertex
    bool closed = false;                    ///< closed without any vertex on it (ends are none)
    bool straight = false;                  ///< within the planar tolerance of its chord
    Tag tag = 0;
    std::vector<Index> patches;  ///< sorted; the patches that contain it (in their border or interior)
  };
  // `points` of a loop at one vertex begin and end with that vertex's point.

  /// A feature of dimension 2: a planar polygonal facet with holes, or the facets that one smooth
  /// face was cut into. Its triangles are oriented alike: `regions[0]` lies behind them (opposite to
  /// the normal (b-a) x (c-a)), `regions[1]` in front. They form an orientable manifold with border.
  struct Patch {
    Index first_triangle = 0, triangle_count = 0;  ///< its range in `triangles`
    bool planar = false;  ///< all its points lie within the planar tolerance of one plane
    Vector normal;        ///< unit normal of the plane if planar, else zero
    Point origin;         ///< a point on that plane
    std::array<Index, 2> regions{0, 0};
    Tag tag = 0;
    std::vector<Index> curves;    ///< sorted; curves of its border and curves embedded in it
    std::vector<Index> vertices;  ///< sorted; all its feature vertices, on curves or isolated inside
    Index file = 0;               ///< index of the soup it came from
  };

  struct Triangle {
    std::array<Index, 3> points;
    Index patch = none;
  };

  struct Region {
    Tag tag = 0;        ///< region number, or the tag of a region point
    double volume = 0;  ///< volume in the complex, input units cubed
    double size = 0;    ///< target edge length, 0: none given
    std::string name;   ///< name for messages: file name or tag
  };

  /// Counts of the changes by which the builder made the input a complex.
  struct Cleanup {
    Index welded_points = 0;         ///< points merged with another one
    Index degenerate_triangles = 0;  ///< triangles without area, dropped
    Index repeated_triangles = 0;    ///< duplicate triangles in one soup, dropped
    Index shared_triangles = 0;      ///< duplicate triangles of several soups, which became interfaces
    /// Sorted pairs of tags for those shared triangles: the tag that was dropped and the tag that was kept.
    std::vector<std::pair<Tag, Tag>> replaced_tags;
  };

  /// A warning about a part of the input that has no effect or contradicts another part.
  struct Warning {
    std::string message;  ///< full sentence: entity, coordinates, what to do next
    Point where;
  };

  std::vector<Point> points;
  std::vector<Vertex> vertices;
  std::vector<Curve> curves;
  std::vector<Patch> patches;
  std::vector<Triangle> triangles;
  std::vector<Region> regions;  ///< regions[0] is the outside (and every hole)
  TagNames names;               ///< names that files gave to tags
  /// Whether the tags of all patches (curves) come from `number_untagged`, so that they depend on the order
  /// of the facets.
  bool numbered_patches = false, numbered_curves = false;

  Box bounds;
  double planar_tolerance = 0;  ///< tolerance that this complex was built with, absolute
  double largest_deviation =
      0;  ///< absolute: the largest distance by which merging (weld, planar, collinear) moved the input
  Cleanup cleanup;
  std::vector<Warning> warnings;

  /// Return whether a patch or curve contains this vertex or curve. Cost: logarithmic in the list.
  bool vertex_on_patch(Index vertex, Index patch) const;
  bool curve_on_patch(Index curve, Index patch) const;
  bool vertex_on_curve(Index vertex, Index curve) const;
};

}  // namespace collarmesh
