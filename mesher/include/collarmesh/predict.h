#pragma once

#include <functional>
#include <span>
#include <vector>

#include "collarmesh/pipeline.h"
#include "collarmesh/plc.h"

namespace collarmesh {

/// Estimates of the size of a mesh and of its time. bench/README.md gives their errors.
struct Prediction {
  double size = 0;  ///< the target edge length, absolute, input units
  double tets = 0;  ///< number of tets, at least 1; infinite if too many for a double; 0 if the complex has
                    ///< no region
  double seconds =
      0;  ///< time of all stages from the refinement to the certificate, on the machine of the benchmarks
};

/// Predicts the mesh that `run_pipeline` makes of a complex with these options, for each of these target edge
/// lengths (input units; 0: `options.mesh.size`), without making the mesh. Uses the features of the complex,
/// the widths between them and the sizes. Considers sizes by region, patch, curve, curvature, gap, gradation
/// and place, but no budgets. Precondition: the complex comes from `build_plc`. Throws OptionError for sizes
/// that are negative or below `size_min`, for sizes of tags that the complex does not have, and if coarsening
/// is switched off. Returns one prediction for each length. Calls `told` with each as soon as it is made, in
/// the order of the sizes. Uses up to `options.mesh.threads` threads, which may call the size field at the
/// same time. Cost: near linear in the complex, and for each size two counts of vertices (bench/README.md has
/// times).
std::vector<Prediction> predict(const Plc& plc, const PipelineOptions& options, std::span<const double> sizes,
                                const std::function<void(const Prediction&)>& told = {});

}  // namespace collarmesh
