#pragma once

#include <cstdint>

#include "support/acute_shapes.h"

/// Boxes with loose polylines inside. No facet bounds the polylines, so a complex of n segments is as large
/// as its curves. Sides of the boxes are about 1; n is the approximate number of segments.
namespace collarmesh::testing::polylines {

using acute::Shape;

/// Two zigzags along skew lines, with this angle (degrees) between consecutive segments. The Delaunay
/// triangulation of their vertices has n^2 / 4 tets.
Shape skew_zigzags(unsigned n, double angle = 135);

/// Two helices around one axis, with 16 segments to a turn.
Shape helices(unsigned n);

/// A knot that winds around a torus; its strands are about as far apart as its segments are long.
Shape torus_knot(unsigned n);

/// A walk in random directions with steps of one length, reflected at the walls of a box, which it fills
/// evenly.
Shape random_walk(unsigned n, std::uint32_t seed = 1);

/// The edges of randomly turned boxes of various shapes, without their sides, in a grid.
Shape box_frames(unsigned n, std::uint32_t seed = 1);

/// Random points, each joined to its three nearest ones.
Shape graph(unsigned n, std::uint32_t seed = 1);

/// Two layers of parallel wires; the upper ones run across the lower ones, above them by `gap` times the
/// distance between neighbours.
Shape crossed_wires(unsigned n, double gap = 1);

/// Two such layers of strips: facets half as wide as their distance.
Shape crossed_strips(unsigned n, double gap = 1);

/// A square mesh of wires that are welded where they cross.
Shape welded_mesh(unsigned n);

/// Two combs without facets, back to back and turned: the tips of their teeth lie on two skew lines.
Shape skew_combs(unsigned n);

/// Letters, as outlines of rings with corners, along two skew lines.
Shape outlines(unsigned n);

/// A conical spiral. Each segment is shorter than the one before by the same factor; the last one has the
/// length `smallest`.
Shape shrinking_spiral(unsigned n, double smallest);

/// Segments from a common point: a hub.
Shape star(unsigned n, std::uint32_t seed = 1);

/// A shape, and beside it a copy of it scaled by `small`.
Shape with_small_copy(const Shape& shape, double small);

}  // namespace collarmesh::testing::polylines
