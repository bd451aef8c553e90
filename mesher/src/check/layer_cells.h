#pragma once

#include <map>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/tet_mesh.h"

/// Further names of guarantees, those of meshes with boundary layers.
namespace collarmesh::guarantee {

inline constexpr char layer_arrays[] = "layer_arrays";  ///< equal lengths, indices in range
/// Positive everywhere in tets and linear cells; at corners and integration points of other prisms and
/// pyramids.
inline constexpr char layer_jacobian[] = "layer_jacobian";
inline constexpr char layer_conforming[] = "layer_conforming";  ///< cells meet in whole sides
inline constexpr char layer_sides[] = "layer_sides";  ///< boundaries and interfaces are listed, once each
/// Each edge has one mid-edge node, which all cells at the edge share.
inline constexpr char layer_mid_nodes[] = "layer_mid_nodes";
inline constexpr char layer_volume[] = "layer_volume";  ///< regions keep their volumes
inline constexpr char core_angles[] = "core_angles";    ///< angles of the tets outside layers

}  // namespace collarmesh::guarantee

namespace collarmesh::checks {

/// The least dihedral angle of tets outside layers, in degrees, if the bounds give none.
inline constexpr double least_core_angle = 8;

/// Checks the cells of boundary layers together with the tets, by the mesh alone: lengths of arrays; positive
/// Jacobians; each side of a cell either is a side of one other cell, which lies on its other side, or is
/// listed among the faces or quadrangles; sides between regions are listed, too; the cells at an edge share
/// its mid-edge node. Adds findings. A mesh without layers may be given, too. Cost: O(n log n).
void check_layer_cells(const TetMesh& mesh, CheckReport& report, std::size_t findings_per_guarantee = 20);

/// Returns the volume of each region, by index: of its tets, prisms and pyramids, as if their edges were
/// straight.
std::map<Index, double> volumes_with_layers(const TetMesh& mesh);

/// Checks that the regions of `mesh` have the volumes `before`. `allowed`: by region, the absolute difference
/// allowed beyond rounding; 0 for regions that it does not list. Adds findings.
void check_layer_volumes(const std::map<Index, double>& before, const TetMesh& mesh,
                         const std::map<Index, double>& allowed, CheckReport& report);

/// Checks the tets outside layers as in a mesh without layers: the radius-edge ratio is within its bound,
/// or dihedral angles have the lower bound of thin tets and all angles are at most 150 degrees. Writes the
/// mesh's angles and sizes to the report. `walls`: for each point, the wall's point below it, or none. Adds
/// findings.
void check_core_angles(const TetMesh& mesh, const std::vector<Index>& walls, const Plc& plc,
                       const Bounds& bounds, CheckReport& report);

}  // namespace collarmesh::checks
