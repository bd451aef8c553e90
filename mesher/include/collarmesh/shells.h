#pragma once

#include <functional>
#include <string>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/pipeline.h"

namespace collarmesh {

/// Meshes the patches of a complex with triangles of the target edge lengths, which share nodes at common
/// curves. The patches may form closed or open surfaces, meet in T-junctions, or be planar domains.
/// The result has faces and curve edges but no tets. Faces of a solid point outwards; those of an open
/// surface are oriented alike as far as it is orientable. Curves are divided once, by size; patches are
/// refined by circumcentres, coarsened and smoothed until all angles are within the bounds of `check_shells`,
/// or as near to them as the budget of insertions allows. If there is exact geometry, nodes move onto it as
/// far as the bounds allow. `PipelineOptions::faces` chooses the patches. With dimension 1, all curves are
/// divided into edges, also without patches, and the result has no faces (`check_lines` judges it). Only the
/// options of sizes, the distance, order, exact geometry and budgets count. Same input and options: same
/// mesh. The status is `complete` even where the certificate (`PipelineResult::check`) has findings. Throws
/// PlcError for a complex without patches (with dimension 1: without curves), OptionError for unknown patches
/// and for sizes of tags that the complex does not have. Cost: near linear in the triangles of the complex
/// and of the result.
PipelineResult mesh_shells(const Plc& plc, const PipelineOptions& options = {},
                           const Execution& execution = {});

/// Meshes the patches of a complex from a source; the patches need not bound anything. Facets that are no
/// complex are repaired as for solids.
SoupPipelineResult mesh_shells(ComplexSource& source, const PipelineOptions& options = {},
                               const Execution& execution = {});

/// Checks, as `check_shells` does, a mesh of the patches of `whole` with the names or numbers in `faces` (see
/// `PipelineOptions::faces`). `CheckOptions::exact` has the measures of the whole complex. Throws OptionError
/// if no patch has one of these names or numbers.
CheckReport check_faces(const TetMesh& mesh, const Plc& whole, const std::vector<std::string>& faces,
                        CheckOptions options = {}, const Execution& execution = {});

/// Builds the complex that `mesh_shells` meshes, with a function that builds a complex by a given repair.
/// Facets that are a complex stay as they are, even open ones, which the repair of solids would close. Facets
/// that are no complex are repaired, and so are solids with features below the tolerance. Throws PlcError.
RepairedPlc build_shell_complex(const std::function<RepairedPlc(const RepairOptions&)>& build,
                                const RepairOptions& repair);

}  // namespace collarmesh
