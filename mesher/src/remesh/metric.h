#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::remeshing {

/// A measure of lengths and volumes in units of target edge lengths. It is the same in all directions: each
/// vertex has a target length; the target length of an edge or a tet is the mean of those at its corners.
/// Functions take edges as vectors, so that a metric could depend on directions.
class Metric {
 public:
  /// `targets`: the target lengths, by vertex.
  explicit Metric(std::vector<double> targets) : targets_(std::move(targets)) {}

  double target(Index vertex) const { return targets_[vertex]; }
  double target(Index a, Index b) const { return 0.5 * (targets_[a] + targets_[b]); }
  double target(const std::array<Index, 4>& tet) const {
    return 0.25 * (targets_[tet[0]] + targets_[tet[1]] + targets_[tet[2]] + targets_[tet[3]]);
  }

  /// Returns the length of an edge between a and b in units of its target length.
  double length(Index a, Index b, const Vector& edge) const { return norm(edge) / target(a, b); }
  double squared_length(Index a, Index b, const Vector& edge) const {
    const double unit = target(a, b);
    return squared_norm(edge) / (unit * unit);
  }
  /// Returns whether an edge is longer than `length` times its target length. Needs no division.
  bool exceeds(double length, Index a, Index b, const Vector& edge) const {
    const double unit = target(a, b);
    return squared_norm(edge) > length * length * (unit * unit);
  }
  /// Returns the length of a vector inside a tet, in units of the tet's target length.
  double length(const std::array<Index, 4>& tet, const Vector& way) const { return norm(way) / target(tet); }
  /// Returns a volume inside a tet in units of the tet's target length cubed.
  double volume(const std::array<Index, 4>& tet, double in_space) const {
    const double unit = target(tet);
    return in_space / (unit * unit * unit);
  }

  /// Adds a vertex.
  void add(double target) { targets_.push_back(target); }
  /// Sets the number of vertices: removes the last ones, or adds vertices with this target length.
  void resize(std::size_t vertices, double target = 0) { targets_.resize(vertices, target); }
  void set(Index vertex, double target) { targets_[vertex] = target; }

 private:
  std::vector<double> targets_;
};

}  // namespace collarmesh::remeshing
