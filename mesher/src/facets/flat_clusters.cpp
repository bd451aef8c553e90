#include "facets/flat_clusters.h"

#include <algorithm>
#include <cmath>

#include "delaunay/predicates.h"

namespace collarmesh::facets {

namespace {

// A triangle is a needle if its height is below this many planar tolerances.
constexpr double needle_height = 10;
// A triangle whose height is below this many tolerances of a plane may belong to that plane even if it faces
// the other way.
constexpr double foldable_height = 2;
// The tolerance of a seed's plane is at most this share of the seed's height (but covers rounding), so that
// the faces of a body smaller than the planar tolerance stay distinct.
constexpr double share_of_height = 0.1;

double longest_side(const ComplexDraft& draft, Index t) {
  return std::max({distance(draft.corner(t, 0), draft.corner(t, 1)),
                   distance(draft.corner(t, 1), draft.corner(t, 2)),
                   distance(draft.corner(t, 2), draft.corner(t, 0))});
}

class ClusterFinder {
 public:
  ClusterFinder(const ComplexDraft& draft, const EdgeTable& edges, ClusterBorder border)
      : draft_(draft),
        edges_(edges),
        border_(border),
        areas_(draft.triangles.size()),
        heights_(draft.triangles.size()),
        grows_(draft.triangles.size(), false) {
    result_.seed.assign(draft.triangles.size(), none);
    result_.normal.resize(draft.triangles.size());
    for (Index t = 0; t < areas_.size(); ++t) {
      areas_[t] =
          0.5 * norm(cross(draft.corner(t, 1) - draft.corner(t, 0), draft.corner(t, 2) - draft.corner(t, 0)));
      heights_[t] = 2 * areas_[t] / longest_side(draft, t);
      result_.normal[t] = unit_normal(draft, t);
    }
  }

  // Grows clusters from seeds, the largest triangles first. Most triangles of a curved surface have no
  // neighbour in their plane; they are no seeds.
  FlatClusters run() {
    std::vector<Index> order;
    for (Index t = 0; t < areas_.size(); ++t) {
      for_each_neighbour(t, [&](Index side) { grows_[t] = grows_[t] || joins(side, t, t); });
      if (grows_[t]) order.push_back(t);
    }
    std::ranges::sort(order, [this](Index a, Index b) { return precedes(a, b); });
    for (const Index t : order)
      if (result_.seed[t] == none) grow(t);
    for (Index t = 0; t < areas_.size(); ++t) {
      if (result_.seed[t] == none) result_.seed[t] = t;
      if (heights_[t] <= needle_height * draft_.planar_tolerance)
        result_.normal[t] = result_.normal[result_.seed[t]];
    }
    return std::move(result_);
  }

 private:
  bool precedes(Index a, Index b) const { return areas_[a] != areas_[b] ? areas_[a] > areas_[b] : a < b; }

  // Visits the neighbours of a triangle across edges of exactly two triangles, as sides.
  template <class Visit>
  void for_each_neighbour(Index t, const Visit& visit) const {
    for (unsigned i = 0; i < 3; ++i) {
      const auto sides = edges_.sides(edges_.edge_of(3 * t + i));
      if (sides.size() == 2) visit(sides[0] / 3 == t ? sides[1] : sides[0]);
    }
  }

  void grow(Index seed) {
    result_.seed[seed] = seed;
    stack_.assign(1, seed);
    while (!stack_.empty()) {
      const Index t = stack_.back();
      stack_.pop_back();
      for_each_neighbour(t, [&](Index side) {
        const Index other = side / 3;
        const bool had_its_turn = !grows_[other] && precedes(other, seed);
        if (had_its_turn || result_.seed[other] != none || !joins(side, t, seed)) return;
        result_.seed[other] = seed;
        stack_.push_back(other);
      });
    }
  }

  // Returns whether the triangle of this side belongs to the seed's cluster. Precondition: its neighbour t
  // does.
  bool joins(Index side, Index t, Index seed) const {
    return same_facet(t, side / 3) || (!divided(t, side / 3) && in_plane(side, seed));
  }

  // Returns whether a given feature separates two neighbours. A needle along the feature lies in the planes
  // of both faces, but must get the normal of its own face.
  bool divided(Index s, Index t) const {
    if (border_ == ClusterBorder::none) return false;
    const Origin &a = draft_.origins[s], &b = draft_.origins[t];
    return (a.soup != b.soup || a.tag != b.tag) &&
           (draft_.soup_gives_features[a.soup] || draft_.soup_gives_features[b.soup]);
  }

  // Returns whether two triangles are parts of one polygon: these count as coplanar, whatever rounding has
  // done to the corners.
  bool same_facet(Index s, Index t) const {
    return draft_.origins[s].soup == draft_.origins[t].soup &&
           draft_.origins[s].facet == draft_.origins[t].facet;
  }

  // Returns whether the triangle of this side lies in the plane of the seed, and faces the same way or is too
  // low to tell.
  bool in_plane(Index side, Index seed) const {
    const Point& p = draft_.points[apex(draft_.triangles, side)];
    if (!point_in_plane(p, seed)) return false;
    return dot(result_.normal[side / 3], result_.normal[seed]) > 0 ||
           heights_[side / 3] <= foldable_height * tolerance(seed);
  }

  double tolerance(Index seed) const {
    return std::min(draft_.planar_tolerance, std::max(share_of_height * heights_[seed], draft_.rounding()));
  }

  bool point_in_plane(const Point& p, Index seed) const {
    const Point& a = draft_.corner(seed, 0);
    if (draft_.planar_tolerance > 0) return std::fabs(dot(result_.normal[seed], p - a)) <= tolerance(seed);
    return predicates::orientation(a, draft_.corner(seed, 1), draft_.corner(seed, 2), p) == 0;
  }

  const ComplexDraft& draft_;
  const EdgeTable& edges_;
  ClusterBorder border_;
  std::vector<double> areas_, heights_;
  std::vector<bool> grows_;  // whether a triangle can be a seed
  std::vector<Index> stack_;
  FlatClusters result_;
};

}  // namespace

Vector unit_normal(const ComplexDraft& draft, Index triangle) {
  const Vector n = cross(draft.corner(triangle, 1) - draft.corner(triangle, 0),
                         draft.corner(triangle, 2) - draft.corner(triangle, 0));
  const double length = norm(n);
  return length > 0 ? n / length : Vector{};
}

FlatClusters find_flat_clusters(const ComplexDraft& draft, const EdgeTable& edges, ClusterBorder border) {
  return ClusterFinder(draft, edges, border).run();
}

}  // namespace collarmesh::facets
