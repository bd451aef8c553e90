#include "collarmesh/predict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "collarmesh/error.h"
#include "collarmesh/options.h"
#include "predict/vertex_counts.h"

namespace collarmesh {

namespace {

constexpr double sizes_per_diagonal = 20;  // of the default size

// Returns the predicted seconds, which are mostly proportional to the tets before coarsening; fitted
// (bench/predicted_elements.py).
double seconds_for(double refined_tets, unsigned order) {
  constexpr double of_one = 4.6e-6, power = 1.19, of_second_order = 1.3;
  return of_one * std::pow(refined_tets, power) * (order == 2 ? of_second_order : 1);
}

/// Returns the options with another size; 0: their own.
PipelineOptions with_size(PipelineOptions options, double size) {
  if (size > 0) options.mesh.size = size;
  return options;
}

void require_valid(const PipelineOptions& options, std::span<const double> sizes, const Plc& plc) {
  if (!options.coarsen) throw OptionError("only meshes that are coarsened can be predicted");
  require_known_tags(options.mesh, plc);
  if (sizes.empty()) validate({options});
  for (const double size : sizes) {
    if (!(size >= 0) || !std::isfinite(size))
      throw OptionError(fmt::format("a size of {} cannot be predicted; 0 stands for the default", size));
    validate({with_size(options, size)});
  }
}

}  // namespace

std::vector<Prediction> predict(const Plc& plc, const PipelineOptions& options,
                                std::span<const double> sizes) {
  require_valid(options, sizes, plc);
  const double diagonal = plc.bounds.diagonal();
  const bool is_empty = plc.regions.size() < 2;
  const prediction::Shape shape(plc);
  std::vector<Prediction> predictions;
  for (const double given : sizes) {
    PipelineOptions of_size = with_size(options, given);
    MeshOptions& mesh = of_size.mesh;
    Prediction& made = predictions.emplace_back();
    made.size = mesh.size > 0 ? mesh.size : diagonal / sizes_per_diagonal;
    if (is_empty) continue;
    mesh.bounds.tolerance = tolerance_of(plc, mesh.bounds, mesh.size, static_cast<int>(options.order));
    made.tets = std::max(1.0, prediction::count_tets(shape, mesh));
    const double refined = prediction::count_tets(shape, mesh, prediction::model_of_refinement());
    made.seconds = seconds_for(refined, options.order);
  }
  return predictions;
}

}  // namespace collarmesh
