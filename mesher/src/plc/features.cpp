#include "plc/features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/disjoint_sets.h"

namespace collarmesh::plc {

using namespace facets;

namespace {

class SegmentTest {
 public:
  SegmentTest(const ComplexDraft& draft, const EdgeTable& edges, const FlatClusters& clusters,
              double feature_angle)
      : draft_(draft),
        edges_(edges),
        clusters_(clusters),
        every_fold_(feature_angle <= 0),
        smallest_cosine_(std::cos(feature_angle * std::numbers::pi / 180)) {}

  bool operator()(Index edge) const {
    const auto sides = edges_.sides(edge);
    if (sides.size() != 2) return true;
    const Index s = sides[0] / 3, t = sides[1] / 3;
    if (draft_.origins[s].soup != draft_.origins[t].soup || draft_.origins[s].tag != draft_.origins[t].tag)
      return true;
    if (clusters_.seed[s] == clusters_.seed[t]) return false;
    const double cosine = dot(clusters_.normal[s], clusters_.normal[t]);
    // Soups that give their own features get a further curve only where two sheets are folded onto each
    // other, because no mesh can follow such a fold without a curve.
    if (draft_.soup_gives_features[draft_.origins[s].soup]) return cosine < 0;
    return every_fold_ || cosine < smallest_cosine_;
  }

 private:
  const ComplexDraft& draft_;
  const EdgeTable& edges_;
  const FlatClusters& clusters_;
  bool every_fold_;
  double smallest_cosine_;
};

// The extent of points along a normal.
struct Extent {
  Vector normal;
  double low = INFINITY, high = -INFINITY;
};

// Returns the corners of these triangles, with duplicates.
std::vector<Index> corners_of(const ComplexDraft& draft, const std::vector<Index>& triangles) {
  std::vector<Index> points;
  points.reserve(3 * triangles.size());
  for (const Index t : triangles)
    points.insert(points.end(), draft.triangles[t].begin(), draft.triangles[t].end());
  return points;
}

// Returns the largest distance of the points from a plane, or the first distance above the limit.
double deviation_from(const ComplexDraft& draft, const std::vector<Index>& points, const Point& origin,
                      const Vector& normal, double limit) {
  double largest = 0;
  for (const Index p : points) {
    largest = std::fmax(largest, std::fabs(dot(normal, draft.points[p] - origin)));
    if (largest > limit) break;
  }
  return largest;
}

}  // namespace

std::vector<FeatureSegment> find_segments(const ComplexDraft& draft, const EdgeTable& edges,
                                          const FlatClusters& clusters, double feature_angle) {
  std::vector<FeatureSegment> named;
  for (const Segment& s : draft.segments)
    named.push_back({std::min(s.a, s.b), std::max(s.a, s.b), edges.find(s.a, s.b), s.tag,
                     draft.soup_gives_features[s.soup]});
  std::ranges::stable_sort(named, {}, [](const FeatureSegment& s) { return std::array{s.edge, s.a, s.b}; });
  named.erase(std::unique(named.begin(), named.end(),
                          [](const auto& s, const auto& t) { return s.a == t.a && s.b == t.b; }),
              named.end());

  std::vector<FeatureSegment> segments;
  const SegmentTest is_segment(draft, edges, clusters, feature_angle);
  auto next = named.begin();
  for (Index e = 0; e < edges.size(); ++e) {
    if (next != named.end() && next->edge == e)
      segments.push_back(*next++);
    else if (is_segment(e))
      segments.push_back({edges.ends(e)[0], edges.ends(e)[1], e, 0});
  }
  segments.insert(segments.end(), next, named.end());
  return segments;
}

Index find_patches(const ComplexDraft& draft, const EdgeTable& edges,
                   const std::vector<FeatureSegment>& segments, std::vector<Index>& patch_of) {
  std::vector<bool> is_segment(edges.size(), false);
  for (const FeatureSegment& s : segments)
    if (s.edge != none) is_segment[s.edge] = true;
  DisjointSets patches(draft.triangles.size());
  for (Index e = 0; e < edges.size(); ++e)
    if (!is_segment[e])
      for (const Index side : edges.sides(e).subspan(1)) patches.unite(edges.sides(e)[0] / 3, side / 3);
  // The representative of a set is its first triangle.
  patch_of.resize(draft.triangles.size());
  Index count = 0;
  for (Index t = 0; t < draft.triangles.size(); ++t)
    patch_of[t] = patches.find(t) == t ? count++ : patch_of[patches.find(t)];
  return count;
}

void fit_plane(ComplexDraft& draft, const std::vector<Index>& triangles, Plc::Patch& patch) {
  Index largest = triangles[0];
  double largest_area = 0;
  Vector mean{};
  for (const Index t : triangles) {
    const Vector n = cross(draft.corner(t, 1) - draft.corner(t, 0), draft.corner(t, 2) - draft.corner(t, 0));
    mean = mean + n;
    const double twice_area = norm(n);
    if (twice_area <= largest_area) continue;
    largest = t;
    largest_area = twice_area;
  }
  const std::vector<Index> points = corners_of(draft, triangles);
  const auto accept = [&](const Point& origin, const Vector& normal) {
    const double limit = std::max(draft.planar_tolerance, draft.rounding());
    const double deviation = deviation_from(draft, points, origin, normal, limit);
    if (deviation > limit) return false;
    patch.planar = true;
    patch.origin = origin;
    patch.normal = normal;
    draft.largest_deviation = std::max(draft.largest_deviation, deviation);
    return true;
  };
  if (accept(draft.corner(largest, 0), unit_normal(draft, largest)) || norm(mean) == 0) return;
  // A plane with the mean normal may be nearer to all points than the plane of one triangle.
  Extent extent{mean / norm(mean)};
  const Point& base = draft.corner(largest, 0);
  for (const Index p : points) {
    const double height = dot(extent.normal, draft.points[p] - base);
    extent.low = std::fmin(extent.low, height);
    extent.high = std::fmax(extent.high, height);
  }
  accept(base + 0.5 * (extent.low + extent.high) * extent.normal, extent.normal);
}

}  // namespace collarmesh::plc
