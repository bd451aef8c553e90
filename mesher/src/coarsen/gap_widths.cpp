#include "coarsen/gap_widths.h"

#include <algorithm>

namespace collarmesh::coarsening {

double GapWidths::from(const Point& p, Index patch, double widest) {
  Index at = none;
  facing_.triangles().squared_distance_to(p, INFINITY, &at,
                                          [&](Index t) { return plc_.triangles[t].patch == patch; });
  if (at == none) return widest;
  double width = widest;
  for (unsigned side = 0; side < 2; ++side)
    if (plc_.patches[patch].regions[side] != 0)
      width = std::min(width, facing_.from(p, at, side, widest, crossings_).distance);
  return width;
}

}  // namespace collarmesh::coarsening
