#include "collarmesh/plc.h"

#include <algorithm>

namespace collarmesh {

bool Plc::vertex_on_patch(Index vertex, Index patch) const {
  return std::ranges::binary_search(vertices[vertex].patches, patch);
}

bool Plc::curve_on_patch(Index curve, Index patch) const {
  return std::ranges::binary_search(curves[curve].patches, patch);
}

bool Plc::vertex_on_curve(Index vertex, Index curve) const {
  return std::ranges::binary_search(vertices[vertex].curves, curve);
}

}  // namespace collarmesh
