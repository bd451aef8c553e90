#pragma once

#include <string>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// Returns the path of the file of periodic conditions for a mesh file: cell_periodic.inp for cell.inp.
std::string abaqus_periodic_path(const std::string& path);

/// Writes conditions on the displacements of periodic faces, for CalculiX and Abaqus. The displacement of an
/// image is that of the node whose image it is, rotated by the motion, plus the displacement of the pair's
/// reference node (set PERIODIC_1_REFERENCE). A degree of freedom can be dependent only once. So at edges and
/// corners of a cell, where several pairs meet, all images depend directly on the first node of their chain
/// of images. Nodes on the axis of a pair's rotation have no condition from this pair; they form a set
/// (PERIODIC_1_AXIS). PERIODIC_HELD is a node without a condition, to be fixed against rigid motion.
void write_abaqus_periodic(const std::string& path, const TetMesh& mesh);

}  // namespace collarmesh::io
