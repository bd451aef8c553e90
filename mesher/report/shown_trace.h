#pragma once

#include <string>
#include <vector>

#include "collarmesh/trace.h"
#include "report/shown_mesh.h"

namespace collarmesh::report {

/// A step of a trace that a page shows beside the mesh.
struct ShownStep {
  std::string stage, detail;
  ShownMesh cells;           ///< relative to the centre of the mesh shown, with its face tags; marks: 1 in a
                             ///< collar, 2 thin, 4 about to be ripped out
  std::vector<float> lines;  ///< two points, six numbers, for each segment of a curve
  std::vector<float> balls;  ///< balls of collars: a centre and a radius, four numbers for each
};

/// Returns the steps to show. A step with more than `most` tets shows only those at the surface and at the
/// planes through the centre, and is left out if even these are too many. Shows cells outside all regions
/// only if there are no others.
std::vector<ShownStep> shown_trace(const Trace& trace, const ShownMesh& mesh, std::size_t most = 20000);

}  // namespace collarmesh::report
