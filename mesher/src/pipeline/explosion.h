#pragma once

#include <cstddef>
#include <string>

#include "collarmesh/plc.h"

namespace collarmesh {

/// Says that a refinement came to `most` vertices, the last one at `where`, and which features are near it.
/// Cost: linear.
std::string describe_explosion(const Plc& plc, std::size_t most, const Point& where);

}  // namespace collarmesh
