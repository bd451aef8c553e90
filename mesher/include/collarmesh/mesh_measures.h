#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// The shapes of a mesh's tetrahedra, for summaries and reports.
struct MeshMeasures {
  static constexpr std::size_t bins = 18, listed = 10;
  struct Extreme {
    double angle;  ///< dihedral angle, degrees
    Index tet;
  };

  double min_dihedral = 180, max_dihedral = 0;  ///< degrees
  double max_radius_edge = 0;       ///< largest ratio of tets that are neither thin nor in a collar; only the
                                    ///< ratio of such tets is bounded
  double max_thin_radius_edge = 0;  ///< largest ratio of thin tets; 0: there are none
  double max_collar_radius_edge = 0;              ///< largest ratio in collars; 0: there are none
  std::array<std::size_t, bins> min_dihedrals{};  ///< tets by their smallest dihedral angle, 10 degrees a bin
  std::array<std::size_t, bins> max_dihedrals{};  ///< tets by their largest dihedral angle
  std::array<std::size_t, bins>
      radius_edges{};                      ///< tets by radius-edge ratio, 0.25 a bin; the last bin is open
  std::map<Index, double> region_volumes;  ///< by index of the region; input units cubed
  /// The ten tets with the smallest and the ten with the largest dihedral angles, the most extreme first.
  std::vector<Extreme> smallest_angles, largest_angles;

  enum class Kind { plain, thin, collar };
  /// Counts a tet of this quality. Call it for the tets in their order.
  void add(Index tet, const TetQuality& quality, Index region, Kind kind);
};

/// Measures a tet by its corners; the volume is that of the curved tet if the mesh is of second order.
TetQuality measure_tet(const TetMesh& mesh, Index tet);

/// Measures all tets. In a mesh without regions all tets are in region 1.
MeshMeasures measure_mesh(const TetMesh& mesh);

}  // namespace collarmesh
