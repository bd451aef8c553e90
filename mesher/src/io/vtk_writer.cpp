// VTK's legacy format for unstructured grids, version 3.0, binary (big endian); "VTK File Formats"
// (VTK User's Guide). vtk_grid.h describes the arrays.
#include <bit>
#include <string_view>
#include <variant>

#include "io/file_writer.h"
#include "io/tet_mesh_formats.h"
#include "io/vtk_grid.h"

namespace collarmesh::io {

namespace {

constexpr std::string_view type_name(std::uint8_t) { return "unsigned_char"; }
constexpr std::string_view type_name(std::int32_t) { return "int"; }
constexpr std::string_view type_name(std::int64_t) { return "long"; }  // meshio knows no other name for it
constexpr std::string_view type_name(float) { return "float"; }
constexpr std::string_view type_name(double) { return "double"; }

template <class T>
void write_values(FileWriter& out, const std::vector<T>& values) {
  for (const T value : values) out.append_bytes(value, std::endian::big);
  out << '\n';
}

/// Writes cells, each preceded by the number of its corners.
void write_cells(FileWriter& out, const VtkGrid& grid) {
  const auto& corners = std::get<std::vector<std::int32_t>>(grid.connectivity.values);
  const auto& ends = std::get<std::vector<std::int64_t>>(grid.offsets.values);
  out << "CELLS " << grid.cell_count << ' ' << grid.cell_count + corners.size() << '\n';
  std::int64_t begin = 0;
  for (const std::int64_t end : ends) {
    out.append_bytes(static_cast<std::int32_t>(end - begin), std::endian::big);
    for (; begin < end; ++begin) out.append_bytes(corners[static_cast<std::size_t>(begin)], std::endian::big);
  }
  out << "\nCELL_TYPES " << grid.cell_count << '\n';
  for (const std::uint8_t type : std::get<std::vector<std::uint8_t>>(grid.types.values))
    out.append_bytes(std::int32_t{type}, std::endian::big);
  out << '\n';
}

void write_field(FileWriter& out, const std::vector<VtkArray>& arrays) {
  if (arrays.empty()) return;
  out << "FIELD FieldData " << arrays.size() << '\n';
  for (const VtkArray& array : arrays)
    std::visit(
        [&](const auto& values) {
          using T = typename std::decay_t<decltype(values)>::value_type;
          out << array.name << ' ' << array.components << ' ' << values.size() << ' ' << type_name(T{})
              << '\n';
          write_values(out, values);
        },
        array.values);
}

void write_data(FileWriter& out, std::string_view section, std::size_t count,
                const std::vector<VtkArray>& arrays) {
  if (!arrays.empty()) out << section << ' ' << count << '\n';
  write_field(out, arrays);
}

}  // namespace

void write_vtk(const std::string& path, const TetMesh& mesh) {
  FileWriter out(path);
  const VtkGrid grid = make_vtk_grid(mesh);
  out << "# vtk DataFile Version 3.0\nWritten by collarmesh.\nBINARY\nDATASET UNSTRUCTURED_GRID\n";
  write_field(out, names_array(mesh));
  out << "POINTS " << grid.point_count << " double\n";
  write_values(out, std::get<std::vector<double>>(grid.points.values));
  write_cells(out, grid);
  write_data(out, "CELL_DATA", grid.cell_count, grid.cell_data);
  write_data(out, "POINT_DATA", grid.point_count, grid.point_data);
  out.commit();
}

}  // namespace collarmesh::io
