#pragma once

#include <functional>
#include <string>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/pipeline.h"

namespace collarmesh {

/// Meshes the patches of a complex with triangles of the target edge lengths, which share nodes at common
/// curves: closed and open surfaces, patches that meet in T-junctions, planar domains. The result has faces
/// and curve edges and no tets; in it faces of a solid look outwards, those of an open surface are oriented
/// alike as far as it is orientable. Curves are divided once, by size; patches are refined by circumcentres,
/// coarsened and smoothed until all angles are within the bounds of `check_shells`, or as near to them as the
/// budget of insertions allows. With exact geometry nodes lie on it. With `PipelineOptions::faces` these
/// patches alone are meshed; with the dimension 1 all curves are, with edges alone, also where there are no
/// patches (judged by `check_lines`). Of the options those of sizes, the distance, order and budgets count.
/// Same input and options: same mesh. The status is `complete` even where the certificate
/// (`PipelineResult::check`) has findings. Throws PlcError for a complex without patches, OptionError for
/// sizes of tags that it does not have. Cost: near linear in the triangles of the complex and of the result.
PipelineResult mesh_shells(const Plc& plc, const PipelineOptions& options = {},
                           const Execution& execution = {});

/// The same for the complexes of a source, which need not bound anything. Facets that are no complex are
/// repaired as for solids.
SoupPipelineResult mesh_shells(ComplexSource& source, const PipelineOptions& options = {},
                               const Execution& execution = {});

/// `check_shells` for a mesh of some patches of a complex: those with these names or numbers
/// (`PipelineOptions::faces`). The exact measures are those of the whole complex. Throws OptionError where no
/// patch has a name.
CheckReport check_faces(const TetMesh& mesh, const Plc& whole, const std::vector<std::string>& faces,
                        CheckOptions options = {}, const Execution& execution = {});

/// Builds the complex that `mesh_shells` meshes, by a function that builds one with a repair: facets that are
/// a complex stay as they are, also open ones, which the repair of solids would close; solids are repaired
/// where they have features below the tolerance, and so is what is no complex. Throws PlcError.
RepairedPlc build_shell_complex(const std::function<RepairedPlc(const RepairOptions&)>& build,
                                const RepairOptions& repair);

}  // namespace collarmesh
