#pragma once

#include <optional>
#include <span>
#include <string>

#include "collarmesh/check.h"
#include "collarmesh/coarsen.h"
#include "collarmesh/exact_geometry.h"
#include "collarmesh/improve.h"
#include "collarmesh/interior_nodes.h"
#include "collarmesh/layers.h"
#include "collarmesh/mesher.h"
#include "collarmesh/periodic.h"
#include "collarmesh/plc.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/polygon_soup.h"
#include "collarmesh/progress.h"
#include "collarmesh/project_boundary.h"
#include "collarmesh/repair.h"
#include "collarmesh/second_order.h"
#include "collarmesh/shape_measures.h"
#include "collarmesh/split.h"
#include "collarmesh/tet_mesh.h"
#include "collarmesh/trace.h"

/// The stages from facets to a certified mesh, as the program `collarmesh` runs them: repair, refine,
/// coarsen, improve, project onto exact geometry, raise the order, check, add boundary layers, split.
namespace collarmesh {

/// The mesh that a run begins with.
enum class Start {
  automatic,   ///< refinement; if it takes far too many vertices, the constrained tetrahedra
  refinement,  ///< refinement: features are inserted one by one, with all guarantees
  /// Constrained tetrahedra: their faces and edges include the facets and segments of the complex. Later
  /// stages bring them to the size. At first their number is about twice that of the facets, even if features
  /// are very near each other, but some tetrahedra keep angles beyond the bounds.
  constrained
};

struct PipelineOptions {
  PlcOptions complex = {};    ///< how a complex is built from facets
  RepairOptions repair = {};  ///< how facets that do not form a complex are repaired
  MeshOptions mesh = {};      ///< sizes, bounds and budgets; the time limit holds for all stages together
  Start start = Start::automatic;
  bool coarsen = true;      ///< remove tets that the sizes do not need
  unsigned improve = 2;     ///< level of improvement, 1 to 3; 0: leave the slivers
  double min_dihedral = 0;  ///< degrees; 0: the angle of the level
  unsigned order = 1;       ///< order of the cells, 1 or 2
  /// 3: tetrahedra in the solids; 2: triangles on the patches; 1: lines on the curves (`mesh_shells`).
  unsigned dimension = 3;
  std::vector<std::string> faces =
      {};  ///< names or numbers of the patches to mesh with triangles; empty: all
  /// Number of seeds to try, from `mesh.seed` on, until every guarantee holds; at least 1. If no seed
  /// succeeds, the first mesh is kept; of meshes from constrained tetrahedra, the one with fewest findings.
  unsigned seeds = 2;
  SplitOptions split = {};   ///< internal patches that get nodes of their own on each side, after the check
  LayerOptions layers = {};  ///< boundary layers, made after the check and before the split
  PeriodicOptions periodic = {};  ///< patches whose meshes are images of each other
  bool trace = false;             ///< fill in PipelineResult::trace
  unsigned partitions = 0;        ///< number of ranks to divide the tets among (see `partition`); 0: no
                                  ///< partition
  /// The geometry that the facets approximate, such as a CAD shape. Until the vertices move onto this
  /// geometry, the mesh keeps tighter bounds. May be empty.
  ExactGeometry exact = {};
  ShapeMeasures exact_measures = {};  ///< measures of that geometry, for the certificate; may be empty
  /// For `remesh` without a complex: moves nodes on curved faces and curves onto a smooth surface. It passes
  /// through the nodes of the given mesh and stays within the surface distance of that mesh's triangles.
  bool smooth_surface = false;
};

/// Returns the options with the changes that their `mesh.profile` makes.
PipelineOptions with_profile(PipelineOptions options);

/// The result of a run. It has a mesh only if `result.status` is complete or guarantee_missed.
struct PipelineResult {
  MeshResult result;                        ///< the result of the refinement; its mesh has passed through all
                                            ///< stages
  std::optional<CoarsenReport> coarsening;  ///< nothing if coarsening was switched off
  ImproveReport improvement;
  std::optional<ProjectReport> projection;  ///< nothing without exact geometry
  SecondOrderReport second_order;
  CheckReport check;
  std::optional<InteriorNodesReport> interior_nodes;  ///< nothing unless each tet has to have an interior
                                                      ///< node
  std::optional<PeriodicReport> periodic;             ///< nothing unless patches have to be periodic
  std::optional<LayersReport> layers;                 ///< nothing unless layers are asked for
  std::optional<SplitReport> split;                   ///< nothing unless patches are to be split
  Trace trace;  ///< trace of the run that made the mesh, or of a refinement that ended early

  bool guarantees_hold() const { return result.status == MeshStatus::complete && check.passed(); }
  /// Returns a sentence about the first missed guarantee; empty if all hold.
  std::string missed() const;
};

struct SoupPipelineResult : PipelineResult {
  Plc plc;              ///< the complex that was meshed
  RepairReport repair;  ///< the changes that made the input a valid complex
};

/// The source of the complexes to mesh. It builds one for each repair that is tried.
class ComplexSource {
 public:
  virtual ~ComplexSource() = default;
  /// Builds the next complex. The report says whether it was cancelled. Throws PlcError.
  virtual RepairedPlc build(const RepairOptions& repair, const Execution& execution) = 0;
  /// Sets the options that depend on the complex built last, such as sizes by place and exact geometry. The
  /// options may keep references to that complex. Throws OptionError.
  virtual void adapt(const Plc& plc, PipelineOptions& options) = 0;
};

/// Meshes the solids of a complex, and certifies the mesh against it. `check.notes` lists the attempts.
///
/// If a guarantee is missed, tries further repairs (`further_repairs`), then constrained tetrahedra if angles
/// miss their bounds, then further seeds. If no mesh passes, keeps the first one; if all meshes begin with
/// constrained tetrahedra (`Start`), keeps the one with the fewest findings.
///
/// A refinement ends early at a bound on vertices. Then tries coarser repairs (`coarser_repairs`), which must
/// lose no body, region, name or tag except numbers of CAD faces. If none of them makes a mesh, meshes the
/// first complex from its constrained tetrahedra or refines it within larger bounds. If both of these meshes
/// miss guarantees, keeps the refined one unless it misses them at far more of its tets.
///
/// Where features thinner than the feature size make a refinement far too fine, tries constrained tetrahedra,
/// then coarser repairs. Makes thin rods from rings of vertices instead of refining them, if nothing but one
/// size is asked for. If cells have first order, no distance is asked for and a region's volume is off by
/// more than 2%, makes a mesh that passes again, nearer to the surfaces: at most twice, and each time in at
/// most half of the time that the time limit leaves.
///
/// `execution.progress` is also called at the beginning of each stage (`ProgressReport::begins`); its
/// fraction covers all stages. If cancelled or out of time, the result has that status and no mesh. Throws
/// PlcError for facets that cannot be repaired to form a complex, OptionError for conflicting options and for
/// sizes of unknown tags.
SoupPipelineResult run_pipeline(ComplexSource& source, const PipelineOptions& options = {},
                                const Execution& execution = {});

/// Meshes the solids that one or several soups bound, in the same way as those of a ComplexSource.
SoupPipelineResult run_pipeline(std::span<const PolygonSoup> soups, const PipelineOptions& options = {},
                                const Execution& execution = {});

/// Meshes a complex that exists already, with further seeds but no further repairs. Where a refinement takes
/// far more vertices than the sizes ask for and no budget is given, the mesh begins with constrained
/// tetrahedra; if these fail, too, the run ends with the status `budget_hit`.
PipelineResult run_pipeline(const Plc& plc, const PipelineOptions& options = {},
                            const Execution& execution = {});

/// Returns the surface distance tolerance of these options on a complex with this diagonal; both in input
/// units.
double distance_of(const PipelineOptions& options, double diagonal);

/// Throws OptionError, with the known tags, if a size is given for a tag that no feature has.
void require_known_tags(const MeshOptions& options, const Plc& plc);

}  // namespace collarmesh
