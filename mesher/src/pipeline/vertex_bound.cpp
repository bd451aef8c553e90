#include "pipeline/vertex_bound.h"

#include <algorithm>
#include <cmath>

#include "collarmesh/options.h"
#include "predict/vertex_counts.h"
#include "tolerance/curvature.h"

namespace collarmesh {

namespace {

// Coefficients of the bound on the number of vertices that refinement makes before coarsening. Real parts
// need at most a quarter of it.
constexpr double always = 20000, by_feature = 160, by_square = 64, by_cube = 160;
constexpr double sizes_per_diagonal = 20;  // as for the default size

constexpr double square(double x) { return x * x; }

double area_of(const Plc& plc, Index triangle) {
  const auto& [a, b, c] = plc.triangles[triangle].points;
  return 0.5 * norm(cross(plc.points[b] - plc.points[a], plc.points[c] - plc.points[a]));
}

/// Returns how many squares together have the patch's area. The side of a square is the size or, if that is
/// shorter, the longest chord that keeps the tolerance.
double squares_on(const Plc& plc, const Plc::Patch& patch, double size, const SurfaceTolerance& tolerance) {
  const std::vector<Curvature> curvature =
      patch.planar ? std::vector<Curvature>(patch.triangle_count) : curvatures(plc, patch);
  constexpr double most_per_square = 1. / 16;  // smallest area of a square, relative to the size squared: a
                                               // limit for folds, where the surface turns very sharply
  double squares = 0;
  for (Index i = 0; i < patch.triangle_count; ++i) {
    const Index t = patch.first_triangle + i;
    const double area = area_of(plc, t);
    const double squared_chord = 8 * tolerance.at_triangle(t) / curvature[i].largest;
    squares += area / (curvature[i].largest > 0
                           ? std::clamp(squared_chord, most_per_square * size * size, size * size)
                           : size * size);
  }
  return squares;
}

/// Returns how many squares together have the area of the patch's curved triangles. The side of a square is
/// the longest chord that keeps the tolerance or, if that is shorter, the size. Where the radius of curvature
/// is below the tolerance, as in folds, the tolerance is taken as the radius.
double squares_of_chords(const Plc& plc, const Plc::Patch& patch, double size,
                         const SurfaceTolerance& tolerance) {
  if (patch.planar) return 0;
  const std::vector<Curvature> curvature = curvatures(plc, patch);
  double squares = 0;
  for (Index i = 0; i < patch.triangle_count; ++i) {
    const Index t = patch.first_triangle + i;
    if (!(curvature[i].largest > 0)) continue;
    const double near = tolerance.at_triangle(t), radius = std::max(1 / curvature[i].largest, near);
    squares += area_of(plc, t) / std::min(8 * near * radius, size * size);
  }
  return squares;
}

// Returns whether the only sizes are one target edge length everywhere and target lengths of regions.
bool plain_sizes(const PipelineOptions& options) {
  RunOptions given{options};
  given.mesh.region_size.clear();
  const RunOptions defaults;
  return !options.mesh.size_field && std::ranges::none_of(option_table(), [&](const Option& option) {
    return option.finer && option.get(given) != option.get(defaults);
  });
}

double expected_by_features(const Plc& plc, const MeshOptions& options) {
  const double diagonal = plc.bounds.diagonal(),
               everywhere = options.size > 0 ? options.size : diagonal / sizes_per_diagonal;
  const auto size_of = [&](const Plc::Region& region) {
    const auto asked = options.region_size.find(region.tag);
    return std::min(everywhere, asked != options.region_size.end() ? asked->second
                                : region.size > 0                  ? region.size
                                                                   : everywhere);
  };
  const SurfaceTolerance tolerance = tolerance_of(plc, options.bounds, options.size);
  double vertices =
      by_feature * static_cast<double>(plc.vertices.size() + plc.curves.size() + plc.patches.size());
  for (Index r = 1; r < plc.regions.size(); ++r)
    vertices += by_cube * std::fabs(plc.regions[r].volume) / std::pow(size_of(plc.regions[r]), 3);
  for (const Plc::Patch& patch : plc.patches) {
    const double size =
        std::min(size_of(plc.regions[patch.regions[0]]), size_of(plc.regions[patch.regions[1]]));
    vertices += by_square * squares_on(plc, patch, size, tolerance);
  }
  return vertices;
}

// Returns the factor by which bounds tighter than the defaults increase the number of vertices. Near smooth
// surfaces this number is inversely proportional to the surface distance.
double by_bounds(const Plc& plc, const MeshOptions& options) {
  constexpr double power = 4, by_vertex_ratio = 4;
  const double distance =
      options.bounds.distance > 0
          ? default_distance(options.size, plc.bounds.diagonal()) / options.bounds.distance
          : 1;
  const double ratio = std::pow(Bounds{}.radius_edge / options.bounds.radius_edge, power);
  return std::max(1.0, distance) * std::max(1.0, ratio) * (options.vertex_ratio > 0 ? by_vertex_ratio : 1);
}

}  // namespace

double smallest_size(const MeshOptions& options, double diagonal) {
  double size = options.size > 0 ? options.size : diagonal / sizes_per_diagonal;
  for (const auto* sizes : {&options.region_size, &options.patch_size, &options.curve_size})
    for (const auto& [tag, asked] : *sizes) size = std::min(size, asked);
  return size;
}

std::size_t most_vertices_expected(const Plc& plc, const PipelineOptions& options) {
  constexpr double tets_per_vertex = 6, largest = 1e15;
  MeshOptions mesh = options.mesh;
  double vertices = expected_by_features(plc, mesh);
  if (!plain_sizes(options) && plc.regions.size() > 1)
    vertices += by_cube * prediction::count_tets(prediction::Shape(plc), mesh) / tets_per_vertex;
  return static_cast<std::size_t>(std::min((always + vertices) * by_bounds(plc, mesh), largest));
}

std::size_t most_vertices_on_rods(const Plc& plc, const MeshOptions& options) {
  // `by_chord`: vertices for each square whose sides are the longest chords that keep the tolerance; rods far
  // thinner than the size need fewer. `most`: the largest number returned.
  constexpr double by_chord = 8, most = 1e6;
  const SurfaceTolerance tolerance = tolerance_of(plc, options.bounds, options.size);
  const double size = smallest_size(options, plc.bounds.diagonal());
  double squares = 0;
  for (const Plc::Patch& patch : plc.patches) {
    double area = 0;
    for (Index i = 0; i < patch.triangle_count; ++i) area += area_of(plc, patch.first_triangle + i);
    const double own = squares_of_chords(plc, patch, size, tolerance);
    const auto is_thicker_than_chords = [&](Index region) {
      return region == 0 || 4 * square(plc.regions[region].volume / area) > area / own;
    };
    if (own > 0 && std::ranges::all_of(patch.regions, is_thicker_than_chords)) squares += own;
  }
  return static_cast<std::size_t>(std::min(by_chord * squares, most));
}

}  // namespace collarmesh
