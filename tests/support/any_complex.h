#pragma once

#include <vector>

#include "collarmesh/plc_builder.h"

namespace collarmesh::testing {

/// Builds the complex of a soup, which need not be solid.
inline Plc complex_of(const PolygonSoup& soup) {
  PlcOptions any;
  any.require_solid = false;
  const std::vector<PolygonSoup> soups{soup};
  return build_plc(soups, any);
}

}  // namespace collarmesh::testing
