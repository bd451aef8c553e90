#pragma once

#include <cstddef>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// How evenly the tets are divided, and how much the parts have to tell each other.
struct PartitionMeasures {
  std::size_t partitions = 0;             ///< that have tets; 0: the mesh is not partitioned
  std::size_t smallest = 0, largest = 0;  ///< tets of one
  double imbalance = 0;                   ///< of the largest: its tets / their mean - 1
  std::size_t cut_faces = 0;              ///< triangles between tets of two partitions
};

/// Cost: linear.
PartitionMeasures measure_partitions(const TetMesh& mesh);

/// Throws OptionError, saying what to install, where the library that partitions (Scotch) is not there.
void require_partitioner();

/// Divide the tets among ranks: `TetMesh::tet_partition`. Of the graph of tets that share a face few edges
/// are cut. No partition is empty, and none has more tets than 1.03 times the mean, or the mean rounded up.
/// The same mesh is divided alike on any machine and by any number of threads. Throws OptionError unless
/// there are 1 to as many partitions as tets, and as `require_partitioner` does. Cost: n log(partitions), and
/// for each tet that Scotch gives to a partition beyond that bound, which are few, at worst n; 200 bytes per
/// tet for a while.
void partition(TetMesh& mesh, unsigned partitions);

}  // namespace collarmesh
