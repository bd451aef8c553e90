#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::remeshing {

/// A function that returns the quality of a tet if it is above the second argument. It returns a negative
/// number if not, or if the tet must not be made, for example because its volume is negative.
using FillingQuality = std::function<double(const std::array<Index, 4>&, double)>;

/// Fills a polyhedron with tets between its vertices, so that the worst tet is as good as possible (small
/// polyhedron reconnection: Liu, Chen, Sun 2007). `hull` has its triangles, each oriented so that it makes a
/// positive tet with a point above it inside the polyhedron. The tets have positive volumes, and each of
/// their faces that is not in the hull is shared by two of them; so they cover every point inside exactly
/// once, and no point outside. Returns an empty list if no filling with all tets better than `above` is found
/// in `most_steps` steps, each of which tries a tet. Cost: grows exponentially with the number of vertices,
/// up to `most_steps`.
std::vector<std::array<Index, 4>> fill_polyhedron(std::span<const std::array<Index, 3>> hull, double above,
                                                  const FillingQuality& quality, std::size_t most_steps);

}  // namespace collarmesh::remeshing
