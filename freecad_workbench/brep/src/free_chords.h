#pragma once

#include <string>

#include "tessellation.h"
#include "topology.h"

namespace collarmesh::brep {

/// Makes chords and points of `topology.free_parts`, as a soup of segments and vertices, which may be empty.
/// Leaves out a part that is so near to faces that its chords may cross their triangles, and a part whose
/// chords may cross those of an earlier part; notes list these.
PolygonSoup cut_free_parts(const Topology& topology, const std::string& file,
                           const TessellationOptions& options, Tessellation& result);

}  // namespace collarmesh::brep
