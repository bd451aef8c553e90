#pragma once

#include <string>
#include <vector>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// A mesh with a number at each of its points.
struct PointField {
  TetMesh mesh;
  std::string name;
  std::vector<double> values;  ///< one per point
};

/// Reads a mesh with a scalar field on its points: .vtu (an array of PointData) or .msh (a view, $NodeData).
/// If `name` is empty, reads the only field. Throws ReadError (path, line or byte), which lists the fields
/// when the choice is not clear.
PointField read_point_field(const std::string& path, const std::string& name = {});

}  // namespace collarmesh::io
