#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "collarmesh/second_order.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::layering {

/// The bulges of a mesh's edges: the vectors from their middles to their mid-edge nodes.
class Bulges {
 public:
  Bulges() = default;
  /// Finds the bulges on the boundary of a mesh of second order: those in its lists of faces and edges.
  explicit Bulges(const TetMesh& mesh);

  bool empty() const { return bulges_.empty(); }
  /// Returns the bulge of the edge between two points; zero if it is straight or not on the boundary.
  Vector operator()(Index a, Index b) const;
  /// Returns whether the edge between two points is on the boundary, so that its bulge was found.
  bool knows(Index a, Index b) const;

 private:
  std::vector<std::pair<std::uint64_t, Vector>> bulges_;  // by edge key
};

/// Turns a mesh of second order into one of first order. Precondition: its mid-edge nodes are its last
/// points.
void straighten(TetMesh& mesh);

/// The places of the points of a mesh with layers: the point of the wall below, and the height above it,
/// relative to that of all layers there.
struct PlacesInLayers {
  std::vector<Index> wall;      ///< by point: the point of the wall below it or at it; none elsewhere
  std::vector<Index> given;     ///< the same point by its number in the mesh without layers
  std::vector<double> share;    ///< from 0 on walls to 1 beside the core
  std::vector<bool> is_raised;  ///< by point of a wall: whether there are layers above it
};

struct CurvedLayers {
  SecondOrderReport report;
  /// Points of walls at cells that fold, by their numbers in the mesh without layers.
  std::vector<Index> folded;
};

/// Adds mid-edge nodes to a mesh with layers. Edges of walls keep their bulges, and edges above them get
/// bulges that fade towards the core. The core gets its nodes as any mesh does, but keeps its tets. Where
/// cells would fold, edges above the walls get straighter. Where that is not enough and `may_move_walls` is
/// true, edges of walls get straighter, too, and the report lists their nodes.
CurvedLayers curve(TetMesh& mesh, const Plc& plc, const Bulges& bulges, const PlacesInLayers& places,
                   const SecondOrderOptions& options, const Execution& execution, bool may_move_walls);

}  // namespace collarmesh::layering
