#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh {

/// Cells of boundary layers other than tets, with the quadrangles at their sides. They conform to the tets
/// and triangles of a mesh, whose points they use. Arrays of a kind of cell have the same length.
struct LayerCells {
  /// Corners of a prism: a, b, c of the triangle that lies on the wall or is nearer to it, then d, e, f above
  /// them. (b-a) x (c-a) points to the side of d, e, f.
  std::vector<std::array<Index, 6>> prisms;
  std::vector<Index> prism_region;         ///< index of the region in the complex, from 1
  std::vector<Tag> prism_tag;              ///< tag of that region
  std::vector<std::uint16_t> prism_layer;  ///< number of the layer, from 1 at the wall

  /// Corners of a pyramid: a, b, c, d of its base, counterclockwise as seen from the apex, with d above a and
  /// c above b; then the apex e.
  std::vector<std::array<Index, 5>> pyramids;
  std::vector<Index> pyramid_region;
  std::vector<Tag> pyramid_tag;
  std::vector<std::uint16_t> pyramid_layer;

  /// Boundary, interface and internal-facet quadrangles a, b, c, d: sides of prisms, bases of pyramids. The
  /// normal points from quad_regions[0] to quad_regions[1], as that of the mesh's faces.
  std::vector<std::array<Index, 4>> quads;
  std::vector<std::array<Index, 2>> quad_regions;
  std::vector<Index> quad_patch;  ///< index of the patch in the complex, none when unknown
  std::vector<Tag> quad_tag;      ///< tag of that patch

  /// Mid-edge nodes; empty in first order. Their edges are, for a prism, ab, bc, ca, de, ef, fd, ad, be, cf;
  /// for a pyramid ab, bc, cd, da, ae, be, ce, de; for a quadrangle ab, bc, cd, da.
  std::vector<std::array<Index, 9>> prism_mid_nodes;
  std::vector<std::array<Index, 8>> pyramid_mid_nodes;
  std::vector<std::array<Index, 4>> quad_mid_nodes;

  /// By tet of the mesh: the number of its layer, from 1 at the wall; 0 for tets of no layer. Empty: no tet
  /// is in a layer. The last corner of a tet in a layer lies above the first one.
  std::vector<std::uint16_t> tet_layer;

  bool empty() const { return prisms.empty() && pyramids.empty() && tet_layer.empty(); }
};

}  // namespace collarmesh
