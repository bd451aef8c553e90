#pragma once

namespace collarmesh {

/// Largest permitted distance between the middle of an edge, or of an arc's chord, and the smooth patch or
/// curve through its ends, relative to the length of the edge or chord. An arc that turns by 60 degrees has
/// 0.13; an edge across a fold has more than the limit.
constexpr double largest_sagitta = 0.15;

}  // namespace collarmesh
