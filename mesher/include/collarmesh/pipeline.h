#pragma once

#include <optional>
#include <span>
#include <string>

#include "collarmesh/check.h"
#include "collarmesh/coarsen.h"
#include "collarmesh/exact_geometry.h"
#include "collarmesh/improve.h"
#include "collarmesh/mesher.h"
#include "collarmesh/plc.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/polygon_soup.h"
#include "collarmesh/progress.h"
#include "collarmesh/project_boundary.h"
#include "collarmesh/repair.h"
#include "collarmesh/second_order.h"
#include "collarmesh/shape_measures.h"
#include "collarmesh/tet_mesh.h"

/// The whole way from facets to a certified mesh, as the program `collarmesh` goes it: repair, refine,
/// coarsen, improve, project onto exact geometry, raise the order, check.
namespace collarmesh {

struct PipelineOptions {
  PlcOptions complex = {};    ///< how facets become a complex
  RepairOptions repair = {};  ///< and what happens where they are none
  MeshOptions mesh = {};      ///< sizes, bounds and budgets; the time limit is one for all stages
  bool coarsen = true;        ///< as few tets as the sizes ask for
  unsigned improve = 2;       ///< level, 1 to 3; 0: leave the slivers
  double min_dihedral = 0;    ///< degrees, in place of the level's; 0: the level's
  unsigned order = 1;         ///< of the cells, 1 or 2
  /// So many are tried, from `mesh.seed` on, until every guarantee holds; at least 1. The first mesh stays
  /// where none does.
  unsigned seeds = 2;
  unsigned partitions = 0;  ///< the tets are divided among so many ranks (see `partition`); 0: they are not
  /// What the facets approximate, as a CAD shape. The mesh is kept within tighter bounds first, so that its
  /// vertices can move onto this; may be empty.
  ExactGeometry exact = {};
  ShapeMeasures exact_measures = {};  ///< of the same, for the certificate; may be empty
};

/// What came out. Only where `result.status` is complete or guarantee_missed is there a mesh, `result.mesh`.
struct PipelineResult {
  MeshResult result;                        ///< of the refinement; its mesh has gone through all stages
  std::optional<CoarsenReport> coarsening;  ///< unless it was switched off
  ImproveReport improvement;
  std::optional<ProjectReport> projection;  ///< where there is exact geometry
  SecondOrderReport second_order;
  CheckReport check;

  bool guarantees_hold() const { return result.status == MeshStatus::complete && check.passed(); }
  /// The first guarantee that is missed, a sentence; empty where all hold.
  std::string missed() const;
};

struct SoupPipelineResult : PipelineResult {
  Plc plc;              ///< the complex that was meshed
  RepairReport repair;  ///< what was done to make it one
};

/// Where complexes to mesh come from, one for each repair that is tried.
class ComplexSource {
 public:
  virtual ~ComplexSource() = default;
  /// Throws PlcError. Where it was cancelled the report says so.
  virtual RepairedPlc build(const RepairOptions& repair, const Execution& execution) = 0;
  /// Set the options that depend on the complex built last: sizes by place, exact geometry. They may refer to
  /// it. Throws OptionError.
  virtual void adapt(const Plc& plc, PipelineOptions& options) = 0;
};

/// Mesh the solids of a complex, and certify the mesh against it. Where a guarantee is missed further repairs
/// are tried (`further_repairs`), then further seeds; of meshes that miss one the first stays. Where the
/// refinement takes far more vertices than the sizes ask for, it ends, and coarser repairs are tried
/// (`coarser_repairs`) that lose no body, region, name or tag but for numbers of CAD faces; where none of
/// their complexes does better, the first one is meshed as far as the budgets allow. What was tried is told
/// in `check.notes`. `execution.progress` is called at the begin of each stage, too
/// (`ProgressReport::begins`), and its fraction is that of all stages. Cancelled or out of time, the result
/// has that status and no mesh. Throws PlcError for facets that are no complex and cannot be repaired,
/// OptionError for options that contradict each other and for sizes of tags that the complex does not have.
SoupPipelineResult run_pipeline(ComplexSource& source, const PipelineOptions& options = {},
                                const Execution& execution = {});

/// The same for the solids that one or several soups bound.
SoupPipelineResult run_pipeline(std::span<const PolygonSoup> soups, const PipelineOptions& options = {},
                                const Execution& execution = {});

/// The same for a complex that is there already, with further seeds only.
PipelineResult run_pipeline(const Plc& plc, const PipelineOptions& options = {},
                            const Execution& execution = {});

/// The surface distance tolerance that these options stand for on a complex of this diagonal, absolute.
double distance_of(const PipelineOptions& options, double diagonal);

/// Throws OptionError, with the tags that there are, when a size is given for a tag that no feature has.
void require_known_tags(const MeshOptions& options, const Plc& plc);

}  // namespace collarmesh
