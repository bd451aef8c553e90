#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/mesher.h"
#include "collarmesh/options.h"
#include "refine/generate_linked.h"
#include "refine/refinement.h"
#include "refine/trace_recorder.h"

namespace collarmesh {

namespace {

bool outside(const Plc::Patch& patch) { return patch.regions[0] == 0 && patch.regions[1] == 0; }

// The features to keep, and their new numbers by old numbers; `none` for removed features.
struct KeptNumbers {
  std::vector<Index> kept, number;

  template <class Features, class Keep>
  KeptNumbers(const Features& features, const Keep& keep) : number(features.size(), none) {
    for (Index i = 0; i < features.size(); ++i) {
      if (!keep(features[i])) continue;
      number[i] = static_cast<Index>(kept.size());
      kept.push_back(i);
    }
  }
  bool keeps(Index i) const { return number[i] != none; }
  // Drops removed features from a list and renumbers the others; the list stays sorted.
  void apply(std::vector<Index>& list) const {
    std::erase_if(list, [&](Index i) { return !keeps(i); });
    for (Index& i : list) i = number[i];
  }
};

/// The complex without the patches outside all regions, and without curves and vertices that lie only on such
/// patches: no mesh has these features, so they need no refinement. Points and regions keep their numbers.
class FeaturesInside {
 public:
  /// Keeps the complex by reference.
  explicit FeaturesInside(const Plc& complex) : complex_(complex) {
    if (std::ranges::none_of(complex.patches, outside)) return;
    const KeptNumbers patches(complex.patches, [](const Plc::Patch& patch) { return !outside(patch); });
    const auto keeps_some = [](const KeptNumbers& of, const std::vector<Index>& list) {
      return std::ranges::any_of(list, [&](Index i) { return of.keeps(i); });
    };
    const KeptNumbers curves(complex.curves, [&](const Plc::Curve& curve) {
      return curve.patches.empty() || keeps_some(patches, curve.patches);
    });
    const KeptNumbers vertices(complex.vertices, [&](const Plc::Vertex& vertex) {
      return (vertex.patches.empty() && vertex.curves.empty()) || keeps_some(patches, vertex.patches) ||
             keeps_some(curves, vertex.curves);
    });

    Plc& reduced = reduced_.emplace(complex);
    reduced.triangles.clear();
    reduced.patches.clear();
    reduced.curves.clear();
    reduced.vertices.clear();
    for (const Index p : patches.kept) {
      Plc::Patch& patch = reduced.patches.emplace_back(complex.patches[p]);
      patch.first_triangle = static_cast<Index>(reduced.triangles.size());
      for (Index i = 0; i < patch.triangle_count; ++i)
        reduced.triangles.push_back(
            {complex.triangles[complex.patches[p].first_triangle + i].points, patches.number[p]});
      curves.apply(patch.curves);
      vertices.apply(patch.vertices);
    }
    for (const Index c : curves.kept) {
      Plc::Curve& curve = reduced.curves.emplace_back(complex.curves[c]);
      for (Index& end : curve.ends)
        if (end != none) end = vertices.number[end];
      patches.apply(curve.patches);
    }
    for (const Index v : vertices.kept) {
      Plc::Vertex& vertex = reduced.vertices.emplace_back(complex.vertices[v]);
      curves.apply(vertex.curves);
      patches.apply(vertex.patches);
    }
    vertices_ = vertices.kept;
    curves_ = curves.kept;
    patches_ = patches.kept;
  }

  const Plc& plc() const { return reduced_ ? *reduced_ : complex_; }
  /// Returns the tolerance for `plc()`, made from one for the whole complex.
  SurfaceTolerance tolerance(const SurfaceTolerance& whole) const {
    return reduced_ ? whole.of_patches(complex_, patches_) : whole;
  }
  /// Replaces the numbers of features in a mesh of `plc()` by those in the whole complex.
  void restore_numbers(TetMesh& mesh) const {
    if (!reduced_) return;
    const auto restore = [](Index& feature, const std::vector<Index>& whole) {
      if (feature != none) feature = whole[feature];
    };
    for (Index& patch : mesh.face_patch) restore(patch, patches_);
    for (Index& curve : mesh.edge_curve) restore(curve, curves_);
    for (TetMesh::VertexFeature& feature : mesh.features)
      if (feature.dimension < 3)
        restore(feature.feature, feature.dimension == 0   ? vertices_
                                 : feature.dimension == 1 ? curves_
                                                          : patches_);
  }

 private:
  const Plc& complex_;
  std::optional<Plc> reduced_;                      // nothing if no patch lies outside
  std::vector<Index> vertices_, curves_, patches_;  // by kept feature: its number in the whole complex
};

void require(bool holds, const std::string& message) {
  if (!holds) throw OptionError(message);
}

void require_valid(const MeshOptions& o) {
  RunOptions options;
  options.mesh = o;
  options.coarsen = false;  // coarsening validates its own options
  validate(options);
  require(o.edges_per_hole >= 0, "edges per hole must be at least 0 (0: no minimum)");
  require(o.exterior_radius_edge >= 1, "the exterior radius-edge bound must be at least 1");
  require(o.representation_angle > 0 && o.representation_angle < 90,
          "the representation angle must be between 0 and 90 degrees");
}

}  // namespace

double default_distance(double size, double diagonal, int order) {
  constexpr double share_of_size = 0.1, sizes_per_diagonal = 20, for_curved_elements = 1.0 / 550;
  const double largest = diagonal / sizes_per_diagonal;
  const double distance = share_of_size * (size > 0 ? std::min(size, largest) : largest);
  return order == 2 ? std::min(distance, for_curved_elements * diagonal) : distance;
}

MeshResult generate(const Plc& plc, const MeshOptions& options, const Execution& execution) {
  KnownNeighbours neighbours;
  return generate(plc, options, execution, neighbours);
}

MeshResult generate(const Plc& plc, const MeshOptions& options, const Execution& execution,
                    KnownNeighbours& neighbours, Trace* trace) {
  require_valid(options);
  const FeaturesInside inside(plc);
  MeshOptions of_inside = with_profile(options);
  of_inside.bounds.tolerance = inside.tolerance(tolerance_of(plc, options.bounds, options.size));
  std::optional<Refinement> refinement(std::in_place, inside.plc(), of_inside, execution);
  if (trace != nullptr) refinement->record_steps();
  MeshResult result;
  result.status = refinement->run();
  if (refinement->narrow_cells_are_dear()) {
    of_inside.narrow_cells = NarrowCells::left;
    refinement.emplace(inside.plc(), of_inside, execution);
    if (trace != nullptr) refinement->record_steps();
    result.status = refinement->run();
  }
  result.has_narrow_cells = of_inside.narrow_cells == NarrowCells::left;
  result.statistics = refinement->statistics();
  result.message = refinement->message();
  if (trace != nullptr) *trace = refinement->trace();
  if (!result.message.empty()) result.where = refinement->where();
  if (result.status == MeshStatus::complete || result.status == MeshStatus::guarantee_missed) {
    Extracted extracted = refinement->extract();
    result.mesh = std::move(extracted.mesh);
    neighbours = std::move(extracted.neighbours);
    inside.restore_numbers(result.mesh);
    if (trace != nullptr) trace->push_back(stitched_step(result.mesh, trace->back()));
  }
  return result;
}

}  // namespace collarmesh
