#include "pipeline/rod_axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/distances.h"

namespace collarmesh::pipeline {

RodAxes::RodAxes(const std::vector<SheathedRod>& rods) : rods_(rods) {
  std::vector<std::array<Index, 3>> pieces;
  for (Index rod = 0; rod < rods.size(); ++rod) {
    const std::vector<Point>& axis = rods[rod].axis;
    first_point_.push_back(static_cast<Index>(points_.size()));
    for (std::size_t i = 0; i < axis.size(); ++i) {
      const auto at = static_cast<Index>(points_.size());
      points_.push_back(axis[i]);
      along_.push_back(i > 0 ? along_.back() + collarmesh::distance(axis[i - 1], axis[i]) : 0);
      if (i + 1 == axis.size()) continue;
      pieces.push_back({at, at + 1, at + 1});
      rod_of_.push_back(rod);
    }
    most_reach_ = std::max(most_reach_, rods[rod].reach);
  }
  first_point_.push_back(static_cast<Index>(points_.size()));
  pieces_.emplace(points_, std::move(pieces));
  common_rod_ = pieces_->common_labels(rod_of_);
}

double RodAxes::distance(Index rod, const Point& p) const {
  return std::sqrt(pieces_->squared_distance_to(
      p, INFINITY, nullptr, [&](Index node) { return common_rod_[node] != none && common_rod_[node] != rod; },
      [&](Index piece) { return rod_of_[piece] == rod; }));
}

bool RodAxes::comes_near_itself(Index rod, double along, double across) const {
  const Index first = first_point_[rod], end = first_point_[rod + 1], root = pieces_->root();
  const double bound = across * across;
  bool comes_near = false;
  for (Index at = first; at < end && !comes_near; ++at)
    pieces_->visit_near(
        {&root, 1}, points_[at], bound,
        [&](Index node) { return common_rod_[node] != none && common_rod_[node] != rod; },
        [&](Index piece) {
          if (rod_of_[piece] != rod) return;
          const auto& [from, to, same] = pieces_->points(piece);
          const double length =
                           std::min(std::fabs(along_[from] - along_[at]), std::fabs(along_[to] - along_[at])),
                       other_way = rods_[rod].ends.empty() ? along_[end - 1] - length : length;
          if (std::min(length, other_way) <= along) return;
          comes_near |= squared_distance_to_segment(points_[at], points_[from], points_[to]) < bound;
        });
  return comes_near;
}

std::vector<Index> RodAxes::rods_near(const Point& p, double room, double more) const {
  std::vector<Index> near;
  if (pieces_->empty()) return near;
  const Index root = pieces_->root();
  const double farthest = room * most_reach_ + more, bound = farthest * farthest;
  const auto is_found = [&](Index rod) { return std::ranges::count(near, rod) > 0; };
  pieces_->visit_near(
      {&root, 1}, p, bound,
      [&](Index node) { return common_rod_[node] != none && is_found(common_rod_[node]); },
      [&](Index piece) {
        const Index rod = rod_of_[piece];
        if (is_found(rod)) return;
        const auto [a, b, c] = pieces_->corners(piece);
        const double least = room * rods_[rod].reach + more;
        if (squared_distance_to_triangle(p, a, b, c) <= least * least) near.push_back(rod);
      });
  std::ranges::sort(near);
  return near;
}

}  // namespace collarmesh::pipeline
