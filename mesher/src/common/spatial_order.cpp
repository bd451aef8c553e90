#include "common/spatial_order.h"

#include <algorithm>
#include <bit>
#include <boost/sort/spreadsort/integer_sort.hpp>
#include <cassert>
#include <cmath>

namespace collarmesh {

namespace {

constexpr double cells_per_axis = 1 << 21;

// The lower 21 bits of n, two zeros before each.
std::uint64_t spread_bits(std::uint64_t n) {
  n = (n | n << 32) & 0x001f00000000ffff;
  n = (n | n << 16) & 0x001f0000ff0000ff;
  n = (n | n << 8) & 0x100f00f00f00f00f;
  n = (n | n << 4) & 0x10c30c30c30c30c3;
  return (n | n << 2) & 0x1249249249249249;
}

std::uint64_t place_in(const Box& bounds, double scale, const Point& p) {
  const auto along = [&](double from, double to) {
    const double cell = scale * (to - from);
    return cell > 0 ? spread_bits(static_cast<std::uint64_t>(std::min(cell, cells_per_axis - 1))) : 0;
  };
  return along(bounds.min.x, p.x) << 2 | along(bounds.min.y, p.y) << 1 | along(bounds.min.z, p.z);
}

// Along the curve through the cells of their own box; then those that share a cell, in the same way.
void put_in_order(std::span<SpatialKey> keys, std::span<const Point> points) {
  Box bounds;
  for (const SpatialKey& key : keys) bounds.add(points[key.item]);
  const Vector sides = bounds.max - bounds.min;
  const double scale = cells_per_axis / std::max({sides.x, sides.y, sides.z});
  if (!(scale > 0 && std::isfinite(scale))) {  // one point, or an extent that has no cells
    std::sort(keys.begin(), keys.end(),
              [](const SpatialKey& a, const SpatialKey& b) { return a.item < b.item; });
    return;
  }
  for (SpatialKey& key : keys) key.place = place_in(bounds, scale, points[key.item]);
  boost::sort::spreadsort::integer_sort(
      keys.begin(), keys.end(), [](const SpatialKey& key, unsigned shift) { return key.place >> shift; },
      [](const SpatialKey& a, const SpatialKey& b) { return a.place < b.place; });
  for (auto first = keys.begin(); first != keys.end();) {
    const std::uint64_t place = first->place;
    const auto last =
        std::find_if(first, keys.end(), [&](const SpatialKey& key) { return key.place != place; });
    if (last - first > 1) {
      put_in_order({first, last}, points);
      std::for_each(first, last, [&](SpatialKey& key) { key.place = place; });
    }
    first = last;
  }
}

}  // namespace

std::vector<SpatialKey> spatial_order(std::span<const Point> points) {
  std::vector<SpatialKey> keys;
  keys.reserve(points.size());
  for (Index item = 0; item < points.size(); ++item) keys.push_back({0, item});
  put_in_order(keys, points);
  return keys;
}

std::size_t spatial_split(std::span<const SpatialKey> keys) {
  assert(keys.size() >= 2);
  const std::uint64_t differing = keys.front().place ^ keys.back().place;
  if (differing == 0) return keys.size() / 2;
  const std::uint64_t upper_half = std::bit_floor(differing);
  const auto first = std::partition_point(
      keys.begin(), keys.end(), [&](const SpatialKey& key) { return (key.place & upper_half) == 0; });
  return static_cast<std::size_t>(first - keys.begin());
}

}  // namespace collarmesh
