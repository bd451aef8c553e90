#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "collarmesh/polygon_soup.h"

/// Inputs whose features meet at acute angles, one generator per family. Angles are in degrees; lengths are
/// about 1, so that a target edge length of 0.3 suits all of them.
namespace collarmesh::testing::acute {

struct Shape {
  std::string name;                ///< the call that makes it
  std::vector<PolygonSoup> soups;  ///< together they are one complex
  double volume = 0;               ///< volume of all regions together, for planar shapes
  double feature_angle = 0;        ///< 30 for curved shapes
};

/// Returns a prism over a triangle with this angle between two sides of length 1.
Shape wedge(double angle, double length = 1);

/// Returns a unit wedge and a similar one of this size just above its top, with a gap as wide as the small
/// one.
Shape wedge_on_a_large_one(double angle, double small);

/// Returns a box with k rectangles inside that share one segment. The angles between neighbours are equal or,
/// if seed > 0, random and at least a third of their mean.
Shape fan(unsigned k, std::uint32_t seed = 0);

/// Returns a prism over a regular k-gon cut into k regions that share its axis.
Shape sectors(unsigned k);

/// Returns a pyramid of height 1 over a regular k-gon. `apex_angle` is the apex angle of the cone around it;
/// a few degrees make it a needle.
Shape pyramid(unsigned k, double apex_angle);

/// Returns a pyramid over a random polygon around the origin, its apex anywhere above it.
Shape random_pyramid(std::uint32_t seed);

/// Returns a prism over a star with this many points; its inner corners have this radius, the outer ones 1.
Shape star_prism(unsigned points, double inner_radius);

/// Returns a prism over a star with random radii.
Shape random_star_prism(unsigned points, std::uint32_t seed);

/// Returns an octahedron with a spike of this height on every side.
Shape spiked_octahedron(double height);

/// Returns a blade that is sharpened to this angle along one side and ends in a point.
Shape knife(double angle);

/// Returns two knives with a common sharp side.
Shape two_knives(double angle, double gap_angle);

/// Returns two wedges that touch along their sharp edges only; the angle between them is the gap.
Shape wedges_touching_in_an_edge(double angle, double gap_angle);

/// Returns two cubes that touch in an edge, one turned about it by this angle.
Shape cubes_touching_in_an_edge(double gap_angle);

/// Returns two pyramids that touch only with their tips: both upright, or one lying beside the other with a
/// gap.
Shape pyramids_tip_to_tip(unsigned k, double apex_angle);

/// Returns two cubes that touch in a corner only.
Shape cubes_touching_in_a_corner();

/// Returns a pyramid whose tip stands on the side of a box, as two solids.
Shape pyramid_on_a_box(double apex_angle);

/// Returns a box with a facet that rises from its bottom at this angle and ends inside.
Shape facet_ending_inside(double angle);

/// Returns a box with a segment that rises from a point in its bottom at this angle and ends inside.
Shape segment_meeting_a_facet(double angle);

/// Returns a box with some segments from one point inside, in random directions.
Shape segments_from_a_point(unsigned count, std::uint32_t seed);

/// Returns a unit box with some pairs of facets inside that meet at 20 degrees and have edges of this length.
/// Nothing else is of this size.
Shape pairs_in_a_box(unsigned count, double size, std::uint32_t seed = 1);

/// Returns a wedge with a lone segment inside, parallel to its sharp edge at this distance or askew.
Shape segment_near_a_crease(double angle, double distance, bool askew = false);

/// Returns a wedge with a dangling facet inside, whose border passes its sharp edge at this distance.
Shape facet_near_a_crease(double angle, double distance);

/// Returns a bar with triangular teeth of height 1 and the given angle at their tips.
Shape comb(unsigned teeth, double angle);

/// Returns a tetrahedron of random corners, not too flat.
Shape random_tetrahedron(std::uint32_t seed);

/// Returns members of the planar families with random parameters, turned at random.
std::vector<Shape> random_members(std::uint32_t seed);

/// Turns a shape by a random rotation.
Shape turned(Shape shape, std::uint32_t seed);

/// Curved sharp rims. Their features need the feature angle 30.
Shape round_cone(double half_angle);
Shape lens(double rim_angle);
/// Returns the upper part of a torus of radii 1 and 0.25, above a plane at this share of the minor radius.
Shape cut_torus(double plane);
/// Returns a lens over a stadium of length 2 plus its width: the sharp rim comes back close to itself.
Shape long_lens(double rim_angle, double width);
/// Returns a bar of length 1 over the outline of a drop: its only side is one smooth patch that meets itself
/// at this angle.
Shape drop_bar(double angle);
/// Returns a cone of height 1 over the outline of a drop: its only side is one smooth patch, folded along a
/// curve that is no crease and ends at the acute apex.
Shape drop_cone(double angle, double apex_angle);
/// Returns only the side of a drop_cone, inside a box.
Shape drop_cone_in_a_room(double angle, double apex_angle);
/// Returns a box with a sheet that rises from its bottom at this angle, becomes steeper by 60 degrees and
/// ends inside.
Shape curved_facet_ending_inside(double angle);

}  // namespace collarmesh::testing::acute
