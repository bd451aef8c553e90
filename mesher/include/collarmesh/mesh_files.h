#pragma once

#include <string>
#include <vector>

#include "collarmesh/options.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/progress.h"

namespace collarmesh {

/// The result of a run on files: the mesh, with notes on CAD shapes.
struct FilesResult : SoupPipelineResult {
  std::vector<std::string> notes;  ///< changes to CAD shapes, a line each
};

/// Meshes the solids that the files bound, and certifies the mesh. Reads all formats that the program reads:
/// surfaces, complexes and CAD shapes. The mesh follows the exact geometry of CAD shapes. Link with
/// `collarmesh::files`.
/// `format` overrides the files' extensions. Uses the options of the mesh, `overlap`, `names`,
/// `given_names` and `size_field_file`; `names` may be a path or the text itself. Throws ReadError, PlcError
/// and OptionError, as `run_pipeline` does.
FilesResult mesh_files(const std::vector<std::string>& paths, const RunOptions& options = {},
                       const std::string& format = {}, const Execution& execution = {});

}  // namespace collarmesh
