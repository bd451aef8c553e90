#pragma once

#include <map>
#include <string>

#include "collarmesh/geometry.h"
#include "collarmesh/tag_colours.h"

namespace collarmesh::brep {

/// Names of solids, and colours of faces and solids, as a CAD file gives them; by number. Names of faces are
/// not read.
struct CadLabels {
  std::map<Tag, std::string> solid_names;  ///< spelled as in the file, possibly repeated
  TagColours colours;                      ///< colours of faces and solids
};

}  // namespace collarmesh::brep
