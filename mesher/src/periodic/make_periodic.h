#pragma once

#include <vector>

#include "collarmesh/periodic.h"

namespace collarmesh::periodicity {

/// Adds nodes to a mesh for each pair: at the places that nodes of either group have in `source`, another
/// mesh of the same complex, and at the corresponding places of the other group. Leaves out places that are
/// too near to other places. Returns the nodes. If the source was refined but not coarsened, `targets` has
/// the target edge length at each of its vertices (see `sparse_nodes`), otherwise it is empty.
std::vector<Index> add_periodic_nodes(TetMesh& mesh, const TetMesh& source, const Plc& plc,
                                      const PeriodicOptions& options, double distance,
                                      const std::vector<double>& targets);

}  // namespace collarmesh::periodicity
