#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "collarmesh/tet_mesh.h"
#include "io/cell_nodes.h"

/// A mesh as an unstructured grid of VTK, which several file formats store.
namespace collarmesh::io {

/// Returns VTK's number of a kind of cells.
int vtk_type_of(CellKind kind, int order);

/// Converts nodes from our order to VTK's, or back: in VTK's wedges the normal of the first triangle points
/// away from the second one.
CellNodes in_vtk_order(CellKind kind, const CellNodes& nodes);

struct VtkArray {
  std::string name;
  std::variant<std::vector<std::uint8_t>, std::vector<std::int32_t>, std::vector<std::int64_t>,
               std::vector<float>, std::vector<double>>
      values;
  int components = 1;
};

/// Cells: those of volumes (tets, prisms, pyramids), then faces (triangles, quadrangles), then curve edges.
/// Cell arrays, with a value for every cell:
///   region                    of a volume; of a face the one behind it, or in front if none is behind
///   region_back, region_front of a face: TetMesh::face_regions; of a volume: its own region; 0 for edges
///   tag                       of the cell's region, patch or curve
///   feature                   index of the patch or curve in the complex; -1: unknown or a volume
///   collar, crease            TetMesh::tet_collar, TetMesh::tet_crease; 0 for other cells
///   thin                      TetMesh::tet_thin, if there is any; 0 for other cells
///   layer                     of a volume, if the mesh has layers; 0 for other cells
///   partition                 TetMesh::tet_partition, if there is any; of faces and edges: cell_partitions.h
///   radius_edge, min_dihedral, max_dihedral   of tets; 0 for other cells
/// Point arrays, if features are known: feature_dimension, feature.
struct VtkGrid {
  VtkArray points, connectivity, offsets, types;  ///< offsets: where each cell ends
  std::vector<VtkArray> point_data, cell_data;

  std::size_t point_count = 0, cell_count = 0;
};
VtkGrid make_vtk_grid(const TetMesh& mesh);

/// Arrays of the pieces of a mesh: numbers of points and cells in the whole mesh, and marks of ghosts.
constexpr std::string_view vtk_point_ids = "GlobalPointIds", vtk_cell_ids = "GlobalCellIds",
                           vtk_ghosts = "vtkGhostType";

/// Removes faces and edges from a grid that also has cells with volume, and returns them as arrays for the
/// FieldData of the file: so views that cut or select cells show the volume alone. Each returned array is
/// named like the array of the grid from which its values come, with `boundary_` before it; `boundary_of` has
/// the numbers of points and of cells with volume, so that a reader can tell whether these were changed. Cell
/// arrays that only concern faces and edges are removed from the grid. The names of groups are returned, too.
std::vector<VtkArray> take_boundary(const TetMesh& mesh, VtkGrid& grid);
constexpr std::string_view vtk_boundary_prefix = "boundary_";
/// The cell arrays for which `take_boundary` adds arrays of the boundary.
constexpr std::array<std::string_view, 6> vtk_boundary_arrays{"tag",          "region",  "region_back",
                                                              "region_front", "feature", vtk_cell_ids};

/// The array in FieldData that has the names of groups, as the bytes of a text (names_text.h): VTK has arrays
/// of strings, but not all readers support them.
constexpr std::string_view vtk_names = "names";
/// Returns the array of names alone, or no array if there are no names.
std::vector<VtkArray> names_array(const TetMesh& mesh);
/// Returns the text in an array of names.
std::string names_of(const std::vector<std::int64_t>& bytes);

/// Returns the name of the values' type in .vtu files, such as "Float64".
std::string_view vtu_type(const VtkArray& array);
/// Writes a grid as a .vtu file; takes connectivity, offsets and types out of the grid. Arrays named
/// `vtk_point_ids` or `vtk_cell_ids` become the grid's GlobalIds. Throws WriteError.
void write_vtu_grid(const std::string& path, VtkGrid& grid, const std::vector<VtkArray>& field_data);

/// A piece of a grid that is being read.
struct VtkPiece {
  using Arrays = std::map<std::string, std::vector<std::int64_t>, std::less<>>;
  std::vector<Point> points;
  std::vector<std::int64_t> connectivity, ends, types;
  Arrays point_data, cell_data;  ///< the existing arrays of `vtk_point_arrays` and `vtk_cell_arrays`
  std::string names;             ///< names of groups, as in names_text.h
};

/// The arrays of labels that are read, under our names and those of meshio and Gmsh.
constexpr std::array<std::string_view, 3> vtk_point_arrays{"feature_dimension", "feature", vtk_point_ids};
constexpr std::array<std::string_view, 15> vtk_cell_arrays{
    "tag",         "gmsh:physical", "medit:ref", "CellEntityIds", "region",
    "region_back", "region_front",  "feature",   "collar",        "crease",
    "thin",        "layer",         "partition", vtk_cell_ids,    vtk_ghosts};

/// Reads the pieces of a .vtu file, each with the faces and edges that FieldData has (`take_boundary`).
/// Throws ReadError.
std::vector<VtkPiece> read_vtu_pieces(const std::string& path);

/// A fault of a piece, to which the caller adds the file and the place.
struct VtkPieceError {
  std::string_view array;
  std::string message;
};

/// Adds a piece to a mesh. Cells of a single point are skipped. Throws VtkPieceError. Precondition: arrays
/// have one value for each point or cell.
void add_vtk_piece(const VtkPiece& piece, TetMesh& mesh);

/// Completes a mesh after the last piece: drops arrays that only some pieces have. Throws ReadError.
void complete_vtk_mesh(const std::string& path, TetMesh& mesh);

}  // namespace collarmesh::io
