#pragma once

#include <cstddef>

#include "collarmesh/plc.h"

namespace collarmesh {

double length_of(const Plc& plc, const Plc::Curve& curve);

/// Returns the minimum number of edges of a curve that turns by half a circle or more, so that holes look
/// round. It is proportional to the turning angle, but at most the number for one circle, because the turning
/// angle of rough polylines has no bound. Returns 0 for other curves.
std::size_t least_edges(const Plc& plc, const Plc::Curve& curve, double edges_per_circle);

}  // namespace collarmesh
