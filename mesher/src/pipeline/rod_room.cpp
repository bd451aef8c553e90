#include "pipeline/rod_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "location/triangle_hierarchy.h"
#include "pipeline/rod_axes.h"

namespace collarmesh::pipeline {

namespace {

// Smallest distance of other features from the axis, in multiples of the sheath's reach. The tets that make
// room for a sheath extend to 1.4 to 1.8 times its reach, and the tets around these are about as large as the
// sheath is wide.
constexpr double clearance = 3;
// Places whose distance along an axis is above this multiple of the sheath's reach must be far from each
// other in space, too. Bends of axes with sheaths are so slight that places less far apart cannot meet.
constexpr double along_itself = 8;

/// The features of a complex, for measuring how far a rod's axis is from the features that are no part of
/// that rod.
class OtherFeatures {
 public:
  OtherFeatures(const Plc& plc, const std::vector<SheathedRod>& rods)
      : plc_(plc), others_(static_cast<Index>(rods.size())) {
    find_owners(rods);
    std::vector<std::array<Index, 3>> pieces;
    const auto add = [&](const std::array<Index, 3>& corners, Index owner, Index patch) {
      pieces.push_back(corners);
      owner_.push_back(owner);
      patch_.push_back(patch);
    };
    for (const Plc::Triangle& t : plc.triangles) add(t.points, patch_owner_[t.patch], t.patch);
    for (Index c = 0; c < plc.curves.size(); ++c) {
      const std::vector<Index>& points = plc.curves[c].points;
      for (std::size_t i = 0; i + (plc.curves[c].closed ? 0 : 1) < points.size(); ++i) {
        const Index next = points[(i + 1) % points.size()];
        add({points[i], next, next}, curve_owner_[c], none);
      }
    }
    for (const Plc::Vertex& vertex : plc.vertices) {
      const auto owned =
          std::ranges::find_if(vertex.curves, [&](Index c) { return curve_owner_[c] != others_; });
      add({vertex.point, vertex.point, vertex.point},
          owned != vertex.curves.end() ? curve_owner_[*owned] : others_, none);
    }
    pieces_.emplace(plc.points, std::move(pieces));
    common_owner_ = pieces_->common_labels(owner_);
  }

  /// Returns whether another feature is nearer to a point on the axis of a rod than this bound. `hosts`:
  /// patches that do not count.
  bool is_within(double bound, const Point& p, Index rod, const std::vector<Index>& hosts) const {
    const double squared = bound * bound;
    return pieces_->squared_distance_to(
               p, squared, nullptr, [&](Index node) { return common_owner_[node] == rod; },
               [&](Index piece) {
                 return owner_[piece] != rod &&
                        (patch_[piece] == none || std::ranges::count(hosts, patch_[piece]) == 0);
               }) < squared;
  }

 private:
  void find_owners(const std::vector<SheathedRod>& rods) {
    patch_owner_.assign(plc_.patches.size(), others_);
    curve_owner_.assign(plc_.curves.size(), others_);
    for (Index rod = 0; rod < rods.size(); ++rod) {
      patch_owner_[rods[rod].patch] = rod;
      for (const SheathedRod::End& end : rods[rod].ends)
        patch_owner_[end.patch] = curve_owner_[end.curve] = rod;
    }
  }

  const Plc& plc_;
  Index others_;  // the owner of features that are no part of a rod
  std::vector<Index> patch_owner_, curve_owner_;
  std::vector<Index> owner_, patch_;  // by piece
  std::optional<TriangleHierarchy> pieces_;
  std::vector<Index> common_owner_;  // by node: the owner of all pieces below it, or none
};

/// Returns whether other features are far enough from a rod. The patches at the rod's ends may be near the
/// axis only where the axis leaves them.
bool is_clear(const OtherFeatures& others, const SheathedRod& rod, Index number) {
  constexpr double steepest = 0.9;  // least increase of the distance from a host per length of the axis
  const double bound = clearance * rod.reach;
  double length = 0;
  for (std::size_t i = 0; i + 1 < rod.axis.size(); ++i) length += distance(rod.axis[i], rod.axis[i + 1]);
  double before = 0;
  for (std::size_t i = 0; i < rod.axis.size(); ++i) {
    if (i > 0) before += distance(rod.axis[i - 1], rod.axis[i]);
    std::vector<Index> hosts;
    for (std::size_t end = 0; end < rod.ends.size(); ++end)
      if (steepest * (end == 0 ? before : length - before) < bound) hosts.push_back(rod.ends[end].host);
    if (others.is_within(bound, rod.axis[i], number, hosts)) return false;
  }
  return true;
}

}  // namespace

void remove_rods_without_room(const Plc& plc, std::vector<SheathedRod>& rods, const Execution& execution) {
  if (rods.empty()) return;
  const OtherFeatures others(plc, rods);
  const RodAxes axes(rods);
  std::vector<bool> stays(rods.size(), false);
  for (Index rod = 0; rod < rods.size() && !execution.cancelled(); ++rod) {
    const auto meets_earlier = [&](const Point& p) {
      const std::vector<Index> near = axes.rods_near(p, clearance, clearance * rods[rod].reach);
      return std::ranges::any_of(near, [&](Index other) { return other < rod && stays[other]; });
    };
    stays[rod] =
        !axes.comes_near_itself(rod, along_itself * rods[rod].reach, 2 * clearance * rods[rod].reach) &&
        is_clear(others, rods[rod], rod) && std::ranges::none_of(rods[rod].axis, meets_earlier);
  }
  std::vector<SheathedRod> kept;
  for (Index rod = 0; rod < rods.size(); ++rod)
    if (stays[rod] && !execution.cancelled()) kept.push_back(std::move(rods[rod]));
  rods = std::move(kept);
}

}  // namespace collarmesh::pipeline
