#include "pipeline/explosion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "check/findings.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh {

namespace {

using Near = std::pair<double, Index>;  // squared distance and patch

std::vector<Near> nearest_patches(const Plc& plc, const Point& where) {
  std::vector<Near> patches(plc.patches.size());
  for (Index p = 0; p < patches.size(); ++p) patches[p] = {INFINITY, p};
  for (const Plc::Triangle& t : plc.triangles) {
    const auto& [a, b, c] = t.points;
    patches[t.patch].first =
        std::min(patches[t.patch].first,
                 squared_distance_to_triangle(where, plc.points[a], plc.points[b], plc.points[c]));
  }
  std::ranges::sort(patches);
  return patches;
}

}  // namespace

std::string describe_explosion(const Plc& plc, std::size_t most, const Point& where) {
  std::string text =
      fmt::format("the refinement takes more than {} vertices, far more than the sizes ask for, around {}",
                  most, checks::At{where});
  if (const std::vector<Near> near = nearest_patches(plc, where); near.size() >= 2)
    text += fmt::format(", which is within {:.3g} of patches {} and {}", std::sqrt(near[1].first),
                        near[0].second, near[1].second);
  return text;
}

}  // namespace collarmesh
