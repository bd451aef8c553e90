#pragma once

#include <array>
#include <vector>

#include "check/subject.h"

namespace collarmesh::checks {

/// Finds the mesh edges on each bent curve of the complex from the tags of the mesh's faces: the edges at
/// which the faces have the tags of the curve's patches, those of other curves left out. Finds none along a
/// curve inside one face, like a seam. Nodes of other programs lie on the exact curve, off the complex's
/// polyline, so that their places alone would not tell. Cost: O(n log n).
std::vector<std::vector<std::array<Index, 2>>> border_edges(const Subject& subject);

}  // namespace collarmesh::checks
