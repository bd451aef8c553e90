#pragma once

#include <vector>

#include "collarmesh/layers.h"

namespace collarmesh::layering {

/// The layers that the options ask for, by patch of a complex.
class WallChoice {
 public:
  /// Throws OptionError if a wall does not exist or is named twice.
  WallChoice(const LayerOptions& options, const Plc& plc);

  bool is_wall(Index patch) const { return patch != none && wall_of_[patch] != none; }
  /// Returns the layers of a patch. Precondition: it is a wall.
  const WallLayers& operator[](Index patch) const { return walls_[wall_of_[patch]]; }

 private:
  std::vector<WallLayers> walls_;
  std::vector<Index> wall_of_;  // by patch: index of its layers; none
};

/// Returns the height of all layers relative to the first one.
double relative_thickness(const WallLayers& wall);

}  // namespace collarmesh::layering
