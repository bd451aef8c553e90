#pragma once

#include "collarmesh/pipeline.h"
#include "collarmesh/plc.h"

namespace collarmesh {

/// How large a mesh will be, and how long it will take. Estimates: see bench/README.md for how far off they are.
struct Prediction {
  double size = 0;     ///< the target edge length it is for, absolute, input units
  double tets = 0;     ///< at least 1 where there is a region
  double seconds = 0;  ///< of all stages from the refinement to the certificate, with one thread
};

/// Predict what `run_pipeline` makes of a complex with these options, without making it. Sizes by region, patch,
/// curve, curvature, gap, gradation and place count as they do in the mesh; budgets do not. Precondition: the
/// options coarsen, as they do by default.
/// Throws OptionError for negative sizes and for sizes of tags that the complex does not have.
/// Cost: near linear in the triangles of the complex; grows with the mesh predicted up to about a second.
Prediction predict(const Plc& plc, const PipelineOptions& options = {});

}  // namespace collarmesh
