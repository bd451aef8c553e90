#pragma once

#include <string>
#include <vector>

#include "collarmesh/options.h"
#include "collarmesh/pipeline.h"
#include "collarmesh/progress.h"

namespace collarmesh {

/// What a run on files has beside its mesh.
struct FilesResult : SoupPipelineResult {
  std::vector<std::string> notes;  ///< what was done to CAD shapes, a line each
};

/// Mesh what files bound, of all formats that the program reads: surfaces, complexes and CAD shapes, whose
/// exact geometry the mesh follows, and certify the mesh. Link with `collarmesh::files`. `format` counts in
/// place of the files' extensions. Of the options those of the mesh, `overlap`, `names` and `size_field_file`
/// count; the file with names may also be its text. Throws ReadError, PlcError and OptionError, as
/// `run_pipeline` does.
FilesResult mesh_files(const std::vector<std::string>& paths, const RunOptions& options = {},
                       const std::string& format = {}, const Execution& execution = {});

}  // namespace collarmesh
