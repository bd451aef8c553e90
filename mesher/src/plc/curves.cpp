#include "plc/curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/cells_at_vertices.h"
#include "common/disjoint_sets.h"
#include "common/distances.h"

namespace collarmesh::plc {

using namespace facets;

namespace {

class CurveFinder {
 public:
  CurveFinder(ComplexDraft& draft, const EdgeTable& edges, const std::vector<FeatureSegment>& segments,
              const std::vector<Index>& patch_of, const std::vector<Index>& folds, double feature_angle,
              Plc& plc)
      : draft_(draft),
        edges_(edges),
        segments_(segments),
        plc_(plc),
        exact_(feature_angle <= 0),
        largest_turn_(feature_angle * std::numbers::pi / 180),
        is_vertex_(draft.points.size(), false),
        is_fold_(draft.points.size(), false),
        used_(segments.size(), false) {
    for (const Index p : folds) is_vertex_[p] = is_fold_[p] = true;
    for (const Index p : draft.loose_points) {
      is_vertex_[p] = true;
      is_fold_[p] = false;
    }
    index_ends();
    collect_patches(patch_of);
  }

  void run() {
    mark_vertices();
    trace_chains();
    if (exact_) cut_bent_chains();
    add_vertices();
    for (const Chain& chain : chains_) add_curve(chain);
    for (Index c = 0; c < plc_.curves.size(); ++c) add_to_vertices(c);
  }

 private:
  struct Chain {
    std::vector<Index> points;  // the first point of a loop is repeated at its end
    Index segment;              // one of its segments
  };

  void index_ends() {
    std::vector<std::array<Index, 2>> ends;
    for (const FeatureSegment& s : segments_) ends.push_back({s.a, s.b});
    segments_at_ = {ends, draft_.points.size()};
  }

  void collect_patches(const std::vector<Index>& patch_of) {
    first_patch_.push_back(0);
    for (const FeatureSegment& s : segments_) {
      if (s.edge != none)
        for (const Index side : edges_.sides(s.edge)) patches_.push_back(patch_of[side / 3]);
      const auto begin = patches_.begin() + first_patch_.back();
      std::sort(begin, patches_.end());
      patches_.erase(std::unique(begin, patches_.end()), patches_.end());
      first_patch_.push_back(static_cast<Index>(patches_.size()));
    }
  }

  std::span<const Index> patches_of(Index segment) const {
    return {patches_.data() + first_patch_[segment], patches_.data() + first_patch_[segment + 1]};
  }
  Index other_end(Index segment, Index point) const {
    return segments_[segment].a == point ? segments_[segment].b : segments_[segment].a;
  }

  void mark_vertices() {
    mark_pinched_points();
    for (Index p = 0; p < draft_.points.size(); ++p)
      if (!segments_at_[p].empty() && !passes(p)) is_vertex_[p] = true;
  }

  // Marks points as vertices where several fans of triangles meet, or where a fan meets a segment that is no
  // edge of a triangle.
  void mark_pinched_points() {
    const auto& triangles = draft_.triangles;
    DisjointSets fans(3 * triangles.size());
    const auto corner_at = [&](Index side, Index point) {
      const Index t = side / 3;
      return 3 * t + static_cast<Index>(std::ranges::find(triangles[t], point) - triangles[t].begin());
    };
    for (Index e = 0; e < edges_.size(); ++e)
      for (const Index side : edges_.sides(e).subspan(1))
        for (const Index p : edges_.ends(e)) fans.unite(corner_at(edges_.sides(e)[0], p), corner_at(side, p));
    std::vector<Index> fan_of(draft_.points.size(), none);
    for (Index corner = 0; corner < 3 * triangles.size(); ++corner) {
      const Index p = triangles[corner / 3][corner % 3], fan = fans.find(corner);
      if (fan_of[p] == none) fan_of[p] = fan;
      if (fan_of[p] != fan) is_vertex_[p] = true;
    }
    for (const FeatureSegment& s : segments_)
      for (const Index p : {s.a, s.b})
        if (s.edge == none && fan_of[p] != none) is_vertex_[p] = true;
  }

  // Returns whether exactly one curve passes through this point.
  bool passes(Index point) const {
    const auto at = segments_at_[point];
    if (at.size() != 2) return false;
    const auto p = patches_of(at[0]), q = patches_of(at[1]);
    if (!std::equal(p.begin(), p.end(), q.begin(), q.end())) return false;
    if (segments_[at[0]].tag != segments_[at[1]].tag) return false;
    if (segments_[at[0]].given && segments_[at[1]].given) return true;
    const Point &here = draft_.points[point], &before = draft_.points[other_end(at[0], point)],
                &after = draft_.points[other_end(at[1], point)];
    const Vector u = here - before, v = after - here;
    if (exact_) return dot(u, v) > 0 && distance_to_segment(here, before, after) <= draft_.planar_tolerance;
    return std::atan2(norm(cross(u, v)), dot(u, v)) <= largest_turn_;
  }

  void trace_chains() {
    for (Index s = 0; s < segments_.size(); ++s)
      for (const Index p : {segments_[s].a, segments_[s].b})
        if (!used_[s] && is_vertex_[p]) trace(s, p);
    for (Index s = 0; s < segments_.size(); ++s)
      if (!used_[s]) trace(s, segments_[s].a);
  }

  void trace(Index segment, Index from) {
    Chain chain{{from}, segment};
    Index point = from;
    for (Index s = segment;;) {
      used_[s] = true;
      point = other_end(s, point);
      chain.points.push_back(point);
      if (is_vertex_[point] || point == from) break;
      const auto at = segments_at_[point];
      s = at[0] == s ? at[1] : at[0];
    }
    chains_.push_back(std::move(chain));
  }

  // Cuts chains, except given ones, at the points farthest from their chords until all pieces are straight.
  // This is necessary because `passes` compares a point only with its two neighbours.
  void cut_bent_chains() {
    std::vector<Chain> pieces;
    for (const Chain& chain : chains_) {
      if (segments_[chain.segment].given) {
        pieces.push_back(chain);
        continue;
      }
      std::vector<std::array<std::size_t, 2>> stack{{0, chain.points.size() - 1}};
      while (!stack.empty()) {
        const auto [first, last] = stack.back();
        stack.pop_back();
        const std::size_t farthest = farthest_from_chord(chain, first, last);
        if (deviation(chain, farthest, first, last) <= draft_.planar_tolerance &&
            chain.points[first] != chain.points[last]) {
          pieces.push_back({{chain.points.begin() + static_cast<std::ptrdiff_t>(first),
                             chain.points.begin() + static_cast<std::ptrdiff_t>(last) + 1},
                            chain.segment});
          is_vertex_[chain.points[first]] = is_vertex_[chain.points[last]] = true;
          continue;
        }
        stack.push_back({farthest, last});
        stack.push_back({first, farthest});
      }
    }
    chains_ = std::move(pieces);
  }

  double deviation(const Chain& chain, std::size_t at, std::size_t first, std::size_t last) const {
    return distance_to_segment(draft_.points[chain.points[at]], draft_.points[chain.points[first]],
                               draft_.points[chain.points[last]]);
  }

  std::size_t farthest_from_chord(const Chain& chain, std::size_t first, std::size_t last) const {
    std::size_t farthest = first;
    double largest = -1;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double d = deviation(chain, i, first, last);
      if (d <= largest) continue;
      largest = d;
      farthest = i;
    }
    return farthest;
  }

  void add_vertices() {
    vertex_at_.assign(draft_.points.size(), none);
    for (Index p = 0; p < draft_.points.size(); ++p) {
      if (!is_vertex_[p]) continue;
      vertex_at_[p] = static_cast<Index>(plc_.vertices.size());
      plc_.vertices.push_back({p, draft_.point_tags[p], {}, {}});
    }
  }

  void add_curve(const Chain& chain) {
    Plc::Curve curve;
    curve.points = chain.points;
    curve.tag = segments_[chain.segment].tag;
    curve.patches.assign(patches_of(chain.segment).begin(), patches_of(chain.segment).end());
    const Index first = chain.points.front(), last = chain.points.back();
    curve.closed = first == last && !is_vertex_[first];
    if (curve.closed) curve.points.pop_back();
    curve.ends = {vertex_at_[first], vertex_at_[last]};
    if (first != last) {
      double largest = 0;
      for (const Index p : chain.points)
        largest = std::fmax(largest,
                            distance_to_segment(draft_.points[p], draft_.points[first], draft_.points[last]));
      // If folds cut a given curve into pieces of two points, such a piece does not show whether the whole
      // curve is straight.
      const bool cut_off = segments_[chain.segment].given && (is_fold_[first] || is_fold_[last]);
      curve.straight = chain.points.size() == 2 ? !cut_off : largest <= draft_.planar_tolerance;
      if (curve.straight) draft_.largest_deviation = std::max(draft_.largest_deviation, largest);
    }
    plc_.curves.push_back(std::move(curve));
  }

  void add_to_vertices(Index c) {
    for (const Index v : plc_.curves[c].ends)
      if (v != none && (plc_.vertices[v].curves.empty() || plc_.vertices[v].curves.back() != c))
        plc_.vertices[v].curves.push_back(c);
  }

  ComplexDraft& draft_;
  const EdgeTable& edges_;
  const std::vector<FeatureSegment>& segments_;
  Plc& plc_;
  bool exact_;
  double largest_turn_;
  CellsAtVertices segments_at_;
  std::vector<Index> first_patch_, patches_;  // patches of each segment
  std::vector<bool> is_vertex_, is_fold_;     // folds are vertices that the input does not give
  std::vector<bool> used_;
  std::vector<Chain> chains_;
  std::vector<Index> vertex_at_;
};

}  // namespace

void find_curves(ComplexDraft& draft, const EdgeTable& edges, const std::vector<FeatureSegment>& segments,
                 const std::vector<Index>& patch_of, const std::vector<Index>& folds, double feature_angle,
                 Plc& plc) {
  CurveFinder(draft, edges, segments, patch_of, folds, feature_angle, plc).run();
}

}  // namespace collarmesh::plc
