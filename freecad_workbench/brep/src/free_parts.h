#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "topology.h"

namespace collarmesh::brep {

/// The edges that bound no face, and the vertices that end no edge.
std::vector<TopoDS_Shape> parts_of_no_face(const TopoDS_Shape& shape);

/// Of these, keep in `topology.free_parts` what lies inside the closed solids. They are cut where they meet
/// faces or one another, and the faces have vertices there; pieces have the number of the part. Notes tell of
/// the others, and of pieces outside. Precondition: the topology's solids share their faces.
void keep_free_parts_inside(const std::vector<TopoDS_Shape>& parts, const std::string& file,
                            Topology& topology);

/// The least distance between two shapes, 0 where OpenCASCADE finds none.
double distance_between(const TopoDS_Shape& a, const TopoDS_Shape& b);

}  // namespace collarmesh::brep
