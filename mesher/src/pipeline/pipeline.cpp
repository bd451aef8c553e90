// The order of the stages. Builds a complex and tries meshes of it (`Tries`) until one keeps every guarantee;
// each mesh goes through the stages of `MeshMaker::make`. The kept mesh is then divided and split.
#include "collarmesh/pipeline.h"

#include <fmt/format.h>

#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "check/split.h"
#include "collarmesh/options.h"
#include "collarmesh/partition.h"
#include "collarmesh/usable_threads.h"
#include "pipeline/mesh_job.h"
#include "pipeline/tries.h"
#include "pipeline/wall_layers.h"
#include "shells/run.h"

namespace collarmesh {

namespace {

using pipeline::MeshJob;
using pipeline::Tries;

/// A thread that determines the number of usable threads while refinement runs.
class ThreadCounter {
 public:
  explicit ThreadCounter(unsigned threads) {
    if (threads == 1) return;
    try {
      thread_ = std::jthread([] { usable_threads(); });
    } catch (const std::system_error&) {
      // Without this thread, the first user of threads determines their number.
    }
  }

 private:
  std::jthread thread_;
};

/// A source of complexes built from facets.
class SoupSource : public ComplexSource {
 public:
  /// Keeps references to both arguments.
  SoupSource(std::span<const PolygonSoup> soups, const PlcOptions& options)
      : soups_(soups), options_(options) {}

  RepairedPlc build(const RepairOptions& repair, const Execution& execution) override {
    RepairedPlc built = collapse_small_features(build_repaired_plc(soups_, options_, repair, execution),
                                                soups_, options_, repair, execution);
    if (!built.report.wrapped && !built.report.cancelled) {
      if (first_)
        keep_feature_numbers(*first_, built.plc);
      else
        first_ = built.plc;
    }
    return built;
  }
  void adapt(const Plc&, PipelineOptions&) override {}

 private:
  std::span<const PolygonSoup> soups_;
  const PlcOptions& options_;
  std::optional<Plc> first_;  // the first complex; the options refer to its feature numbers
};

void require_valid(const PipelineOptions& options) {
  validate({options});
  if (options.partitions > 0) require_partitioner();
}

/// Makes triangles or lines instead of tets. `input` is a complex or a source of complexes.
template <class Input>
auto run_shells(Input& input, MeshJob& job) {
  job.control.begin_only_stage();
  auto made = shells::run(input, job.given, job.execution());
  if (made.result.status == MeshStatus::cancelled && job.control.out_of_time()) {
    made.result.status = MeshStatus::budget_hit;
    made.result.message = fmt::format(
        "the time limit of {} s is reached; raise it, or size for a coarser mesh", job.given.mesh.time_limit);
  }
  return made;
}

/// Divides the tets of the kept mesh among ranks, if the options ask for it.
void divide(MeshJob& job) {
  if (job.given.partitions == 0) return;
  job.control.begin("partition", 0.96, 1);
  partition(job.made.result.mesh, job.given.partitions);
  job.control.stop_if_asked();
}

/// Gives both sides of the patches to be split separate nodes, and checks the result. The mesh was certified
/// before the split.
void split_patches(MeshJob& job) {
  if (!job.given.split.any()) return;
  job.control.begin("split", 0.98, 1);
  TetMesh& mesh = job.made.result.mesh;
  const checks::SplitMeasures before = checks::measure_before_split(mesh);
  if (job.exact()) mesh.group_names = GroupNames::cad;  // so that the sides get names like CAD faces
  job.made.split = split(mesh, job.options.split);
  checks::check_split(mesh, job.made.split->interfaces.sides, before, job.made.check);
  job.control.stop_if_asked();
}

/// Makes a mesh by calling `mesh`, then runs the stages that run once, for the kept mesh. If the run ended
/// early, there is no mesh.
template <class Mesh>
void run_stages(MeshJob& job, const Mesh& mesh) {
  try {
    mesh();
    pipeline::add_layers(job);
    divide(job);
    split_patches(job);
  } catch (const Ended&) {
    job.made.result.mesh = {};
  }
}

}  // namespace

SoupPipelineResult run_pipeline(ComplexSource& source, const PipelineOptions& options,
                                const Execution& execution) {
  require_valid(options);
  const ThreadCounter counter(options.mesh.threads);
  MeshJob job(options, execution);
  if (options.dimension < 3) return run_shells(source, job);
  SoupPipelineResult all;
  run_stages(job, [&] { Tries(job, &source).mesh_repaired(all); });
  if (all.repair.repaired)
    job.made.check.notes.push_back(fmt::format("the mesh was judged against the {} complex",
                                               all.repair.wrapped ? "wrapped" : "repaired"));
  static_cast<PipelineResult&>(all) = std::move(job.made);
  return all;
}

SoupPipelineResult run_pipeline(std::span<const PolygonSoup> soups, const PipelineOptions& options,
                                const Execution& execution) {
  SoupSource source(soups, options.complex);
  return run_pipeline(source, options, execution);
}

PipelineResult run_pipeline(const Plc& plc, const PipelineOptions& options, const Execution& execution) {
  require_valid(options);
  const ThreadCounter counter(options.mesh.threads);
  MeshJob job(options, execution);
  if (options.dimension < 3) return run_shells(plc, job);
  run_stages(job, [&] { Tries(job, nullptr).mesh(plc); });
  return std::move(job.made);
}

std::string PipelineResult::missed() const {
  if (!result.message.empty() || check.findings.empty()) return result.message;
  return check.findings.front().message;
}

double distance_of(const PipelineOptions& options, double diagonal) {
  return options.mesh.bounds.distance > 0
             ? options.mesh.bounds.distance
             : default_distance(options.mesh.size, diagonal, static_cast<int>(options.order));
}

}  // namespace collarmesh
