#pragma once

#include <array>
#include <span>
#include <vector>

#include "collarmesh/plc.h"
#include "common/distances.h"
#include "common/hierarchy.h"

namespace collarmesh {

/// A feature of a complex: a vertex, curve or patch.
struct Feature {
  std::uint8_t dimension;
  Index index;
  friend bool operator==(const Feature&, const Feature&) = default;
};

/// Bounding-volume hierarchy over the features of a complex. Below each feature is a hierarchy over its
/// triangles, its segments or its point. A query about some of the features visits no elements of the others,
/// so its cost is logarithmic however finely a feature is tessellated.
class FeatureHierarchy {
 public:
  /// Keeps references to both; `points` are the complex's, possibly in another frame.
  FeatureHierarchy(const Plc& plc, std::span<const Point> points);

  /// A triangle; segments and points are degenerate triangles.
  using Element = std::array<Index, 3>;
  /// Returns the number of an element within its feature: a curve's segment or a patch's triangle.
  Index number(Index element) const { return element - first_element_[feature_of_[element]]; }
  std::array<Point, 3> corners(Index element) const {
    const Element& e = elements_[element];
    return {points_[e[0]], points_[e[1]], points_[e[2]]};
  }
  const Element& element(Index index) const { return elements_[index]; }

  /// Returns the distance from p to the nearest feature that `counts` accepts, or `bound` if no such feature
  /// is nearer.
  template <class Counts>
  double distance_to_features(const Point& p, double bound, const Counts& counts) const;

  /// Returns the distance from p to the nearest of the feature's elements that `counts` accepts. If none of
  /// them is nearer than `bound`, returns `bound`, and `nearest` is none.
  template <class Counts>
  double distance_within(Feature feature, const Point& p, double bound, Index& nearest,
                         const Counts& counts) const;

  /// Returns the point of the feature nearest to p.
  Point nearest_point(Feature feature, const Point& p) const;

  /// Calls visit(element) for the elements of the feature whose boxes meet `box`.
  template <class Visit>
  void visit_box(Feature feature, const Box& box, const Visit& visit) const;

 private:
  Index number_of(Feature feature) const { return first_feature_[feature.dimension] + feature.index; }
  /// Adds a tree over these items. Returns its root.
  Index build(std::span<Index> items, std::span<const Box> boxes);
  double squared_distance_to(const Point& p, Index element) const;
  /// Visits the leaves below `root` whose boxes are nearer to p than the bound, nearest first; `leaf(index)`
  /// may lower the bound.
  template <class Leaf>
  void descend(Index root, const Point& p, double& squared_bound, const Leaf& leaf) const;

  std::span<const Point> points_;
  std::array<Index, 3> first_feature_{};  // by dimension: number of the first feature among all features
  std::vector<Feature> features_;
  std::vector<Element> elements_;     // by feature
  std::vector<Index> feature_of_;     // by element
  std::vector<Index> first_element_;  // by feature
  std::vector<Index> roots_;          // by feature
  Hierarchy<Box> trees_;              // over the elements of each feature, and over features
  Index root_ = none;                 // root of the tree over features
};

template <class Leaf>
void FeatureHierarchy::descend(Index root, const Point& p, double& squared_bound, const Leaf& leaf) const {
  if (root == none) return;
  trees_.visit_near(
      root, squared_bound, [&](Index node) { return squared_distance_to_box(p, trees_.bounds(node)); }, leaf);
}

template <class Counts>
double FeatureHierarchy::distance_to_features(const Point& p, double bound, const Counts& counts) const {
  double squared = bound * bound;
  descend(root_, p, squared, [&](Index feature) {
    if (!counts(features_[feature])) return;
    descend(roots_[feature], p, squared,
            [&](Index element) { squared = std::fmin(squared, squared_distance_to(p, element)); });
  });
  return std::sqrt(squared);
}

template <class Counts>
double FeatureHierarchy::distance_within(Feature feature, const Point& p, double bound, Index& nearest,
                                         const Counts& counts) const {
  nearest = none;
  double squared = bound * bound;
  descend(roots_[number_of(feature)], p, squared, [&](Index element) {
    const double d = squared_distance_to(p, element);
    if (d >= squared || !counts(element)) return;
    squared = d;
    nearest = element;
  });
  return nearest == none ? bound : std::sqrt(squared);
}

template <class Visit>
void FeatureHierarchy::visit_box(Feature feature, const Box& box, const Visit& visit) const {
  trees_.descend<ChildOrder::right_first>(
      roots_[number_of(feature)], [&](const Box& bounds) { return boxes_meet(bounds, box); }, visit);
}

}  // namespace collarmesh
