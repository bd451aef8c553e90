#pragma once

#include "collarmesh/pipeline.h"

namespace collarmesh::shells {

/// Does the work of `run_pipeline` for `PipelineOptions::dimension` 1 and 2: see `mesh_shells`.
/// Preconditions: the options are valid, and the caller watches their time limit.
SoupPipelineResult run(ComplexSource& source, const PipelineOptions& options, const Execution& execution);
PipelineResult run(const Plc& plc, const PipelineOptions& options, const Execution& execution);

}  // namespace collarmesh::shells
