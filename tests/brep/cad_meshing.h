#pragma once

#include <TopoDS_Shape.hxx>
#include <string>
#include <vector>

#include "collarmesh/brep/cad_model.h"
#include "collarmesh/check.h"
#include "collarmesh/mesher.h"
#include "collarmesh/project_boundary.h"
#include "collarmesh/second_order.h"

/// The way from a CAD file to a judged mesh, as the program takes it.
namespace collarmesh::testing {

struct CadMeshed {
  Plc plc;
  MeshResult result;
  ProjectReport projection;
  SecondOrderReport second_order;
  CheckReport report;
};

/// Write a shape to a BREP file and mesh that; sizes are relative to the diagonal.
CadMeshed mesh_of_shape(const TopoDS_Shape& shape, double relative_size = 0.1, int order = 1);
CadMeshed mesh_of_cad_file(const std::string& path, double relative_size = 0.1, int order = 1);

/// The shape that a file holds, numbered as FreeCAD does.
TopoDS_Shape shape_in(const std::string& path);

/// By OpenCASCADE's search over the whole face with its border: how far the mesh points on faces, mid-side
/// nodes as well, are from the face that their tag names, at most over about `samples` points. Points in the
/// projection's exceptions, nodes beside them and straightened nodes are left out.
double farthest_from_faces(const CadMeshed& meshed, const TopoDS_Shape& shape, std::size_t samples = 400);

/// Empty when all is right, else what is wrong.
std::string faults(const CadMeshed& meshed);

}  // namespace collarmesh::testing
