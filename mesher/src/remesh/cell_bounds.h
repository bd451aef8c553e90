#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "collarmesh/bounds.h"
#include "remesh/thin_shape.h"
#include "tolerance/narrow_places.h"

namespace collarmesh::remeshing {

/// The vertices of a mesh that lie on creases of the complex. The cells that touch them are the collars of a
/// coarsened mesh.
class CreaseCells {
 public:
  /// Finds these vertices by their features. Vertices added to the mesh later count as not on creases.
  CreaseCells(const Plc& plc, const std::vector<TetMesh::VertexFeature>& features, double crease_angle);

  bool touch(const std::array<Index, 4>& corners) const {
    return any_ && std::ranges::any_of(corners, [this](Index v) { return at(v); });
  }
  bool at(Index vertex) const { return any_ && vertex < on_crease_.size() && on_crease_[vertex] != 0; }
  bool is_crease(Index curve) const { return curve != none && is_crease_[curve]; }
  bool any() const { return any_; }

 private:
  std::vector<bool> is_crease_;          // by curve
  std::vector<std::uint8_t> on_crease_;  // by mesh vertex
  bool any_ = false;
};

/// Stands for a vertex that will be inserted on a patch, or on a curve of a patch.
inline constexpr Index inserted_on_surface = none - 1;

/// Bounds that hold only at some places of a coarsened mesh: the largest dihedral angle of cells that touch a
/// crease; on request, that cells elsewhere exceed the radius-edge bound only in narrow places, and that each
/// tet has an interior node. The bounds on thin tets are in `ThinShape`.
class CellBounds {
 public:
  /// Shape rules multiply the quality of a tet that `allow` forbids by this, so that any permitted tet is
  /// better.
  static constexpr double forbidden = 1e-3;

  /// Keeps the mesh by reference if each tet needs an interior node.
  CellBounds(const Plc& plc, const TetMesh& mesh, const Bounds& bounds);

  /// Returns whether a tet with these corners may be made. With default options, tets that keep the bounds on
  /// thin tets (`ThinShape`) are always allowed.
  bool allow(const Corners& p, const std::array<Index, 4>& corners) const {
    if (lacks_interior_node(corners)) return false;
    if (creases_.touch(corners)) return dihedral_cosines(p).largest_angle >= cosine_;
    return !narrow_ || ratio_holds(p) || narrow_->contain(p, corners);
  }
  /// Returns whether `allow` may forbid tets that keep the bounds on thin tets.
  bool forbid_thin_tets() const { return narrow_.has_value() || tight_ || mesh_ != nullptr; }
  /// Returns whether each tet needs an interior node and this one has none: all its corners lie on surfaces.
  bool lacks_interior_node(const std::array<Index, 4>& corners) const {
    return mesh_ != nullptr && std::ranges::all_of(corners, [this](Index v) { return on_surface(v); });
  }

 private:
  bool on_surface(Index vertex) const {
    if (vertex == inserted_on_surface) return true;
    if (vertex == none) return false;  // the vertex will be inserted inside a region
    const auto& [dimension, feature] = mesh_->features[vertex];
    if (dimension >= 2 || feature == none) return dimension < 3;
    return dimension == 1 ? curve_on_surface_[feature] : vertex_on_surface_[feature];
  }
  bool ratio_holds(const Corners& p) const {
    const Circumsphere sphere = circumsphere(p);
    return sphere.squared_radius <= squared_ratio_ * sphere.shortest_squared_edge;
  }

  CreaseCells creases_;
  double cosine_;  // signed squared cosine of the largest angle at creases
  bool tight_;     // whether the largest angle at creases is below that of thin tets
  double squared_ratio_;
  std::optional<NarrowPlaces> narrow_;                      // nothing if tets may be thin anywhere
  const TetMesh* mesh_ = nullptr;                           // null unless each tet needs an interior node
  std::vector<bool> curve_on_surface_, vertex_on_surface_;  // by curve or vertex of the complex; empty unless
                                                            // each tet needs an interior node
};

/// All bounds on the tets of a mesh except the radius-edge bound.
struct TetBounds {
  ThinShape thin;
  CellBounds cells;
};

/// Marks the cells that touch a crease as its collar (in `tet_collar`: 2 if they have an edge on it, else 1),
/// and then thin tets. In a mesh with collar balls, the existing marks of collars stay.
void mark_cells(TetMesh& mesh, const Plc& plc, const Bounds& bounds);

}  // namespace collarmesh::remeshing
