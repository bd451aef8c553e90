#pragma once

#include <cstddef>
#include <string>

#include "collarmesh/plc.h"

namespace collarmesh {

/// Returns a clause that says that a refinement takes more than `most` vertices, the last one at `where`, and
/// which two patches, if there are two, are nearest to that place.
std::string describe_explosion(const Plc& plc, std::size_t most, const Point& where);

}  // namespace collarmesh
