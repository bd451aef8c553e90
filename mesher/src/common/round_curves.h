#pragma once

#include <cstddef>

#include "collarmesh/plc.h"

namespace collarmesh {

double length_of(const Plc& plc, const Plc::Curve& curve);

/// How many edges stand for a curve that turns by half a circle or more, so that a hole is seen to be round:
/// so many to a full circle; at most those of one circle, as rough polylines turn without end. 0 for other
/// curves.
std::size_t least_edges(const Plc& plc, const Plc::Curve& curve, double edges_per_circle);

}  // namespace collarmesh
