#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "collarmesh/geometry.h"

namespace collarmesh::remeshing {

/// The time at which each vertex, or a tet at it, last changed: 0 if none has changed yet. Data read at some
/// vertices is up to date as long as none of these vertices has changed since.
class ChangeTimes {
 public:
  explicit ChangeTimes(std::size_t vertices) : at_(vertices, 0) {}

  std::uint32_t now() const { return now_; }
  /// Begins a new time and returns it.
  std::uint32_t advance() { return ++now_; }
  /// Makes room for new vertices.
  void resize(std::size_t vertices) { at_.resize(vertices, 0); }
  /// Records that a vertex changes now.
  void note(Index vertex) {
    assert(vertex < at_.size());
    at_[vertex] = now_;
  }
  /// Begins a new time, and records that a vertex changes then.
  void note_next(Index vertex) { advance(), note(vertex); }
  std::uint32_t at(Index vertex) const {
    assert(vertex < at_.size());
    return at_[vertex];
  }
  /// Returns whether any of these vertices has changed at this time or later.
  template <class Vertices>
  bool any_since(std::uint32_t when, const Vertices& vertices) const {
    return std::ranges::any_of(vertices, [&](Index v) { return at(v) >= when; });
  }
  /// Returns whether any of these vertices has changed later than at this time.
  template <class Vertices>
  bool any_after(std::uint32_t time, const Vertices& vertices) const {
    return any_since(time + 1, vertices);
  }

 private:
  std::uint32_t now_ = 0;
  std::vector<std::uint32_t> at_;  // by vertex
};

}  // namespace collarmesh::remeshing
