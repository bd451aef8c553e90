#pragma once

#include <cstddef>

#include "collarmesh/mesher.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/plc.h"

namespace collarmesh {

/// Returns a number of vertices far above the number that refinement needs for a complex without features
/// much finer than the sizes. Sheets that meet at a hundredth of a degree, needles and folds may need more.
/// The number does not depend on the distances between features. Cost: linear if target edge lengths are
/// given only for the whole shape and for regions, else near linear.
std::size_t most_vertices_expected(const Plc& plc, const PipelineOptions& options);

/// Returns an upper limit, at most a million, on the number of vertices that refinement needs on rods and
/// other curved bodies far thinner than the smallest target edge length. Leaves out walls thinner than the
/// longest edge that keeps the tolerance, which may need more.
std::size_t most_vertices_on_rods(const Plc& plc, const MeshOptions& options);

/// Returns the smallest of the target edge lengths for the whole shape, regions, patches and curves, in input
/// units. If none is given for the whole shape, uses the default for this diagonal.
double smallest_size(const MeshOptions& options, double diagonal);

}  // namespace collarmesh
