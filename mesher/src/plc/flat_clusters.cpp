#include "plc/flat_clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "delaunay/predicates.h"

namespace collarmesh::build {

namespace {

// A triangle lower than this many planar tolerances is a needle.
constexpr double needle_height = 10;
// One lower than this many may lie in a plane whatever its own normal says.
constexpr double foldable_height = 2;

double longest_side(const Draft& draft, Index t) {
  return std::max({distance(draft.corner(t, 0), draft.corner(t, 1)),
                   distance(draft.corner(t, 1), draft.corner(t, 2)),
                   distance(draft.corner(t, 2), draft.corner(t, 0))});
}

class ClusterFinder {
 public:
  ClusterFinder(const Draft& draft, const EdgeTable& edges)
      : draft_(draft), edges_(edges), areas_(draft.triangles.size()), heights_(draft.triangles.size()) {
    result_.seed.assign(draft.triangles.size(), none);
    result_.normal.resize(draft.triangles.size());
    for (Index t = 0; t < areas_.size(); ++t) {
      areas_[t] =
          0.5 * norm(cross(draft.corner(t, 1) - draft.corner(t, 0), draft.corner(t, 2) - draft.corner(t, 0)));
      heights_[t] = 2 * areas_[t] / longest_side(draft, t);
      result_.normal[t] = unit_normal(draft, t);
    }
  }

  FlatClusters run() {
    std::vector<Index> order(areas_.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(),
              [this](Index a, Index b) { return areas_[a] != areas_[b] ? areas_[a] > areas_[b] : a < b; });
    for (const Index t : order)
      if (result_.seed[t] == none) grow(t);
    for (const Index t : order)
      if (heights_[t] <= needle_height * draft_.planar_tolerance)
        result_.normal[t] = result_.normal[result_.seed[t]];
    return std::move(result_);
  }

 private:
  void grow(Index seed) {
    result_.seed[seed] = seed;
    stack_.assign(1, seed);
    while (!stack_.empty()) {
      const Index t = stack_.back();
      stack_.pop_back();
      for (unsigned i = 0; i < 3; ++i) {
        const auto sides = edges_.sides(edges_.edge_of(3 * t + i));
        if (sides.size() != 2) continue;
        const Index side = sides[0] / 3 == t ? sides[1] : sides[0];
        if (result_.seed[side / 3] != none || !(same_facet(t, side / 3) || in_plane(side, seed))) continue;
        result_.seed[side / 3] = seed;
        stack_.push_back(side / 3);
      }
    }
  }

  // A polygon is one plane, whatever rounding has done to its corners.
  bool same_facet(Index s, Index t) const {
    return draft_.origins[s].soup == draft_.origins[t].soup &&
           draft_.origins[s].facet == draft_.origins[t].facet;
  }

  // Does the triangle lie in the plane of the seed, seen from the same side?
  bool in_plane(Index side, Index seed) const {
    const Point& p = draft_.points[apex(draft_.triangles, side)];
    if (!point_in_plane(p, seed)) return false;
    return dot(result_.normal[side / 3], result_.normal[seed]) > 0 ||
           heights_[side / 3] <= foldable_height * draft_.planar_tolerance;
  }

  bool point_in_plane(const Point& p, Index seed) const {
    const Point& a = draft_.corner(seed, 0);
    if (draft_.planar_tolerance > 0)
      return std::fabs(dot(result_.normal[seed], p - a)) <= draft_.planar_tolerance;
    return predicates::orientation(a, draft_.corner(seed, 1), draft_.corner(seed, 2), p) == 0;
  }

  const Draft& draft_;
  const EdgeTable& edges_;
  std::vector<double> areas_, heights_;
  std::vector<Index> stack_;
  FlatClusters result_;
};

}  // namespace

Vector unit_normal(const Draft& draft, Index triangle) {
  const Vector n = cross(draft.corner(triangle, 1) - draft.corner(triangle, 0),
                         draft.corner(triangle, 2) - draft.corner(triangle, 0));
  const double length = norm(n);
  return length > 0 ? n / length : Vector{};
}

FlatClusters find_flat_clusters(const Draft& draft, const EdgeTable& edges) {
  return ClusterFinder(draft, edges).run();
}

}  // namespace collarmesh::build
