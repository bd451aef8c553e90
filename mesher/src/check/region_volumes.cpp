// Checks the volumes of the mesh's regions against those that the complex's triangles enclose.
#include <cassert>
#include <cmath>
#include <vector>

#include "check/mesh_to_check.h"
#include "check/predicates.h"

namespace collarmesh::checks {

// Returns the expected volumes. If a surface moves by at most d, the volume changes by at most d times the
// surface's area, to first order.
RegionVolumes expected_volumes(const MeshToCheck& to_check) {
  const Plc& plc = to_check.plc;
  RegionVolumes volumes{collarmesh::measures_of(plc).volumes, std::vector<double>(plc.regions.size(), 0)};
  for (Index i = 0; i < plc.triangles.size(); ++i) {
    const Plc::Triangle& t = plc.triangles[i];
    const Plc::Patch& patch = plc.patches[t.patch];
    if (patch.regions[0] == patch.regions[1]) continue;
    const double allowance = patch.planar ? to_check.patch_allowance[t.patch]
                                          : to_check.tolerance.at_triangle(i) + to_check.rounding;
    for (const Index region : patch.regions)
      volumes.allowed[region] +=
          allowance * area(to_check.plc_corner(t, 0), to_check.plc_corner(t, 1), to_check.plc_corner(t, 2));
  }
  return volumes;
}

void check_region_volumes(const MeshToCheck& to_check, const CheckReport& report, Findings& findings) {
  assert(report.region_volumes.size() == to_check.plc.regions.size());
  const Plc& plc = to_check.plc;
  const RegionVolumes volumes = expected_volumes(to_check);
  for (Index r = 1; r < plc.regions.size(); ++r) {
    const double expected = volumes.enclosed[r];
    check_measure(volume_of_region, {"region", r, plc.regions[r].tag}, plc.bounds.centre(),
                  report.region_volumes[r], expected, 1e-12 * std::fabs(expected) + volumes.allowed[r],
                  findings);
  }
}

}  // namespace collarmesh::checks
