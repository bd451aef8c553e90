#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "collarmesh/polygon_soup.h"

/// Inputs for tests. No two features meet at an acute angle unless the comment says so.
namespace collarmesh::testing {

/// Returns a box whose sides have the tags 1 (x min), 2 (x max), 3, 4 (y), 5, 6 (z); each side is n x n
/// rectangles.
PolygonSoup box(const Point& min = {0, 0, 0}, const Point& max = {1, 1, 1}, unsigned n = 1);

/// Returns a polygon (counterclockwise in x, y) extruded from z = 0 to the height; caps 1 (bottom) and 2
/// (top), sides from 3.
PolygonSoup extrusion(std::span<const Point> polygon, double height);

/// Returns three unit cubes in an L, as an extrusion.
PolygonSoup l_shape();

/// Returns a regular k-gon extruded, with the corners on the unit circle.
PolygonSoup regular_prism(unsigned k, double height = 1);

/// Rotates the profile (x the radius, z the height, from bottom to top) about the z axis; all triangles have
/// tag 1. The profile starts and ends on the axis, or is closed (without repeating its first point).
PolygonSoup revolution(std::span<const Point> profile, unsigned segments, bool closed = false);

/// Returns a sphere of 20 f^2 nearly regular triangles. The points of frequency f are among those of
/// frequency k f.
PolygonSoup icosphere(double radius, unsigned frequency);
/// Returns a sphere with approximately this number of triangles.
PolygonSoup icosphere_of(double radius, std::size_t triangles);

PolygonSoup uv_sphere(double radius, unsigned rings, unsigned segments);
PolygonSoup cylinder(double radius, double height, unsigned segments, unsigned rings = 1);
PolygonSoup torus(double major, double minor, unsigned major_segments, unsigned minor_segments);

/// Returns a cone. Its apex is acute if the cone is slender, and its rim if the cone is flat.
PolygonSoup cone(double radius, double height, unsigned segments, unsigned rings = 1);

/// Returns a sphere of radius 1 with a filleted, rounded spike of the given radius and height on its pole:
/// one smooth patch.
PolygonSoup spiked_sphere(double spike_radius, double spike_height, unsigned segments = 48);

/// Returns the unit box with a cubic cavity of the given edge length near its centre.
PolygonSoup box_with_cavity(double size);

/// Returns the unit box with a square facet (tag 7) of the given edge length in its top side.
PolygonSoup box_with_small_facet(double size);

/// Returns the unit box on a second one, as one complex. The facet between them (tag 7) occurs once, and
/// region points give the boxes the tags 10 (below) and 20.
PolygonSoup two_boxes();
/// Returns two boxes as two closed surfaces that share a side.
std::vector<PolygonSoup> touching_boxes();

/// Returns two bodies that meet only in a straight edge; below, two rings that meet only in a circle.
std::vector<PolygonSoup> boxes_touching_in_an_edge();
std::vector<PolygonSoup> rings_touching_in_a_circle();

/// Returns the unit box with a free square facet (tag 7) of the given edge length inside.
PolygonSoup box_with_dangling_facet(double size = 0.4);

/// Returns the unit box with n points on each of two skew lines inside.
PolygonSoup box_with_skew_lines(unsigned n);

/// Returns boxes inside each other, all oriented outwards, the largest first.
std::vector<PolygonSoup> nested_boxes(unsigned levels);

/// Returns a plate 4 x 4 x 1 with a round hole: facets with holes, and a smooth one (tag 7).
PolygonSoup plate_with_hole(double radius, unsigned segments);

/// Returns a prism over a random convex polygon with obtuse corners, turned and slightly sheared.
PolygonSoup random_prism(std::uint32_t seed);

/// Returns the convex hull of random points on a sphere, made of triangles, so its segments meet at acute
/// angles. Precondition: at most about 40 points.
PolygonSoup random_hull(std::uint32_t seed, unsigned points);

/// Applies a map to every point of a soup. The map must keep the orientation and planes.
PolygonSoup transformed(const PolygonSoup& soup, const std::function<Point(const Point&)>& map);
PolygonSoup translated(const PolygonSoup& soup, const Vector& by);
PolygonSoup scaled(const PolygonSoup& soup, double by);
/// Rotates a soup about an axis through the origin (of any length), in degrees.
PolygonSoup rotated(const PolygonSoup& soup, const Vector& axis, double degrees);
/// Turns a soup inside out.
PolygonSoup inverted(const PolygonSoup& soup);
/// Returns the soup with its points and facets in another order.
PolygonSoup permuted(const PolygonSoup& soup, std::uint32_t seed);
/// Returns both in one soup, with points not merged.
PolygonSoup joined(const PolygonSoup& a, const PolygonSoup& b);

}  // namespace collarmesh::testing
