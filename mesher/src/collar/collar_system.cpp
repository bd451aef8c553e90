#include "collar/collar_system.h"

#include <cassert>
#include <numeric>

#include "collar/collar_placement.h"
#include "common/sort_uniquely.h"

namespace collarmesh {

CollarSystem::CollarSystem(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases) {
  if (creases.empty()) return;
  features_ = std::make_unique<const FeatureHierarchy>(plc, points);
  vertex_ball_.assign(plc.vertices.size(), none);
  crease_curve_.assign(plc.curves.size(), false);
  for (const Crease& crease : creases) {
    if (crease.vertex != none) crease_vertices_.push_back(crease.vertex);
    if (crease.curve != none) crease_curve_[crease.curve] = true;
  }
  for (Index c = 0; c < plc.curves.size(); ++c)
    if (crease_curve_[c] && !plc.curves[c].closed)
      crease_vertices_.insert(crease_vertices_.end(), plc.curves[c].ends.begin(), plc.curves[c].ends.end());
  sort_uniquely(crease_vertices_);
  plant(plc, points);
}

CollarSystem::CollarSystem(const Plc& plc, std::span<const Point> points, std::span<const Crease> creases,
                           const CollarOptions& options)
    : CollarSystem(plc, points, creases) {
  if (creases.empty()) return;
  GapInHierarchy gap(plc, *features_);
  if (!CollarPlacement(plc, points, gap, options, *this).place_all()) balls_.clear();
}

// Builds the tree over creases. A curve is one leaf, because its balls are added at once.
void CollarSystem::plant(const Plc& plc, std::span<const Point> points) {
  std::vector<Point> centres;
  std::vector<std::size_t> numbers;  // places in `leaves_`
  for (const Index vertex : crease_vertices_) {
    numbers.push_back(vertex);
    centres.push_back(points[plc.vertices[vertex].point]);
  }
  for (Index curve = 0; curve < plc.curves.size(); ++curve) {
    if (!crease_curve_[curve]) continue;
    Box box;
    for (const Index p : plc.curves[curve].points) box.add(points[p]);
    numbers.push_back(plc.vertices.size() + curve);
    centres.push_back(box.centre());
  }
  const auto count = static_cast<Index>(centres.size());
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), Index{0});
  const auto centre_of = [&](Index crease) { return centres[crease]; };
  creases_.add(
      0, count, 1, median_splits(std::span(order), centre_of), [](Index, Index) { return Box{}; }, joined);
  root_of_.assign(count, none);
  leaves_.assign(plc.vertices.size() + plc.curves.size(), none);
  for (Index node = 0; node < creases_.node_count(); ++node)
    if (creases_.is_leaf(node))
      leaves_[numbers[order[creases_.first(node)]]] = node;
    else
      creases_.bounds(creases_.left(node)).parent = creases_.bounds(creases_.right(node)).parent = node;
}

void CollarSystem::complete() {
  if (creases_.empty()) return;
  creases_ = {};
  leaves_.clear();
  root_of_.clear();
  trees_ = {};
  if (!balls_.empty()) build_over_balls(0);
}

// Adds to the trees the balls placed since the last call. Precondition: the system is not complete.
void CollarSystem::index_balls(const Feature& crease) {
  assert(!creases_.empty());
  if (indexed_ == balls_.size()) return;
  const Index leaf = leaf_of(crease);
  root_of_[creases_.first(leaf)] = trees_.node_count();
  const Box box = build_over_balls(indexed_);
  indexed_ = static_cast<Index>(balls_.size());
  for (Index node = leaf; node != none; node = creases_.bounds(node).parent) {
    OfCreases& bounds = creases_.bounds(node);
    bounds.box.add(box);
    bounds.centred = CentredBox(bounds.box);
  }
}

Box CollarSystem::build_over_balls(Index first) {
  std::vector<Index> order(balls_.size() - first);
  std::iota(order.begin(), order.end(), first);
  const Index root = trees_.node_count();
  const auto centre_of = [&](Index ball) { return balls_[ball].centre; };
  const auto box_of = [&](Index place, Index) {
    const auto& [centre, radius, dimension, feature] = balls_[order[place]];
    const Vector reach = radius * (1 + 1e-9) * Vector{1, 1, 1};
    return Box{centre - reach, centre + reach};
  };
  const Box box = trees_.add(0, static_cast<Index>(order.size()), 1,
                             median_splits(std::span(order), centre_of), box_of, joined);
  trees_.renumber([&](Index place) { return order[place]; }, root);
  return box;
}

// Visits the balls below nodes whose box qualifies, until visit_ball returns true.
template <class Meets, class Visit>
void CollarSystem::visit(const Meets& meets_box, const Visit& visit_ball) const {
  if (!creases_.empty())
    creases_.descend(
        0, [&](const OfCreases& bounds) { return meets_box(bounds.centred); },
        [&](Index crease) {
          return root_of_[crease] != none && trees_.descend(root_of_[crease], meets_box, visit_ball);
        });
  else if (!trees_.empty())
    trees_.descend(0, meets_box, visit_ball);
}

Index CollarSystem::ball_containing(const Point& p) const {
  Index found = none;
  visit([&](const CentredBox& box) { return box.squared_distance(p) == 0; },
        [&](Index ball) {
          if (!contains(ball, p)) return false;
          found = ball;
          return true;
        });
  return found;
}

void CollarSystem::balls_meeting(const Point& p, double radius, std::size_t most,
                                 std::vector<Index>& found) const {
  found.clear();
  visit([&](const CentredBox& box) { return box.squared_distance(p) <= radius * radius; },
        [&](Index ball) {
          const double reach = radius + balls_[ball].radius;
          if (squared_distance(p, balls_[ball].centre) <= reach * reach) found.push_back(ball);
          return found.size() >= most;
        });
}

void CollarSystem::balls_on_segment(const Point& p, const Point& q, std::vector<Index>& found) const {
  found.clear();
  const SegmentAgainstBoxes segment(p, q);
  visit([&](const CentredBox& box) { return segment.may_meet(box); },
        [&](Index ball) {
          if (contains(ball, nearest_point_on_segment(balls_[ball].centre, p, q))) found.push_back(ball);
          return false;
        });
}

}  // namespace collarmesh
