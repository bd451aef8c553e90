#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "remesh/thin_shape.h"

namespace collarmesh::remeshing {

/// The faces of a hull, for measuring the tets that they make with an apex. Measures two tets at a time,
/// faster than calls of `remeshing::extreme_cosines`, and computes terms that do not depend on the apex only
/// once.
class HullShapes {
 public:
  static constexpr std::size_t at_once = 2;

  void clear() { pairs_.clear(); }
  bool empty() const { return pairs_.empty(); }
  /// Sets the faces. Each face makes a tet of positive volume with an apex inside the hull. If the number of
  /// faces is odd, the last one is repeated.
  void assign(std::span<const std::array<Index, 3>> faces, const std::vector<Point>& points);

  std::size_t pairs() const { return pairs_.size(); }
  /// Measures the tets on the faces 2 `pair` and 2 `pair` + 1. If a tet has no positive volume, only
  /// `positive` is valid.
  std::array<ExtremeCosines, at_once> extreme_cosines(std::size_t pair, const Point& apex) const;

 private:
  using Two = double __attribute__((vector_size(at_once * sizeof(double))));
  struct TwoVectors {
    Two x, y, z;
  };
  struct Pair {
    std::array<TwoVectors, 3> corners;
    TwoVectors normal;
    Two inverse_squared_normal;
    std::array<Two, 3> squared_sides;  ///< squared lengths of the sides opposite the corners
    Two least_cosine;                  ///< signed squared cosine of the face's obtuse angle; 1: has none
  };

  static TwoVectors minus(const TwoVectors& a, const TwoVectors& b);
  static TwoVectors cross(const TwoVectors& a, const TwoVectors& b);
  static Two dot(const TwoVectors& a, const TwoVectors& b);
  static Two least_cosine(const Two& x, const Two& y, const Two& z);

  std::vector<Pair> pairs_;
};

}  // namespace collarmesh::remeshing
