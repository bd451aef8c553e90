#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "collarmesh/bounds.h"
#include "collarmesh/mesh_measures.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/shape_measures.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

struct CheckOptions {
  /// The bounds to check against. If the mesh marks thin tets, only marked ones may be thin. Tets marked
  /// as cells of a collar count as such at creases only.
  Bounds bounds = {};
  ShapeMeasures exact = {};  ///< measures of the exact geometry behind the complex; where one is NaN or
                             ///< missing, that of the complex counts
  std::size_t findings_per_guarantee = 20;  ///< further findings are counted but not listed
  unsigned threads = 0;                     ///< maximum number of threads; 0: all cores
};

/// A guarantee that does not hold, and where.
struct Finding {
  std::string guarantee;   ///< short stable name, e.g. "positive_volume", "watertight", "region_volume"
  std::string message;     ///< full sentence with ids, coordinates, measured and allowed value
  std::vector<Index> ids;  ///< indices of the mesh entities concerned
  Point where;
};

/// Measures of the triangles of a mesh without tets.
struct TriangleMeasures {
  static constexpr std::size_t bins = 18;
  std::size_t triangles = 0;
  double min_angle = 180, max_angle = 0;       ///< angles at the triangles' corners, degrees
  std::array<std::size_t, bins> min_angles{};  ///< triangles by their smallest angle, 10 degrees a bin
  std::array<std::size_t, bins> max_angles{};  ///< triangles by their largest angle
  std::size_t at_sharp_corners = 0;  ///< triangles below the bound only because the input has a sharp corner
};

struct CheckReport {
  std::vector<Finding> findings;
  std::size_t findings_total = 0;  ///< findings, including those not listed
  /// Sentences about labels that differ from the complex's, so that features were matched by position.
  /// `run_pipeline` adds sentences about its attempts.
  std::vector<std::string> notes;
  std::vector<std::string> warnings;  ///< sentences about volumes and thin places that changed noticeably
  // Measurements of the mesh:
  std::size_t tets = 0, points = 0, faces = 0, edges = 0, collar_tets = 0, thin_tets = 0;
  double max_radius_edge = 0;  ///< largest radius-edge ratio of tets that are neither thin nor in collars
  double max_thin_radius_edge = 0;  ///< largest radius-edge ratio of thin tets
  std::size_t forced_tets = 0;  ///< thin tets that keep their bounds only because these are lower where the
                                ///< input forces short edges
  double min_forced_dihedral = 180;             ///< smallest dihedral angle of the forced tets, degrees
  double min_dihedral = 180, max_dihedral = 0;  ///< dihedral angles outside collars, degrees
  double max_collar_dihedral = 0;               ///< largest dihedral angle in collars, degrees
  double min_collar_dihedral = 180;             ///< smallest dihedral angle in collars, degrees
  double max_surface_distance = 0;     ///< largest distance between mesh and complex on smooth patches and
                                       ///< curves, in both directions, input units
  double median_edge = 0;              ///< median length of the edges, input units
  std::size_t surface_tets = 0;        ///< tets with all corners on boundaries, interfaces or patches inside
                                       ///< regions
  std::vector<double> region_volumes;  ///< by region index, [0] unused; of curved elements if the order is 2
  ShapeMeasures of_input, of_mesh;     ///< empty if labels or points are not usable
  MeshMeasures measures;               ///< measures of all tets, collars included; of no tet if labels or
                                       ///< points are not usable
  std::optional<TriangleMeasures> triangles;  ///< only for a mesh without tets (`check_shells`)

  bool cancelled = false;  ///< the execution was cancelled, so the check is incomplete

  bool passed() const { return findings_total == 0 && !cancelled; }
};

/// Recomputes every guarantee from the mesh alone, independently of how it was made: positive volumes,
/// conformity, watertight regions, region volumes, curves as unions of edges, facets as unions of faces,
/// equal areas of planar patches, radius-edge ratios (for thin tets and collars: angles), surface distance. A
/// region may lose or gain 5% of its volume with elements of first order, 1% with those of second
/// order, or more if `Bounds::distance` is given; a warning names regions that are more than 2% off. The same
/// allowance holds for the volumes that closed surfaces enclose (`shells_of`). Averaged over a patch, walls
/// keep at least half of their thickness and gaps half of their width. A mesh read from a file (no feature
/// indices) is matched to the complex by tags and position; it is matched by position alone if its tags are
/// not the complex's or if it has no boundary triangles or curve edges. Tets count as cells of a collar only
/// at creases of the complex. Cancellation takes effect between groups of guarantees.
CheckReport check(const TetMesh& mesh, const Plc& plc, const CheckOptions& options = {},
                  const Execution& execution = {});

/// Bounds on the angles of a surface mesh, degrees. At a sharp corner between two curves of the input, the
/// smallest angle may be half of the corner's angle.
inline constexpr double least_triangle_angle = 20, largest_triangle_angle = 120;

/// Recomputes every guarantee of a mesh of triangles alone (`mesh_shells`): conformity (every edge has two
/// triangles, or lies on a curve and has one triangle of each patch there), vertices, curves as chains of
/// edges, tags, orientation, areas of planar patches, surface distance in both directions, angles, and
/// positive Jacobians of curved triangles. A mesh without feature indices is matched by tags and position.
CheckReport check_shells(const TetMesh& mesh, const Plc& plc, const CheckOptions& options = {},
                         const Execution& execution = {});

/// Recomputes every guarantee of a mesh of curve edges alone: every vertex and curve is present, each curve
/// is one chain of edges from end to end and near the input in both directions, edges are listed once, tags
/// are right, and no edge of second order folds. Cost: linear in the edges and in the complex, times a
/// logarithm.
CheckReport check_lines(const TetMesh& mesh, const Plc& plc, const CheckOptions& options = {});

}  // namespace collarmesh
