#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/improve.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/second_order.h"
#include "collarmesh/tet_mesh.h"

/// Boundary layers: thin cells along walls, in which flow, heat or currents change fast across the wall.
namespace collarmesh {

/// The layers at some faces.
struct WallLayers {
  std::vector<std::string> faces = {};  ///< names or numbers of patches; empty: all boundaries
  double first = 0;      ///< height of the first layer, absolute; 0: a tenth of the edge length there
  double growth = 1.2;   ///< ratio of the heights of a layer and the one before it, at least 1
  unsigned count = 3;    ///< number of layers, at least 1
  double thickness = 0;  ///< total height of the layers, absolute, in place of `first`; 0: not given
};

struct LayerOptions {
  /// One text for each group of walls: "FACES", "FACES:first=F,growth=G,count=N,region=R" or
  /// "FACES:thickness=T,...". FACES are names or numbers of patches with commas between them, or "all"; only
  /// region R gets layers.
  std::vector<std::string> walls = {};
  bool tets = false;  ///< divide the prisms and pyramids into tets

  bool any() const { return !walls.empty(); }
};

/// The result of layers at one group of faces.
struct LayersReport {
  /// A reason why layers are lower than asked for, and where.
  struct Reduction {
    std::string why;        ///< the reason
    std::size_t nodes = 0;  ///< nodes of the wall that this reason concerns
    double smallest = 1;    ///< smallest height there, as a share of the height asked for
    Point where;            ///< the node with that share
  };
  struct Patch {
    Tag tag = 0;
    std::string name;
    double area = 0;     ///< area of the wall, absolute
    double covered = 0;  ///< part of that area that all layers cover, absolute
    double asked = 0;    ///< total height asked for, absolute
    double mean = 0;     ///< mean of the total height reached, weighted by area, absolute
    /// Histogram over the wall's area: entry i is the area where layers reach 0.1 i to 0.1 (i + 1) of the
    /// height asked for.
    std::array<double, 10> histogram{};
  };
  std::vector<Patch> patches;
  std::vector<Reduction> reductions;
  std::size_t prisms = 0, pyramids = 0, tets = 0;  ///< cells in the layers
  /// For each corner node in the layers, the wall's node below it (on a wall: itself); none elsewhere.
  std::vector<Index> walls;
  double largest_step = 1;  ///< largest ratio of the total heights at two neighbouring nodes that both have
                            ///< layers
  double seconds = 0;
  bool cancelled = false;

  /// Returns the share of the walls' area that all layers cover, 0 to 1.
  double coverage() const;
};

/// Reads the walls that the options name: returns one for each text. Throws OptionError for text that cannot
/// be read.
std::vector<WallLayers> read_walls(const LayerOptions& options);

/// Throws OptionError, with the known names, if a wall does not exist or two texts name one wall.
void require_known_walls(const LayerOptions& options, const Plc& plc);

/// Puts layers of prisms on walls: on the inner side of boundaries, on one or both sides of interfaces, and
/// on both sides of facets inside regions. The tets there are pushed inwards and improved; the triangles and
/// edges of the walls stay. Nodes that also lie on other patches slide along these.
///
/// Layers are lower where there is little room: in gaps, where prisms would fold, and where tets would miss
/// their bounds (`improvement.bounds`). Heights of neighbours with layers differ by at most a factor of 2.
/// Heights are 0 at nodes where no direction along the patches without layers leads away from all walls, for
/// instance where such a patch continues a wall. There, prisms become pyramids and tets. In second order the
/// edges of walls keep their nodes, and their bulges fade towards the tets. Precondition: `mesh` comes from
/// `generate` for `plc`. Same mesh and options: same result, with any number of threads. If cancelled, the
/// mesh has first order and no layers. Throws OptionError as `require_known_walls` does. Cost: near linear in
/// the tets.
LayersReport make_layers(TetMesh& mesh, const Plc& plc, const LayerOptions& options,
                         const ImproveOptions& improvement, const SecondOrderOptions& second_order = {},
                         const Execution& execution = {});

}  // namespace collarmesh
