#pragma once

#include <cstddef>

#include "collarmesh/mesher.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/plc.h"

namespace collarmesh {

/// Returns an upper limit far above the number of vertices that refinement needs for a complex without
/// features much finer than the sizes. (Sheets that meet at a hundredth of a degree, needles and folds make
/// millions of vertices.) It does not depend on the distances between features. Cost: linear if there are
/// only target edge lengths everywhere and in regions, else near linear.
std::size_t most_vertices_expected(const Plc& plc, const PipelineOptions& options);

/// Returns an upper limit, at most a million, on the number of vertices that refinement needs on rods and
/// other curved bodies far thinner than the smallest target edge length. Walls thinner than the longest edge
/// that keeps the tolerance do not count; they may need more.
std::size_t most_vertices_on_rods(const Plc& plc, const MeshOptions& options);

/// Returns the smallest of the target edge lengths that are given as numbers, absolute. If none is given for
/// the whole shape, the default for this diagonal counts.
double smallest_size(const MeshOptions& options, double diagonal);

}  // namespace collarmesh
