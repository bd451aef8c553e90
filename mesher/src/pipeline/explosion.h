#pragma once

#include <cstddef>
#include <string>

#include "collarmesh/plc.h"

namespace collarmesh {

/// Returns a sentence saying that a refinement reached `most` vertices, the last one at `where`, and which
/// two patches are nearest to that place. Cost: linear.
std::string describe_explosion(const Plc& plc, std::size_t most, const Point& where);

}  // namespace collarmesh
