// VTK's XML format for unstructured grids: appended arrays, compressed in blocks, base64. Headers are UInt64.
// See "VTK File Formats" (VTK User's Guide) and vtkXMLDataReader. vtk_grid.h describes the arrays. The cells
// are those of volumes; faces and edges are in FieldData. In a mesh without volumes, triangles and edges are
// the cells.
#include <tbb/task_arena.h>

#include <array>
#include <bit>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/usable_threads.h"
#include "common/large_pages.h"
#include "common/parallel_for.h"
#include "io/base64.h"
#include "io/file_writer.h"
#include "io/tet_mesh_formats.h"
#include "io/vtk_grid.h"
#include "io/zlib_block.h"

namespace collarmesh::io {

namespace {

constexpr int fastest = 1;                    // level of zlib_pack
constexpr std::size_t block_bytes = 1 << 18;  // a multiple of every value's size, as some readers require

template <class T>
constexpr std::string_view xml_type_name = {};
template <>
constexpr std::string_view xml_type_name<std::uint8_t> = "UInt8";
template <>
constexpr std::string_view xml_type_name<std::int32_t> = "Int32";
template <>
constexpr std::string_view xml_type_name<std::int64_t> = "Int64";
template <>
constexpr std::string_view xml_type_name<float> = "Float32";
template <>
constexpr std::string_view xml_type_name<double> = "Float64";

/// One array in its written form: the header (number of blocks, their size, size of the last one if it is
/// smaller, compressed sizes) and the compressed blocks, in base64.
struct DataArray {
  const VtkArray* array;
  std::string_view type, bytes;
  std::size_t values;
  std::string header, blocks;

  explicit DataArray(const VtkArray& from) : array(&from) {
    std::visit(
        [this](const auto& all) {
          using T = typename std::decay_t<decltype(all)>::value_type;
          type = xml_type_name<T>;
          bytes = {reinterpret_cast<const char*>(all.data()), all.size() * sizeof(T)};
          values = all.size();
        },
        from.values);
  }
  std::size_t block_count() const { return (bytes.size() + block_bytes - 1) / block_bytes; }
};

/// The arrays of one part of the file.
struct Section {
  std::string_view name;
  std::vector<DataArray> arrays;

  Section(std::string_view its_name, std::span<const VtkArray> of)
      : name(its_name), arrays(of.begin(), of.end()) {}
};

/// The part of an array that one thread encodes.
struct Piece {
  DataArray* array;
  std::string_view bytes;
  std::size_t first;  // place of its text in the array's
};
constexpr std::size_t piece_bytes = 3 << 15;  // a multiple of three

void join(std::span<const std::string> blocks, DataArray& array, std::string& joined) {
  std::vector<std::uint64_t> header{blocks.size(), block_bytes, array.bytes.size() % block_bytes};
  std::size_t size = 0;
  for (const std::string& block : blocks) {
    header.push_back(block.size());
    size += block.size();
  }
  reserve_in_large_pages(joined, size);
  for (const std::string& block : blocks) joined += block;
  array.header =
      base64_encode({reinterpret_cast<const char*>(header.data()), header.size() * sizeof(std::uint64_t)});
  reserve_in_large_pages(array.blocks, base64_size(size));
  array.blocks.resize(base64_size(size));
}

/// Compresses and encodes all arrays.
void encode(std::span<Section> sections) {
  std::vector<DataArray*> arrays;
  std::vector<std::size_t> first{0};  // first block of each array, and the end
  std::vector<std::string_view> bytes;
  for (Section& section : sections)
    for (DataArray& array : section.arrays) {
      arrays.push_back(&array);
      for (std::size_t i = 0; i < array.block_count(); ++i)
        bytes.push_back(array.bytes.substr(i * block_bytes, block_bytes));
      first.push_back(bytes.size());
    }
  std::vector<std::string> blocks(bytes.size()), joined(arrays.size());
  parallel_for(blocks.size(), [&](std::size_t i) { blocks[i] = zlib_pack(bytes[i], fastest); });
  parallel_for(arrays.size(), [&](std::size_t i) {
    join(std::span(blocks).subspan(first[i], first[i + 1] - first[i]), *arrays[i], joined[i]);
  });
  blocks.clear();
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < arrays.size(); ++i)
    for (std::size_t at = 0; at < joined[i].size(); at += piece_bytes)
      pieces.push_back({arrays[i], std::string_view(joined[i]).substr(at, piece_bytes), base64_size(at)});
  parallel_for(pieces.size(), [&](std::size_t i) {
    base64_encode(pieces[i].bytes, pieces[i].array->blocks.data() + pieces[i].first);
  });
}

void write_section(FileWriter& out, const Section& section, std::size_t& offset) {
  out << "      <" << section.name;
  for (const DataArray& array : section.arrays)
    if (const std::string& name = array.array->name; name == vtk_point_ids || name == vtk_cell_ids)
      out << " GlobalIds=\"" << name << '"';
  out << ">\n";
  for (const DataArray& array : section.arrays) {
    const int components = array.array->components;
    out << "        <DataArray type=\"" << array.type << "\" Name=\"" << array.array->name << '"';
    // meshio gives arrays with this attribute a second dimension.
    if (components > 1) out << " NumberOfComponents=\"" << components << '"';
    if (section.name == "FieldData") out << " NumberOfTuples=\"" << array.values << '"';
    out << " format=\"appended\" offset=\"" << offset << "\"/>\n";
    offset += array.header.size() + array.blocks.size();
  }
  out << "      </" << section.name << ">\n";
}

}  // namespace

void write_vtu(const std::string& path, const TetMesh& mesh) {
  // The first call of usable_threads limits TBB to the threads that the system allows.
  if (tbb::this_task_arena::max_concurrency() > 1) static_cast<void>(usable_threads());
  VtkGrid grid = make_vtk_grid(mesh);
  const std::vector<VtkArray> boundary =
      mesh.is_surface() || mesh.is_curves() ? names_array(mesh) : take_boundary(mesh, grid);
  write_vtu_grid(path, grid, boundary);
}

std::string_view vtu_type(const VtkArray& array) {
  return std::visit(
      [](const auto& values) { return xml_type_name<typename std::decay_t<decltype(values)>::value_type>; },
      array.values);
}

void write_vtu_grid(const std::string& path, VtkGrid& grid, const std::vector<VtkArray>& field_data) {
  static_assert(std::endian::native == std::endian::little);
  FileWriter out(path);
  const std::array<VtkArray, 3> cells{std::move(grid.connectivity), std::move(grid.offsets),
                                      std::move(grid.types)};
  Section sections[] = {{"FieldData", field_data},
                        {"Points", {&grid.points, 1}},
                        {"Cells", cells},
                        {"PointData", grid.point_data},
                        {"CellData", grid.cell_data}};
  encode(sections);
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" "
         "compressor=\"vtkZLibDataCompressor\">\n  <UnstructuredGrid>\n";
  std::size_t offset = 0;
  write_section(out, sections[0], offset);
  out << "    <Piece NumberOfPoints=\"" << grid.point_count << "\" NumberOfCells=\"" << grid.cell_count
      << "\">\n";
  for (const Section& section : std::span(sections).subspan(1)) write_section(out, section, offset);
  out << "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"base64\">\n   _";
  for (const Section& section : sections)
    for (const DataArray& array : section.arrays) out << array.header << array.blocks;
  out << "\n  </AppendedData>\n</VTKFile>\n";
  out.commit();
}

}  // namespace collarmesh::io
