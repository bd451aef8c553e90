#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

namespace collarmesh::report {

/// Returns the counts of cells of boundary layers, each followed by a comma; empty for a mesh without layers.
inline std::string layers_text(std::size_t prisms, std::size_t pyramids) {
  return (prisms > 0 ? fmt::format("{} prisms, ", prisms) : "") +
         (pyramids > 0 ? fmt::format("{} pyramids, ", pyramids) : "");
}
inline std::string quads_text(std::size_t quads) {
  return quads > 0 ? fmt::format("{} quadrangles, ", quads) : std::string();
}

}  // namespace collarmesh::report
