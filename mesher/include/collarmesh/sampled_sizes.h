#pragma once

#include <functional>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/size_field.h"

namespace collarmesh {

/// Returns the target edge lengths at many places at once, one for each place: positive; infinite where no
/// length is asked for.
using SizesAt = std::function<std::vector<double>(const std::vector<Point>&)>;

/// Samples `sizes` on grids as fine as the sizes themselves, with hundreds of places in each call, and
/// interpolates linearly in the cells. The coarsest grid has cells of 1/64 of the box's longest side. A cell
/// is refined when the size at a place in it is asked for and the cell is longer than the smallest size at
/// its corners. A place outside the box gets the size of the nearest place inside. Several threads may call
/// the returned field at once, and the results do not depend on their order. Exceptions of `sizes` pass
/// through.
SizeField sampled_sizes(SizesAt sizes, const Box& box);

}  // namespace collarmesh
