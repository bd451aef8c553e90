#pragma once

#include <cstdint>

#include "support/acute_shapes.h"

/// Boxes with loose polylines inside. The polylines bound no facets, so that the size of a complex is that of
/// its curves. The boxes' sides are 1 long; n is the approximate number of segments.
namespace collarmesh::testing::polylines {

using acute::Shape;

/// Returns two zigzags along skew lines, with this angle (degrees) between consecutive segments. The Delaunay
/// triangulation of their vertices has n^2 / 4 tets.
Shape skew_zigzags(unsigned n, double angle = 135);

/// Returns two helices around one axis, with 16 segments to a turn.
Shape helices(unsigned n);

/// Returns a knot that winds around a torus; its strands are about as far apart as its segments are long.
Shape torus_knot(unsigned n);

/// Returns a walk in random directions with steps of one length, reflected at the walls of a box, which it
/// fills evenly.
Shape random_walk(unsigned n, std::uint32_t seed = 1);

/// Returns the edges of randomly turned boxes of various shapes, without sides, in a grid.
Shape box_frames(unsigned n, std::uint32_t seed = 1);

/// Returns random points, each joined to its three nearest ones.
Shape graph(unsigned n, std::uint32_t seed = 1);

/// Returns two layers of parallel wires; the upper ones run across the lower ones, above them by `gap` times
/// the distance between neighbours.
Shape crossed_wires(unsigned n, double gap = 1);

/// Returns two layers as of crossed_wires, but of strips: facets half as wide as the distance between
/// neighbours.
Shape crossed_strips(unsigned n, double gap = 1);

/// Returns a square mesh of wires that are welded where they cross.
Shape welded_mesh(unsigned n);

/// Returns two combs without facets, back to back and turned: the tips of their teeth lie on two skew lines.
Shape skew_combs(unsigned n);

/// Returns outlines of letters along two skew lines. A letter is a ring with two polygons of 12 corners.
Shape outlines(unsigned n);

/// Returns a conical spiral. Each segment is shorter than the one before by the same factor; the last point
/// is `smallest` times as far from the tip as the first.
Shape shrinking_spiral(unsigned n, double smallest);

/// Returns segments from a common point, which is a hub.
Shape star(unsigned n, std::uint32_t seed = 1);

/// Returns a shape, and beside it a copy of its segments scaled by `small`.
Shape with_small_copy(const Shape& shape, double small);

}  // namespace collarmesh::testing::polylines
