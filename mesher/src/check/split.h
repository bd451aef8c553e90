#pragma once

#include <map>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/split.h"
#include "collarmesh/tet_mesh.h"

/// Further names of guarantees, those of patches that were split.
namespace collarmesh::guarantee {

inline constexpr char split_nodes[] = "split_nodes";      ///< nodes coincide at split triangles only
inline constexpr char split_sectors[] = "split_sectors";  ///< no node holds two sectors together
inline constexpr char split_pairs[] = "split_pairs";  ///< each triangle of a side faces one of the other side
inline constexpr char split_measures[] = "split_measures";  ///< volumes and areas are those of before

}  // namespace collarmesh::guarantee

namespace collarmesh::checks {

/// The sums that a split leaves as they are, apart from rounding.
struct SplitMeasures {
  std::map<Index, double> volumes;  ///< by region, of straight tets
  std::map<Index, double> areas;    ///< by patch, of straight triangles, one for each place
};

/// Precondition: nothing is split yet.
SplitMeasures measure_before_split(const TetMesh& mesh);

/// Checks a mesh that was split, by positions and by tets alone: nodes at one place are where triangles of
/// two sides lie; the tets at each such node hang together by their sides; each triangle of a side has
/// exactly one tet, and one triangle of the other side at its place, which looks the other way; volumes and
/// areas are those of before. Adds findings.
void check_split(const TetMesh& mesh, const std::vector<Sides>& sides, const SplitMeasures& before,
                 CheckReport& report);

}  // namespace collarmesh::checks
