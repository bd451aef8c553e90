#include "collarmesh/remesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "adapt/bring_to_size.h"
#include "adapt/edge_division.h"
#include "adapt/mesh_complex.h"
#include "adapt/smooth_geometry.h"
#include "adapt/smoothing.h"
#include "check/labelled.h"
#include "coarsen/coarsen_edited.h"
#include "coarsen/coarsening_rule.h"
#include "coarsen/target_sizes.h"
#include "collarmesh/error.h"
#include "collarmesh/options.h"
#include "collarmesh/partition.h"
#include "collarmesh/project_boundary.h"
#include "collarmesh/second_order.h"
#include "common/layer_tets.h"
#include "common/run_control.h"
#include "common/thread_limit.h"
#include "improve/improve_edited.h"

namespace collarmesh {

namespace remeshing::adapting {
namespace {

// Limits on rounds and passes. Each round at least halves the longest edges of most tets, so sizes far finer
// than the mesh take many rounds.
constexpr unsigned most_rounds = 40, most_passes = 3;
// Each round divides the distance of an edge from its curve or patch by about four.
constexpr unsigned most_distance_rounds = 6;
// When an edge that is too far from its patch is divided, new faces may be this many times as far from the
// patch as the faces before. They come nearer when the other edges around are divided, too.
constexpr double distant_halves = 2;
// If a pass of divisions changes a smaller share of the vertices, it is the last one.
constexpr double least_share = 0.01;
// Edges longer than this factor times the target are divided. At first the factor is the square root of 2:
// the halves of a longer edge are nearer to the target than the edge is. Later it is such that edges made by
// coarsening are not divided.
constexpr double longest_at_first = 1.4142, longest_later = coarsening::CoarseningRule::longest_new;
// Larger than any radius-edge ratio: with this bound only the worst tet around limits an operation.
constexpr double any_ratio = 1e12;
// Smaller than any radius-edge ratio: with this bound angles alone decide, and slivers are forbidden.
constexpr double no_ratio = 0.1;
// With a given complex or a reconstructed surface, operations may use the share `distance_left` of the
// tolerance: the rest is for points between those that they test, and for moves onto exact geometry.
// `angle_reserve` is the share of the bounds on angles that is kept in reserve for these moves.
constexpr double distance_left = 0.75, angle_reserve = 0.05;
constexpr unsigned most_rounds_of_poor = 4;
// The whole mesh is brought to its size first if more than the share `mostly` of its tets misses the bounds
// on angles, and more than the share `least_beyond` misses even the bounds as lowered where the input forces
// edges to be short (ForcedEdges).
constexpr double mostly = 0.1, least_beyond = 0.02;
// If the smallest angle of a mesh, away from creases and narrow places, is at least this (degrees),
// remeshing keeps it at least this large.
constexpr double good_angle = 15;

class Remeshing {
 public:
  /// `complex`: the complex that the mesh was made from; null: builds one from the mesh's own surface.
  Remeshing(const TetMesh& given, const Plc* complex, const PipelineOptions& options,
            const AdaptOptions& adapt, const Execution& execution)
      : given_(given),
        complex_(complex),
        options_(options),
        adapt_(adapt),
        control_(options, execution, made_) {
    validate({options});
    if (options.smooth_surface && complex != nullptr)
      throw OptionError(
          "smooth-surface reconstructs the surface from the mesh, but the given input already determines it; "
          "leave out smooth-surface or that input");
    if (options.partitions > 0) require_partitioner();
  }

  RemeshResult run() {
    try {
      control_.begin("complex", 0, 0.06);
      build();
      ThreadLimit(options_.mesh.threads).run([&] { reshape(); });
      project();
      raise_order();
      certify();
      forget_numbers();
      partition_tets();
    } catch (const Ended&) {
      made_.result.mesh = {};
    }
    return std::move(made_);
  }

 private:
  TetMesh& mesh() { return made_.result.mesh; }

  void build() {
    MeshComplex built = complex_of(given_, options_.complex);
    mesh() = std::move(built.mesh);
    if (complex_ == nullptr)
      made_.plc = std::move(built.plc);
    else
      follow_complex();
    if (adapt_) adapt_(made_.plc, options_);
    if (complex_ == nullptr)
      options_.exact = {}, options_.exact_measures = {};  // these belong to features of another complex
    require_known_tags(options_.mesh, made_.plc);
    made_.remeshing.tets_before = mesh().tets.size();
    measure_before();
    choose_size();
    options_.mesh.edges_per_hole = 0;  // asks for no further edges around holes
    if (!options_.mesh.bounds.tolerance)
      options_.mesh.bounds.tolerance =
          tolerance_of(made_.plc, options_.mesh.bounds, largest_size_, static_cast<int>(options_.order));
    promised_ = options_.mesh.bounds;
    made_.remeshing.smooth_surface = options_.smooth_surface;
    if (options_.smooth_surface) options_.exact = smooth_geometry(made_.plc, *promised_.tolerance);
    if (complex_ != nullptr || options_.smooth_surface)
      options_.mesh.bounds.tolerance = promised_.tolerance->scaled(distance_left);
    if (options_.exact) options_.mesh.bounds.reserve = angle_reserve;
    choose_bounds();
  }

  /// Gives the mesh the features of the given complex, in place of the features found on its own surface.
  void follow_complex() {
    TetMesh listed =
        corners_of(given_).mesh;  // without the curves that `complex_of` found at folds and borders
    mesh().edges = std::move(listed.edges);
    mesh().edge_tag = std::move(listed.edge_tag);
    mesh().edge_curve.assign(mesh().edges.size(), none);
    forget_numbers();
    mesh().features.clear();
    std::ranges::fill(mesh().tet_region, none);
    made_.plc = *complex_;
    control_.watch([&](const Execution& execution) {
      mesh() = checks::labelled(
          mesh(), made_.plc, {.bounds = options_.mesh.bounds, .threads = options_.mesh.threads}, execution);
    });
  }

  /// Chooses the bounds that operations keep: stricter ones if all angles of the mesh are already within
  /// them.
  void choose_bounds() {
    kept_ = options_.mesh.bounds;
    for (const double angle : {good_angle, kept_.thin_angle})
      if (angle >= kept_.thin_angle && angles_are_within(angle)) {
        kept_.thin_angle = angle;
        kept_.radius_edge = no_ratio;
        return;
      }
  }

  /// Returns whether every tet keeps the bounds for this smallest angle, which creases and short edges of the
  /// surface may lower.
  bool angles_are_within(double smallest) { return count_beyond(smallest, forced_edges()) == 0; }

  std::shared_ptr<const ForcedEdges> forced_edges() {
    return forced_edges_of(made_.plc, mesh(), options_.mesh.bounds.lower_where_forced);
  }

  /// Returns the number of tets with angles beyond the bounds for this smallest angle.
  std::size_t count_beyond(double smallest, std::shared_ptr<const ForcedEdges> forced) {
    const ThinShape thin(made_.plc, mesh(), smallest, 0, std::move(forced));
    const auto& p = mesh().points;
    return static_cast<std::size_t>(std::ranges::count_if(mesh().tets, [&](const std::array<Index, 4>& v) {
      return !thin.contains({p[v[0]], p[v[1]], p[v[2]], p[v[3]]}, v);
    }));
  }

  void measure_before() {
    RemeshReport& report = made_.remeshing;
    report.smallest_angle_before = 180;
    for (const auto& [a, b, c, d] : mesh().tets) {
      const auto& p = mesh().points;
      const TetQuality quality = measure(p[a], p[b], p[c], p[d]);
      report.smallest_angle_before = std::min(report.smallest_angle_before, quality.min_dihedral);
      report.largest_angle_before = std::max(report.largest_angle_before, quality.max_dihedral);
    }
  }

  /// Chooses the size. If the options have no size, the field alone counts; without a field, the mesh's own
  /// lengths count.
  void choose_size() {
    MeshOptions& options = options_.mesh;
    const double diagonal = made_.plc.bounds.diagonal();
    if (options.size == 0) {
      if (!options.size_field) options.size_field = size_field_on_mesh(mesh(), lengths_at_vertices());
      options.size = diagonal;
    }
    const std::vector<double> sizes = target_sizes();
    largest_size_ = std::min(diagonal, *std::ranges::max_element(sizes));
  }

  /// Returns for each vertex the size that asks for edges of the present mean length there.
  std::vector<double> lengths_at_vertices() {
    std::vector<double> sum(mesh().points.size(), 0), count(sum);
    for (const auto& tet : mesh().tets)
      for (const Index v : tet)
        for (const Index w : tet)
          if (v != w) {
            sum[v] += distance(mesh().points[v], mesh().points[w]);
            count[v] += 1;
          }
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] /= Sizing::edge_per_size * count[v];
    return sum;
  }

  std::vector<double> target_sizes() { return coarsening::target_sizes(mesh(), made_.plc, options_.mesh); }

  void reshape() {
    if (is_full()) coarsen_and_improve();  // a mesh that is to become coarser may begin above the limit
    const bool poor = is_mostly_poor();
    if (poor) bring_to_size();
    for (unsigned pass = 0; pass < most_passes; ++pass) {
      const double from = 0.06 + 0.24 * pass;
      control_.begin("remesh", from, from + 0.12);
      const std::size_t divided = refine(pass == 0);
      control_.begin("coarsen", from + 0.12, from + 0.24);
      coarsen_and_improve();
      if (static_cast<double>(divided) < least_share * static_cast<double>(mesh().points.size())) break;
    }
    if (poor) relax();
    smooth(mesh(), made_.plc, kept_, Metric(target_sizes()), control_.execution());
    control_.stop_if_asked(control_.execution().cancelled());
    mark_thin_tets(mesh(), options_.mesh.bounds.radius_edge);
  }

  /// Returns whether so many tets miss the bounds on angles that improving them one by one is futile, as in a
  /// triangulation of nothing but the surface's vertices.
  bool is_mostly_poor() {
    const double thin_angle = options_.mesh.bounds.thin_angle, tets = static_cast<double>(mesh().tets.size());
    return static_cast<double>(count_beyond(thin_angle, nullptr)) > mostly * tets &&
           static_cast<double>(count_beyond(thin_angle, forced_edges())) > least_beyond * tets;
  }

  void bring_to_size() {
    control_.begin("remesh", 0.06, 0.12);
    control_.watch([&](const Execution& execution) {
      adapting::bring_to_size(mesh(), made_.plc, options_kept(), execution);
    });
    if (is_full()) coarsen_and_improve();
  }

  /// Divides edges so that vertices face each other, and coarsens again, as long as that reduces the number
  /// of tets that miss the bounds.
  void relax() {
    std::size_t fewest = count_beyond(options_.mesh.bounds.thin_angle, forced_edges());
    for (unsigned round = 0; round < most_rounds_of_poor && fewest > 0; ++round) {
      TetMesh before = mesh();
      const auto coarsening = made_.coarsening;
      const auto improvement = made_.improvement;
      const RemeshReport report = made_.remeshing;
      control_.watch(
          [&](const Execution& execution) { adapting::relax(mesh(), made_.plc, options_kept(), execution); });
      if (!is_full()) coarsen_and_improve();
      const std::size_t now = count_beyond(options_.mesh.bounds.thin_angle, forced_edges());
      if (is_full() || now >= fewest) {
        mesh() = std::move(before);
        made_.coarsening = coarsening;
        made_.improvement = improvement;
        made_.remeshing = report;
        return;
      }
      fewest = now;
    }
  }

  EditableMesh edited() { return {mesh(), made_.plc, options_.mesh.bounds, options_.mesh.edges_per_hole}; }

  /// Returns the options with the bounds that operations keep.
  MeshOptions options_kept() const {
    MeshOptions options = options_.mesh;
    options.bounds = kept_;
    return options;
  }

  /// Divides long edges, and improves the tets after each round, until no long edge can be divided or
  /// `most_rounds` rounds are made. With a given complex, then divides edges that are too far from its
  /// features. Returns how many edges it has divided in all.
  std::size_t refine(bool first) {
    EditableMesh piece = edited();
    if (first) improve_shapes(piece, false);
    const MeshOptions options = options_kept();
    EdgeDivision division(piece, options, target_sizes());
    std::size_t all = 0;
    for (unsigned round = 0; round < most_rounds; ++round) {
      const std::size_t divided = divide([&](const Execution& execution) {
        return division.divide_all(first ? longest_at_first : longest_later, options_.mesh.max_vertices,
                                   execution);
      });
      if (divided == 0) break;
      all += divided;
      ++made_.remeshing.rounds;
      improve_shapes(piece, true);
    }
    if (complex_ != nullptr) all += follow_features(piece, division);
    made_.remeshing.divided_edges += all;
    piece.store();
    return all;
  }

  /// Runs a division and returns its count. Throws Ended if the run was stopped or has too many vertices.
  std::size_t divide(const std::function<std::size_t(const Execution&)>& division) {
    std::size_t divided = 0;
    control_.watch([&](const Execution& execution) { divided = division(execution); });
    require_budget();
    return divided;
  }

  /// Divides edges that are too far from the curves and patches of the complex.
  std::size_t follow_features(EditableMesh& piece, EdgeDivision& division) {
    std::size_t all = 0;
    for (unsigned round = 0; round < most_distance_rounds; ++round) {
      piece.surfaces.accept_distant(distant_halves);
      const std::size_t divided = divide([&](const Execution& execution) {
        return division.divide_distant(options_.mesh.max_vertices, execution);
      });
      if (divided == 0) break;
      all += divided;
      piece.surfaces.accept_distant(1);
      improve_shapes(piece, true);
    }
    piece.surfaces.accept_distant(0);
    return all;
  }

  /// Improves poor tets by any operation that does not make the worst tet around worse. With `keep_vertices`,
  /// vertices are inserted and removed only at angles above the bound for thin tets.
  void improve_shapes(EditableMesh& piece, bool keep_vertices) {
    ImproveOptions options = improve_options(2);
    options.bounds = kept_;
    options.bounds.radius_edge = any_ratio;
    options.thin_above = keep_vertices ? 1e-3 : any_ratio;
    options.keep_vertices = keep_vertices;
    if (keep_vertices) options.passes = 1;
    // `coarsen_and_improve` also tries the slower operations on tets that are still poor.
    add(improve(piece, options, control_.execution(), false));
  }

  void coarsen_and_improve() {
    EditableMesh piece = edited();
    made_.coarsening = coarsen(piece, options_kept(), control_.execution());
    control_.stop_if_asked(made_.coarsening->cancelled);
    made_.remeshing.contracted_edges += made_.coarsening->contracted_edges;
    if (options_.improve > 0) {
      ImproveOptions options = improve_options(options_.improve);
      options.bounds = kept_;
      options.thin_above = options_.mesh.bounds.radius_edge;
      options.keep_vertices = true;
      if (options_.min_dihedral > 0) options.min_dihedral = options_.min_dihedral;
      add(improve(piece, options, control_.execution()));
    }
    piece.store();
  }

  void add(const ImproveReport& report) {
    control_.stop_if_asked(report.cancelled);
    made_.improvement = report;
  }

  void project() {
    if (!options_.exact) return;
    control_.begin("project", 0.78, 0.8);
    control_.watch([&](const Execution& execution) {
      made_.projection = project_boundary(mesh(), made_.plc, options_.exact,
                                          {.bounds = promised_, .threads = options_.mesh.threads}, execution);
    });
    mark_thin_tets(mesh(), promised_.radius_edge);
  }

  void raise_order() {
    if (options_.order == 1) return;
    control_.begin("second order", 0.8, 0.86);
    made_.second_order = make_second_order(
        mesh(), made_.plc, {.exact = options_.exact, .bounds = promised_, .threads = options_.mesh.threads},
        control_.execution());
    control_.stop_if_asked(made_.second_order.cancelled);
  }

  void certify() {
    control_.begin("check", 0.86, 0.96);
    made_.check =
        check(mesh(), made_.plc,
              {.bounds = promised_, .exact = options_.exact_measures, .threads = options_.mesh.threads},
              control_.execution());
    control_.stop_if_asked(made_.check.cancelled);
  }

  /// Removes feature numbers, which would refer to this internal complex. Tags identify features, as in a
  /// mesh from a file.
  void forget_numbers() {
    for (TetMesh::VertexFeature& feature : mesh().features) feature.feature = none;
    std::ranges::fill(mesh().face_patch, none);
    std::ranges::fill(mesh().edge_curve, none);
  }

  void partition_tets() {
    if (options_.partitions == 0) return;
    control_.begin("partition", 0.96, 1);
    partition(mesh(), options_.partitions);
  }

  bool is_full() {
    const std::size_t most = options_.mesh.max_vertices;
    return most != 0 && mesh().points.size() >= most;
  }

  void require_budget() {
    if (!is_full()) return;
    made_.result.status = MeshStatus::budget_hit;
    made_.result.message = fmt::format(
        "the limit of {} vertices is reached; raise --max-vertices, or the sizes for a coarser mesh",
        options_.mesh.max_vertices);
    throw Ended();
  }

  const TetMesh& given_;
  const Plc* complex_;
  PipelineOptions options_;
  const AdaptOptions& adapt_;
  RemeshResult made_;
  RunControl control_;
  double largest_size_ = 0;
  Bounds promised_;  // bounds of the certificate
  Bounds kept_;      // bounds that operations keep
};

}  // namespace
}  // namespace remeshing::adapting

namespace {

RemeshResult remesh(const TetMesh& mesh, const Plc* complex, const PipelineOptions& options,
                    const AdaptOptions& adapt, const Execution& execution) {
  if (!mesh.layers.prisms.empty() || !mesh.layers.pyramids.empty()) {
    TetMesh cut = tets_of_layers(mesh);
    cut.layers = {};
    return remesh(cut, complex, options, adapt, execution);
  }
  return remeshing::adapting::Remeshing(mesh, complex, options, adapt, execution).run();
}

}  // namespace

RemeshResult remesh(const TetMesh& mesh, const PipelineOptions& options, const AdaptOptions& adapt,
                    const Execution& execution) {
  return remesh(mesh, nullptr, options, adapt, execution);
}

RemeshResult remesh(const TetMesh& mesh, const Plc& complex, const PipelineOptions& options,
                    const AdaptOptions& adapt, const Execution& execution) {
  return remesh(mesh, &complex, options, adapt, execution);
}

}  // namespace collarmesh
