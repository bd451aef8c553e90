#pragma once

#include <string>

#include "tessellation.h"
#include "topology.h"

namespace collarmesh::brep {

/// Converts `topology.free_parts` to chords and points. Returns them as a soup of segments and vertices,
/// which may be empty; adds the edges' samples and lengths to `result`. If the shape has solids, leaves out
/// parts that are so near to faces that their chords may cross the triangles, and parts whose chords may
/// cross those of an earlier part, and lists both in `result.notes`.
PolygonSoup cut_free_parts(const Topology& topology, const std::string& file,
                           const TessellationOptions& options, Tessellation& result);

}  // namespace collarmesh::brep
