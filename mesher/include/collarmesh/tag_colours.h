#pragma once

#include <cstdint>
#include <map>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// A colour 0xRRGGBB in the sRGB space.
using Colour = std::uint32_t;

/// Colours that a CAD file gives to the tags of patches and regions.
struct TagColours {
  std::map<Tag, Colour> patches, regions;
  bool empty() const { return patches.empty() && regions.empty(); }
};

}  // namespace collarmesh
