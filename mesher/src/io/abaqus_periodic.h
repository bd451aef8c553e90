#pragma once

#include <string>

#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// The file of the conditions beside that of a mesh: cell_periodic.inp beside cell.inp.
std::string abaqus_periodic_path(const std::string& path);

/// Writes conditions on the displacements of periodic faces, for CalculiX and Abaqus. The displacement of an
/// image is that of its node, turned as the motion turns, and that of a reference node, which each pair has
/// (set PERIODIC_1_REFERENCE). A degree of freedom depends once only: at edges and corners of a cell, chains
/// of images are followed to one node, and what the other pairs say there follows from that. Nodes on an axis
/// have no condition; they are a set (PERIODIC_1_AXIS). PERIODIC_HELD is a node that depends on none, to be
/// held against drifting.
void write_abaqus_periodic(const std::string& path, const TetMesh& mesh);

}  // namespace collarmesh::io
