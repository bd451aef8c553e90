#pragma once

#include <vector>

#include "collarmesh/tet_mesh.h"

/// Which partition the other cells of a partitioned mesh belong to: that with the lowest number of the tets
/// they are sides of; the lowest of all for what is no side of a tet. Cost: linear.
namespace collarmesh::io {

/// Numbers of partitions that are read are below this: formats have 32 bits for them, and some count from 1.
constexpr Index most_partitions = 0x7fffffff;

std::vector<Index> partitions_of_faces(const TetMesh& mesh);
std::vector<Index> partitions_of_edges(const TetMesh& mesh);
/// The same for nodes, those amid edges included.
std::vector<Index> partitions_of_points(const TetMesh& mesh);

/// The numbers of the partitions that have tets, ascending.
std::vector<Index> partition_numbers(const TetMesh& mesh);

/// Returns for each partition, in the order of `partition_numbers`, the tets of others that share a vertex
/// with one of its tets, ascending.
std::vector<std::vector<Index>> ghost_tets(const TetMesh& mesh);

}  // namespace collarmesh::io
