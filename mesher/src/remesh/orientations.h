#pragma once

#include "improve/workpiece.h"

namespace collarmesh::remeshing {

/// Returns whether all tets that a change makes are positively oriented, decided exactly. Qualities are
/// computed with rounding errors, so they mean nothing if vertices are as close as 1e-12 of their
/// coordinates.
bool stays_oriented(const improvement::TetComplex& complex, const improvement::Change& change);

}  // namespace collarmesh::remeshing
