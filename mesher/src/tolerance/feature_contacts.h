#pragma once

#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh {

/// The pairs of features of a complex that have a point in common. Edges between the features of other pairs
/// cannot be shorter than the distance between the two features.
class FeatureContacts {
 public:
  /// Keeps the complex by reference. Cost: near linear in the complex.
  explicit FeatureContacts(const Plc& plc);

  /// Returns whether two features, of dimensions 0 to 2, are the same or have a point in common. Cost:
  /// logarithmic, except if many patches meet in a vertex.
  bool touch(unsigned dimension, Index feature, unsigned other_dimension, Index other) const;

 private:
  bool patches_touch(Index a, Index b) const;

  const Plc& plc_;
  std::vector<std::vector<Index>> neighbours_;  // by patch: other patches that it meets, sorted
  std::vector<bool> at_hub_;  // by patch: whether many patches meet at one of its vertices; `neighbours_`
                              // does not list these
};

}  // namespace collarmesh
