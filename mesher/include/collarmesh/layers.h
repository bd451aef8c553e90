#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "collarmesh/geometry.h"
#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"

/// Boundary layers: thin cells along walls, in which flow, heat or currents change fast across the wall.
namespace collarmesh {

/// The layers at some faces.
struct WallLayers {
  std::vector<std::string> faces = {};  ///< names or numbers of patches; empty: all boundaries
  double first = 0;      ///< height of the first layer, absolute; 0: a tenth of the edges there
  double growth = 1.2;   ///< ratio of the heights of a layer and the one before it, at least 1
  unsigned count = 3;    ///< number of layers, at least 1
  double thickness = 0;  ///< height of all layers, absolute, in place of `first`; 0: not given
};

struct LayerOptions {
  /// Each is "FACES" or "FACES:first=F,growth=G,count=N" or "FACES:thickness=T,...", FACES names or numbers
  /// of patches with commas between them, or "all".
  std::vector<std::string> walls = {};
  bool tets = false;  ///< divide the prisms and pyramids into tets

  bool any() const { return !walls.empty(); }
};

/// The result of layers at one group of faces.
struct LayersReport {
  /// A place where layers are lower than asked for.
  struct Reduction {
    std::string why;        ///< the reason
    std::size_t nodes = 0;  ///< nodes on the wall with it
    double smallest = 1;    ///< smallest share of the height that is left
    Point where;            ///< the place of it
  };
  struct Patch {
    Tag tag = 0;
    std::string name;
    double area = 0;     ///< of the wall, absolute
    double covered = 0;  ///< of that, beside cells of all layers, absolute
    double asked = 0;    ///< height of all layers, absolute
    double mean = 0;     ///< mean height reached, by area
    /// Area by reached share of the height: of tenth i from 0.1 i to 0.1 (i + 1).
    std::array<double, 10> histogram{};
  };
  std::vector<Patch> patches;
  std::vector<Reduction> reductions;
  std::size_t prisms = 0, pyramids = 0, tets = 0;  ///< cells in the layers
  double seconds = 0;

  /// Returns the share of the walls' area beside cells of all layers, 0 to 1.
  double coverage() const;
};

}  // namespace collarmesh
