#pragma once

#include <map>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/split.h"
#include "collarmesh/tet_mesh.h"

/// Further names of guarantees, for patches that were split.
namespace collarmesh::guarantee {

inline constexpr char split_nodes[] = "split_nodes";      ///< nodes coincide at split triangles only
inline constexpr char split_sectors[] = "split_sectors";  ///< no node joins tets that split patches separate
inline constexpr char split_pairs[] = "split_pairs";  ///< each triangle of one side coincides with one of the
                                                      ///< other side
inline constexpr char split_measures[] = "split_measures";  ///< volumes and areas are those before the split

}  // namespace collarmesh::guarantee

namespace collarmesh::checks {

/// Sums that a split must not change, apart from rounding.
struct SplitMeasures {
  std::map<Index, double> volumes;  ///< by region, of straight tets
  std::map<Index, double> areas;    ///< by patch, of straight triangles, each place counted once
};

/// Measures a mesh before anything is split.
SplitMeasures measure_before_split(const TetMesh& mesh);

/// Checks a mesh with split patches, by positions and tets alone: only nodes of split triangles share a
/// place; the tets at each such node are connected through common sides; each split triangle belongs to
/// exactly one tet, and coincides with one triangle of the other side, of opposite orientation; volumes and
/// areas are those before the split. Adds findings.
void check_split(const TetMesh& mesh, const std::vector<Sides>& sides, const SplitMeasures& before,
                 CheckReport& report);

}  // namespace collarmesh::checks
