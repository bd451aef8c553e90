#pragma once

#include <string>

#include "tessellation.h"
#include "topology.h"

namespace collarmesh::brep {

/// Chords and points of `topology.free_parts`, as a soup of segments and vertices. A part that is so near to
/// faces that its chords may cross their triangles is left out, and so is one whose chords may cross those of
/// a part before; notes tell. Then the soup may be empty.
PolygonSoup cut_free_parts(const Topology& topology, const std::string& file,
                           const TessellationOptions& options, Tessellation& result);

}  // namespace collarmesh::brep
