#pragma once

#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/tet_mesh.h"
#include "pipeline/rod_cavity.h"

namespace collarmesh::pipeline {

/// A cavity around a rod, and the tetrahedra between its walls and the sheath.
struct RodFilling {
  /// A vertex of the refined mesh, or of the rod with its sheath, and its number in the complex of the gap.
  struct Origin {
    bool is_of_rod;
    Index vertex, number;
  };
  /// Returns where a point of the gap comes from; null if the filling added it.
  const Origin* origin_of(const Point& point) const {
    const auto found = origins.find({point.x, point.y, point.z});
    return found != origins.end() ? &found->second : nullptr;
  }

  std::vector<Index> tets, faces;  ///< elements of the refined mesh that the cavity takes
  TetMesh gap;
  /// By patch of the gap's complex: the planar patch of the whole complex that it lies in; none for the
  /// patches that consist of one triangle of a wall or of the skin.
  std::vector<Index> hosts;
  std::map<std::tuple<double, double, double>, Origin> origins;
};

/// Fills the gap between a sheath and the walls of its cavity. Returns nothing if it was cancelled. Throws
/// NoRoom if triangles of the walls or the skin would be divided, and PlcError if features are too near each
/// other.
std::optional<RodFilling> fill_cavity(const Plc& plc, MeshAroundRods& around, Index rod, double room,
                                      const Execution& execution);

}  // namespace collarmesh::pipeline
