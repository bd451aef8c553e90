#pragma once

#include <cstddef>
#include <functional>

#include "collarmesh/pipeline.h"

namespace collarmesh {

struct RemeshReport {
  std::size_t tets_before = 0;
  double smallest_angle_before = 0, largest_angle_before = 0;  ///< dihedral angles, degrees
  std::size_t divided_edges = 0, contracted_edges = 0;
  std::size_t rounds = 0;       ///< rounds of edge divisions
  bool smooth_surface = false;  ///< nodes were moved onto a smooth surface made of the given mesh
};

struct RemeshResult : SoupPipelineResult {
  RemeshReport remeshing;
};

/// A function that sets options which depend on the complex of the mesh, such as a size field defined by its
/// features.
using AdaptOptions = std::function<void(const Plc&, PipelineOptions&)>;

/// Adapts any tetrahedral mesh to target edge lengths, finer or coarser. Divides edges longer than sqrt 2
/// times the target, collapses short ones as `coarsen` does, and improves poor tets, until the lengths fit.
/// The result follows the mesh's own surface: its boundaries, interfaces, listed faces and edges become a
/// complex (`SoupPipelineResult::plc`). The curves of the complex are the listed edges; if these do not cover
/// all borders between tags of faces, folds above `options.complex.feature_angle` are curves, too. Keeps
/// regions, tags and names; the result identifies features by tags alone, like a mesh from a file. Divisions
/// may make tets worse for a while; improvement after each round must restore the bounds on angles, and the
/// certificate tells where it could not. The result is certified against the complex. For a mesh of second
/// order, its corners are remeshed, and mid-edge nodes are made anew if `options.order` is 2. Only the
/// options of sizes, bounds, improvement, order, partitions and budgets count; exact geometry is ignored,
/// because its features are those of another complex. With `options.smooth_surface`, nodes on curved patches
/// and curves go to a smooth surface through the nodes of the given mesh, within the tolerance of its
/// triangles. Without a size and a field the lengths stay as they are. Same mesh and options: same result,
/// with any number of threads. Throws PlcError for a mesh that is not conforming, OptionError for sizes of
/// tags that the mesh does not have. Cost: near linear in the tets of the mesh and of the result.
RemeshResult remesh(const TetMesh& mesh, const PipelineOptions& options = {}, const AdaptOptions& adapt = {},
                    const Execution& execution = {});

/// Adapts a mesh as above, but the result follows the complex that the mesh was made of, and is certified
/// against it: `complex`, not the triangles of the mesh, determines where nodes are inserted, where they
/// move, and how far faces may be off. If `options.exact` is the geometry behind the complex (`adapt` may set
/// it), nodes are moved onto it. The mesh must have a vertex at each vertex of the complex, and faces and
/// edges that cover its patches and curves. Throws PlcError with the place where they are missing.
RemeshResult remesh(const TetMesh& mesh, const Plc& complex, const PipelineOptions& options = {},
                    const AdaptOptions& adapt = {}, const Execution& execution = {});

}  // namespace collarmesh
