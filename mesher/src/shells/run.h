#pragma once

#include "collarmesh/pipeline.h"

namespace collarmesh::shells {

/// Runs `run_pipeline` for `PipelineOptions::dimension` 2: see `mesh_shells`. The options are valid, and the
/// caller keeps their limit of time.
SoupPipelineResult run(ComplexSource& source, const PipelineOptions& options, const Execution& execution);
PipelineResult run(const Plc& plc, const PipelineOptions& options, const Execution& execution);

}  // namespace collarmesh::shells
