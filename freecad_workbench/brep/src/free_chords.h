#pragma once

#include <string>

#include "tessellation.h"
#include "topology.h"

namespace collarmesh::brep {

/// Chords and points of `topology.free_parts`, as a soup of segments and vertices. A part that is so near to
/// faces that its chords may cross their triangles is left out, and a note tells; then the soup may be empty.
PolygonSoup cut_free_parts(const Topology& topology, const std::string& file,
                           const TessellationOptions& options, Tessellation& result);

}  // namespace collarmesh::brep
