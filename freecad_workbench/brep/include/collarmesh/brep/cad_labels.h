#pragma once

#include <map>
#include <string>

#include "collarmesh/geometry.h"
#include "collarmesh/tag_colours.h"

namespace collarmesh::brep {

/// Names and colours that a CAD file gives to sub-shapes, by their numbers.
struct CadLabels {
  std::map<Tag, std::string> solid_names;  ///< spelled as in the file, possibly repeated
  TagColours colours;                      ///< colours of faces and solids
};

}  // namespace collarmesh::brep
