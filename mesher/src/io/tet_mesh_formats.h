#pragma once

#include <string>
#include <vector>

#include "collarmesh/io/point_field_io.h"
#include "collarmesh/tet_mesh.h"

/// One writer and one reader per format of tetrahedral meshes.
namespace collarmesh::io {

void write_vtu(const std::string& path, const TetMesh& mesh);
void write_pvtu(const std::string& path, const TetMesh& mesh);
void write_vtk(const std::string& path, const TetMesh& mesh);
void write_msh(const std::string& path, const TetMesh& mesh);
/// Writes only the .pvtu file that lists these .vtu files. `like` is the mesh of any of them; all must have
/// the same arrays.
void write_list_of_pieces(const std::string& path, const TetMesh& like,
                          const std::vector<std::string>& pieces);
// The next two also write the ghost tets around each partition:
void write_pvtu_with_ghost_cells(const std::string& path, const TetMesh& mesh);
void write_msh_with_ghost_cells(const std::string& path, const TetMesh& mesh);
void write_msh2(const std::string& path, const TetMesh& mesh);
void write_medit(const std::string& path, const TetMesh& mesh);
void write_abaqus(const std::string& path, const TetMesh& mesh);
void write_unv(const std::string& path, const TetMesh& mesh);
void write_nastran(const std::string& path, const TetMesh& mesh);
void write_ansys(const std::string& path, const TetMesh& mesh);
void write_mfem(const std::string& path, const TetMesh& mesh);
void write_exodus(const std::string& path, const TetMesh& mesh);
void write_su2(const std::string& path, const TetMesh& mesh);
void write_openfoam(const std::string& path, const TetMesh& mesh);
void write_tetgen(const std::string& path, const TetMesh& mesh);
// The readers and writers of these formats are built only with HDF5 or MED:
void write_xdmf(const std::string& path, const TetMesh& mesh);
void write_med(const std::string& path, const TetMesh& mesh);
void write_cgns(const std::string& path, const TetMesh& mesh);

TetMesh read_xdmf(const std::string& path);
TetMesh read_med(const std::string& path);

TetMesh read_vtu(const std::string& path);
TetMesh read_pvtu(const std::string& path);
/// Returns the files that a .pvtu names, one for each piece.
std::vector<std::string> pieces_of_pvtu(const std::string& path);
TetMesh read_vtk(const std::string& path);
TetMesh read_msh(const std::string& path);
TetMesh read_medit(const std::string& path);
TetMesh read_abaqus(const std::string& path);
TetMesh read_unv(const std::string& path);
TetMesh read_tetgen(const std::string& path);

// These also read files without tetrahedra:
TetMesh read_vtu_cells(const std::string& path);
TetMesh read_vtp_cells(const std::string& path);
TetMesh read_msh_cells(const std::string& path);
TetMesh read_medit_cells(const std::string& path);

PointField read_vtu_field(const std::string& path, const std::string& name);
PointField read_msh_field(const std::string& path, const std::string& name);
/// Returns the index of the field to read: the one with the name `wanted` or, if that is empty, the only one.
/// Throws ReadError if there is no such field.
std::size_t choose_field(const std::string& path, const std::vector<std::string>& names,
                         const std::string& wanted);

}  // namespace collarmesh::io
