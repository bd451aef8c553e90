#pragma once

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include "collarmesh/geometry.h"

namespace collarmesh::facets {

using PlaneKernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// A constrained Delaunay triangulation between given points of a plane. Vertices store the index of their
/// point, faces carry a mark, and crossing constraints throw an exception. Few sources include this header,
/// because it is slow to compile.
using PlaneTriangulation = CGAL::Constrained_Delaunay_triangulation_2<
    PlaneKernel,
    CGAL::Triangulation_data_structure_2<
        CGAL::Triangulation_vertex_base_with_info_2<Index, PlaneKernel>,
        CGAL::Constrained_triangulation_face_base_2<
            PlaneKernel, CGAL::Triangulation_face_base_with_info_2<bool, PlaneKernel>>>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

}  // namespace collarmesh::facets
