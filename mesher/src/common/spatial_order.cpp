#include "common/spatial_order.h"

#include <algorithm>
#include <bit>
#include <boost/sort/spreadsort/integer_sort.hpp>
#include <cassert>
#include <cmath>
#include <optional>

#include "common/groups.h"

namespace collarmesh {

namespace {

constexpr double cells_per_axis = 1 << 21;

// Returns the lower 21 bits of n, spread so that two zero bits come before each.
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

void put_in_order(std::span<SpatialKey> keys, std::span<const Point> points);

// Sorts items by their places. Items that share a cell are then sorted along the curve through the cells of
// their own box.
void sort_by_places(std::span<SpatialKey> keys, std::span<const Point> points) {
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

// Returns the number of cells per unit of length along an axis; nothing for one point, or for an extent that
// cannot be divided into cells.
std::optional<double> scale_of(const Box& bounds) {
  const Vector sides = bounds.max - bounds.min;
  const double scale = cells_per_axis / std::max({sides.x, sides.y, sides.z});
  return scale > 0 && std::isfinite(scale) ? std::optional(scale) : std::nullopt;
}

// Orders the items along the curve through the cells of their own box.
void put_in_order(std::span<SpatialKey> keys, std::span<const Point> points) {
  Box bounds;
  for (const SpatialKey& key : keys) bounds.add(points[key.item]);
  const std::optional<double> scale = scale_of(bounds);
  if (!scale) {
    std::ranges::sort(keys, {}, &SpatialKey::item);
    return;
  }
  for (SpatialKey& key : keys) key.place = place_in(bounds, *scale, points[key.item]);
  sort_by_places(keys, points);
}

constexpr std::size_t points_at_once = 8192;

Box box_of(std::span<const Point> points) {
  std::vector<Box> boxes((points.size() + points_at_once - 1) / points_at_once);
  parallel_for_ranges(points.size(), points_at_once, [&](std::size_t first, std::size_t last) {
    Box box;
    for (std::size_t i = first; i < last; ++i) box.add(points[i]);
    boxes[first / points_at_once] = box;
  });
  Box box;
  for (const Box& part : boxes) box.add(part);
  return box;
}

}  // namespace

std::vector<SpatialKey> spatial_order(std::span<const Point> points) {
  std::vector<SpatialKey> keys;
  keys.reserve(points.size());
  for (Index item = 0; item < points.size(); ++item) keys.push_back({0, item});
  put_in_order(keys, points);
  return keys;
}

// First sorts by the highest bits of the places, that is, by large cells; then sorts the items of each large
// cell.
std::vector<SpatialKey> spatial_order_by_all_threads(std::span<const Point> points) {
  constexpr std::size_t many = 32768;
  if (points.size() < many) return spatial_order(points);
  constexpr unsigned bits = 63, bits_of_parts = 12;
  constexpr std::size_t parts = std::size_t{1} << bits_of_parts;
  const Box bounds = box_of(points);
  const std::optional<double> scale = scale_of(bounds);
  std::vector<std::uint64_t> places(points.size(), 0);
  if (scale)
    parallel_for_in_chunks(points.size(),
                           [&](std::size_t i) { places[i] = place_in(bounds, *scale, points[i]); });
  const auto part_of = [&](std::size_t i) { return places[i] >> (bits - bits_of_parts); };
  const std::vector<Index> order = order_by_group(parts, points.size(), part_of);
  std::vector<SpatialKey> keys(points.size());
  parallel_for_in_chunks(points.size(), [&](std::size_t i) { keys[i] = {places[order[i]], order[i]}; });
  if (!scale) return keys;
  parallel_for(parts, [&](std::size_t part) {
    // Searches the items, not the keys, because other threads change the places of keys meanwhile.
    const auto first = std::ranges::lower_bound(order, part, {}, part_of),
               last = std::ranges::upper_bound(order, part, {}, part_of);
    const auto begin = static_cast<std::size_t>(first - order.begin());
    if (first != last)
      sort_by_places(std::span(keys).subspan(begin, static_cast<std::size_t>(last - first)), points);
  });
  return keys;
}

std::size_t spatial_split(std::span<const SpatialKey> keys) {
  assert(keys.size() >= 2);
  const std::uint64_t differing = keys.front().place ^ keys.back().place;
  if (differing == 0) return keys.size() / 2;
  const std::uint64_t upper_half = std::bit_floor(differing);
  const auto first = std::ranges::partition_point(
      keys, [&](const SpatialKey& key) { return (key.place & upper_half) == 0; });
  return static_cast<std::size_t>(first - keys.begin());
}

}  // namespace collarmesh
