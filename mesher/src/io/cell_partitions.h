#pragma once

#include <vector>

#include "collarmesh/tet_mesh.h"

/// The partitions of faces, edges and points of a partitioned mesh: each belongs to the lowest partition of
/// the tets around it or, if it is at no tet, to the lowest of all. Cost: linear.
namespace collarmesh::io {

/// Partition numbers read from files must be below this: formats have 32 bits for them, and some count from
/// 1.
constexpr Index most_partitions = 0x7fffffff;

std::vector<Index> partitions_of_faces(const TetMesh& mesh);
std::vector<Index> partitions_of_edges(const TetMesh& mesh);
/// Returns the partitions of points, including mid-edge nodes.
std::vector<Index> partitions_of_points(const TetMesh& mesh);

/// Returns the numbers of the partitions that have tets, ascending.
std::vector<Index> partition_numbers(const TetMesh& mesh);

/// Returns for each partition, in the order of `partition_numbers`, the tets of other partitions that share a
/// vertex with one of its tets, ascending.
std::vector<std::vector<Index>> ghost_tets(const TetMesh& mesh);

}  // namespace collarmesh::io
