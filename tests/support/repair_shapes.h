#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "collarmesh/repair.h"

/// Facets that are no complex, one generator per fault, and oracles for their repaired form. Lengths are
/// about 1. Facets have tags above 0.
namespace collarmesh::testing::faulty {

using Random = std::mt19937_64;

/// Returns the number of random members that a test uses: `count` times the environment variable
/// COLLARMESH_FAMILY_SHARE (above 1 for longer searches, below 1 with sanitizers), but at least one.
unsigned members(unsigned count);

double uniform(Random& random, double low, double high);
Vector random_direction(Random& random);
/// Turns a soup about a random axis through the origin by a random angle.
PolygonSoup turned(const PolygonSoup& soup, Random& random);
/// Moves every point by up to `by` along each axis, so that nothing meets by symmetry.
PolygonSoup jittered(const PolygonSoup& soup, Random& random, double by);
/// Cuts every polygon into triangles.
PolygonSoup triangulated(const PolygonSoup& soup);
/// Lets every polygon begin with another corner; its orientation is kept.
PolygonSoup corners_rotated(const PolygonSoup& soup, Random& random);
/// Returns only the facets for which `keep` holds.
template <class Keep>
PolygonSoup filtered(const PolygonSoup& soup, const Keep& keep) {
  PolygonSoup result;
  result.name = soup.name;
  result.points = soup.points;
  result.region_tag = soup.region_tag;
  for (Index f = 0; f < soup.facet_count(); ++f)
    if (keep(f)) result.add_facet(soup.polygon(soup.facet_polygons(f)[0]), soup.facet_tag(f));
  return result;
}
/// Returns all soups in one, with points not merged.
PolygonSoup joined(std::span<const PolygonSoup> soups);

// Shapes

/// Returns boxes whose corners are multiples of 1/4 between 0 and `grid` / 4: many share faces and edges,
/// overlap in faces, touch or lie inside each other. No two are equal.
std::vector<Box> random_boxes(Random& random, unsigned count, unsigned grid);
PolygonSoup soup_of(const Box& box);

/// Returns the unit box with a rectangle (tag 7) across it at z = height; with `share` < 1 it ends inside.
/// Its corners lie on sides of the box, or `overhang` outside.
PolygonSoup box_with_wall(double height, double share, double overhang = 0);

/// Returns a prism of height 1 over a regular k-gon of radius 1 with a twisted top. Its sides are quadrangles
/// that are not planar, or two triangles each.
PolygonSoup twisted_prism(unsigned k, double degrees, bool quadrangles);

/// Returns two spheres of radius 1 and `inner`, either of which may be turned inside out.
PolygonSoup nested_spheres(double inner, bool outer_inverted, bool inner_inverted);

struct OpenSphere {
  PolygonSoup soup;
  std::vector<Point> holes;        ///< centres of the holes
  std::vector<std::size_t> edges;  ///< number of edges around each hole
};
/// Returns a unit sphere without the facets around some of its points, which are far from each other.
OpenSphere sphere_with_holes(Random& random, unsigned frequency, unsigned holes);

/// Repeats some facets, in the same or in the opposite orientation.
PolygonSoup with_repeated_facets(const PolygonSoup& soup, Random& random, unsigned count, bool inverted);
/// Reverses some facets.
PolygonSoup with_inverted_facets(const PolygonSoup& soup, Random& random, unsigned count);

/// Returns the unit box with some sides cut into n x n squares, whose corners lie on edges of other sides.
PolygonSoup box_with_t_junctions(Random& random, unsigned n);

/// Returns a cube of edge 1 with a slot of this width from above, half as deep as the cube.
PolygonSoup slotted_box(double width);
/// Returns a cube of edge 1 with a fin of this width and height 1/2 on top.
PolygonSoup finned_box(double width);
/// Returns a cube of edge 1 with a pyramid of this width and height 1/2 on top; the facet around its base is
/// cut into triangles.
PolygonSoup spiked_box(double width);

/// Returns a block whose upper side is a landscape of n x n squares that folds over and through itself.
PolygonSoup folded_terrain(Random& random, unsigned n, double fold);

/// Moves a soup by `offset`, and rounds coordinates to single precision.
PolygonSoup in_single_precision(const PolygonSoup& soup, const Vector& offset);

// Oracles

double signed_volume(const PolygonSoup& soup);
double area(const PolygonSoup& soup);
Box bounds(std::span<const PolygonSoup> soups);

/// Returns the winding number by its definition: the sum of the signed solid angles of all triangles divided
/// by 4 pi.
double direct_winding_number(const PolygonSoup& soup, const Point& p);

struct Sampled {
  double volume = 0, deviation = 0;  ///< an estimate, with its standard deviation
};
/// Estimates the volume where winding numbers are above 1/2, from two random points in each of n^3 cells.
Sampled sampled_volume(const PolygonSoup& soup, Random& random, unsigned n);

/// Returns the volumes that boxes enclose, in pieces that are connected through facets: by label, sorted. If
/// boxes overlap, the common part belongs to the first one; boxes with the same label count as one.
std::map<Tag, std::vector<double>> piece_volumes(std::span<const Box> boxes, std::span<const Tag> labels);

/// Polygons around a convex body, oriented outwards.
using Convex = std::vector<std::vector<Point>>;
Convex convex_of(const PolygonSoup& soup);
/// Returns the part of a body behind a plane.
Convex clipped(const Convex& body, const Point& origin, const Vector& normal);
Convex intersection(Convex a, const Convex& b);
double volume(const Convex& body);
/// `places` returns, for each body, the volume of its part that lies in no earlier body, by inclusion and
/// exclusion; `union_volume` returns their sum.
double union_volume(std::span<const Convex> bodies);
std::vector<double> places(std::span<const Convex> bodies);

// Judgement

double total_volume(const Plc& plc);
/// Returns the volumes by region tag, sorted.
std::map<Tag, std::vector<double>> region_volumes(const Plc& plc);

/// Returns the faults of a repaired complex, whatever its input: faults of the complex itself, unknown tags,
/// and corners that fill no hole and are farther from the input than `reach` (absolute).
std::vector<std::string> faults_of(const RepairedPlc& repaired, std::span<const PolygonSoup> input,
                                   double reach);

/// Builds the complex; if that throws, fails the test with the message.
RepairedPlc repaired(std::span<const PolygonSoup> soups, const RepairOptions& options = {});
inline RepairedPlc repaired(const PolygonSoup& soup, const RepairOptions& options = {}) {
  return repaired({&soup, 1}, options);
}

}  // namespace collarmesh::testing::faulty
