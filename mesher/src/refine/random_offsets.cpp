#include "refine/random_offsets.h"

#include "common/split_mix.h"

namespace collarmesh {

namespace {

// At most `most_offsets` offsets are tried. The first `offsets_of_full_length` have full length; each later
// one is half as long as the one before it.
constexpr int most_offsets = 16, offsets_of_full_length = 8;

}  // namespace

Vector RandomOffsets::in_cube() {
  const auto next = [this] { return 2 * next_unit(state_) - 1; };
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
