#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "collarmesh/locate.h"
#include "collarmesh/polygon_soup.h"
#include "collarmesh/tag_colours.h"
#include "collarmesh/tet_mesh.h"

/// Conversion of numpy arrays to and from the library's types. The Python side has checked their shapes and
/// kinds.
namespace collarmesh::python {

/// Makes a soup from a dict. Keys: name, points (n, 3); corners (c,), polygon_ends (p,), facet_ends (f,),
/// facet_tags (f,); segments (s, 2), segment_tags (s,); holes (h, 3); regions (r, 5): place, tag, size;
/// facet_holes (k, 4): facet, place. Throws OptionError for corners out of range.
PolygonSoup soup_of(const pybind11::dict& arrays);
/// Returns a dict of dimension to a dict of tag to "#rrggbb".
pybind11::dict colours_of(const TagColours& colours);
/// Returns the name, points, facets and names of tags of a soup, with the keys of `soup_of`.
pybind11::dict arrays_of(const PolygonSoup& soup);

/// Makes a mesh from a dict. Keys: the names of TetMesh's arrays; feature_dimension and feature for the
/// features of points; `names`, a dict of dimension to a dict of tag to name; and `cad_names`.
TetMesh tet_mesh_of(const pybind11::dict& arrays);
pybind11::dict arrays_of(TetMesh mesh);
/// Returns arrays: the tet, the barycentric coordinates and the mesh's nearest point of each place; -1: none.
pybind11::tuple arrays_of(const std::vector<MeshPlace>& places);
/// Returns the array of `TetMesh::tet_partition`.
pybind11::array partition_array(const TetMesh& mesh);

}  // namespace collarmesh::python
