// Checks the volumes of the mesh's regions against those that the complex's triangles enclose.
#include <cassert>
#include <cmath>
#include <vector>

#include "check/predicates.h"
#include "check/subject.h"

namespace collarmesh::checks {

// Returns the expected volumes. If a surface moves by at most d, the volume changes by at most d times the
// surface's area, to first order.
RegionVolumes expected_volumes(const Subject& subject) {
  const Plc& plc = subject.plc;
  RegionVolumes volumes{collarmesh::measures_of(plc).volumes, std::vector<double>(plc.regions.size(), 0)};
  for (Index i = 0; i < plc.triangles.size(); ++i) {
    const Plc::Triangle& t = plc.triangles[i];
    const Plc::Patch& patch = plc.patches[t.patch];
    if (patch.regions[0] == patch.regions[1]) continue;
    const double allowance =
        patch.planar ? subject.patch_allowance[t.patch] : subject.tolerance.at_triangle(i) + subject.rounding;
    for (const Index region : patch.regions)
      volumes.allowed[region] +=
          allowance * area(subject.plc_corner(t, 0), subject.plc_corner(t, 1), subject.plc_corner(t, 2));
  }
  return volumes;
}

void check_region_volumes(const Subject& subject, const CheckReport& report, Findings& findings) {
  assert(report.region_volumes.size() == subject.plc.regions.size());
  const Plc& plc = subject.plc;
  const RegionVolumes volumes = expected_volumes(subject);
  for (Index r = 1; r < plc.regions.size(); ++r) {
    const double expected = volumes.enclosed[r];
    check_measure(volume_of_region, {"region", r, plc.regions[r].tag}, plc.bounds.centre(),
                  report.region_volumes[r], expected, 1e-12 * std::fabs(expected) + volumes.allowed[r],
                  findings);
  }
}

}  // namespace collarmesh::checks
