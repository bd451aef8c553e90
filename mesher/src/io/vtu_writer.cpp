// VTK's XML format for unstructured grids: appended arrays, compressed in blocks, base64. Headers
// are UInt64. See "VTK File Formats" (VTK User's Guide) and vtkXMLDataReader. What the arrays are:
// vtk_grid.h. The cells are the tets; faces and edges are in FieldData.
#include <zlib.h>

#include <bit>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/base64.h"
#include "io/file_writer.h"
#include "io/tet_mesh_formats.h"
#include "io/vtk_grid.h"

namespace collarmesh::io {

namespace {

constexpr std::size_t block_bytes = 1 << 18;  // a multiple of every value's size, as some readers ask

template <class T>
constexpr std::string_view type_name = {};
template <>
constexpr std::string_view type_name<std::uint8_t> = "UInt8";
template <>
constexpr std::string_view type_name<std::int32_t> = "Int32";
template <>
constexpr std::string_view type_name<std::int64_t> = "Int64";
template <>
constexpr std::string_view type_name<float> = "Float32";
template <>
constexpr std::string_view type_name<double> = "Float64";

/// One array, compressed: the header (number of blocks, their size, size of the last one if it is
/// smaller, compressed sizes) and the blocks.
struct DataArray {
  std::string name;
  std::string_view type;
  std::size_t values = 0;
  int components = 1;
  std::vector<std::uint64_t> header;
  std::string blocks;

  std::string_view header_bytes() const {
    return {reinterpret_cast<const char*>(header.data()), header.size() * sizeof(std::uint64_t)};
  }
  std::size_t encoded_size() const { return base64_size(header_bytes().size()) + base64_size(blocks.size()); }
};

void append_compressed(std::string_view block, DataArray& array) {
  const std::size_t before = array.blocks.size();
  uLongf size = compressBound(block.size());
  array.blocks.resize(before + size);
  if (compress2(reinterpret_cast<Bytef*>(array.blocks.data() + before), &size,
                reinterpret_cast<const Bytef*>(block.data()), block.size(), Z_BEST_SPEED) != Z_OK)
    throw std::bad_alloc();  // the only way it fails with a buffer of that size
  array.blocks.resize(before + size);
  array.header.push_back(size);
}

DataArray compressed(const VtkArray& array) {
  return std::visit(
      [&](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        const std::size_t count = (bytes.size() + block_bytes - 1) / block_bytes;
        DataArray result{array.name,
                         type_name<T>,
                         values.size(),
                         array.components,
                         {count, block_bytes, bytes.size() % block_bytes},
                         {}};
        for (std::size_t at = 0; at < bytes.size(); at += block_bytes)
          append_compressed(bytes.substr(at, block_bytes), result);
        return result;
      },
      array.values);
}

/// The arrays of one part of the file.
struct Section {
  std::string_view name;
  std::vector<DataArray> arrays;
};

Section compressed(std::string_view name, const std::vector<VtkArray>& arrays) {
  Section section{name, {}};
  for (const VtkArray& array : arrays) section.arrays.push_back(compressed(array));
  return section;
}

void write_section(FileWriter& out, const Section& section, std::size_t& offset) {
  out << "      <" << section.name << ">\n";
  for (const DataArray& array : section.arrays) {
    out << "        <DataArray type=\"" << array.type << "\" Name=\"" << array.name << '"';
    // meshio gives arrays with the attribute a second dimension.
    if (array.components > 1) out << " NumberOfComponents=\"" << array.components << '"';
    if (section.name == "FieldData") out << " NumberOfTuples=\"" << array.values << '"';
    out << " format=\"appended\" offset=\"" << offset << "\"/>\n";
    offset += array.encoded_size();
  }
  out << "      </" << section.name << ">\n";
}

}  // namespace

void write_vtu(const std::string& path, const TetMesh& mesh) {
  static_assert(std::endian::native == std::endian::little);
  FileWriter out(path);
  VtkGrid grid = make_vtk_grid(mesh);
  const Section sections[] = {
      compressed("FieldData", take_boundary(mesh, grid)), compressed("Points", {grid.points}),
      compressed("Cells", {grid.connectivity, grid.offsets, grid.types}),
      compressed("PointData", grid.point_data), compressed("CellData", grid.cell_data)};
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
    for (const DataArray& array : section.arrays)
      out << base64_encode(array.header_bytes()) << base64_encode(array.blocks);
  out << "\n  </AppendedData>\n</VTKFile>\n";
  out.commit();
}

}  // namespace collarmesh::io
