#pragma once

#include <functional>
#include <optional>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// The geometry that the curves (dimension 1) and patches (2) of a complex approximate. Returns the point of
/// a feature that is nearest to a mesh node on it, or nothing if the complex itself is the exact geometry
/// there.
using ExactGeometry =
    std::function<std::optional<Point>(unsigned dimension, Index feature, const Point& node)>;

}  // namespace collarmesh
