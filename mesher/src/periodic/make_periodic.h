#pragma once

#include <vector>

#include "collarmesh/periodic.h"

namespace collarmesh::periodicity {

/// Adds nodes to a mesh at the places of the nodes that the first group of each pair has in `source`, another
/// mesh of the same complex, and at the images of these places. Returns them. `targets`: target edge length
/// at every vertex of the source if it is only refined (see `sparse_nodes`), else empty.
std::vector<Index> add_periodic_nodes(TetMesh& mesh, const TetMesh& source, const Plc& plc,
                                      const PeriodicOptions& options, double distance,
                                      const std::vector<double>& targets);

}  // namespace collarmesh::periodicity
