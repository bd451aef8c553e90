#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "collarmesh/mesher.h"
#include "refine/sizing.h"
#include "tolerance/curvature.h"

namespace collarmesh {

namespace {

void judge(const char* option, const std::map<Tag, double>& sizes, double size,
           std::vector<std::string>& told) {
  for (const auto& [tag, asked] : sizes)
    if (asked >= size)
      told.push_back(fmt::format("--{} {}={:.6g}: no effect, as --size asks for {:.6g} everywhere.", option,
                                 tag, asked, size));
}

/// Returns the shortest edge length that the number of elements per full circle asks for.
double smallest_of(const CurvatureSizes& sizes) {
  double smallest = INFINITY;
  for (const double each : sizes.triangle) smallest = std::min(smallest, each);
  for (const auto& curve : sizes.curve_segment)
    for (const double each : curve) smallest = std::min(smallest, each);
  return smallest;
}

}  // namespace

std::vector<std::string> sizes_without_effect(const Plc& plc, const MeshOptions& options) {
  const double size = default_size(plc, options);
  std::vector<std::string> told;
  judge("region-size", options.region_size, size, told);
  judge("patch-size", options.patch_size, size, told);
  judge("curve-size", options.curve_size, size, told);
  if (options.elements_per_circle <= 0) return told;
  const double smallest = smallest_of(curvature_sizes(plc, options.elements_per_circle));
  if (std::isinf(smallest))
    told.push_back(fmt::format("--elements-per-circle {:.6g}: no effect, as nothing here is curved.",
                               options.elements_per_circle));
  else if (smallest >= Sizing::edge_per_size * size)
    told.push_back(
        fmt::format("--elements-per-circle {:.6g}: no effect, as that asks for edges of {:.6g} or more, and "
                    "--size for {:.6g} everywhere.",
                    options.elements_per_circle, smallest / Sizing::edge_per_size, size));
  return told;
}

}  // namespace collarmesh
