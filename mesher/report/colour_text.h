#pragma once

#include <fmt/format.h>

#include <string>

#include "collarmesh/tag_colours.h"

namespace collarmesh::report {

/// Returns a colour as pages use it: "#rrggbb".
inline std::string colour_text(Colour colour) { return fmt::format("#{:06x}", colour); }

}  // namespace collarmesh::report
