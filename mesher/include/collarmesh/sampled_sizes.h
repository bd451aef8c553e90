#pragma once

#include <functional>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/size_field.h"

namespace collarmesh {

/// Target edge lengths at many places at once, one for each place: positive, infinite where there is no wish.
using SizesAt = std::function<std::vector<double>(const std::vector<Point>&)>;

/// Samples sizes on grids that are as fine as the sizes there, hundreds of places in a call, and interpolates
/// linearly in the cells. The coarsest grid has cells of 1/64 of the box's longest side, and a cell gets a
/// finer one when a place in it is asked for and it is longer than the smallest size at its corners. No place
/// outside of the box is sampled; its nearest place counts there. Several threads may ask at once, and the
/// answers do not depend on their order. What `sizes` throws comes out.
SizeField sampled_sizes(SizesAt sizes, const Box& box);

}  // namespace collarmesh
