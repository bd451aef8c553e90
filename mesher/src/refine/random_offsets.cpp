#include "refine/random_offsets.h"

namespace collarmesh {

namespace {

// So many offsets are tried where they lead into a collar.
constexpr int most_offsets = 16, offsets_of_full_length = 8;

}  // namespace

// splitmix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
Vector RandomOffsets::in_cube() {
  const auto next = [this] {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
  };
  const double x = next(), y = next();
  return {x, y, next()};
}

Vector RandomOffsets::outside_collars(const Point& from, double length, const Vector& normal) {
  const double nn = squared_norm(normal);
  for (int k = 0; k < most_offsets; ++k) {
    const Vector any = (k < offsets_of_full_length ? length : length *= 0.5) * in_cube();
    const Vector offset = nn > 0 ? any - (dot(any, normal) / nn) * normal : any;
    if (collars_.ball_containing(from + offset) == none) return offset;
  }
  return {};
}

}  // namespace collarmesh
