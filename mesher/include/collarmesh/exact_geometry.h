#pragma once

#include <functional>
#include <optional>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// The geometry that the curves (dimension 1) and patches (2) of a complex approximate: the point of a
/// feature nearest to a node of the mesh on it, or nothing where the complex itself is what is meant.
using ExactGeometry =
    std::function<std::optional<Point>(unsigned dimension, Index feature, const Point& node)>;

}  // namespace collarmesh
