#pragma once

#include "improve/workpiece.h"

namespace collarmesh::remeshing {

/// Returns whether all tets that a change makes are positively oriented, decided exactly. Qualities are
/// computed with rounding: they mean nothing between vertices that are 1e-12 of their coordinates apart.
bool stays_oriented(const improvement::TetComplex& complex, const improvement::Change& change);

}  // namespace collarmesh::remeshing
