#pragma once

#include <cmath>
#include <memory>

#include "collarmesh/mesher.h"
#include "predict/shape.h"

namespace collarmesh::prediction {

/// The fitted coefficients of predictions (bench/predicted_elements.py). Unit of length: the target edge
/// length.
struct Model {
  double edge = 1.04;          ///< length of an edge on a curve
  double area = 0.65;          ///< area of a patch per vertex
  double volume = 0.61;        ///< volume of a region per vertex
  double growth = 2;           ///< growth of edges per unit length, away from short edges
  double asked_growth = 1;     ///< growth per unit length away from curves with sizes of their own
  double chord = 1.15;         ///< deviation of chords, relative to the distance tolerance
  double aspect = 3;           ///< largest ratio of edge lengths along and across the bend of a patch
  double wall = 8.7;           ///< largest ratio of edge lengths to the width of a wall
  double strip = 7;            ///< largest ratio of edge lengths on curves to the width of a strip of surface
  double border_from = 0.4;    ///< least distance of vertices on a patch from its border
  double border_to = 0.8;      ///< distance from the border at which vertices on a patch reach full density
  double depth_from = 0.3;     ///< the same as border_from, for regions
  double depth_to = 0.75;      ///< the same as border_to, for regions
  double tets_per_vertex = 6;  ///< for a vertex inside a region: 24 tets meet there, and each has four
                               ///< corners
};

/// Returns the model of the mesh before it is coarsened, where the bound on radius-edge ratios keeps
/// edges about as short as walls are thick and strips are wide.
inline Model model_of_refinement() {
  Model model;
  model.wall = model.strip = 1.2;
  model.growth = 0.8;
  model.edge = 1.08;
  return model;
}

/// A counter that predicts the number of tets from the number of vertices and the share of directions around
/// each that lead into regions. Cost: grows with the mesh, up to a bound that is linear in the complex.
class TetCounter {
 public:
  /// Keeps references to the shape and to the options.
  TetCounter(const Shape& shape, const MeshOptions& options, const Model& model = {});
  ~TetCounter();
  TetCounter(const TetCounter&) = delete;
  TetCounter& operator=(const TetCounter&) = delete;
  /// Goes on where the last call ended. Stops as soon as it has counted `enough` tets, which is all that many
  /// callers need. Returns the number so far; infinite if a double cannot hold it.
  double count_up_to(double enough);

 private:
  class Counter;
  std::unique_ptr<Counter> counter_;
};

/// Predicts the number of tets.
double count_tets(const Shape& shape, const MeshOptions& options, const Model& model = {},
                  double enough = INFINITY);

}  // namespace collarmesh::prediction
