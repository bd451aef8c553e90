#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "topology.h"

namespace collarmesh::brep {

/// Returns the edges that belong to no face, and the vertices that belong to no face and no edge.
std::vector<TopoDS_Shape> parts_of_no_face(const TopoDS_Shape& shape);

/// Puts the parts that lie inside closed solids into `topology.free_parts`. Cuts parts where they meet faces
/// or one another, and inserts vertices into the faces there; pieces have the number of their part. Notes
/// list the parts and pieces that are left out. Precondition: solids that touch share their faces.
void keep_free_parts_inside(const std::vector<TopoDS_Shape>& parts, const std::string& file,
                            Topology& topology);

/// Returns the least distance between two shapes; 0 if OpenCASCADE fails.
double distance_between(const TopoDS_Shape& a, const TopoDS_Shape& b);

}  // namespace collarmesh::brep
