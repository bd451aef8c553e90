#pragma once

#include <string>

#include "tessellation.h"
#include "topology.h"

namespace collarmesh::brep {

/// Makes chords and points of `topology.free_parts`, as a soup of segments and vertices, which may be empty.
/// If the shape has solids, leaves out parts that are so near to faces that their chords may cross the
/// triangles, and parts whose chords may cross those of an earlier part. Notes list these.
PolygonSoup cut_free_parts(const Topology& topology, const std::string& file,
                           const TessellationOptions& options, Tessellation& result);

}  // namespace collarmesh::brep
