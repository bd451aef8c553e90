#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "collarmesh/bounds.h"
#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/size_field.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh {

/// The moment at which the balls of collars are placed: during refinement, each as soon as the mesh is fine
/// enough around its crease (paper, section 3.2), or before the first vertex is inserted. The guarantees are
/// the same.
enum class CollarCreation { in_pass, up_front };

/// A choice between refinement for practical meshes and refinement exactly as the paper's proofs assume it.
enum class Profile {
  standard,
  /// Makes exactly the assumptions of the proofs. All features that meet below 90 degrees are creases. A
  /// feature's point is inserted only if it is medial (paper, section 3.1); otherwise the balls around it are
  /// split. One bound on circumradius / shortest edge holds everywhere during the run, also in collars and
  /// outside regions. A crease gets its balls when the cells near it meet only features that contain it.
  /// Cells between two sheets that face each other keep the bound, too. Nothing is refined in blocks,
  /// coarsened or improved; sizes apply only if they are given.
  paper
};

/// Whether the radius-edge bound applies to cells in narrow places. A place is narrow between features that
/// have no point in common and are nearer to each other than a tenth of the size, as across a thin wall.
/// Cells there may exceed the bound in meshes that will be coarsened, where angles are bounded instead of the
/// ratio (Bounds::thin_angle).
enum class NarrowCells {
  bounded,          ///< all keep the bound
  left,             ///< all may exceed the bound
  bounded_if_cheap  ///< bounded if that takes at most about twice the vertices; otherwise all may exceed the
                    ///< bound
};

/// The goals of `generate`. Lengths are absolute, in input units, and are target edge lengths: the median
/// edge of a large mesh is about a tenth longer, as in other meshers.
struct MeshOptions {
  Profile profile = Profile::standard;  ///< sets some of the other options, see `with_profile`
  double size = 0;  ///< target edge length everywhere; 0: 1/20 of the diagonal (Profile::paper: the diagonal)
  double size_min = 0;                     ///< lower bound on target edge lengths given by sizes and size
                                           ///< fields; 0: none
  std::map<Tag, double> region_size = {};  ///< target edge length by region tag
  std::map<Tag, double> patch_size = {};   ///< target edge length by patch tag
  std::map<Tag, double> curve_size = {};   ///< target edge length by curve tag
  /// Increase of the target edge length per unit of distance from a finer patch, curve or region; 0:
  /// unlimited.
  double gradation = 0;
  SizeField size_field = {};  ///< target edge length at a point; may be empty
  /// Number of elements per full circle, by the curvature of smooth patches and curves; 0: no effect.
  double elements_per_circle = 0;
  /// Minimum number of edges per full circle on smooth curves that turn by half a circle or more, so that
  /// small holes stay round. It does not change target edge lengths; 0: none.
  double edges_per_hole = 7;
  double elements_across_gap = 0;  ///< number of target edge lengths between a patch and the feature that it
                                   ///< faces across a region; 0: no effect
  Bounds bounds = {};
  /// Bound on circumradius / shortest edge outside every region; used if larger than the bound inside. Edges
  /// that lead straight across a gap do not count as shortest edges there.
  double exterior_radius_edge = 8;
  NarrowCells narrow_cells = NarrowCells::bounded;
  double vertex_ratio = 0;  ///< bound on largest circumradius / shortest edge at a vertex in the regions
                            ///< (paper, section 1.2); 0: none, else > 2 sqrt 2
  double theta = 0.3;  ///< warp distance relative to a gap ball's radius (paper, Procedure 2); 0: never warp
  CollarCreation collar_creation = CollarCreation::in_pass;  ///< when collars are created
  double representation_angle = 50;  ///< bound on the tilt of collar triangles (Definition 12), degrees
  std::uint64_t seed = 0;            ///< seed of the random offsets; same input, options and seed: same mesh
  std::size_t max_vertices = 0;      ///< budget of vertices; 0: none
  /// Budget in bytes for the mesh structures (a whole run takes about 1.2 times as much); 0: none.
  std::size_t max_memory = 0;
  double time_limit = 0;    ///< budget in seconds; 0: none
  unsigned threads = 0;     ///< 0: all cores; any number makes the same mesh
  bool count_work = false;  ///< fill in MeshStatistics::counts, which takes some time
};

/// Returns the options with the changes that their profile makes.
MeshOptions with_profile(MeshOptions options);

/// Returns MeshOptions::size, or its default for this complex if it is 0.
double default_size(const Plc& plc, const MeshOptions& options);

/// Returns a sentence for each option of sizes that makes nothing finer: sizes by tag that are not below
/// `size`, and numbers of elements per circle that shorten no edge. Does not judge sizes that depend on the
/// place.
std::vector<std::string> sizes_without_effect(const Plc& plc, const MeshOptions& options);

/// Returns the default of the surface distance tolerance, absolute: a tenth of the target edge length `size`
/// (0: of the default length, see MeshOptions), at most 1/200 of the diagonal. A circle whose radius is near
/// the target length then gets about eight edges, whose chord error is about this tolerance. Small curves may
/// be rougher than large ones, but see MeshOptions::edges_per_hole. For cells of second order the tolerance
/// is at most 1/550 of the diagonal: it applies to the triangles between corners, and coarser triangles could
/// not be curved without inverting elements.
double default_distance(double size, double diagonal, int order = 1);

enum class MeshStatus {
  complete,          ///< the refinement ended; `check` certifies the mesh
  guarantee_missed,  ///< the refinement ended but could not meet a bound; `message` says which and where
  budget_hit,        ///< vertices, memory or time ran out; no mesh
  cancelled          ///< no mesh
};

/// Counts of the work that the paper's analysis bounds; filled in if MeshOptions::count_work is set.
struct WorkCounts {
  std::size_t located = 0;         ///< points and protective balls that were located at a mesh vertex
  std::size_t relocated = 0;       ///< moves of such a point or ball to a new, nearer vertex
  std::size_t looks = 0;           ///< inspections of such a point or ball because of a new vertex or
                                   ///< of a candidate for a new vertex
  std::size_t gap_queries = 0;     ///< queries of the gap size, with collars created during refinement
  std::size_t gap_cells = 0;       ///< Voronoi cells that these queries explored
  std::size_t gap_interviews = 0;  ///< pieces of features whose distance the queries of gap sizes computed
  std::size_t largest_degree = 0;  ///< largest number of neighbours of a new vertex
  std::size_t largest_cavity = 0;  ///< largest number of cells that one insertion destroyed
  /// The largest cavity except at vertices and curves of the complex where very many features meet.
  std::size_t largest_cavity_outside_hubs = 0;
  /// Largest number of cells per vertex in the whole triangulation, at any time.
  double peak_cells_per_vertex = 0;
  std::size_t before_quality = 0;  ///< vertices inserted for other reasons while a skinny cell waited
  std::size_t ripped_out = 0;      ///< vertices in collars that are not in the result (paper, Procedure 5)
  /// Extremes of R_v / r_v (paper, section 1.2), the largest circumradius at a vertex over half of its
  /// shortest edge, over vertices whose cells all lie in regions and outside collars; 0 if there is no such
  /// vertex.
  double smallest_aspect = 0, largest_aspect = 0;
};

struct MeshStatistics {
  std::size_t vertices_inserted = 0;   ///< vertices of the whole triangulation, including the box and the
                                       ///< outside
  std::size_t vertices_in_blocks = 0;  ///< vertices inserted in blocks that several threads may refine
  std::size_t cells = 0;
  std::size_t exact_predicates = 0;   ///< decisions that the floating-point filter left to exact arithmetic
  std::size_t warps = 0, yields = 0;  ///< destroy() calls that warped, or that yielded to a lower dimension
  std::size_t peak_bytes = 0;         ///< memory of the mesh structures
  double seconds = 0;
  WorkCounts counts;
};

struct MeshResult {
  MeshStatus status = MeshStatus::complete;
  std::string message;  ///< for statuses other than complete: the problem, its place (coordinates), and a
                        ///< remedy
  Point where;
  TetMesh mesh;
  MeshStatistics statistics;
  bool has_narrow_cells = false;  ///< cells above the radius-edge bound may remain
                                  ///< (MeshOptions::narrow_cells)
};

/// Meshes a complex: Sparse Voronoi Refinement (paper, Procedure 1). Preconditions: `plc` comes from
/// `build_plc` and may have creases. Guarantee (status complete): every tet in a region and outside collars
/// has circumradius / shortest edge <= radius_edge, every tet in a collar has no dihedral angle above
/// collar_angle; curves are unions of edges, patches unions of faces, planar ones exactly up to rounding and
/// smooth ones within `distance`. Throws OptionError when options contradict each other, PlcError if features
/// come so near to each other that no collar fits between them. Cost: near linear in the output.
MeshResult generate(const Plc& plc, const MeshOptions& options = {}, const Execution& execution = {});

}  // namespace collarmesh
