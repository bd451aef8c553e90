#pragma once

#include <cstddef>

#include "collarmesh/bounds.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// Operations that `improve` may use, and its goals.
struct ImproveOptions {
  double min_dihedral = 20;  ///< degrees; improve tets with a smaller dihedral angle, or with an obtuse angle
                             ///< that counts as smaller (see `improve`)
  Bounds bounds = {};        ///< bounds that no new tet breaks
  double thin_above = 0;  ///< radius-edge ratio above which later stages call tets thin; 0: the bound on the
                          ///< ratio
  bool move_vertices = true;  ///< also move, insert and remove vertices instead of only changing connections
  /// Near thin tets, improve poor tets without inserting or removing vertices, because a coarsened mesh has
  /// as few vertices as it needs. This does not hold for tets with an angle above the upper bound for thin
  /// tets.
  bool keep_vertices = false;
  double edges_per_hole = 0;  ///< as MeshOptions::edges_per_hole
  unsigned passes = 3;        ///< maximum number of passes, each over the tets that are still poor
  unsigned threads = 0;       ///< maximum number of threads; 0: all cores. The result does not depend on it
};

/// Returns the options of a level: 1 only changes connections, for tets with angles below 15 degrees; 2 is
/// the default; 3 improves tets up to 30 degrees, in more passes. Throws OptionError for other levels.
ImproveOptions improve_options(unsigned level);

struct ImproveReport {
  std::size_t candidates = 0;  ///< tets worse than `min_dihedral` at the beginning
  std::size_t remaining = 0;   ///< tets worse than `min_dihedral` at the end
  std::size_t edge_removals = 0, boundary_flips = 0, moved_vertices = 0, contracted_edges = 0,
              inserted_vertices = 0;
  /// Number of detours: sequences of operations that first made tets worse and then better, and single
  /// operations that detours made possible. The counts above leave them out.
  std::size_t detours = 0;
  double seconds = 0;
  bool cancelled = false;  ///< the mesh is valid and partly improved
};

/// Removes slivers by hill climbing on the smallest sine of a tet's dihedral angles (obtuse ones count 0.7
/// times, so that 155 degrees is about as bad as 17), worst tets first. The operations: removing edges,
/// inside regions and on patches; moving vertices within their features; collapsing edges, if no new edge is
/// longer than the longest one of the tets that change; inserting vertices on edges (Freitag and
/// Ollivier-Gooch 1997; the edge removal is Klincsek's optimal triangulation of the ring, as in Klingner and
/// Shewchuk 2007, section 2). A sliver with two faces on a smooth patch is removed from its region. For a tet
/// with an angle above the bound for thin tets, also fills the space around two of its edges with new tets,
/// and collapses edges whatever the new lengths.
/// For the few tets that no operation improves, tries an operation that makes tets worse and improves its
/// result; undoes both unless the tets are better afterwards, compared from the worst one up. Apart from
/// these trials, no operation makes the worst tet of its cavity worse. No operation, trials included, touches
/// a collar, leaves the plane of a planar patch, puts faces or edges farther from their smooth patch or curve
/// than `bounds` allow, or makes a tet that may not be thin exceed the radius-edge bound. Preconditions:
/// `mesh` comes from `generate` for `plc`, first order, with the same `Bounds::distance`. Cost: linear in the
/// tets; poor tets cost little if they can reach `min_dihedral`.
ImproveReport improve(TetMesh& mesh, const Plc& plc, const ImproveOptions& options = {},
                      const Execution& execution = {});

}  // namespace collarmesh
