#pragma once

namespace collarmesh {

/// Largest distance of the middle of an edge, or of an arc's chord, from the smooth patch or curve through
/// its ends, relative to its length: about 60 degrees of turning, 30 at each end, make 0.13. An edge across a
/// fold is farther off.
constexpr double largest_sagitta = 0.15;

}  // namespace collarmesh
