// Meshes surfaces on their own, from a complex to certified triangles.
#include "shells/run.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/shells.h"
#include "common/flat_features.h"
#include "common/thread_limit.h"
#include "repair/noise.h"
#include "shells/chosen_patches.h"
#include "shells/curve_mesher.h"
#include "shells/curved_triangles.h"
#include "shells/surface_mesher.h"
#include "shells/turn_patches.h"

namespace collarmesh::shells {

namespace {

// Shares of the tolerance that the distance between mesh and complex may use: before vertices move onto exact
// geometry, and in the final mesh.
constexpr double share_before_moves = 0.7, share = 0.85;

struct Ended {};

/// Returns whether every patch bounds a region.
bool is_solid(const Plc& plc) {
  return std::all_of(plc.patches.begin(), plc.patches.end(),
                     [](const Plc::Patch& patch) { return patch.regions[0] > 0 || patch.regions[1] > 0; });
}

/// Returns the tolerance. Where faces nearly touch, the default of solids is tiny, because volumes would
/// vanish there; surfaces need no such bound. So here the tolerance is at least a share of the target edge
/// length, unless the options give a tolerance.
SurfaceTolerance surface_tolerance(const Plc& plc, const PipelineOptions& options) {
  constexpr double least_per_size = 0.005;
  const Bounds& bounds = options.mesh.bounds;
  SurfaceTolerance given = tolerance_of(plc, bounds, options.mesh.size, static_cast<int>(options.order));
  if (!given.varies() || bounds.distance > 0 || bounds.tolerance) return given;
  const double least = least_per_size * default_size(plc, options.mesh);
  std::vector<double> triangles;
  triangles.reserve(plc.triangles.size());
  for (Index t = 0; t < plc.triangles.size(); ++t)
    triangles.push_back(std::min(given.largest(), std::max(least, given.at_triangle(t))));
  return {plc, std::move(triangles), given.largest()};
}

class Run {
 public:
  Run(const PipelineOptions& options, const Execution& execution) : given_(options), execution_(execution) {
    given_.complex.require_solid = false;
  }

  void build(ComplexSource& source, SoupPipelineResult& all) {
    begin("complex", 0);
    RepairedPlc built = build_shell_complex(
        [&](const RepairOptions& repair) { return source.build(repair, execution_); }, given_.repair);
    all.repair = std::move(built.report);
    if (all.repair.cancelled) stop();
    all.plc = std::move(built.plc);
  }

  void mesh(const Plc& plc, const PipelineOptions& options, PipelineResult& made) {
    if (options.dimension == 1) return mesh_lines(plc, options, made);
    if (plc.patches.empty())
      throw PlcError(
          plc.curves.empty()
              ? "The input has no faces to mesh with triangles; add some, or leave --dimension 2 out."
              : "The input has no faces to mesh with triangles, only curves; add faces, or mesh its curves "
                "with "
                "lines (--dimension 1).",
          {});
    require_known_tags(options.mesh, plc);
    Bounds bounds = options.mesh.bounds;
    bounds.tolerance = surface_tolerance(plc, options);
    const FlatFeatures flat(plc);
    const ExactGeometry exact = options.exact ? flat.limit(options.exact) : ExactGeometry();
    begin("refine", 0.1);
    SurfaceMesher mesher(plc, options.mesh, *bounds.tolerance, exact ? share_before_moves : share,
                         execution_);
    mesher.run();
    stop_if_asked();
    if (exact) {
      begin("project", 0.7);
      made.projection = mesher.project(exact, share);
      stop_if_asked();
    }
    TetMesh& mesh = made.result.mesh = mesher.mesh();
    if (options.order == 2) {
      begin("second order", 0.8);
      made.second_order = curve_triangles(mesh, plc, mesher, exact);
    }
    turn_patches(mesh, plc);
    made.result.status = MeshStatus::complete;
    begin("check", 0.9);
    made.check = check_shells(
        mesh, plc, {.bounds = bounds, .exact = options.exact_measures, .threads = options.mesh.threads},
        execution_);
    stop_if_asked();
  }

  /// Meshes curves alone, as for beams.
  void mesh_lines(const Plc& plc, const PipelineOptions& options, PipelineResult& made) {
    if (plc.curves.empty())
      throw PlcError(
          "The input has no edges or curves to mesh with lines; add some, or leave --dimension 1 out.", {});
    require_known_tags(options.mesh, plc);
    Bounds bounds = options.mesh.bounds;
    bounds.tolerance = tolerance_of(plc, bounds, options.mesh.size, static_cast<int>(options.order));
    const FlatFeatures flat(plc);
    const ExactGeometry exact = options.exact ? flat.limit(options.exact) : ExactGeometry();
    begin("refine", 0.1);
    CurveMesh lines = mesh_curves(plc, options.mesh, *bounds.tolerance, options.order, exact);
    made.result.mesh = std::move(lines.mesh);
    if (exact) made.projection = std::move(lines.projection);
    made.second_order = std::move(lines.second_order);
    made.result.status = MeshStatus::complete;
    begin("check", 0.9);
    made.check =
        check_lines(made.result.mesh, plc,
                    {.bounds = bounds, .exact = options.exact_measures, .threads = options.mesh.threads});
  }

  /// Calls `stages`. If the run was stopped, leaves no mesh in `made`.
  template <class Stages>
  void until_ended(PipelineResult& made, const Stages& stages) {
    try {
      stages();
    } catch (const Ended&) {
      made.result.mesh = {};
      made.result.status = MeshStatus::cancelled;
      made.result.message = "the run was stopped";
    }
  }

  const PipelineOptions& options() const { return given_; }

 private:
  void begin(std::string_view stage, double fraction) {
    stop_if_asked();
    if (execution_.progress && !execution_.progress({.phase = stage, .fraction = fraction, .begins = true}))
      stop();
  }
  void stop_if_asked() const {
    if (execution_.cancelled()) stop();
  }
  [[noreturn]] static void stop() { throw Ended(); }

  PipelineOptions given_;
  const Execution& execution_;
};

}  // namespace

SoupPipelineResult run(ComplexSource& source, const PipelineOptions& options, const Execution& execution) {
  SoupPipelineResult all;
  Plc whole;
  Run stages(options, execution);
  stages.until_ended(all, [&] {
    stages.build(source, all);
    PipelineOptions adapted = stages.options();
    if (!adapted.faces.empty()) {
      whole = std::move(all.plc);  // kept, because the adapted options may refer to it
      source.adapt(whole, adapted);
      ChosenPatches chosen = choose_patches(whole, adapted.faces);
      chosen.adapt(adapted);
      all.plc = std::move(chosen.plc);
    } else {
      source.adapt(all.plc, adapted);
    }
    stages.mesh(all.plc, adapted, all);
  });
  return all;
}

PipelineResult run(const Plc& plc, const PipelineOptions& options, const Execution& execution) {
  PipelineResult made;
  Run stages(options, execution);
  stages.until_ended(made, [&] {
    if (options.faces.empty()) {
      stages.mesh(plc, stages.options(), made);
      return;
    }
    const ChosenPatches chosen = choose_patches(plc, options.faces);
    PipelineOptions adapted = stages.options();
    chosen.adapt(adapted);
    stages.mesh(chosen.plc, adapted, made);
  });
  return made;
}

}  // namespace collarmesh::shells

namespace collarmesh {

CheckReport check_faces(const TetMesh& mesh, const Plc& whole, const std::vector<std::string>& faces,
                        CheckOptions options, const Execution& execution) {
  const shells::ChosenPatches chosen = shells::choose_patches(whole, faces);
  chosen.adapt(options.exact);
  return check_shells(mesh, chosen.plc, options, execution);
}

RepairedPlc build_shell_complex(const std::function<RepairedPlc(const RepairOptions&)>& build,
                                const RepairOptions& repair) {
  if (repair.mode != RepairMode::automatic) return build(repair);
  RepairOptions no_repair = repair;
  no_repair.mode = RepairMode::off;
  RepairedPlc built;
  try {
    built = build(no_repair);
  } catch (const PlcError&) {
    return build(repair);
  }
  if (built.report.cancelled || !shells::is_solid(built.plc)) return built;
  const double tolerance = repair.tolerance * built.plc.bounds.diagonal();
  return repairing::find_noise(built.plc, tolerance) ? build(repair) : built;
}

}  // namespace collarmesh
