#pragma once

#include "collarmesh/mesher.h"
#include "predict/shape.h"

namespace collarmesh::prediction {

/// The fitted coefficients of predictions (bench/predicted_elements.py). Lengths are in target edge lengths.
struct Model {
  double edge = 1.04;          ///< length of an edge on a curve
  double area = 0.65;          ///< of a patch to a vertex
  double volume = 0.61;        ///< of a region to a vertex
  double growth = 2;           ///< of edges per unit length, away from small ones
  double asked_growth = 1;     ///< the same, away from curves with sizes of their own
  double chord = 1.15;         ///< the share of the distance tolerance that chords are off
  double aspect = 3;           ///< the largest ratio of edges along and across a curved patch
  double wall = 8.7;           ///< the largest ratio of edges to the width of a wall
  double strip = 7;            ///< the same of edges on curves to the width of a strip of surface
  double border_from = 0.4;    ///< no vertex on a patch is nearer to its border
  double border_to = 0.8;      ///< vertices on a patch are as dense beyond as far away from the border
  double depth_from = 0.3;     ///< the same inside regions
  double depth_to = 0.75;      ///< the same inside regions
  double tets_per_vertex = 6;  ///< that is inside; 24 tets meet there and have four corners each
};

/// Returns the model of the mesh before it is coarsened: bounds on radius-edge ratios make tets as small as
/// walls and strips.
inline Model model_of_refinement() {
  Model model;
  model.wall = model.strip = 1.2;
  model.growth = 0.8;
  model.edge = 1.08;
  return model;
}

/// The tets of the mesh that will be: by its vertices, and the share of the directions around each that lead
/// into regions. Infinite where a double cannot hold
/// it. Cost: grows with the mesh, up to a bound that is linear in the complex.
double count_tets(const Shape& shape, const MeshOptions& options, const Model& model = {});

}  // namespace collarmesh::prediction
