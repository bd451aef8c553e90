#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/tet_mesh.h"
#include "common/shared_bounds.h"
#include "remesh/shape.h"
#include "tolerance/forced_edges.h"

namespace collarmesh::remeshing {

/// A tet's extreme angles as squared cosines with the signs of the cosines: like cosines they decrease as
/// angles grow, but they need no roots.
struct ExtremeCosines {
  double smallest_angle;  ///< signed squared cosine of the smallest dihedral angle
  double largest_angle;   ///< signed squared cosine of the largest dihedral or face angle
  bool positive;          ///< whether the volume is positive
};

inline double signed_square(double x) { return x * std::fabs(x); }
/// Returns the squared sine of an angle from its signed squared cosine.
inline double squared_sine(double signed_square_of_cosine) { return 1 - std::fabs(signed_square_of_cosine); }
inline double sine(double signed_square_of_cosine) {
  return std::sqrt(squared_sine(signed_square_of_cosine));
}

/// Returns the signed squared cosine of the largest angle of the tet's faces if it is obtuse, else 1.
inline double least_cosine_of_faces(const Corners& p) {
  const double ab = squared_distance(p[0], p[1]), ac = squared_distance(p[0], p[2]),
               ad = squared_distance(p[0], p[3]), bc = squared_distance(p[1], p[2]),
               bd = squared_distance(p[1], p[3]), cd = squared_distance(p[2], p[3]);
  double least = 1;
  const auto see_face = [&least](double x, double y, double z) {
    const double longest = std::max({x, y, z}), excess = x + y + z - 2 * longest;
    if (excess >= 0) return;
    const double others = longest == x ? y * z : longest == y ? x * z : x * y;
    least = std::min(least, 0.25 * signed_square(excess) / others);
  };
  see_face(ab, ac, bc);
  see_face(ab, ad, bd);
  see_face(ac, ad, cd);
  see_face(bc, bd, cd);
  return least;
}

/// Returns the extreme dihedral angles. For a flat or an inverted tet only `positive` is meaningful.
inline ExtremeCosines dihedral_cosines(const Corners& p) {
  const Vector ab = p[1] - p[0], ac = p[2] - p[0], ad = p[3] - p[0], bc = p[2] - p[1], bd = p[3] - p[1];
  const Vector n_a = cross(bc, bd), n_b = cross(ad, ac), n_c = cross(ab, ad), n_d = cross(ac, ab);
  if (!(-dot(n_d, ad) > 0)) return {1, -1, false};
  const double a = 1 / squared_norm(n_a), b = 1 / squared_norm(n_b), c = 1 / squared_norm(n_c),
               d = 1 / squared_norm(n_d);
  // The negated product of the faces' outward unit normals is the cosine of the dihedral angle.
  const auto square = [](double product, double x, double y) {
    return -(product * x) * (std::fabs(product) * y);  // this order keeps products in range at any scale
  };
  const std::array<double, 6> squares{square(dot(n_c, n_d), c, d), square(dot(n_b, n_d), b, d),
                                      square(dot(n_b, n_c), b, c), square(dot(n_a, n_d), a, d),
                                      square(dot(n_a, n_c), a, c), square(dot(n_a, n_b), a, b)};
  double least = squares[0], greatest = squares[0];
  for (unsigned i = 1; i < 6; ++i) {
    least = std::min(least, squares[i]);
    greatest = std::max(greatest, squares[i]);
  }
  return {std::min(1.0, greatest), std::max(-1.0, least), true};
}

inline ExtremeCosines extreme_cosines(const Corners& p) {
  ExtremeCosines cosines = dihedral_cosines(p);
  if (cosines.positive)
    cosines.largest_angle = std::max(-1.0, std::min(cosines.largest_angle, least_cosine_of_faces(p)));
  return cosines;
}

/// Returns true only if all dihedral angles lie between the acute angle with the first squared cosine and the
/// obtuse angle with the second one, and all face angles are below that obtuse angle. Needs no divisions;
/// returns false in close cases.
inline bool surely_between(const Corners& p, double squared_cosine, double squared_obtuse_cosine) {
  constexpr double rounding = 1e-9;
  const double acute = squared_cosine * (1 - rounding), obtuse = squared_obtuse_cosine * (1 - rounding);
  const Vector ab = p[1] - p[0], ac = p[2] - p[0], ad = p[3] - p[0], bc = p[2] - p[1], bd = p[3] - p[1],
               cd = p[3] - p[2];
  const Vector n_a = cross(bc, bd), n_b = cross(ad, ac), n_c = cross(ab, ad), n_d = cross(ac, ab);
  const double a = squared_norm(n_a), b = squared_norm(n_b), c = squared_norm(n_c), d = squared_norm(n_d);
  // Notes violations without branches; NaN violates every bound.
  unsigned beyond = 0;
  const auto require = [&beyond](bool holds) { beyond |= holds ? 0U : 1U; };
  // The negated product of outward normals has the sign of the cosine.
  const auto see_edge = [&](const Vector& m, const Vector& n, double squares) {
    const double product = dot(m, n);
    require(product * product < (product < 0 ? acute : obtuse) * squares);
  };
  see_edge(n_c, n_d, c * d);
  see_edge(n_b, n_d, b * d);
  see_edge(n_b, n_c, b * c);
  see_edge(n_a, n_d, a * d);
  see_edge(n_a, n_c, a * c);
  see_edge(n_a, n_b, a * b);
  // Tests the corner of a face between sides of squared lengths x and y; `across`: that of the third side.
  const auto see_corner = [&](double x, double y, double across) {
    const double product = std::min(0.0, x + y - across);
    require(product * product < 4 * obtuse * (x * y));
  };
  const auto see_face = [&](double x, double y, double z) {
    see_corner(x, y, z);
    see_corner(y, z, x);
    see_corner(z, x, y);
  };
  const double s_ab = squared_norm(ab), s_ac = squared_norm(ac), s_ad = squared_norm(ad),
               s_bc = squared_norm(bc), s_bd = squared_norm(bd), s_cd = squared_norm(cd);
  see_face(s_ab, s_ac, s_bc);
  see_face(s_ab, s_ad, s_bd);
  see_face(s_ac, s_ad, s_cd);
  see_face(s_bc, s_bd, s_cd);
  require(-dot(n_d, ad) > 0);
  return beyond == 0;
}

/// A tet's extreme angles, degrees.
struct ExtremeAngles {
  double smallest;  ///< smallest dihedral angle; negative for a flat or an inverted tet
  double largest;   ///< largest dihedral or face angle
};

inline ExtremeAngles extreme_angles(const Corners& p) {
  const ExtremeCosines cosines = extreme_cosines(p);
  if (!cosines.positive) return {-1, 180};
  const auto angle = [](double square) {
    return std::acos(std::copysign(std::sqrt(std::fabs(square)), square)) * 180 / std::numbers::pi;
  };
  return {angle(cosines.smallest_angle), angle(cosines.largest_angle)};
}

/// A tet that computes its extreme angles and its narrowness when they are first asked for, and keeps them.
class MeasuredTet {
 public:
  /// Keeps references to the places and the vertices of the corners.
  MeasuredTet(const Corners& places, const std::array<Index, 4>& vertices)
      : places_(places), vertices_(vertices) {}

  const Corners& places() const { return places_; }
  const std::array<Index, 4>& vertices() const { return vertices_; }
  const ExtremeCosines& cosines() {
    if (!cosines_) cosines_ = extreme_cosines(places_);
    return *cosines_;
  }
  /// Returns the width that forced edges leave to the tet, relative to its longest edge
  /// (ForcedEdges::narrowness). Each call must get the same `forced`.
  double narrowness(const ForcedEdges& forced) {
    if (!narrowness_) narrowness_ = forced.narrowness(places_, vertices_);
    return *narrowness_;
  }

 private:
  const Corners& places_;
  const std::array<Index, 4>& vertices_;
  std::optional<ExtremeCosines> cosines_;
  std::optional<double> narrowness_;
};

/// The bounds on the shape of thin tets: a lower and an upper bound on dihedral angles, and an upper bound on
/// face angles. Where the input permits only smaller angles, the lower bound is reduced: to half the angle at
/// which features meet there, or to ForcedEdges::smallest_angle if the input forces an edge of the tet to be
/// short; both divided by `tets_across`.
class ThinShape {
 public:
  static constexpr double largest_angle = largest_angle_of_thin_tets;
  static constexpr double rounding = 1e-6;  ///< degrees, a margin for other ways to compute an angle

  /// `smallest_angle` is in degrees; 0: no tet is thin. Vertices are numbered as in `mesh`. `reserve`: the
  /// share of their distance from 0 or 180 degrees by which the bounds are made stricter. `forced`: see
  /// forced_edges_of. `tets_across`: see Bounds.
  ThinShape(const Plc& plc, const TetMesh& mesh, double smallest_angle, double reserve,
            std::shared_ptr<const ForcedEdges> forced, double tets_across = 1);

  bool empty() const { return !(smallest_ > 0); }
  double squared_cosine_of_largest() const { return -cosine_; }
  /// Returns the sine of the lower bound on a tet's dihedral angles, with a margin for rounding.
  double smallest_sine(const Corners& p, const std::array<Index, 4>& corners) const {
    MeasuredTet tet(p, corners);
    return std::min(smallest_sine_at(corners), forced_sine(tet));
  }
  /// Returns whether a tet of positive volume has an angle above the largest one of thin tets. `shape` is its
  /// shape_quality, which rules out such dihedral angles for most tets.
  bool is_too_obtuse(MeasuredTet& tet, double shape) const {
    return shape > obtuse_weight * sine_of_largest_ + rounding ? least_cosine_of_faces(tet.places()) < cosine_
                                                               : tet.cosines().largest_angle < cosine_;
  }
  /// The squared sines of the smallest angle and of 180 degrees minus the largest angle, each divided by the
  /// squared sine of its bound: both are at least 1 if the tet keeps the bounds. Negative for a flat or an
  /// inverted tet.
  struct SquaredMargins {
    double of_smallest, of_largest;
  };
  SquaredMargins squared_margins(const ExtremeCosines& cosines, const Corners& p,
                                 const std::array<Index, 4>& corners) const {
    if (!cosines.positive) return {-1, -1};
    const double least = smallest_sine_at(corners), smallest = squared_sine(cosines.smallest_angle),
                 largest = cosines.largest_angle < 0 ? squared_sine(cosines.largest_angle) : 1;
    double margin = smallest / (least * least);
    if (forced_ && margin < good_enough) {
      MeasuredTet tet(p, corners);
      if (const double forced = deep_forced_sine(tet); forced < deep)
        margin = std::max(margin, std::min(good_enough, smallest / (forced * forced)));
    }
    return {margin, largest * inverse_squared_sine_of_largest_};
  }
  /// Returns the quality of a tet of positive volume; `sine` is its quality by angles alone (shape_quality).
  /// If forced edges permit only angles below `deep`, small angles count relative to what these edges permit,
  /// so that large angles decide.
  double shape_quality_where_forced(MeasuredTet& tet, double sine) const {
    const double forced = sine < largest_forced_sine ? deep_forced_sine(tet) : 1;
    if (forced >= deep) return sine;
    const ExtremeCosines& cosines = tet.cosines();
    const double smallest = remeshing::sine(cosines.smallest_angle) * sine_ / forced;
    return cosines.largest_angle < 0
               ? std::min(smallest, obtuse_weight * remeshing::sine(cosines.largest_angle))
               : smallest;
  }
  /// Returns whether a tet of positive volume is about as good as its forced edges permit.
  bool is_as_forced(const Corners& p, const std::array<Index, 4>& corners) const {
    if (empty()) return false;
    if (MeasuredTet tet(p, corners); deep_forced_sine(tet) >= deep) return false;
    const SquaredMargins margins = squared_margins(extreme_cosines(p), p, corners);
    return std::min(margins.of_smallest, margins.of_largest) >= good_enough;
  }
  /// Returns true only if both squared margins are above the square of `margin`, which must be at least 1.
  /// Much cheaper than computing the margins, but returns false for some such tets, too.
  bool surely_exceeds(double margin, const Corners& p) const {
    const double smallest = margin * sine_, largest = margin * sine_of_largest_;
    return largest < 1 && surely_between(p, 1 - smallest * smallest, 1 - largest * largest);
  }
  /// Returns whether the tet keeps the bounds of thin tets, and a short forced edge lowers these bounds.
  bool is_thin_by_force(const Corners& p, const std::array<Index, 4>& corners) const {
    MeasuredTet tet(p, corners);
    return !empty() && forced_ && forced_sine(tet) < sine_ && contains(tet);
  }
  bool contains(const Corners& p, const std::array<Index, 4>& corners) const {
    MeasuredTet tet(p, corners);
    return contains(tet);
  }
  bool contains(MeasuredTet& tet) const {
    if (empty()) return false;
    const ExtremeCosines& cosines = tet.cosines();
    if (!cosines.positive || cosines.largest_angle < cosine_) return false;
    const double smallest = sine(cosines.smallest_angle);
    return smallest >= smallest_sine_at(tet.vertices()) || smallest >= forced_sine(tet);
  }

 private:
  // The sine of 1.7 degrees. Where forced edges only permit angles below this, operations judge a tet by what
  // the edges permit. They judge all other tets as if no edge were forced, although forced edges may lower
  // the bounds of these tets, too.
  static constexpr double deep = 0.03;
  // Largest squared margin that forced edges can give a tet.
  static constexpr double good_enough = 2;
  // Forced edges are looked up only for tets whose quality by angles alone is below this.
  static constexpr double largest_forced_sine = 0.35;

  double smallest_sine_at(const std::array<Index, 4>& corners) const {
    double least = sine_;
    if (sine_at_vertex_.empty()) return least;
    for (const Index v : corners)
      if (v < sine_at_vertex_.size()) least = std::min(least, sine_at_vertex_[v]);
    return least;
  }
  double forced_sine(MeasuredTet& tet) const;
  // Returns `forced_sine` if it is below `deep`, else 1. Cheaper than `forced_sine`.
  double deep_forced_sine(MeasuredTet& tet) const;

  double smallest_, sine_, cosine_, sine_of_largest_, inverse_squared_sine_of_largest_;
  double share_;  // factor of the lower bounds that creases and forced edges give; grows with the reserve and
                  // decreases with `tets_across`
  double deep_narrowness_;              // narrower tets may have forced sines below `deep`
  std::vector<double> sine_at_vertex_;  // empty if no crease is sharp enough to lower the bound
  std::shared_ptr<const ForcedEdges> forced_;
};

/// Returns the forced edges of a mesh in its current state; null if `lower_bounds` is false or the mesh has
/// no `features`. Precondition: the mesh's faces are set.
std::shared_ptr<const ForcedEdges> forced_edges_of(const Plc& plc, const TetMesh& mesh, bool lower_bounds);

/// Marks the tets outside collars whose circumradius / shortest edge is above the bound.
void mark_thin_tets(TetMesh& mesh, double radius_edge);

}  // namespace collarmesh::remeshing
