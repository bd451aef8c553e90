#include "pipeline/refinement.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <optional>

#include "common/thread_limit.h"
#include "pipeline/explosion.h"
#include "pipeline/vertex_bound.h"
#include "predict/vertex_counts.h"
#include "refine/generate_linked.h"
#include "tolerance/thin_places.h"

namespace collarmesh::pipeline {

namespace {

// Factors and reserve for runs with exact geometry: the bounds must still hold after the vertices have moved
// onto it. CAD triangles are up to a tenth of the tolerance away from the shape; the factor on the distance
// leaves room for twice that, and some more.
constexpr double distance_left = 0.75, ratio_left = 0.99, angle_reserve = 0.05;

// Layers are pushed into the tets, which makes angles worse where walls are one tet apart.
constexpr double reserve_for_layers = 0.2;

// Bound on angles in collars, degrees, with which refinement ended on all shapes tried. Coarsening and
// improvement reach smaller bounds.
constexpr double reached_collar_angle = 130;

/// A comparison of the number of vertices of a refinement with the number that its sizes ask for. It is
/// costly to compute the latter number, and to find out whether thin features may cause more vertices. So
/// both are done only if a refinement inserts many vertices, and the computation stops as soon as the
/// comparison is decided.
class VertexCounter {
 public:
  VertexCounter(const MeshJob& job, Fineness fineness) : job_(job), fineness_(fineness) {}

  /// Returns whether a refinement that ended with these vertices made far more than the sizes ask for,
  /// because of features thinner than the feature size.
  bool exceeds(std::size_t vertices) {
    if (fineness_ == Fineness::any || vertices <= few) return false;
    exceeded_ |= is_above_most(static_cast<double>(vertices)) && may_be_thin();
    return exceeded_;
  }

  /// Returns an execution that ends when there are far more vertices than the sizes ask for. It keeps
  /// references to this object and to the other execution.
  Execution watched(const Execution& execution) {
    Execution watched = execution;
    if (fineness_ == Fineness::as_asked)
      watched.progress = [this, &execution](const ProgressReport& report) {
        return !will_exceed(report.vertices) && (!execution.progress || execution.progress(report));
      };
    return watched;
  }

  bool has_exceeded() const { return exceeded_; }
  std::size_t most() {
    if (!is_known_) count_up_to(largest);
    return static_cast<std::size_t>(std::min(most_, largest));
  }

 private:
  // Without thin features, a refinement mostly makes fewer vertices than the sum of `few` and the number of
  // tets of the coarsened mesh.
  static constexpr std::size_t few = 1500;
  static constexpr double largest = 1e15;

  // Returns whether a refinement that has reached this number of vertices must end with too many. The moments
  // of progress reports depend on the clock, so this must be false throughout a refinement that does not
  // exceed the limit at its end. While such a refinement bounds narrow cells, it may have up to twice the
  // limit plus `some_more` vertices, which it drops if it begins again.
  bool will_exceed(std::size_t vertices) {
    constexpr std::size_t some_more = 5000;
    return fineness_ == Fineness::as_asked && vertices > few + some_more &&
           is_above_most(0.5 * static_cast<double>(vertices - some_more), 2) && exceeds(vertices);
  }

  // Returns whether this is more than the sizes ask for. Counts `ahead` times as far as the answer needs, so
  // that later calls with more vertices need no new count.
  bool is_above_most(double vertices, double ahead = 1) {
    if (vertices <= few) return false;
    if (!is_known_ && vertices >= most_) count_up_to(ahead * (vertices - static_cast<double>(few)));
    return vertices > most_;
  }

  void count_up_to(double enough) {
    if (!shape_) {
      shape_.emplace(*job_.plc);
      tets_.emplace(*shape_, job_.options.mesh);
    }
    const double tets = tets_->count_up_to(enough);
    most_ = static_cast<double>(few) + tets;
    is_known_ = tets < enough;
    if (!is_known_) return;
    tets_.reset();
    shape_.reset();
  }

  // Returns whether thin places may take more vertices than the sizes ask for. This costs far more than the
  // prediction.
  bool may_be_thin() {
    if (!thin_) {
      const double thinner = thinner_than_asked(job_.given, job_.plc->bounds.diagonal());
      ThreadLimit(job_.given.mesh.threads).run([&] {
        thin_ = squares_in_thin_places(*job_.plc, thinner) > static_cast<double>(most());
      });
    }
    return *thin_;
  }

  const MeshJob& job_;
  Fineness fineness_;
  bool exceeded_ = false;
  std::optional<prediction::Shape> shape_;
  std::optional<prediction::TetCounter> tets_;
  double most_ = 0;  // the number that the sizes ask for; while it is not known, a lower limit on it
  bool is_known_ = false;
  std::optional<bool> thin_;  // the answer of may_be_thin
};

}  // namespace

MeshOptions options_of_refinement(const MeshJob& job, NarrowCells narrow_cells) {
  assert(job.plc);
  MeshOptions options = job.options.mesh;
  options.time_limit = 0;  // the control has one limit for all stages
  if (job.options.coarsen) options.narrow_cells = narrow_cells;
  if (job.given.layers.any()) options.bounds.reserve = reserve_for_layers;
  if (!job.exact()) return options;
  options.bounds.tolerance = tolerance_of(*job.plc, options.bounds, 0).scaled(distance_left);
  if (options.profile == Profile::standard)  // the paper's proofs need the given ratio
    options.bounds.radius_edge = std::max(1.0, ratio_left * options.bounds.radius_edge);
  options.bounds.reserve = std::max(angle_reserve, options.bounds.reserve);
  return options;
}

double least_thin_ratio(const MeshJob& job) {
  return job.options.mesh.bounds.radius_edge / (job.exact() ? ratio_left : 1);
}

double thinner_than_asked(const PipelineOptions& given, double diagonal) {
  constexpr double rounding = 1e-9;
  return given.repair.feature_size * smallest_size(given.mesh, diagonal) * (1 + rounding);
}

void refine(MeshJob& job, Fineness fineness) {
  job.control.begin("refine", 0.06, job.options.coarsen ? 0.6 : 0.7);
  MeshOptions options = job.refined_with;
  options.bounds.interior_node = false;  // a later stage inserts these nodes
  if (job.options.coarsen)
    options.bounds.collar_angle = std::max(options.bounds.collar_angle, reached_collar_angle);
  VertexCounter counter(job, fineness);
  MeshResult& result = job.made.result =
      generate(*job.plc, options, counter.watched(job.execution()), job.neighbours,
               job.options.trace ? &job.made.trace : nullptr);
  if (counter.has_exceeded() ||
      (result.status != MeshStatus::cancelled && counter.exceeds(result.statistics.vertices_inserted)))
    throw FarTooFine{counter.most()};
  if (result.status == MeshStatus::cancelled && job.control.out_of_time()) job.control.stop();
  if (job.hit_bound())
    result.message =
        describe_explosion(*job.plc, job.budget.most(), result.where) +
        "; mend the features that nearly meet there, raise the repair tolerance (repair-tolerance), wrap the "
        "input (repair wrap), or let the refinement go on (max-vertices)";
  if (result.status == MeshStatus::cancelled || result.status == MeshStatus::budget_hit) throw Ended();
  job.refined_with.bounds.lower_where_forced = result.has_narrow_cells;
}

}  // namespace collarmesh::pipeline
