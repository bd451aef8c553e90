#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/tag_names.h"

namespace collarmesh {

/// The input of a file or program: points, polygonal facets and loose segments, unmerged and
/// unchecked. `build_plc` turns one or several soups into a piecewise-linear complex.
///
/// A facet is a set of polygons in one plane, as in TetGen's .poly: polygons of three or more corners bound
/// it, polygons of two corners are segments inside it, and polygons of one corner are points inside it. A
/// point in a hole cuts the hole out. A triangle is a facet of one polygon.
/// Storage is flat: facet f owns polygons [facets[f].first_polygon, facets[f+1].first_polygon),
/// polygon q owns corners [polygon_starts[q], polygon_starts[q+1]).
class PolygonSoup {
 public:
  struct Facet {
    Index first_polygon = 0;
    Tag tag = 0;
  };
  struct Segment {
    Index a = 0, b = 0;
    Tag tag = 0;
  };
  struct FacetHole {
    Index facet = 0;
    Point point;
  };
  /// A point in a region, with the tag of that region and optionally its target edge length.
  struct RegionPoint {
    Point point;
    Tag tag = 0;
    double size = 0;  ///< absolute, input units; 0: none
  };

  std::string name;  ///< for messages: the file's path
  std::vector<Point> points;
  std::vector<Tag> point_tags;  ///< one per point, or empty
  std::vector<Segment> segments;
  std::vector<Index> vertices;  ///< points that are features by themselves
  /// Whether the soup gives all of its features: its vertices, its segments, borders between tags, and folds
  /// above 90 degrees. If so, the feature angle adds none.
  bool given_features = false;
  std::vector<RegionPoint> region_points;  ///< .poly: region_points and hole_points decide which space of
                                           ///< their file is solid
  std::vector<Point> hole_points;          ///< points in holes: the region around each is empty
  std::vector<RegionPoint> named_regions;  ///< points that give regions a name but do not decide which space
                                           ///< is solid
  std::vector<FacetHole> facet_holes;
  TagNames tag_names;             ///< names that the file gives to its tags
  std::optional<Tag> region_tag;  ///< tag of regions whose boundary is mostly from this soup; none: a
                                  ///< region's tag is its number

  /// Begins a facet; the polygons added next belong to it.
  void begin_facet(Tag tag = 0) { facets_.push_back({polygon_count(), tag}); }

  /// Adds a polygon (point indices, in order, first corner not repeated) to the facet begun last.
  void add_polygon(std::span<const Index> corners) {
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    polygon_starts_.push_back(static_cast<Index>(corners_.size()));
  }

  /// Adds a facet of one polygon.
  void add_facet(std::span<const Index> corners, Tag tag = 0) {
    begin_facet(tag);
    add_polygon(corners);
  }

  /// Adds `by` to the tags of facets, and moves their names to the new tags.
  void shift_facet_tags(Tag by) {
    for (Facet& facet : facets_) facet.tag += by;
    TagNames shifted;
    for (std::size_t d = 0; d < 4; ++d)
      for (const auto& [tag, text] : tag_names.of(d)) shifted.set(d, d == 2 ? tag + by : tag, text);
    tag_names = std::move(shifted);
  }

  Index facet_count() const { return static_cast<Index>(facets_.size()); }
  Index polygon_count() const { return static_cast<Index>(polygon_starts_.size() - 1); }
  Tag facet_tag(Index facet) const { return facets_[facet].tag; }
  /// Returns the polygons of a facet: [first, last).
  std::array<Index, 2> facet_polygons(Index facet) const {
    return {facets_[facet].first_polygon,
            facet + 1 < facets_.size() ? facets_[facet + 1].first_polygon : polygon_count()};
  }
  std::span<const Index> polygon(Index polygon) const {
    return {corners_.data() + polygon_starts_[polygon], corners_.data() + polygon_starts_[polygon + 1]};
  }

 private:
  std::vector<Facet> facets_;
  std::vector<Index> polygon_starts_{0};
  std::vector<Index> corners_;
};

}  // namespace collarmesh
