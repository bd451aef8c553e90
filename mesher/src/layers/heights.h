#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "layers/curving.h"
#include "layers/front.h"
#include "remesh/smooth_surfaces.h"

namespace collarmesh::layering {

/// The reason why layers are lower than asked for.
enum class Cause : std::uint8_t { none, ends, direction, patch, gap, fold, core, step, count };
std::string text_of(Cause cause);

/// The distances by which a front's nodes are pushed along their directions.
class Heights {
 public:
  /// Sets the distances that the options ask for, and 0 where there can be no layers. Keeps references to all
  /// arguments.
  Heights(const Front& front, const TetMesh& mesh, const Plc& plc, const WallChoice& walls);

  std::size_t size() const { return length_.size(); }
  /// Returns the distance along the direction; 0: no layers.
  double operator[](Index node) const { return length_[node]; }
  /// Returns the distance that is asked for.
  double asked(Index node) const { return asked_[node]; }
  /// Return the height of all layers above the wall: the one asked for, and the one reached.
  double asked_height(Index node) const { return asked_height_[node]; }
  double height(Index node) const;
  Cause cause(Index node) const { return cause_[node]; }
  bool is_lower(Index node) const;
  const WallLayers& layers(Index node) const { return *walls_at_[node]; }

  /// Returns the place of a node when it is pushed by this distance.
  Point place(Index node, double distance) const;
  Point place(Index node) const { return place(node, length_[node]); }

  /// Copies the distances, and the causes, of other heights of the same front.
  void take(const Heights& others) {
    length_ = others.length_;
    cause_ = others.cause_;
  }
  /// Reduces the distance by which a node is pushed to at most `to`; to 0 if too little would be left.
  void lower(Index node, double to, Cause cause);
  /// Lowers distances in gaps, so that the layers on both sides leave a part of each gap to the tets between
  /// them.
  void fit_gaps();
  /// Lowers distances where nodes would leave the tolerance of a curved patch on which they slide.
  void fit_patches(const remeshing::SmoothSurfaces& surfaces, const SurfaceTolerance& tolerance);
  /// Leaves layers out where edges of the wall bulge into them by more than a share of their height.
  void fit_bulges(const Bulges& bulges);
  /// Lowers distances where cells would fold, and where neighbours have less than half the height. Returns
  /// whether it lowered any.
  bool settle();
  /// Returns the largest ratio of neighbours' heights.
  double largest_step() const;

 private:
  void ask();
  bool unfold(bool strictly);
  bool limit_steps();
  double relative_jacobian(const WallSide& side) const;

  const Front& front_;
  const TetMesh& mesh_;
  const Plc& plc_;
  const WallChoice& walls_;
  std::vector<double> length_, asked_, asked_height_;
  std::vector<double> possible_;  // the distance asked for, or less where gaps allow less
  std::vector<Cause> cause_;
  std::vector<const WallLayers*> walls_at_;
};

}  // namespace collarmesh::layering
