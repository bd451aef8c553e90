#include "collarmesh/surface_tolerance.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <span>
#include <utility>

#include "collarmesh/bounds.h"
#include "collarmesh/mesher.h"
#include "collarmesh/shape_measures.h"
#include "common/cells_at_vertices.h"
#include "common/parallel_for.h"
#include "common/segments.h"
#include "tolerance/curvature.h"
#include "tolerance/facing.h"
#include "tolerance/thickness.h"

namespace collarmesh {

namespace {

// The tolerance relative to the thickness of the material: in a rod, where opposite sides bend away from each
// other, and in a shell, where they bend the same way. Then the tolerance relative to the width of a gap: in
// a hole and in a slot, which bend like a rod and a shell. doc/architecture/tolerance.md has the
// measurements.
constexpr double share_of_rod = 0.05, share_of_shell = 0.15, share_of_hole = 0.1, share_of_slot = 0.5;
// Share of a region's volume that chords may remove or add, as `volume_of` estimates. The shares of thickness
// are multiplied by the factor with which chords reach this share, but by at most `largest_factor`.
constexpr double share_of_volume = 0.015, largest_factor = 2;
// If chords would remove at least the share `much_of_wedge` of the volume below a patch in a wedge, the
// tolerance there is lowered so that they remove about `share_of_wedge`.
constexpr double share_of_wedge = 0.035, much_of_wedge = 0.25;
// The smallest tolerance in wedges, relative to the largest one. Triangles of CAD faces are hardly ever
// nearer to their surface than this.
constexpr double least_share_in_wedges = 0.018;
// The growth of the tolerance per unit of distance from wedges: collars need a continuous tolerance.
constexpr double slope_beside_wedges = 0.1;
// The smallest tolerance, relative to the largest one: finer details are not resolved.
constexpr double least_share = 5e-4;
// The mean distance of chords from the surface, relative to the tolerance. Most chords are nearer to the
// surface than the tolerance allows.
constexpr double mean_of_sagitta = 0.42;
constexpr double sizes_per_diagonal = 20;  // as for the default size, see refine/sizing.cpp

class LocalTolerance {
 public:
  enum class Volumes {
    kept,    // first order: flat triangles must keep the volumes
    curved,  // second order: curved elements keep the volumes
    any      // the largest tolerance over all sizes and orders
  };
  LocalTolerance(const Plc& plc, double size)
      : plc_(plc),
        size_(size > 0 ? size : plc.bounds.diagonal() / sizes_per_diagonal),
        largest_(default_distance(size, plc.bounds.diagonal())),
        reach_(1.01 * largest_ / share_of_rod),
        thickness_(plc),
        curvature_(plc.triangles.size()),
        of_material_(plc.triangles.size(), largest_),
        of_gap_(plc.triangles.size(), largest_),
        of_wedge_(plc.triangles.size(), INFINITY) {}

  SurfaceTolerance run(Volumes volumes) {
    for (const Plc::Patch& patch : plc_.patches) {
      if (patch.planar) continue;
      const std::vector<Curvature> of_patch = curvatures(plc_, patch);
      std::copy(of_patch.begin(), of_patch.end(), curvature_.begin() + patch.first_triangle);
    }
    parallel_for_ranges(plc_.triangles.size(), 256, [&](std::size_t first, std::size_t last) {
      Thickness::Crossings crossings;
      for (auto t = static_cast<Index>(first); t < last; ++t)
        if (!patch_of(t).planar) look_around(t, crossings);
    });
    find_thick_ends_of_wedges();
    keep_wedges();
    std::vector<double> factors(plc_.patches.size(), volumes == Volumes::any ? largest_factor : 1);
    if (volumes == Volumes::kept) factors = factors_by_volumes();
    std::vector<double> triangles(plc_.triangles.size(), largest_);
    for (Index t = 0; t < triangles.size(); ++t)
      if (!patch_of(t).planar) triangles[t] = at(t, factors[plc_.triangles[t].patch]);
    return SurfaceTolerance(plc_, std::move(triangles), largest_);
  }

 private:
  const Plc::Patch& patch_of(Index triangle) const { return plc_.patches[plc_.triangles[triangle].patch]; }

  void look_around(Index triangle, Thickness::Crossings& crossings) {
    for (unsigned side = 0; side < 2; ++side) {
      const auto [opposite, first, is_wedge] = thickness_.at(triangle, side, crossings, reach_);
      if (is_wedge) of_wedge_[triangle] = std::min(of_wedge_[triangle], first.distance);
      if (opposite.triangle == none) continue;
      const bool empty = patch_of(triangle).regions[side] == 0;
      const double lost = lost_by(triangle, side, opposite);
      const double share = empty ? lost * share_of_hole + (1 - lost) * share_of_slot
                                 : lost * share_of_rod + (1 - lost) * share_of_shell;
      double& tolerance = (empty ? of_gap_ : of_material_)[triangle];
      tolerance = std::min(tolerance, share * opposite.distance);
    }
  }

  // Finds the thickness of wedges where it exceeds the reach. Skips patches whose wedges are nowhere thinner
  // than the reach: chords remove too little of such wedges to matter.
  void find_thick_ends_of_wedges() {
    for (const Plc::Patch& patch : plc_.patches) {
      const auto of_patch = std::span(of_wedge_).subspan(patch.first_triangle, patch.triangle_count);
      if (std::ranges::all_of(of_patch, [](double thickness) { return std::isinf(thickness); })) continue;
      parallel_for_ranges(of_patch.size(), 256, [&](std::size_t first, std::size_t last) {
        Thickness::Crossings crossings;
        for (std::size_t i = first; i < last; ++i) {
          if (!std::isinf(of_patch[i])) continue;
          for (unsigned side = 0; side < 2; ++side)
            if (const auto found =
                    thickness_.at(patch.first_triangle + static_cast<Index>(i), side, crossings);
                found.is_wedge)
              of_patch[i] = std::min(of_patch[i], found.first.distance);
        }
      });
    }
  }

  // Keeps the volume of wedges. Where a patch and the opposite side of a thin place meet in a crease, a
  // tolerance that is a share of the thickness would go to zero towards the crease. There, the tolerance
  // instead limits the share of the volume below the patch that chords remove.
  void keep_wedges() {
    std::vector<double> at_points(plc_.points.size(), INFINITY);
    bool any = false;
    for (const Plc::Patch& patch : plc_.patches) {
      if (patch.planar) continue;
      const double allowed = allowed_in_wedges(patch);
      if (allowed >= largest_) continue;
      any = true;
      for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t)
        if (!std::isinf(of_wedge_[t]))
          for (const Index p : plc_.triangles[t].points) at_points[p] = std::min(at_points[p], allowed);
    }
    if (!any) return;
    grow(at_points);
    for (Index t = 0; t < plc_.triangles.size(); ++t)
      for (const Index p : plc_.triangles[t].points) of_gap_[t] = std::min(of_gap_[t], at_points[p]);
  }

  // Returns the tolerance that wedges allow; infinite if chords would remove little of the wedges, or if less
  // than half of the patch is in wedges, as at a fold.
  double allowed_in_wedges(const Plc::Patch& patch) const {
    double all = 0, area = 0, volume = 0;
    for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
      const double own = area_of(t);
      all += own;
      if (std::isinf(of_wedge_[t])) continue;
      area += own;
      volume += own * of_wedge_[t] / 2;
    }
    const double lost = mean_of_sagitta * largest_ * area;
    if (area < all / 2 || lost < much_of_wedge * volume) return INFINITY;
    return largest_ * std::max(share_of_wedge * volume / lost, least_share_in_wedges);
  }

  // Lowers values at points until, along edges of triangles, they grow by at most `slope_beside_wedges` per
  // unit of length.
  void grow(std::vector<double>& at_points) const {
    using Item = std::pair<double, Index>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> next;
    for (Index p = 0; p < at_points.size(); ++p)
      if (at_points[p] < largest_) next.emplace(at_points[p], p);
    const CellsAtVertices triangles(corners_of_triangles(plc_), plc_.points.size());
    while (!next.empty()) {
      const auto [value, p] = next.top();
      next.pop();
      if (value > at_points[p]) continue;
      for (const Index t : triangles[p])
        for (const Index q : plc_.triangles[t].points)
          if (const double there = value + slope_beside_wedges * distance(plc_.points[p], plc_.points[q]);
              there < std::min(at_points[q], largest_))
            next.emplace(at_points[q] = there, q);
    }
  }

  double area_of(Index triangle) const {
    const auto& [a, b, c] = plc_.triangles[triangle].points;
    return 0.5 * norm(cross(plc_.points[b] - plc_.points[a], plc_.points[c] - plc_.points[a]));
  }

  /// Returns the tolerance of a triangle, with the shares of the material's thickness multiplied by a factor.
  double at(Index triangle, double factor) const {
    return std::max(std::min({of_gap_[triangle], factor * of_material_[triangle], largest_}),
                    least_share * largest_);
  }

  // Returns the sum of the principal curvatures, positive where the region on this side is convex.
  double bend(Index triangle, unsigned side) const {
    return side == 0 ? curvature_[triangle].sum : -curvature_[triangle].sum;
  }

  /// Returns the share of this side's volume loss that the opposite side does not gain.
  double lost_by(Index triangle, unsigned side, const Thickness::Opposite& opposite) const {
    const double own = bend(triangle, side), other = bend(opposite.triangle, opposite.side);
    return own == 0 ? 1 : std::clamp(1 + other / own, 0.0, 1.0);
  }

  // A part of a region's surface where chords change the region's volume.
  struct Loss {
    Index triangle;
    double area;     // negative if chords add to the volume
    double sagitta;  // largest distance of chords of the target length from the surface
  };

  double volume_of(const Loss& loss, double factor) const {
    return mean_of_sagitta * loss.area * std::min(at(loss.triangle, factor), loss.sagitta);
  }

  std::vector<std::vector<Index>> boundaries_of_regions() const {
    std::vector<std::vector<Index>> boundaries(plc_.regions.size());
    for (Index p = 0; p < plc_.patches.size(); ++p) {
      const auto& sides = plc_.patches[p].regions;
      if (sides[0] == sides[1]) continue;
      for (const Index r : sides)
        if (r != 0) boundaries[r].push_back(p);
    }
    return boundaries;
  }

  // Returns the parts of these patches where chords change the volume that the patches enclose on the side of
  // this region.
  std::vector<Loss> losses_on(const std::vector<Index>& patches, Index region) const {
    std::vector<Loss> losses;
    for (const Index p : patches) {
      const Plc::Patch& patch = plc_.patches[p];
      if (patch.planar) continue;
      const unsigned side = patch.regions[0] == region ? 0 : 1;
      for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
        const double area = area_of(t);
        if (const double by = bend(t, side); by != 0)
          losses.push_back({t, by > 0 ? area : -area, size_ * size_ * std::fabs(by) / 8});
      }
    }
    return losses;
  }

  // Returns the factor on the shares of thickness with which these losses stay within `share_of_volume`.
  double factor_by_volume(const std::vector<Loss>& losses, double volume) const {
    const auto lost = [&](double factor) {
      double sum = 0;
      for (const Loss& loss : losses) sum += volume_of(loss, factor);
      return std::fabs(sum);
    };
    const double allowed = share_of_volume * volume;
    double factor = largest_factor;
    while (factor > least_share && lost(factor) > allowed)
      factor *= std::max(0.5, std::min(0.98, allowed / lost(factor)));
    return factor;
  }

  // Returns by patch the factors on the shares of thickness with which regions and shells keep their volumes.
  std::vector<double> factors_by_volumes() const {
    std::vector<double> factors(plc_.patches.size(), largest_factor);
    const auto keep = [&](const std::vector<Index>& patches, Index region, double volume) {
      const double factor = factor_by_volume(losses_on(patches, region), volume);
      for (const Index p : patches) factors[p] = std::min(factors[p], factor);
      return factor;
    };
    const auto boundaries = boundaries_of_regions();
    std::vector<double> of_regions(plc_.regions.size(), largest_factor);
    for (Index r = 1; r < plc_.regions.size(); ++r)
      of_regions[r] = keep(boundaries[r], r, std::fabs(plc_.regions[r].volume));
    for (Index p = 0; p < plc_.patches.size(); ++p)  // includes sheets inside a region
      factors[p] = std::min(factors[p], of_regions[plc_.patches[p].regions[0]]);
    const std::vector<Shell> shells = shells_of(plc_);
    const std::vector<double> enclosed = measures_of(plc_).shells;
    for (std::size_t i = 0; i < shells.size(); ++i) keep(shells[i].patches, shells[i].region, enclosed[i]);
    return factors;
  }

  const Plc& plc_;
  double size_, largest_;
  double reach_;  // a greater thickness does not lower the tolerance, except in wedges
  Thickness thickness_;
  std::vector<Curvature> curvature_;
  std::vector<double> of_material_, of_gap_;  // by triangle: tolerances from thickness and from gap widths
  std::vector<double> of_wedge_;              // by triangle: thickness between patches that meet in a crease
};

template <class Better>
double extreme_on(const SurfaceTolerance& tolerance, const Plc::Curve& curve, double extreme,
                  const Better& better) {
  visit_segments(curve, [&](Index a, Index b) { extreme = better(extreme, tolerance.at_segment(a, b)); });
  return extreme;
}

}  // namespace

SurfaceTolerance::SurfaceTolerance(const Plc& plc, std::vector<double> triangles, double largest)
    : largest_(largest) {
  Places places;
  places.points.assign(plc.points.size(), largest);
  for (Index t = 0; t < plc.triangles.size(); ++t)
    for (const Index p : plc.triangles[t].points) places.points[p] = std::min(places.points[p], triangles[t]);
  for (const Plc::Patch& patch : plc.patches) {
    double least = largest, most = 0;
    for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
      most = std::max(most, triangles[t]);
      for (const Index p : plc.triangles[t].points) least = std::min(least, places.points[p]);
    }
    places.least_on_patch.push_back(least);
    places.largest_on_patch.push_back(patch.triangle_count > 0 ? most : largest);
  }
  places.triangles = std::move(triangles);
  places_ = std::make_shared<const Places>(std::move(places));
}

namespace {

// Estimates the largest distance of a smooth patch's triangles from the curved surface that they approximate,
// from the angles between them. Returns it relative to the distance that `coarse_patches` allows.
double coarseness(const Plc& plc, const Plc::Patch& patch, const SurfaceTolerance& tolerance) {
  constexpr double share_of_triangles = 0.25;
  struct Side {
    std::array<Index, 2> edge;
    Index triangle;
    Vector normal;
    double height;  // height of the triangle above the edge
  };
  // If a surface turns by this angle from one triangle to the next, a chord as long as the triangle is high
  // is off its arc by an eighth of the height times the angle.
  const auto relative_distance = [&](const Side& side, double turn) {
    return side.height * turn / 8 / (share_of_triangles * tolerance.at_triangle(side.triangle));
  };
  std::vector<Side> sides;
  for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t) {
    const auto& p = plc.triangles[t].points;
    const Vector n = cross(plc.points[p[1]] - plc.points[p[0]], plc.points[p[2]] - plc.points[p[0]]);
    for (unsigned k = 0; k < 3; ++k)
      if (const double length = distance(plc.points[p[k]], plc.points[p[(k + 1) % 3]]);
          length > 0 && norm(n) > 0)
        sides.push_back({{std::min(p[k], p[(k + 1) % 3]), std::max(p[k], p[(k + 1) % 3])},
                         t,
                         n / norm(n),
                         norm(n) / length});
  }
  std::ranges::sort(sides, [](const Side& a, const Side& b) { return a.edge < b.edge; });
  double largest = 0;
  for (std::size_t i = 1; i < sides.size(); ++i) {
    if (sides[i - 1].edge != sides[i].edge) continue;
    const double turn = std::acos(std::clamp(dot(sides[i - 1].normal, sides[i].normal), -1.0, 1.0));
    largest = std::max({largest, relative_distance(sides[i - 1], turn), relative_distance(sides[i], turn)});
  }
  return largest;
}

}  // namespace

std::vector<CoarsePatch> coarse_patches(const Plc& plc, const SurfaceTolerance& tolerance) {
  std::vector<CoarsePatch> coarse;
  for (Index p = 0; p < plc.patches.size(); ++p) {
    if (plc.patches[p].planar) continue;
    if (const double by = coarseness(plc, plc.patches[p], tolerance); by > 1) coarse.push_back({p, by});
  }
  return coarse;
}

SurfaceTolerance SurfaceTolerance::of_patches(const Plc& whole, std::span<const Index> patches) const {
  if (!varies()) return *this;
  Places places;
  places.points = places_->points;
  for (const Index p : patches) {
    const auto first = places_->triangles.begin() + whole.patches[p].first_triangle;
    places.triangles.insert(places.triangles.end(), first, first + whole.patches[p].triangle_count);
    places.least_on_patch.push_back(places_->least_on_patch[p]);
    places.largest_on_patch.push_back(places_->largest_on_patch[p]);
  }
  SurfaceTolerance of_patches = *this;
  of_patches.places_ = std::make_shared<const Places>(std::move(places));
  return of_patches;
}

double SurfaceTolerance::least_on_curve(const Plc::Curve& curve) const {
  return extreme_on(*this, curve, INFINITY, [](double a, double b) { return std::min(a, b); });
}

double SurfaceTolerance::largest_on_curve(const Plc::Curve& curve) const {
  return extreme_on(*this, curve, 0, [](double a, double b) { return std::max(a, b); });
}

SurfaceTolerance default_tolerance(const Plc& plc, double size, int order) {
  return LocalTolerance(plc, size).run(order == 1 ? LocalTolerance::Volumes::kept
                                                  : LocalTolerance::Volumes::curved);
}

SurfaceTolerance largest_default_tolerance(const Plc& plc) {
  return LocalTolerance(plc, INFINITY).run(LocalTolerance::Volumes::any);
}

SurfaceTolerance tolerance_of_any_size(const Plc& plc, const Bounds& bounds) {
  if (bounds.tolerance) return *bounds.tolerance;
  return bounds.distance > 0 ? SurfaceTolerance(bounds.distance) : largest_default_tolerance(plc);
}

SurfaceTolerance tolerance_of(const Plc& plc, const Bounds& bounds, double size, int order) {
  if (bounds.tolerance) return *bounds.tolerance;
  return bounds.distance > 0 ? SurfaceTolerance(bounds.distance) : default_tolerance(plc, size, order);
}

}  // namespace collarmesh
