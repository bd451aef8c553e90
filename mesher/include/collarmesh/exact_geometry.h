#pragma once

#include <functional>
#include <optional>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// The geometry that the curves (dimension 1) and patches (2) of a complex approximate: a function that
/// returns, for a mesh node on a feature, the nearest point of that feature's exact geometry, or nothing if
/// the complex itself is exact there.
using ExactGeometry =
    std::function<std::optional<Point>(unsigned dimension, Index feature, const Point& node)>;

}  // namespace collarmesh
