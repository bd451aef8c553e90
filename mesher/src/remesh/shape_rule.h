#pragma once

#include <array>
#include <utility>

#include "remesh/cell_bounds.h"
#include "remesh/shape.h"
#include "remesh/thin_shape.h"

namespace collarmesh::remeshing {

class AngleRule;

/// A definition of the quality of tets, and of the tets that operations may make. Several threads may query
/// it at once.
class ShapeRule {
 public:
  ShapeRule() = default;
  ShapeRule(const ShapeRule&) = delete;
  ShapeRule& operator=(const ShapeRule&) = delete;
  virtual ~ShapeRule() = default;

  /// Returns the quality: the larger the better; not positive for a flat or an inverted tet.
  virtual double quality(const Corners& p, const std::array<Index, 4>& corners) const = 0;
  /// Returns a rule that gives the same qualities and computes them from the extreme angles of tets, which
  /// are measured faster for two tets at a time. Returns null if there is no such rule.
  virtual const AngleRule* by_angles() const { return nullptr; }
  /// Returns whether an operation may make this tet. `quality`: its quality. Must accept queries about flat
  /// and inverted tets, too, which may replace worse ones.
  virtual bool allows(const Corners& p, const std::array<Index, 4>& corners, double quality) const = 0;
  /// Returns the quality if it is above `above`, which is at least -1, and an operation may make the tet;
  /// else -1.
  virtual double quality_if_allowed(const Corners& p, const std::array<Index, 4>& corners,
                                    double above) const {
    const double quality = this->quality(p, corners);
    return quality > above && allows(p, corners, quality) ? quality : -1;
  }
  /// Returns whether an operation may make an edge between these vertices. `edge`: its vector; `before`: the
  /// vector of the edge that it replaces.
  virtual bool allows_edge(Index, Index, const Vector& /*edge*/, const Vector& /*before*/) const {
    return true;
  }
  /// Returns the share by which a move of a vertex must raise the quality of the worst tet to be worth it.
  virtual double least_gain() const { return 1e-3; }
  /// Returns the number of step lengths that a move tries, each half of the one before.
  virtual unsigned step_lengths() const { return 4; }
  /// Returns whether operations may replace cells of collars.
  virtual bool dissolves_collars() const { return false; }
};

/// A rule in which the extreme angles of a tet determine its quality.
class AngleRule : public ShapeRule {
 public:
  virtual double quality_of(const ExtremeCosines& cosines, const Corners& p,
                            const std::array<Index, 4>& corners) const = 0;
  double quality(const Corners& p, const std::array<Index, 4>& corners) const final {
    return quality_of(extreme_cosines(p), p, corners);
  }
  const AngleRule* by_angles() const final { return this; }
};

/// A bound on circumradius / shortest edge, which thin tets may exceed.
class RadiusEdgeBound {
 public:
  explicit RadiusEdgeBound(double radius_edge) : squared_(radius_edge * radius_edge) {}
  bool holds(const Corners& p) const {
    const Circumsphere sphere = circumsphere(p);
    return sphere.squared_radius <= squared_ * sphere.shortest_squared_edge;
  }

 private:
  double squared_;
};

/// The rule of thin tets. A quality of 1 or more means that the tet keeps the bounds on thin tets, in a place
/// where it may be thin. Allows operations to make any tet.
class ThinRule final : public AngleRule {
 public:
  explicit ThinRule(TetBounds bounds) : bounds_(std::move(bounds)) {}

  const TetBounds& bounds() const { return bounds_; }

  double quality_of(const ExtremeCosines& cosines, const Corners& p,
                    const std::array<Index, 4>& corners) const override {
    const auto [of_smallest, of_largest] = bounds_.thin.squared_margins(cosines, p, corners);
    if (of_largest < 0) return -1;
    const double quality = std::sqrt(std::min(of_smallest, of_largest));
    const bool fits = !bounds_.cells.forbid_thin_tets() || bounds_.cells.allow(p, corners);
    return fits ? quality : CellBounds::forbidden * std::min(1.0, quality);
  }
  bool allows(const Corners&, const std::array<Index, 4>&, double /*quality*/) const override { return true; }

 private:
  TetBounds bounds_;
};

/// The rule of improvement. The quality is `shape_quality`. New tets must keep the radius-edge bound or, if
/// tets may be thin, the bounds on thin tets. In that case tets with an angle above the largest one of thin
/// tets are worse than all others.
class SliverRule final : public ShapeRule {
 public:
  /// Keeps `thin` and `cells` by reference. If `thin` is null, no tet may exceed the radius-edge bound.
  explicit SliverRule(double radius_edge, const ThinShape* thin = nullptr, const CellBounds* cells = nullptr)
      : bound_(radius_edge), thin_(thin), cells_(cells) {}

  double quality(const Corners& p, const std::array<Index, 4>& corners) const override {
    MeasuredTet tet(p, corners);
    return quality(tet);
  }
  bool allows(const Corners& p, const std::array<Index, 4>& corners, double /*quality*/) const override {
    MeasuredTet tet(p, corners);
    return allows(tet);
  }
  double quality_if_allowed(const Corners& p, const std::array<Index, 4>& corners,
                            double above) const override {
    MeasuredTet tet(p, corners);
    const double quality = this->quality(tet);
    return quality > above && allows(tet) ? quality : -1;
  }

  /// Returns true only if the tet's quality is above `quality`, which must be positive. Much cheaper than
  /// computing the quality, but returns false for some better tets, too.
  bool surely_exceeds(double quality, const Corners& p) const {
    if (forbids_thin_tets()) return false;
    const double of_obtuse = quality / obtuse_weight;
    const double of_largest = thin_ != nullptr ? thin_->squared_cosine_of_largest() : 1;
    return of_obtuse < 1 &&
           surely_between(p, 1 - quality * quality, std::min(1 - of_obtuse * of_obtuse, of_largest));
  }

  /// Returns whether the input forces an edge of the tet to be short, so that hardly a better tet is
  /// possible.
  bool is_as_forced(const Corners& p, const std::array<Index, 4>& corners) const {
    return thin_ != nullptr && thin_->is_as_forced(p, corners);
  }
  double least_gain() const override { return least_gain_; }
  /// Sets `least_gain` for later operations.
  void set_least_gain(double share) { least_gain_ = share; }
  /// Returns whether a tet of this quality has an angle above the largest one of thin tets, has an angle
  /// below about 0.06 degrees, or is forbidden by the bounds on cells. Returns false if no tet may be thin.
  bool is_too_obtuse(double quality) const { return thin_ != nullptr && quality < beyond; }

 private:
  static constexpr double beyond = 1e-3;

  double quality(MeasuredTet& tet) const {
    const double sine = shape_quality(tet.places());
    if (thin_ == nullptr || !(sine > 0)) return sine;
    if (forbids_thin_tets() && !cells_->allow(tet.places(), tet.vertices()))
      return CellBounds::forbidden * sine;
    return thin_->is_too_obtuse(tet, sine) ? beyond * sine : thin_->shape_quality_where_forced(tet, sine);
  }
  bool allows(MeasuredTet& tet) const {
    return (bound_.holds(tet.places()) || (thin_ != nullptr && thin_->contains(tet))) &&
           (cells_ == nullptr || cells_->allow(tet.places(), tet.vertices()));
  }
  bool forbids_thin_tets() const { return cells_ != nullptr && cells_->forbid_thin_tets(); }

  RadiusEdgeBound bound_;
  const ThinShape* thin_;
  const CellBounds* cells_;
  double least_gain_ = 1e-3;
};

}  // namespace collarmesh::remeshing
