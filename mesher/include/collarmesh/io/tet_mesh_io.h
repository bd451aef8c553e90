#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "collarmesh/partition.h"
#include "collarmesh/tet_mesh.h"

namespace collarmesh::io {

/// Writes a mesh by the extension of `path`, or as `format` (an extension with its dot, in any case) says.
/// Writes each file under another name and renames it, so a reader never sees half a file. The sources of the
/// formats say which data each of them keeps (src/io/*_writer.cpp). Throws WriteError, also for ghost cells,
/// prisms and pyramids where the format has no place for them.
void write_tet_mesh(const std::string& path, const TetMesh& mesh, std::string_view format = {},
                    GhostCells ghost_cells = GhostCells::off);

/// Reads the files of `write_tet_mesh`, and other programs' files of these formats as far as they contain
/// tetrahedra, prisms, pyramids, triangles, quadrangles and lines of first or second order. Throws ReadError
/// (path, line or byte).
TetMesh read_tet_mesh(const std::string& path, std::string_view format = {});

/// Returns the extensions of the formats that this program can write: .vtu (VTK), .pvtu (the same, with a
/// .vtu beside it for each partition), .vtk (VTK's legacy format), .msh (Gmsh; 4.1 is written), .mesh
/// (Medit), .inp (Abaqus, CalculiX), .unv (I-DEAS), .ele (TetGen, with .node, .face and .edge beside it).
/// Formats that are only written: .bdf (Nastran), .cdb (Ansys), .mfem (MFEM), .exo (Exodus II), .su2 (SU2),
/// .polymesh (OpenFOAM: the file constant/polyMesh/boundary, with the others beside it). Optional formats:
/// .xdmf (XDMF 3, with .h5 beside it), .med (SALOME) and, only written, .cgns.
std::vector<std::string> written_tet_mesh_formats();
std::vector<std::string> read_tet_mesh_formats();
/// Return the extensions of formats that can hold partitions, and of those that can hold ghost cells.
std::vector<std::string> formats_with_partitions();
std::vector<std::string> formats_with_ghost_cells();
/// Returns the extensions of formats that have no elements of second order.
std::vector<std::string> formats_of_first_order();

/// Returns the extensions of formats that hold prisms and pyramids of an order, 1 or 2.
std::vector<std::string> formats_with_layers(int order);

/// Returns the extensions of formats that can hold a mesh of triangles alone or of curve edges alone.
std::vector<std::string> formats_of_surfaces();

/// Returns a sentence about a format that this program was built without, with the library to install; empty
/// for all others.
std::string missing_library(const std::string& path, std::string_view format = {});

/// Returns whether `write_tet_mesh` knows this extension or format.
bool is_tet_mesh_format(const std::string& path, std::string_view format = {});

}  // namespace collarmesh::io
