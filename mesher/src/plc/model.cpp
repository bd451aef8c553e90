#include "collarmesh/plc.h"

#include <algorithm>

namespace collarmesh {

bool Plc::vertex_on_patch(Index vertex, Index patch) const {
  return std::binary_search(vertices[vertex].patches.begin(), vertices[vertex].patches.end(), patch);
}

bool Plc::curve_on_patch(Index curve, Index patch) const {
  return std::binary_search(curves[curve].patches.begin(), curves[curve].patches.end(), patch);
}

bool Plc::vertex_on_curve(Index vertex, Index curve) const {
  return std::binary_search(vertices[vertex].curves.begin(), vertices[vertex].curves.end(), curve);
}

}  // namespace collarmesh
