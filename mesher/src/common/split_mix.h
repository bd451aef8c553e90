#pragma once

#include <cstdint>

namespace collarmesh {

/// SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014): the state grows by
/// a step, and its mixed bits are the next number.
inline constexpr std::uint64_t split_mix_step = 0x9e3779b97f4a7c15ULL;

/// Mixes the bits, so that each depends on all others; may be used as a hash.
inline std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

/// Returns a number from 0 to below 1 made of the upper bits.
inline double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11U) * 0x1p-53; }

/// Advances the state and returns the next number from 0 to below 1.
inline double next_unit(std::uint64_t& state) { return unit(mixed(state += split_mix_step)); }

}  // namespace collarmesh
