#pragma once

#include "collarmesh/mesher.h"
#include "collarmesh/plc.h"

namespace collarmesh::prediction {

/// What the predictions were fitted to, see bench/predicted_elements.py. Lengths are in target edge lengths.
struct Model {
  double edge = 1;             ///< of an edge on a curve
  double area = 0.85;          ///< of a patch to a vertex
  double volume = 0.75;        ///< of a region to a vertex
  double growth = 0.7;         ///< of edges per unit length, away from small ones
  double chord = 1;            ///< the share of the distance tolerance that chords are off
  double aspect = 3;           ///< most of the lengths along and across a curved patch
  double wall = 8.7;           ///< most of the edge lengths on a wall to its width
  double strip = 7;            ///< the same on curves, to the width of a strip of surface
  double border_from = 0.5;    ///< no vertex on a patch is nearer to its border
  double border_to = 0.9;      ///< nothing is missing beyond
  double depth_from = 0.4;     ///< the same inside regions
  double depth_to = 0.9;
  double tets_per_vertex = 6;  ///< that is inside
};

/// Of the mesh that will be; `tets` by the share of the directions around each vertex that lead into regions.
struct VertexCounts {
  double on_vertices = 0, on_curves = 0, on_patches = 0, inside = 0;
  double tets = 0;
};

/// `options.distance` is that of the mesh.
VertexCounts count_vertices(const Plc& plc, const MeshOptions& options, const Model& model);

}  // namespace collarmesh::prediction
