#pragma once

#include <cstddef>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// Whether the file of each partition also has the tets of other partitions that share a vertex with it.
enum class GhostCells { off, one_layer };

/// The balance of a partition and the size of the interfaces between its parts.
struct PartitionMeasures {
  std::size_t partitions = 0;             ///< number of partitions that have tets; 0: the mesh is not
                                          ///< partitioned
  std::size_t smallest = 0, largest = 0;  ///< number of tets in the smallest and the largest partition
  double imbalance = 0;                   ///< tets of the largest partition divided by the mean, minus 1
  std::size_t cut_faces = 0;              ///< triangles between tets of two partitions
};

/// Measures the partition of a mesh. Cost: linear.
PartitionMeasures measure_partitions(const TetMesh& mesh);

/// Throws OptionError, with the package to install, if the library that partitions (Scotch) is missing.
void require_partitioner();

/// Divides the tets among ranks (`TetMesh::tet_partition`), so that few faces lie between two partitions. No
/// partition is empty, and none has more tets than 1.03 times the mean or, if that is more, the mean rounded
/// up. The result is the same on any machine and with any number of threads. Throws OptionError unless
/// `partitions` is from 1 to the number of tets, and as `require_partitioner` does. Cost: n log(partitions)
/// for n tets, and at worst another n for each of the few tets by which Scotch exceeds that bound. Memory:
/// temporarily 200 bytes per tet.
void partition(TetMesh& mesh, unsigned partitions);

}  // namespace collarmesh
