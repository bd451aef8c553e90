#pragma once

#include <cstdint>

#include "support/acute_shapes.h"

/// Boxes with loose polylines inside: no facet bounds them, so a complex of n segments is as large as its
/// curves make it. Sides of the boxes are about 1; n is about the number of segments.
namespace collarmesh::testing::polylines {

using acute::Shape;

/// Two zigzags along skew lines, with this angle (degrees) between consecutive segments. The Delaunay
/// triangulation of their vertices has n^2 / 4 tets.
Shape skew_zigzags(unsigned n, double angle = 135);

/// Two helices around one axis, with 16 segments to a turn.
Shape helices(unsigned n);

/// A knot that winds around a torus, its strands about as far from each other as its segments are long.
Shape torus_knot(unsigned n);

/// A walk in random directions, steps of one length, reflected at the walls of a box that it fills evenly.
Shape random_walk(unsigned n, std::uint32_t seed = 1);

/// The edges of randomly turned boxes of various shapes, without their sides, in a grid.
Shape box_frames(unsigned n, std::uint32_t seed = 1);

/// Random points, each joined to the three nearest ones.
Shape graph(unsigned n, std::uint32_t seed = 1);

/// Two layers of parallel wires, the upper ones across the lower ones, this far above them in units of the
/// distance between neighbours.
Shape crossed_wires(unsigned n, double gap = 1);

/// The same of strips, facets half as wide as their distance.
Shape crossed_strips(unsigned n, double gap = 1);

/// A square mesh of wires that are welded where they cross.
Shape welded_mesh(unsigned n);

/// Two combs without facets, back to back and turned: the tips of their teeth lie on two skew lines.
Shape skew_combs(unsigned n);

/// Letters, as outlines of rings with corners, along two skew lines.
Shape outlines(unsigned n);

/// A conical spiral, each segment the same share shorter than the one before, the last one this small.
Shape shrinking_spiral(unsigned n, double smallest);

/// Segments that part from one point: a hub.
Shape star(unsigned n, std::uint32_t seed = 1);

/// A shape and beside it a copy of it this small.
Shape with_small_copy(const Shape& shape, double small);

}  // namespace collarmesh::testing::polylines
