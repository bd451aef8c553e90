#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "collarmesh/brep/cad_model.h"
#include "collarmesh/check.h"
#include "collarmesh/mesher.h"
#include "collarmesh/project_boundary.h"
#include "collarmesh/second_order.h"

/// Meshes of CAD files, made and judged as in the program.
namespace collarmesh::testing {

struct CadMeshed {
  Plc plc;
  MeshResult result;
  ProjectReport projection;
  SecondOrderReport second_order;
  CheckReport report;
};

/// Writes a shape to a BREP file and meshes it; sizes are relative to the diagonal.
CadMeshed mesh_of_shape(const TopoDS_Shape& shape, double relative_size = 0.1, int order = 1);
CadMeshed mesh_of_cad_file(const std::string& path, double relative_size = 0.1, int order = 1);

/// Returns the shape in a file, numbered as FreeCAD does.
TopoDS_Shape shape_in(const std::string& path);

/// Returns the largest distance of mesh points on faces, mid-edge nodes included, from the faces that their
/// tags name, over about `samples` points, by OpenCASCADE's search over the whole face with its border.
/// Leaves out exceptions of the projection, nodes beside them, and straightened nodes.
double farthest_from_faces(const CadMeshed& meshed, const TopoDS_Shape& shape, std::size_t samples = 400);

/// Returns the faults of the mesh as text; empty if there are none.
std::string faults(const CadMeshed& meshed);

}  // namespace collarmesh::testing
