#include "tolerance/forced_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace collarmesh {

namespace {

// Returns the distance between the two groups of corners that short edges join; infinite unless the short
// edges are exactly the edges between two groups. `across`: as for narrowness_of.
double distance_across(const std::array<Point, 4>& p, const std::array<unsigned, 4>& across) {
  constexpr unsigned all = 15;
  const unsigned other = across[0], own = all & ~other;
  for (unsigned i = 0; i < 4; ++i)
    if (across[i] != ((own >> i & 1U) != 0 ? other : own)) return INFINITY;
  std::array<Point, 4> q{};  // the corners, with those of one group first
  unsigned first = 0, last = 4;
  for (unsigned i = 0; i < 4; ++i) q[(own >> i & 1U) != 0 ? first++ : --last] = p[i];
  const Vector across_both = first == 2   ? cross(q[1] - q[0], q[3] - q[2])
                             : first == 1 ? cross(q[2] - q[1], q[3] - q[1])
                                          : cross(q[1] - q[0], q[2] - q[0]);
  const double length = norm(across_both);
  return length > 0 ? std::fabs(dot(q[3] - q[0], across_both)) / length : 0;
}

}  // namespace

double narrowness_of(const std::array<Point, 4>& p, const std::array<unsigned, 4>& across) {
  if ((across[0] | across[1] | across[2] | across[3]) == 0) return 1;
  double shortest = INFINITY, longest = 0;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = 0; j < i; ++j) {
      const double squared = squared_distance(p[i], p[j]);
      longest = std::max(longest, squared);
      if ((across[i] >> j & 1U) != 0) shortest = std::min(shortest, squared);
    }
  if (!(shortest < INFINITY)) return 1;
  const double left = std::min(std::sqrt(shortest), distance_across(p, across));
  return std::min(1.0, left / std::sqrt(longest));
}

ForcedEdges::ForcedEdges(const Plc& plc, std::vector<TetMesh::VertexFeature> features,
                         const std::vector<Point>& points, const std::vector<std::array<Index, 3>>& faces,
                         const std::vector<Index>& face_patch, double least_cosine)
    : contacts_(plc),
      features_(std::move(features)),
      normals_(features_.size()),
      least_cosine_(least_cosine) {
  for (Index f = 0; f < faces.size(); ++f) {
    const auto& [a, b, c] = faces[f];
    if (a == none) continue;  // the face was removed from a mesh under improvement
    const Vector normal = cross(points[b] - points[a], points[c] - points[a]);
    for (const Index v : faces[f])
      if (features_[v].dimension == 2 && features_[v].feature == face_patch[f])
        normals_[v] = normals_[v] + normal;
  }
  for (Vector& normal : normals_)
    if (const double length = norm(normal); length > 0) normal = normal / length;
}

bool ForcedEdges::forces(Index a, Index b) const {
  if (std::max(a, b) >= features_.size()) return false;
  const auto& [dimension, feature] = features_[a];
  const auto& [other_dimension, other] = features_[b];
  if (std::max(dimension, other_dimension) > 2 || feature == none || other == none) return false;
  if (dimension == 2 && other_dimension == 2 && feature == other)
    return dot(normals_[a], normals_[b]) < least_cosine_;
  return !contacts_.touch(dimension, feature, other_dimension, other);
}

double ForcedEdges::narrowness(const std::array<Point, 4>& p, const std::array<Index, 4>& corners) const {
  return narrowness_of(p, [&](unsigned i, unsigned j) { return forces(corners[i], corners[j]); });
}

double ForcedEdges::smallest_angle(double narrowness) {
  return 0.5 * std::atan(narrowness) * 180 / std::numbers::pi;
}

}  // namespace collarmesh
