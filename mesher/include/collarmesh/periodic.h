#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

/// Periodic faces, for periodic boundary conditions: pairs of groups of patches. One group is the image of
/// the other, and so is its mesh.
namespace collarmesh {

struct PeriodicOptions {
  /// The pairs. Each is an axis, or two groups of patches and the motion that takes the first to the second:
  /// - "x", "y" or "z": the planar patches at the low and the high end of the shape along that axis;
  /// - "A=B" or "A=B:translation": names or numbers of patches, several with commas between them; the
  ///   translation takes the middle of the first group's box to that of the second's;
  /// - "A=B:translation,DX,DY,DZ": that translation;
  /// - "A=B:rotation,AXIS,DEGREES": about the x, y or z axis;
  /// - "A=B:rotation,PX,PY,PZ,DX,DY,DZ,DEGREES": about the axis through a point with a direction.
  std::vector<std::string> pairs = {};

  bool any() const { return !pairs.empty(); }
};

/// The result for all pairs.
struct PeriodicReport {
  /// The result for one pair.
  struct Pair {
    std::string text;        ///< the pair as the option gives it
    std::size_t nodes = 0;   ///< nodes on the first group, including mid-edge nodes
    std::size_t edges = 0;   ///< edges on curves of the first group
    std::size_t faces = 0;   ///< triangles of the first group
    double largest_gap = 0;  ///< largest distance between a node's image and the node that it maps to,
                             ///< absolute
  };
  std::vector<Pair> pairs;
  std::size_t inserted_nodes = 0;  ///< nodes inserted to give each group the nodes of the other
  std::size_t removed_nodes = 0;   ///< nodes removed because only one group had them
  std::size_t turned_edges = 0;
};

/// Throws OptionError if a pair cannot be read, a name is unknown, or the patches are not images of each
/// other. Curves that are not straight may be off their images by `distance` (input units). The message names
/// a feature without an image and, for a vertex or curve, the distance to the nearest candidate.
void require_periodic_patches(const PeriodicOptions& options, const Plc& plc, double distance);

/// Changes both groups of each pair so that the nodes, edges and triangles of the second are images of those
/// of the first. The tets beside them may have poor shapes. Sets `mesh.periodic`, except for its nodes.
/// Preconditions: patches of these groups are planar and have a region on one side only. Throws OptionError
/// as `require_periodic_patches` does.
PeriodicReport make_periodic(TetMesh& mesh, const Plc& plc, const PeriodicOptions& options, double distance);

}  // namespace collarmesh
