// VTK's XML format for unstructured grids: appended arrays, compressed in blocks, base64. Headers
// are UInt64. See "VTK File Formats" (VTK User's Guide) and vtkXMLDataReader.
//
// Cells: tets, then faces, then curve edges. Cell arrays, each defined for all of them:
//   region                    of a tet; of a face the one behind it, or in front if none is behind
//   region_back, region_front of a face: TetMesh::face_regions; of a tet both its region
//   tag                       of the region, patch or curve
//   feature                   index of the patch or curve in the complex; -1: unknown or a tet
//   collar                    TetMesh::tet_collar; 0 for faces and edges
//   radius_edge, min_dihedral, max_dihedral   of tets; 0 for faces and edges
// Point arrays, if features are known: feature_dimension, feature.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <new>
#include <string_view>
#include <vector>

#include "io/base64.h"
#include "io/file_writer.h"
#include "io/tet_mesh_formats.h"
#include "io/vtu_format.h"

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
  std::string_view name, type;
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

template <class T>
DataArray compressed(std::string_view name, const std::vector<T>& values, int components = 1) {
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  const std::size_t count = (bytes.size() + block_bytes - 1) / block_bytes;
  DataArray array{name, type_name<T>, components, {count, block_bytes, bytes.size() % block_bytes}, {}};
  for (std::size_t at = 0; at < bytes.size(); at += block_bytes)
    append_compressed(bytes.substr(at, block_bytes), array);
  return array;
}

/// The arrays of one part of the file.
struct Section {
  std::string_view name;
  std::vector<DataArray> arrays;
};

std::size_t cell_count(const TetMesh& mesh) {
  return mesh.tets.size() + mesh.faces.size() + mesh.edges.size();
}

/// One value per cell, from what each kind of cell has.
template <class T, class OfTet, class OfFace, class OfEdge>
std::vector<T> per_cell(const TetMesh& mesh, OfTet of_tet, OfFace of_face, OfEdge of_edge) {
  std::vector<T> values;
  values.reserve(cell_count(mesh));
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) values.push_back(static_cast<T>(of_tet(i)));
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) values.push_back(static_cast<T>(of_face(i)));
  for (std::size_t i = 0; i < mesh.edges.size(); ++i) values.push_back(static_cast<T>(of_edge(i)));
  return values;
}

constexpr auto zero = [](std::size_t) { return 0; };

std::vector<double> coordinates(const TetMesh& mesh) {
  std::vector<double> values;
  values.reserve(3 * mesh.points.size());
  for (const Point& p : mesh.points) values.insert(values.end(), {p.x, p.y, p.z});
  return values;
}

std::vector<std::int32_t> connectivity(const TetMesh& mesh) {
  std::vector<std::int32_t> values;
  values.reserve(4 * mesh.tets.size() + 3 * mesh.faces.size() + 2 * mesh.edges.size());
  for (const auto& tet : mesh.tets) values.insert(values.end(), tet.begin(), tet.end());
  for (const auto& face : mesh.faces) values.insert(values.end(), face.begin(), face.end());
  for (const auto& edge : mesh.edges) values.insert(values.end(), edge.begin(), edge.end());
  return values;
}

std::vector<std::int64_t> offsets(const TetMesh& mesh) {
  std::int64_t end = 0;
  return per_cell<std::int64_t>(
      mesh, [&end](std::size_t) { return end += 4; }, [&end](std::size_t) { return end += 3; },
      [&end](std::size_t) { return end += 2; });
}

std::vector<std::uint8_t> cell_types(const TetMesh& mesh) {
  return per_cell<std::uint8_t>(
      mesh, [](std::size_t) { return vtk_tet; }, [](std::size_t) { return vtk_triangle; },
      [](std::size_t) { return vtk_line; });
}

Section cells_section(const TetMesh& mesh) {
  return {"Cells",
          {compressed("connectivity", connectivity(mesh)), compressed("offsets", offsets(mesh)),
           compressed("types", cell_types(mesh))}};
}

Section point_data_section(const TetMesh& mesh) {
  Section section{"PointData", {}};
  if (mesh.features.empty()) return section;
  std::vector<std::uint8_t> dimension;
  std::vector<std::int32_t> feature;
  for (const TetMesh::VertexFeature& f : mesh.features) {
    dimension.push_back(f.dimension);
    feature.push_back(static_cast<std::int32_t>(f.feature));
  }
  section.arrays = {compressed("feature_dimension", dimension), compressed("feature", feature)};
  return section;
}

void add_labels(const TetMesh& mesh, Section& section) {
  const auto tet_region = [&](std::size_t i) { return mesh.tet_region[i]; };
  const auto back = [&](std::size_t i) { return mesh.face_regions[i][0]; };
  const auto front = [&](std::size_t i) { return mesh.face_regions[i][1]; };
  const auto either = [&](std::size_t i) { return back(i) != 0 ? back(i) : front(i); };
  section.arrays.push_back(compressed("region", per_cell<std::int32_t>(mesh, tet_region, either, zero)));
  section.arrays.push_back(compressed("region_back", per_cell<std::int32_t>(mesh, tet_region, back, zero)));
  section.arrays.push_back(compressed("region_front", per_cell<std::int32_t>(mesh, tet_region, front, zero)));
  section.arrays.push_back(compressed("tag", per_cell<std::int64_t>(
                                                 mesh, [&](std::size_t i) { return mesh.tet_tag[i]; },
                                                 [&](std::size_t i) { return mesh.face_tag[i]; },
                                                 [&](std::size_t i) { return mesh.edge_tag[i]; })));
  section.arrays.push_back(compressed(
      "feature", per_cell<std::int32_t>(
                     mesh, [](std::size_t) { return -1; }, [&](std::size_t i) { return mesh.face_patch[i]; },
                     [&](std::size_t i) { return mesh.edge_curve[i]; })));
  section.arrays.push_back(
      compressed("collar", per_cell<std::uint8_t>(
                               mesh, [&](std::size_t i) { return mesh.tet_collar[i]; }, zero, zero)));
}

/// Programs that read the file do not all take infinity.
float finite(double value) {
  return static_cast<float>(std::min(value, double{std::numeric_limits<float>::max()}));
}

void add_measures(const TetMesh& mesh, Section& section) {
  std::array<std::vector<float>, 3> values;
  for (std::vector<float>& v : values) v.reserve(cell_count(mesh));
  for (const auto& [a, b, c, d] : mesh.tets) {
    const TetQuality quality = measure(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]);
    values[0].push_back(finite(quality.radius_edge));
    values[1].push_back(finite(quality.min_dihedral));
    values[2].push_back(finite(quality.max_dihedral));
  }
  constexpr std::array<std::string_view, 3> names{"radius_edge", "min_dihedral", "max_dihedral"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    values[k].resize(cell_count(mesh), 0.0F);
    section.arrays.push_back(compressed(names[k], values[k]));
  }
}

Section cell_data_section(const TetMesh& mesh) {
  Section section{"CellData", {}};
  add_labels(mesh, section);
  add_measures(mesh, section);
  return section;
}

void write_section(FileWriter& out, const Section& section, std::size_t& offset) {
  out << "      <" << section.name << ">\n";
  for (const DataArray& array : section.arrays) {
    out << "        <DataArray type=\"" << array.type << "\" Name=\"" << array.name << '"';
    // meshio gives arrays with the attribute a second dimension.
    if (array.components > 1) out << " NumberOfComponents=\"" << array.components << '"';
    out << " format=\"appended\" offset=\"" << offset << "\"/>\n";
    offset += array.encoded_size();
  }
  out << "      </" << section.name << ">\n";
}

}  // namespace

void write_vtu(const std::string& path, const TetMesh& mesh) {
  static_assert(std::endian::native == std::endian::little);
  FileWriter out(path);
  const Section sections[] = {{"Points", {compressed("Points", coordinates(mesh), 3)}},
                              cells_section(mesh),
                              point_data_section(mesh),
                              cell_data_section(mesh)};
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\" "
         "compressor=\"vtkZLibDataCompressor\">\n  <UnstructuredGrid>\n    <Piece NumberOfPoints=\""
      << mesh.points.size() << "\" NumberOfCells=\"" << cell_count(mesh) << "\">\n";
  std::size_t offset = 0;
  for (const Section& section : sections) write_section(out, section, offset);
  out << "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"base64\">\n   _";
  for (const Section& section : sections)
    for (const DataArray& array : section.arrays)
      out << base64_encode(array.header_bytes()) << base64_encode(array.blocks);
  out << "\n  </AppendedData>\n</VTKFile>\n";
  out.commit();
}

}  // namespace collarmesh::io
