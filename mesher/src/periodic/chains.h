#pragma once

#include <span>
#include <vector>

#include "collarmesh/plc.h"
#include "periodic/cavity.h"
#include "periodic/motions.h"

namespace collarmesh::periodicity {

/// The mesh vertices along a curve, in order. A closed chain does not repeat its first vertex; the chain of a
/// loop at one vertex does.
struct Chain {
  std::vector<Index> nodes;
  bool closed = false;

  std::size_t edges() const { return closed ? nodes.size() : nodes.size() - 1; }
  Index end(std::size_t edge) const { return nodes[(edge + 1) % nodes.size()]; }
};

/// Returns the chains, by curve; empty ones for curves without edges in the mesh.
std::vector<Chain> chains_of(const TetMesh& mesh, const Plc& plc);

/// The numbers of nodes that a change of a chain inserted and removed.
struct ChainChange {
  std::size_t inserted = 0, removed = 0;
  std::vector<Point> stuck;  ///< places of nodes that could not be removed
};

/// Makes the nodes of a curve's chain lie at exactly these places, apart from the nodes at its ends, which
/// stay. Moves nodes that are near a place, inserts new nodes, and removes the rest. Nodes that cannot be
/// removed stay.
ChainChange put_nodes(CavityEditor& editor, Index curve, Chain& chain, std::span<const Point> places);
/// Makes nodes of the chain at these places: moves nodes that are near a place, and inserts new ones. All
/// other nodes stay. Appends the nodes at these places, and those at vertices of the complex, to `nodes`.
ChainChange add_nodes(CavityEditor& editor, Index curve, Chain& chain, std::span<const Point> places,
                      std::vector<Index>& nodes);

/// Returns, for each node of `first`, the node of `second` that is its image under the motion; empty if the
/// numbers of nodes differ. The chains may run in opposite directions.
std::vector<Index> corresponding(const TetMesh& mesh, const Chain& first, const Chain& second,
                                 const Motion& motion);

}  // namespace collarmesh::periodicity
