#include "collarmesh/predict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "collarmesh/error.h"
#include "collarmesh/options.h"
#include "common/parallel_for.h"
#include "common/thread_limit.h"
#include "predict/vertex_counts.h"

namespace collarmesh {

namespace {

constexpr double sizes_per_diagonal = 20;  // for the default size

// Returns the predicted time in seconds. It grows a little faster than the number of tets before coarsening;
// the coefficients are fitted (bench/predicted_elements.py).
double seconds_for(double refined_tets, unsigned order) {
  constexpr double of_one = 4.6e-6, power = 1.19, of_second_order = 1.3;
  return of_one * std::pow(refined_tets, power) * (order == 2 ? of_second_order : 1);
}

/// Returns the options with another size; 0: unchanged.
PipelineOptions with_size(PipelineOptions options, double size) {
  if (size > 0) options.mesh.size = size;
  return options;
}

void require_valid(const PipelineOptions& options, std::span<const double> sizes, const Plc& plc) {
  if (!options.coarsen) throw OptionError("only meshes that are coarsened can be predicted; set coarsen on");
  require_known_tags(options.mesh, plc);
  if (sizes.empty()) validate({options});
  for (const double size : sizes) {
    if (!(size >= 0) || !std::isfinite(size))
      throw OptionError(
          fmt::format("the size to predict is {}, but must be positive, or 0 for the default", size));
    validate({with_size(options, size)});
  }
}

/// Predicts the mesh of a complex with regions. `size` is the one in `options` or, if that is 0, its default.
Prediction predict_one(const prediction::Shape& shape, const PipelineOptions& options, double size) {
  const std::array models{prediction::Model(), prediction::model_of_refinement()};
  std::array<double, 2> tets{};
  parallel_for(models.size(),
               [&](std::size_t i) { tets[i] = prediction::count_tets(shape, options.mesh, models[i]); });
  return {size, std::max(1.0, tets[0]), seconds_for(tets[1], options.order)};
}

}  // namespace

std::vector<Prediction> predict(const Plc& plc, const PipelineOptions& options, std::span<const double> sizes,
                                const std::function<void(const Prediction&)>& told) {
  require_valid(options, sizes, plc);
  const double diagonal = plc.bounds.diagonal();
  const bool is_empty = plc.regions.size() < 2;
  const prediction::Shape shape(plc);
  ThreadLimit limit(options.mesh.threads);
  std::vector<Prediction> predictions;
  for (const double given : sizes) {
    PipelineOptions of_size = with_size(options, given);
    MeshOptions& mesh = of_size.mesh;
    Prediction made{.size = mesh.size > 0 ? mesh.size : diagonal / sizes_per_diagonal};
    if (!is_empty) {
      mesh.bounds.tolerance = tolerance_of(plc, mesh.bounds, mesh.size, static_cast<int>(options.order));
      limit.run([&] { made = predict_one(shape, of_size, made.size); });
    }
    predictions.push_back(made);
    if (told) told(made);
  }
  return predictions;
}

}  // namespace collarmesh
