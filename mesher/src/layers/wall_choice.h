#pragma once

#include <cassert>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/layers.h"

namespace collarmesh::layering {

/// The layers that the options ask for, by patch of a complex.
class WallChoice {
 public:
  /// Throws OptionError if a wall or region does not exist, if a wall gets layers twice or is not beside the
  /// region that its text names, if a text puts layers on no patch, or if a first layer would be too thin
  /// relative to the shape.
  WallChoice(const LayerOptions& options, const Plc& plc);

  bool is_wall(Index patch) const { return patch != none && wall_of_[patch] != none; }
  /// Returns whether a patch has layers in a region beside it.
  bool has_layers(Index patch, Index region) const {
    return is_wall(patch) && lies_in(wall_of_[patch], region);
  }
  /// Returns the numbers of layers, by patch and by the region that contains the layers.
  std::map<std::pair<Index, Index>, unsigned> counts(const Plc& plc) const;
  /// Returns the layers of a patch. Precondition: it is a wall.
  const WallLayers& operator[](Index patch) const {
    assert(is_wall(patch));
    return walls_[wall_of_[patch]];
  }

 private:
  bool lies_in(Index wall, Index region) const {
    return only_in_[wall].empty() || regions_[wall].contains(region);
  }
  void require_heights(const LayerOptions& options, const Plc& plc) const;
  void find_regions(const Plc& plc);
  void put_on_named(const Plc& plc);
  void put_on_all(const LayerOptions& options, const Plc& plc);

  std::vector<WallLayers> walls_;
  std::vector<std::string> only_in_;      // by wall: the region that the text names; empty: none
  std::vector<std::set<Index>> regions_;  // by wall: the regions that get its layers; empty: all
  std::vector<Index> wall_of_;            // by patch: index of its layers, or none
};

/// Returns the height of all layers relative to the first one.
double relative_thickness(const WallLayers& wall);

}  // namespace collarmesh::layering
