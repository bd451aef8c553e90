// Dynamic programming over the sides and diagonals of a polygon (G. T. Klincsek: Minimal triangulations of
// polygonal domains, 1980).
#include "shells/best_triangles.h"

#include <algorithm>
#include <cmath>

#include "shells/triangle_shape.h"

namespace collarmesh::shells {

namespace {

constexpr double impossible = -1;

/// The best triangles on one side of a diagonal.
struct Part {
  double least = INFINITY;  // the least shape of these triangles
  unsigned apex = 0;        // third corner of the triangle at the diagonal
};

}  // namespace

std::optional<std::vector<std::array<unsigned, 3>>> best_triangles(
    std::span<const Point> polygon, double least, const std::function<bool(unsigned, unsigned)>& may_join) {
  const auto count = static_cast<unsigned>(polygon.size());
  std::vector<Part> parts(polygon.size() * polygon.size());
  const auto part = [&](unsigned i, unsigned j) -> Part& { return parts[i * count + j]; };
  for (unsigned width = 2; width < count; ++width)
    for (unsigned i = 0; i + width < count; ++i) {
      const unsigned j = i + width;
      Part& own = part(i, j);
      own.least = impossible;
      if (width + 1 < count && !may_join(i, j)) continue;
      for (unsigned k = i + 1; k < j; ++k) {
        const double others = std::min(part(i, k).least, part(k, j).least);
        if (others < least || others <= own.least) continue;
        const double shape = std::min(others, shape_of({polygon[i], polygon[k], polygon[j]}));
        if (shape >= least && shape > own.least) own = {shape, k};
      }
    }
  std::vector<std::array<unsigned, 3>> triangles;
  std::vector<std::array<unsigned, 2>> waiting;
  if (count > 2) waiting.push_back({0, count - 1});
  while (!waiting.empty()) {
    const auto [i, j] = waiting.back();
    waiting.pop_back();
    if (part(i, j).least == impossible) return std::nullopt;
    const unsigned k = part(i, j).apex;
    triangles.push_back({i, k, j});
    if (k - i > 1) waiting.push_back({i, k});
    if (j - k > 1) waiting.push_back({k, j});
  }
  return triangles;
}

}  // namespace collarmesh::shells
