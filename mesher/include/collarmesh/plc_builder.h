#pragma once

#include <span>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/plc.h"
#include "collarmesh/polygon_soup.h"

namespace collarmesh {

/// The space that a complex divides.
enum class DomainShape {
  enclosed,  ///< the space that its facets enclose
  box        ///< a box around all points, segments and facets, which need not enclose anything
};

struct PlcOptions {
  DomainShape domain = DomainShape::enclosed;
  /// Distance of the box from its contents, relative to the largest side of their bounding box.
  double box_margin = 1;
  double feature_angle =
      30;  ///< degrees; edges where the surface turns by more are segments. 0: every non-coplanar edge
  double planar_tolerance = 1e-6;  ///< relative to the bounding-box diagonal; 0: the exact predicate
  double weld = 1e-9;              ///< relative to the bounding-box diagonal; points closer than this are
                                   ///< merged
  bool require_solid = true;       ///< throw an error if the complex bounds no region
};

/// Builds the complex of one or several soups: welds points, orients facets, merges coplanar and collinear
/// neighbours, finds curves, patches and regions, and validates the result. Regions are numbered from 1 in
/// soup order (a nested shell is a cavity if it is oriented inwards, else a region of its own; in a soup with
/// region and hole points, these decide). Throws PlcError with every fault found. Cost: O(n log n) for n
/// corners.
Plc build_plc(std::span<const PolygonSoup> soups, const PlcOptions& options = {});

/// Numbers the patches from 1 in their order if no facet has a tag, and the curves if no segment has one.
/// `build_plc` calls it. For the complex of repaired soups, call it with the original soups, because the
/// facets that fill holes have tags.
void number_untagged(std::span<const PolygonSoup> soups, Plc& plc);

/// Two features that meet at an acute angle (paper, Definition 1).
struct Crease {
  enum class Kind { facets, segments, segment_and_facet, facets_in_vertex, patch_fold };
  Kind kind;
  double angle;                               ///< degrees
  Index curve = none;                         ///< the crease curve, if the features meet in a curve
  Index vertex = none;                        ///< the crease vertex, if the features meet in a vertex
  std::array<Index, 2> features{none, none};  ///< the two features (patches or curves, by kind)
  Point where;
};

/// Returns all creases with an angle below the threshold (degrees), smallest angle first.
std::vector<Crease> find_creases(const Plc& plc, double threshold = 60);

/// Counts, angles and sizes of a complex, for display.
struct PlcSummary {
  Index points = 0, vertices = 0, curves = 0, straight_curves = 0, patches = 0, planar_patches = 0,
        triangles = 0, regions = 0;
  double diagonal = 0;           ///< input units
  double smallest_angle = 180;   ///< degrees; smallest angle between any two features that meet
  double shortest_segment = 0;   ///< smallest distance between vertices that a curve joins, input units
  double spread = 0;             ///< diagonal / shortest feature length
  double largest_deviation = 0;  ///< as Plc::largest_deviation
  std::vector<Crease> creases;   ///< creases below the given threshold
};
/// Summarizes a complex. `crease_threshold`: degrees.
PlcSummary summarize(const Plc& plc, double crease_threshold = 60);

/// The patches of one tag.
struct PatchSummary {
  Tag tag = 0;
  std::string name;       ///< name of the tag; empty: none
  std::size_t count = 0;  ///< number of patches
  bool planar = true;     ///< all of them are planar
  double area = 0;        ///< total area, input units squared
  Point where;            ///< centre of the largest triangle of the first patch
};
/// Summarizes the patches by tag. Cost: linear.
std::vector<PatchSummary> summarize_patches(const Plc& plc);

/// The curves of one tag.
struct CurveSummary {
  Tag tag = 0;
  std::string name;       ///< name of the tag; empty: none
  std::size_t count = 0;  ///< number of curves
  bool straight = true;   ///< all of them are straight
  double length = 0;      ///< total length, input units
  Point where;            ///< middle of the longest segment of the first curve
};
/// Summarizes the curves by tag. Cost: linear.
std::vector<CurveSummary> summarize_curves(const Plc& plc);

/// Returns a sentence for display: the features that meet, where, and at which angle.
std::string describe(const Plc& plc, const Crease& crease);

}  // namespace collarmesh
