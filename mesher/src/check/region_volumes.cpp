// Region volumes of the mesh against those that the complex's triangles enclose.
#include <cmath>
#include <optional>

#include "check/subject.h"

namespace collarmesh::checks {

namespace {

struct Enclosed {
  std::optional<Point> origin;  ///< a corner of the region: from afar a tiny one's volume would cancel
  long double six_volume = 0;
  double allowed = 0;  ///< how much the volume may differ because the surface may
};

std::vector<Enclosed> enclosed_by_patches(const Subject& subject) {
  const Plc& plc = subject.plc;
  std::vector<Enclosed> regions(plc.regions.size());
  for (const Plc::Triangle& t : plc.triangles) {
    const Plc::Patch& patch = plc.patches[t.patch];
    if (patch.regions[0] == patch.regions[1]) continue;
    const Point &a = subject.plc_corner(t, 0), &b = subject.plc_corner(t, 1), &c = subject.plc_corner(t, 2);
    for (unsigned side = 0; side < 2; ++side) {
      Enclosed& region = regions[patch.regions[side]];
      if (!region.origin) region.origin = a;
      const double cone = six_volume(*region.origin, a, b, c);
      region.six_volume += side == 0 ? cone : -cone;
      region.allowed += subject.patch_allowance[t.patch] * area(a, b, c);
    }
  }
  return regions;
}

}  // namespace

// A surface moved by no more than d encloses a volume changed by no more than d times its area, to
// first order.
void check_region_volumes(const Subject& subject, const CheckReport& report, Findings& findings) {
  const Plc& plc = subject.plc;
  const auto regions = enclosed_by_patches(subject);
  for (Index r = 1; r < plc.regions.size(); ++r) {
    const double expected = static_cast<double>(regions[r].six_volume / 6), found = report.region_volumes[r];
    const double allowed = 1e-12 * std::fabs(expected) + regions[r].allowed;
    if (std::fabs(found - expected) <= allowed) continue;
    findings.add(
        guarantee::region_volume, plc.bounds.centre(), {r},
        "The tets of region {} (tag {}) have a volume of {:.15g}, the complex encloses {:.15g}; the "
        "difference "
        "{:.6g} is above the allowed {:.6g}. Tets are missing or in a wrong region, or the surface was not "
        "reproduced.",
        r, plc.regions[r].tag, found, expected, found - expected, allowed);
  }
}

}  // namespace collarmesh::checks
