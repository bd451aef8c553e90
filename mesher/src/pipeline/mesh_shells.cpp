#include "collarmesh/shells.h"

namespace collarmesh {

namespace {

PipelineOptions of_surfaces(PipelineOptions options) {
  if (options.dimension == 3) options.dimension = 2;
  options.complex.require_solid = false;
  return options;
}

}  // namespace

PipelineResult mesh_shells(const Plc& plc, const PipelineOptions& options, const Execution& execution) {
  return run_pipeline(plc, of_surfaces(options), execution);
}

SoupPipelineResult mesh_shells(ComplexSource& source, const PipelineOptions& options,
                               const Execution& execution) {
  return run_pipeline(source, of_surfaces(options), execution);
}

}  // namespace collarmesh
