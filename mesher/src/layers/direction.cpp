// Finds the direction whose smallest cosine to the normals of walls is largest. It leads to the point of the
// normals' convex hull that is nearest to the origin (Aubry and Loehner, On the most normal normal, 2008).
// Uses the method of Frank and Wolfe, in its variant that moves weight from the normal with the largest
// cosine to the one with the smallest.
//
// Where walls meet sharply, uses Gilbert's algorithm, which only adds weight. It converges more slowly, so
// that after the permitted steps its direction is still nearer to the mean of the normals than the steepest
// one. In such places, layers along its direction become higher and cover more of the walls.
#include "layers/direction.h"

#include <algorithm>
#include <cmath>

namespace collarmesh::layering {

namespace {

constexpr unsigned most_steps = 200;
constexpr double direction_precision = 1e-6;
// Walls with a smaller cosine to the best direction meet sharply.
constexpr double narrow = 0.6;
// The direction from means of normals is used if its least cosine exceeds this share of the steepest
// direction's, and `narrow`.
constexpr double steep_enough = 0.85;
// Two planes count as the same if the sine of the angle between them is at most this.
constexpr double parallel = 1e-4;
// If only one direction is possible, the sine of its angle to each line and plane on which the node has to
// stay may be up to this: normals of curved patches are means over triangles, so the constraints agree only
// roughly.
constexpr double nearly_parallel = 0.02;

}  // namespace

std::optional<Direction> DirectionSearch::best() const {
  if (walls_.empty()) return std::nullopt;
  if (!lines_.empty() || planes_.size() > 1)
    if (const std::optional<Vector> way = only_way()) return judge(*way);
  if (!lines_.empty()) return std::nullopt;
  for (const Vector& plane : planes_)
    if (norm(cross(plane, planes_[0])) > parallel) return std::nullopt;
  const std::optional<Direction> steepest = judge(nearest_to_origin(walls_));
  if (!steepest || steepest->least_cosine <= narrow) return judge(nearest_from_mean());
  if (means_.empty()) return steepest;
  const std::optional<Direction> above_means = judge(nearest_to_origin(means_));
  const double enough = std::max(narrow, steep_enough * steepest->least_cosine);
  return above_means && above_means->least_cosine > enough ? above_means : steepest;
}

/// Returns the point nearest to the origin in the convex hull of these normals or, if there is a plane, of
/// their projections onto it.
Vector DirectionSearch::nearest_to_origin(const std::vector<Vector>& of) const {
  std::vector<Vector> normals;
  for (const Vector& n : of) normals.push_back(in_plane(n));
  std::vector<double> weights(normals.size(), 1.0 / static_cast<double>(normals.size()));
  Vector nearest{};
  for (std::size_t i = 0; i < normals.size(); ++i) nearest = nearest + weights[i] * normals[i];
  for (unsigned step = 0; step < most_steps; ++step) {
    std::size_t least = 0, farthest = normals.size();
    for (std::size_t i = 0; i < normals.size(); ++i) {
      if (dot(normals[i], nearest) < dot(normals[least], nearest)) least = i;
      if (weights[i] > 0 &&
          (farthest == normals.size() || dot(normals[i], nearest) > dot(normals[farthest], nearest)))
        farthest = i;
    }
    const Vector way = normals[least] - normals[farthest];
    const double gain = -dot(nearest, way);
    if (gain <= direction_precision * squared_norm(nearest)) break;
    const double moved = std::min(weights[farthest], gain / squared_norm(way));
    weights[least] += moved;
    weights[farthest] = moved < weights[farthest] ? weights[farthest] - moved : 0;
    nearest = nearest + moved * way;
  }
  return nearest;
}

/// Returns a point of the walls' hull between the mean of their normals and the point nearest to the origin.
Vector DirectionSearch::nearest_from_mean() const {
  Vector nearest{};
  for (const Vector& n : walls_) nearest = nearest + in_plane(n) / static_cast<double>(walls_.size());
  for (unsigned step = 0; step < most_steps; ++step) {
    const auto least = std::min_element(walls_.begin(), walls_.end(), [&](const Vector& a, const Vector& b) {
      return dot(in_plane(a), nearest) < dot(in_plane(b), nearest);
    });
    const Vector way = in_plane(*least) - nearest;
    const double gain = -dot(nearest, way);
    if (gain <= direction_precision * squared_norm(nearest)) break;
    nearest = nearest + std::min(1.0, gain / squared_norm(way)) * way;
  }
  return nearest;
}

/// Returns the direction of the line on which the node has to stay; nothing if there is no single one.
std::optional<Vector> DirectionSearch::only_way() const {
  Vector way{};
  if (!lines_.empty()) {
    way = lines_[0];
  } else {
    double steepest = parallel;
    for (std::size_t i = 1; i < planes_.size(); ++i)
      if (const Vector w = cross(planes_[0], planes_[i]); norm(w) > steepest) {
        steepest = norm(w);
        way = w / steepest;
      }
    if (steepest == parallel) return std::nullopt;
  }
  const bool fits =
      std::all_of(lines_.begin(), lines_.end(),
                  [&](const Vector& line) { return norm(cross(line, way)) <= nearly_parallel; }) &&
      std::all_of(planes_.begin(), planes_.end(),
                  [&](const Vector& plane) { return std::fabs(dot(plane, way)) <= nearly_parallel; });
  if (!fits) return std::nullopt;
  double sum = 0;
  for (const Vector& n : walls_) sum += dot(n, way);
  return lines_.empty() && sum < 0 ? -1.0 * way : way;
}

Vector DirectionSearch::in_plane(const Vector& v) const {
  return planes_.empty() ? v : v - dot(v, planes_[0]) * planes_[0];
}

std::optional<Direction> DirectionSearch::judge(const Vector& way) const {
  const double length = norm(way);
  if (!(length > 0)) return std::nullopt;
  Direction found{way / length, 1};
  for (const Vector& n : walls_) found.least_cosine = std::min(found.least_cosine, dot(n, found.direction));
  if (!(found.least_cosine > 0)) return std::nullopt;
  return found;
}

}  // namespace collarmesh::layering
