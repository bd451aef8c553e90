#include "repair/changing_triangles.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace collarmesh::repairing {

using namespace facets;

ChangingTriangles::ChangingTriangles(ComplexDraft& draft, double reach, Work& work)
    : draft_(draft), reach_(reach), work_(work), frame_(draft.points, draft.triangles) {
  alive_.assign(draft.triangles.size(), true);
  count_ = draft.triangles.size();
  normals_.resize(count_);
  first_.assign(draft.points.size(), none);
  degree_.assign(draft.points.size(), 0);
  next_.assign(3 * count_, none);
  previous_.assign(3 * count_, none);
  for (Index t = 0; t < end(); ++t) link(t);
}

void ChangingTriangles::link(Index t) {
  const Vector normal =
      cross(draft_.corner(t, 1) - draft_.corner(t, 0), draft_.corner(t, 2) - draft_.corner(t, 0));
  const double length = norm(normal);
  normals_[t] = length > 0 ? normal / length : normal;
  for (unsigned i = 0; i < 3; ++i) {
    const Index p = draft_.triangles[t][i];
    next_[3 * t + i] = first_[p];
    if (first_[p] != none) previous_[first_[p]] = 3 * t + i;
    previous_[3 * t + i] = none;
    first_[p] = 3 * t + i;
    ++degree_[p];
  }
}

Index ChangingTriangles::add(const Corners& corners, const Origin& origin) {
  draft_.add_triangle(corners, origin);
  ++count_;
  alive_.push_back(true);
  normals_.emplace_back();
  first_.resize(draft_.points.size(), none);
  degree_.resize(draft_.points.size(), 0);
  next_.resize(next_.size() + 3, none);
  previous_.resize(next_.size(), none);
  link(end() - 1);
  assert(consistent(corners));
  return end() - 1;
}

bool ChangingTriangles::consistent(const Corners& corners) const {
  return std::all_of(corners.begin(), corners.end(), [&](Index point) {
    Index length = 0;
    bool good = true;
    for_each_at(point, [&](Index side) {
      ++length;
      good = good && alive_[side / 3] && draft_.triangles[side / 3][side % 3] == point;
    });
    return good && length == degree_[point];
  });
}

void ChangingTriangles::remove(Index t) {
  assert(alive_[t]);
  alive_[t] = false;
  --count_;
  for (unsigned i = 0; i < 3; ++i) {
    const Index point = draft_.triangles[t][i], before = previous_[3 * t + i], after = next_[3 * t + i];
    --degree_[point];
    (before == none ? first_[point] : next_[before]) = after;
    if (after != none) previous_[after] = before;
  }
  assert(consistent(draft_.triangles[t]));
}

Index ChangingTriangles::least_busy(const Corners& corners) const {
  return *std::ranges::min_element(corners, {}, [&](Index p) { return degree_[p]; });
}

std::vector<Index> ChangingTriangles::sides(const Edge& edge) const {
  std::vector<Index> found;
  if (edge[0] >= degree_.size() || edge[1] >= degree_.size()) return found;
  const bool first_is_busier = degree_[edge[0]] > degree_[edge[1]];
  const Index from = edge[first_is_busier ? 1 : 0], to = edge[first_is_busier ? 0 : 1];
  for_each_at(from, [&](Index side) {
    const Corners& t = draft_.triangles[side / 3];
    const Index i = side % 3;
    if (t[(i + 1) % 3] == to) found.push_back(side);
    if (t[(i + 2) % 3] == to) found.push_back(side - i + (i + 2) % 3);
  });
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Index> ChangingTriangles::triangles_from(Index first) const {
  std::vector<Index> triangles;
  for (Index t = first; t < end(); ++t)
    if (alive_[t]) triangles.push_back(t);
  return triangles;
}

std::vector<Index> ChangingTriangles::corners_of(const std::vector<Index>& triangles) const {
  std::vector<Index> corners;
  corners.reserve(3 * triangles.size());
  for (const Index t : triangles)
    corners.insert(corners.end(), draft_.triangles[t].begin(), draft_.triangles[t].end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

std::vector<Edge> ChangingTriangles::edges_of(const std::vector<Index>& triangles) const {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const Index t : triangles)
    for (const Edge& edge : edges_of(draft_.triangles[t])) edges.push_back(edge);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

Box ChangingTriangles::box_around(std::span<const Index> points) const {
  Box box;
  for (const Index p : points) frame_.add(box, draft_.points[p], 0.5 * reach_);
  return box;
}

bool ChangingTriangles::beyond(Index s, Index t) const {
  const Point& origin = draft_.corner(s, 0);
  double low = INFINITY, high = -INFINITY;
  for (unsigned i = 0; i < 3; ++i) {
    const double height = dot(normals_[s], draft_.corner(t, i) - origin);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return low > reach_ || high < -reach_;
}

ComplexDraft ChangingTriangles::compacted() const {
  ComplexDraft result = draft_;
  std::size_t kept = 0;
  for (Index t = 0; t < alive_.size(); ++t) {
    if (!alive_[t]) continue;
    result.triangles[kept] = draft_.triangles[t];
    result.origins[kept++] = draft_.origins[t];
  }
  result.triangles.resize(kept);
  result.origins.resize(kept);
  return result;
}

}  // namespace collarmesh::repairing
