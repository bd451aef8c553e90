#pragma once

#include <algorithm>
#include <vector>

#include "collarmesh/progress.h"
#include "common/distances.h"
#include "shells/surface_editor.h"

namespace collarmesh::shells {

/// A triangle with all corners on curves, and its only side on a curve.
struct NarrowTriangle {
  Index triangle;
  Index edge;    ///< the edge of the curve at this side
  double width;  ///< distance of the third corner from this side
};

/// Calls visit(NarrowTriangle) for all triangles with all corners on curves and exactly one side on a curve.
/// Excludes triangles with two sides on curves, because they lie in a corner.
template <class Visit>
void for_narrow_triangles(const SurfaceComplex& complex, const Visit& visit) {
  for (Index t = 0; t < complex.triangles.size(); ++t) {
    const auto& c = complex.triangles[t].corners;
    if (!complex.triangles[t].alive()) continue;
    const auto inside = [&](Index v) { return complex.vertices[v].feature.dimension == 2; };
    if (std::any_of(c.begin(), c.end(), inside)) continue;
    unsigned count = 0, third = 0;
    Index edge = none;
    for (unsigned i = 0; i < 3; ++i) {
      const Index side = complex.edge_at(c[(i + 1) % 3], c[(i + 2) % 3]);
      if (side == none) continue;
      ++count;
      third = i;
      edge = side;
    }
    if (count != 1) continue;
    const auto& [a, b] = complex.edges[edge].ends;
    visit(NarrowTriangle{t, edge,
                         distance_to_segment(complex.vertices[c[third]].point, complex.vertices[a].point,
                                             complex.vertices[b].point)});
  }
}

/// The division of the curves of a complex where their distance across a patch is smaller than the length of
/// their edges, so that triangles between them have good angles. Edge lengths grow away from such places by
/// the gradation. Distances are measured in triangles with all corners on curves, so they become more exact
/// when the curves are divided.
class NarrowPlaces {
 public:
  /// Keeps references to all arguments.
  NarrowPlaces(SurfaceComplex& complex, SurfaceEditor& editor, const SurfaceSizes& sizes,
               const Execution& execution);

  /// Divides curves until there are about this many new vertices. Returns whether it left edges longer than
  /// good angles need, to limit their number.
  bool run(std::size_t most_vertices);

 private:
  void measure();
  void bound_widths();
  void lower_sizes();
  bool divide();
  bool divide_edge(Index edge);
  bool divide_tips(Index vertex);
  bool divide_at(Index edge, const std::vector<double>& places);
  double size_on(Index edge, double at) const;

  SurfaceComplex& complex_;
  SurfaceEditor& editor_;
  const SurfaceSizes& sizes_;
  const Execution& execution_;
  std::vector<double> widths_;  // by edge: its largest length for good angles with the features that face it
  std::size_t limit_ = 0;
  bool bounded_ = false;
};

}  // namespace collarmesh::shells
