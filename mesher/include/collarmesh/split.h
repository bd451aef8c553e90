#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// How a solver joins the two sides of a split patch.
enum class Interaction { free, tie, contact };

/// The tags of the two sides of a split patch, whose nodes coincide: minus is behind its triangles, plus in
/// front of them.
struct Sides {
  Tag minus = 0, plus = 0;
};

/// Elements and conditions between the sides of split patches.
struct Interfaces {
  std::vector<Sides> sides;
  Interaction interaction = Interaction::free;
  /// Cohesive elements: corners a, b, c of a triangle of the minus side, counterclockwise as seen from the
  /// plus side, then the corners at the same places on the plus side.
  std::vector<std::array<Index, 6>> prisms;
  /// In second order: the mid-edge nodes of ab, bc, ca, then those on the plus side; the edges between the
  /// sides have none.
  std::vector<std::array<Index, 6>> prism_mid_nodes;
  std::vector<Tag> prism_tag;  ///< tag of the minus side
};

struct SplitOptions {
  std::vector<std::string> patches = {};        ///< names or numbers of internal patches
  bool keep_apart = false;                      ///< split all patches between two regions
  Interaction interaction = Interaction::free;  ///< the condition between the sides, for formats that can
                                                ///< express it
  bool cohesive = false;                        ///< make prisms of zero thickness between the sides

  bool any() const { return keep_apart || !patches.empty(); }
};

struct SplitReport {
  /// A patch that was cut open.
  struct Patch {
    Tag tag = 0;             ///< tag before the cut
    std::string name;        ///< name before the cut; "patch_7" if it had none
    Sides sides;             ///< both 0 if no triangle could be opened
    std::size_t faces = 0;   ///< triangles on each side
    double area = 0;         ///< area of the opened triangles, taken as straight, absolute
    double largest = 0;      ///< area of the largest opened triangle
    Point where;             ///< the middle of that triangle
    std::size_t closed = 0;  ///< triangles that stay closed, because all their corners are on the cut's front
    Point closed_at;         ///< the middle of a closed triangle
  };
  std::vector<Patch> patches;      ///< sorted by tag
  std::size_t split_nodes = 0;     ///< nodes that have copies now
  std::size_t junction_nodes = 0;  ///< split nodes with two or more copies
  std::size_t new_nodes = 0;       ///< number of copies
  std::size_t front_nodes = 0;     ///< nodes of the split patches that have no copies
  Interfaces interfaces;
};

/// Throws OptionError, with the known names, if an internal patch to be split does not exist.
void require_known_patches(const SplitOptions& options, const Plc& plc);

/// Gives the tets on both sides of internal patches separate nodes. The split triangles at a node divide its
/// tets into sectors. The first sector keeps the node; each other sector gets a copy. So cracks stay closed
/// along their fronts, open at mouths on the boundary, and have a node for each sector at junctions. The same
/// holds for mid-edge nodes. Triangles with all their corners on a front cannot open and stay as they are.
/// Each side becomes a boundary. The side behind the triangles (at interfaces, the side of the region with
/// the smaller index) keeps their tag, unless other triangles have it, too; the side in front gets a new tag.
/// The names of the sides are the patch's name with `_minus` and `_plus`. New nodes follow all others; tets
/// keep their order; copies of faces and edges follow all others. Throws OptionError as
/// `require_known_patches` does. Cost: linear, and n log n in the tets at split triangles.
SplitReport split(TetMesh& mesh, const SplitOptions& options);

}  // namespace collarmesh
