#include "location/voronoi_walk.h"

namespace collarmesh {

Index VoronoiWalk::nearest(const Point& p, Index from) {
  double best = squared_distance(p, mesh_.point(from));
  for (;;) {
    mesh_.adjacent_vertices(from, adjacent_);
    Index next = from;
    for (const Index v : adjacent_) {
      const double d = squared_distance(p, mesh_.point(v));
      if (d >= best) continue;
      best = d;
      next = v;
    }
    if (next == from) return from;
    from = next;
  }
}

}  // namespace collarmesh
