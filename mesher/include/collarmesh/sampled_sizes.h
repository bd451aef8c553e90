#pragma once

#include <functional>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/size_field.h"

namespace collarmesh {

/// A function that returns the target edge lengths at many places at once, one for each place, in input
/// units: positive; infinite where no length is asked for.
using SizesAt = std::function<std::vector<double>(const std::vector<Point>&)>;

/// Returns a field that samples `sizes` on grids as fine as the sizes themselves, with hundreds of places in
/// each call, and interpolates linearly in the cells. The coarsest grid has cells of 1/64 of the box's
/// longest side. A cell is refined when the field is called for a place in it and the cell is longer than the
/// smallest size at its corners. A place outside the box gets the size of the nearest place inside. Several
/// threads may call the field at once, and its values do not depend on the order of the calls. Exceptions of
/// `sizes` pass through.
SizeField sampled_sizes(SizesAt sizes, const Box& box);

}  // namespace collarmesh
