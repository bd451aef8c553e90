#include <algorithm>
#include <unordered_map>

#include "collarmesh/partition.h"
#include "partition/shared_faces.h"

namespace collarmesh {

PartitionMeasures measure_partitions(const TetMesh& mesh) {
  PartitionMeasures measures;
  const std::vector<Index>& partition_of = mesh.tet_partition;
  if (partition_of.empty()) return measures;
  std::unordered_map<Index, std::size_t> tets;  // numbers read from a file may have gaps
  for (const Index partition : partition_of) ++tets[partition];
  measures.partitions = tets.size();
  measures.smallest = partition_of.size();
  for (const auto& each : tets) {
    measures.smallest = std::min(measures.smallest, each.second);
    measures.largest = std::max(measures.largest, each.second);
  }
  measures.imbalance = static_cast<double>(measures.largest) * static_cast<double>(tets.size()) /
                           static_cast<double>(partition_of.size()) -
                       1;
  for_each_shared_face(
      mesh, [&](Index t, Index u) { measures.cut_faces += partition_of[t] != partition_of[u] ? 1 : 0; });
  return measures;
}

}  // namespace collarmesh
