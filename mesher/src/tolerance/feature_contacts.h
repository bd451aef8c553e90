#pragma once

#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh {

/// Which features of a complex have a point in common. Those that have none keep a distance that only the
/// input decides.
class FeatureContacts {
 public:
  /// Kept by reference. Cost: near linear in the complex.
  explicit FeatureContacts(const Plc& plc);

  /// Are the two features, of dimensions 0 to 2, one and the same, or have they a point in common? Cost:
  /// logarithmic but where many patches meet in a vertex.
  bool touch(unsigned dimension, Index feature, unsigned other_dimension, Index other) const;

 private:
  bool patches_touch(Index a, Index b) const;

  const Plc& plc_;
  std::vector<std::vector<Index>> neighbours_;  // by patch: others that it meets, sorted
  std::vector<bool> at_hub_;  // by patch: it has a vertex of many, which are not in that list
};

}  // namespace collarmesh
