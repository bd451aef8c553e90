#pragma once

#include <array>
#include <vector>

#include "layers/core.h"
#include "layers/curving.h"

namespace collarmesh::layering {

/// A builder of the mesh of a core and the layers between it and the walls.
class Stack {
 public:
  /// Keeps references to all arguments but `tets`. `given`: the mesh without layers. `tets`: whether to
  /// divide prisms and pyramids into tets.
  Stack(const TetMesh& given, const Front& front, const Heights& heights, const Core& core, bool tets);

  TetMesh build();
  /// Returns the places of the built mesh's points.
  const PlacesInLayers& places() const { return places_; }

 private:
  void number_nodes();
  void take_core();
  void take_walls();
  void fill(const WallSide& side);
  void close(Index side, unsigned corner);
  void extend_curves();
  void drop_unused_points();
  Index node(Index of, unsigned layer) const;
  bool is_before(Index node, Index other) const {
    return front_.nodes[node].vertex < front_.nodes[other].vertex;
  }
  bool is_raised(Index node) const { return heights_[node] > 0; }
  void add_tet(std::array<Index, 4> corners, const WallSide& side, unsigned layer);
  void add_prism(const std::array<Index, 6>& corners, const WallSide& side, unsigned layer);
  void add_pyramid(const std::array<Index, 5>& corners, bool from_first, const WallSide& side,
                   unsigned layer);
  void divide_prism(const WallSide& side, unsigned layer);
  void add_face(const std::array<Index, 3>& corners, Index like, Index from, Index to, bool outwards);
  Tag tag_of(Index region) const { return region < tag_of_region_.size() ? tag_of_region_[region] : 0; }

  const TetMesh& given_;
  const Front& front_;
  const Heights& heights_;
  const Core& core_;
  bool tets_;
  TetMesh mesh_;
  std::vector<Index> first_inner_;  // by node of the front: its node above the first layer, or none
  std::vector<Index> merged_;       // by vertex of the core: its number in the mesh
  PlacesInLayers places_;
  std::vector<Tag> tag_of_region_;
};

}  // namespace collarmesh::layering
