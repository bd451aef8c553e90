// Reads VTK's XML format for unstructured grids: arrays as text or bytes; bytes inline or appended, base64 or
// raw, uncompressed or compressed with zlib or LZ4, with headers of 32 or 64 bits; tetrahedra, prisms,
// pyramids, triangles, quadrangles and lines.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <pugixml.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "io/file_bytes.h"
#include "io/finite_points.h"
#include "io/number_text.h"
#include "io/tet_mesh_formats.h"
#include "io/text_scanner.h"
#include "io/vtk_array.h"
#include "io/vtk_grid.h"

namespace collarmesh::io {

namespace {

/// A file split into its XML and the appended bytes, which need not be valid XML.
class VtuFile {
 public:
  explicit VtuFile(const std::string& path, const char* type = "UnstructuredGrid")
      : path_(path), type_(type), text_(read_bytes(path)) {
    parse_xml();
    read_storage();
    find_appended();
  }

  pugi::xml_node grid() const {
    const pugi::xml_node node = document_.child("VTKFile").child(type_);
    if (!node) fail(document_.child("VTKFile"), fmt::format("expected {}", type_));
    return node;
  }

  /// Returns the values of an array. `count`: the number of values that it must have; `any`: it may have any
  /// number.
  template <class T>
  std::vector<T> values(const pugi::xml_node& array, std::size_t count = any) const {
    const NumberType type = vtk_type(array.attribute("type").value());
    if (type == NumberType::unknown)
      fail(array, fmt::format("unknown type of values {}", in_quotes(array.attribute("type").value())));
    const std::string_view format = array.attribute("format").as_string("ascii");
    std::vector<T> result = format == "ascii" ? text_values<T>(array) : stored_values<T>(array, type, format);
    if (count != any && result.size() != count)
      fail(array, fmt::format("expected {} values of {}, found {}", count, name(array), result.size()));
    return result;
  }

  std::size_t number(const pugi::xml_node& node, const char* attribute) const {
    std::size_t value = 0;
    if (!parse(node.attribute(attribute).value(), value) || value >= none)
      fail(node, fmt::format("expected {}, a count, found {}", attribute,
                             in_quotes(node.attribute(attribute).value())));
    return value;
  }

  /// Throws ReadError with the line of a node of the XML.
  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& message) const {
    fail_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)), message);
  }

  static constexpr std::size_t any = std::numeric_limits<std::size_t>::max();

 private:
  static std::string name(const pugi::xml_node& array) {
    return in_quotes(array.attribute("Name").as_string("Points"));
  }

  [[noreturn]] void fail_at(std::size_t offset, const std::string& message) const {
    throw ReadError(fmt::format("{}: line {}: {}", path_, line_at(offset), message));
  }

  /// Returns the line at an offset. Cost: linear in the distance from the last offset.
  std::size_t line_at(std::size_t offset) const {
    const auto place = [&](std::size_t byte) { return text_.begin() + static_cast<std::ptrdiff_t>(byte); };
    offset = std::min(offset, text_.size());
    const auto [first, last] = std::minmax(offset, line_offset_);
    const auto lines = static_cast<std::size_t>(std::count(place(first), place(last), '\n'));
    line_ = offset < line_offset_ ? line_ - lines : line_ + lines;
    line_offset_ = offset;
    return line_;
  }

  /// Parses only the text before appended raw bytes, which would break the XML.
  void parse_xml() {
    const std::size_t tag = text_.find("<AppendedData");
    const std::size_t tag_end = tag == std::string::npos ? tag : text_.find('>', tag);
    std::string xml = text_.substr(0, tag_end == std::string::npos ? tag_end : tag_end + 1);
    if (tag_end != std::string::npos) {
      appended_begin_ = tag_end + 1;
      xml += "</AppendedData></VTKFile>";
    }
    const pugi::xml_parse_result result = document_.load_buffer(xml.data(), xml.size());
    if (!result)
      fail_at(static_cast<std::size_t>(result.offset),
              fmt::format("the XML is malformed: {}", result.description()));
    const pugi::xml_node root = document_.child("VTKFile");
    if (!root) fail_at(0, "expected a VTKFile");
    if (const std::string_view type = root.attribute("type").value(); type != type_)
      fail(root, fmt::format("expected the type {}, found {}", type_, in_quotes(type)));
  }

  void read_storage() {
    const pugi::xml_node root = document_.child("VTKFile");
    const std::string_view header = root.attribute("header_type").as_string("UInt32");
    if (header != "UInt32" && header != "UInt64")
      fail(root, fmt::format("expected the header type UInt32 or UInt64, found {}", in_quotes(header)));
    storage_.header_bytes = header == "UInt64" ? 8 : 4;
    const std::string_view compressor = root.attribute("compressor").value();
    if (compressor == "vtkZLibDataCompressor")
      storage_.compression = VtkCompression::zlib;
    else if (compressor == "vtkLZ4DataCompressor")
      storage_.compression = VtkCompression::lz4;
    else if (!compressor.empty())
      fail(root, fmt::format("the compressor {} is not supported; save with vtkZLibDataCompressor, "
                             "vtkLZ4DataCompressor or none",
                             in_quotes(compressor)));
    if (std::string_view(root.attribute("byte_order").value()) == "BigEndian")
      storage_.order = std::endian::big;
  }

  void find_appended() {
    if (appended_begin_ == 0) return;
    const pugi::xml_node node = document_.child("VTKFile").child("AppendedData");
    appended_is_base64_ = std::string_view(node.attribute("encoding").value()) == "base64";
    const std::size_t underscore = text_.find('_', appended_begin_);
    if (underscore == std::string::npos) fail(node, "expected an underscore before the appended values");
    appended_begin_ = underscore + 1;
    std::size_t end = std::min(text_.rfind("</AppendedData"), text_.size());
    while (appended_is_base64_ && end > appended_begin_ && text_[end - 1] <= ' ') --end;
    appended_ =
        std::string_view(text_).substr(appended_begin_, std::max(end, appended_begin_) - appended_begin_);
  }

  template <class T>
  std::vector<T> text_values(const pugi::xml_node& array) const {
    const std::string_view text = array.text().get();
    TextScanner scan(path_, text, 0, line_at(text_offset(array)));
    std::vector<T> result;
    while (!scan.at_end())
      if constexpr (std::is_integral_v<T>)
        result.push_back(scan.integer("a value"));
      else
        result.push_back(scan.number("a value"));
    return result;
  }

  std::size_t text_offset(const pugi::xml_node& array) const {
    const std::ptrdiff_t offset = array.first_child().offset_debug();
    return offset < 0 ? 0 : std::min(static_cast<std::size_t>(offset), text_.size());
  }

  template <class T>
  std::vector<T> stored_values(const pugi::xml_node& array, NumberType type, std::string_view format) const {
    std::size_t first_byte = 0;
    const std::string bytes = format == "binary"     ? inline_bytes(array, first_byte)
                              : format == "appended" ? appended_bytes(array, first_byte)
                                                     : unknown_format(array, format);
    if (bytes.size() % size_of(type) != 0)
      fail_byte(first_byte, array, fmt::format("{} bytes are not a whole number of values", bytes.size()));
    return convert_vtk_values<T>(bytes, type, storage_.order);
  }

  std::string inline_bytes(const pugi::xml_node& array, std::size_t& first_byte) const {
    std::string_view text = array.text().get();
    first_byte = text_offset(array);
    const std::size_t start = std::min(text.find_first_not_of(" \t\r\n"), text.size());
    first_byte += start;
    text.remove_prefix(start);
    text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
    return decode(array, text, true, first_byte);
  }

  std::string appended_bytes(const pugi::xml_node& array, std::size_t& first_byte) const {
    std::size_t offset = 0;
    if (!parse(array.attribute("offset").value(), offset) || offset > appended_.size())
      fail(array, fmt::format("the offset {} is not among the {} appended bytes",
                              in_quotes(array.attribute("offset").value()), appended_.size()));
    first_byte = appended_begin_ + offset;
    return decode(array, appended_.substr(offset), appended_is_base64_, first_byte);
  }

  std::string decode(const pugi::xml_node& array, std::string_view stored, bool base64,
                     std::size_t first_byte) const {
    try {
      std::string bytes = decode_vtk_array(stored, base64, storage_);
      require_room(bytes.size());
      return bytes;
    } catch (const VtkArrayError& error) {
      fail_byte(first_byte, array, error.message);
    }
  }

  /// Limits memory: a small file could have many arrays that all refer to the same bytes.
  void require_room(std::size_t decoded) const {
    decoded_ += decoded;
    if (decoded_ > text_.size() * (storage_.compression == VtkCompression::none ? 1 : vtk_largest_ratio))
      throw VtkArrayError{"together the arrays hold more bytes than the file; several share their bytes"};
  }

  [[noreturn]] std::string unknown_format(const pugi::xml_node& array, std::string_view format) const {
    fail(array, fmt::format("expected the format ascii, binary or appended, found {}", in_quotes(format)));
  }

  [[noreturn]] void fail_byte(std::size_t byte, const pugi::xml_node& array,
                              const std::string& message) const {
    throw ReadError(fmt::format("{}: byte {}: values of {}: {}", path_, byte, name(array), message));
  }

  const std::string& path_;
  const char* type_;
  std::string text_;
  pugi::xml_document document_;
  VtkStorage storage_;
  std::size_t appended_begin_ = 0;
  bool appended_is_base64_ = false;
  std::string_view appended_;
  mutable std::size_t line_offset_ = 0, line_ = 1;  ///< the last offset given to line_at, and its line
  mutable std::size_t decoded_ = 0;                 ///< bytes of all arrays so far
};

pugi::xml_node find_array(const pugi::xml_node& section, const char* name) {
  return section.find_child_by_attribute("DataArray", "Name", name);
}

class PieceReader {
 public:
  PieceReader(const VtuFile& file, const pugi::xml_node& piece, bool polygons = false)
      : file_(file),
        piece_(piece),
        polygons_(polygons),
        point_count_(file.number(piece, "NumberOfPoints")),
        cell_count_(file.number(piece, polygons ? "NumberOfPolys" : "NumberOfCells")) {
    if (!polygons) return;
    for (const char* other : {"NumberOfVerts", "NumberOfLines", "NumberOfStrips"})
      if (piece.attribute(other) && file.number(piece, other) > 0)
        file.fail(piece, fmt::format("{} is not 0; save the triangles alone", other));
  }

  VtkPiece take() const {
    VtkPiece piece;
    read_points(piece);
    const pugi::xml_node cells = piece_.child(polygons_ ? "Polys" : "Cells");
    constexpr std::int64_t triangle = 5;
    piece.ends = file_.values<std::int64_t>(required(cells, "offsets"), cell_count_);
    if (polygons_)
      piece.types.assign(cell_count_, triangle);
    else
      piece.types = file_.values<std::int64_t>(required(cells, "types"), cell_count_);
    piece.connectivity = file_.values<std::int64_t>(required(cells, "connectivity"));
    read_arrays(piece_.child("PointData"), vtk_point_arrays, point_count_, piece.point_data);
    read_arrays(piece_.child("CellData"), vtk_cell_arrays, cell_count_, piece.cell_data);
    if (!polygons_) append_boundary(piece);
    if (const pugi::xml_node names =
            find_array(piece_.parent().child("FieldData"), std::string(vtk_names).c_str()))
      piece.names = names_of(file_.values<std::int64_t>(names));
    return piece;
  }

  void read(TetMesh& mesh) const {
    const VtkPiece piece = take();
    try {
      add_vtk_piece(piece, mesh);
    } catch (const VtkPieceError& error) {
      file_.fail(place_of(error.array), error.message);
    }
  }

 private:
  void read_points(VtkPiece& piece) const {
    const pugi::xml_node array = piece_.child("Points").child("DataArray");
    if (!array) file_.fail(piece_, "expected Points");
    if (point_count_ > 0 && array.attribute("NumberOfComponents").as_int(3) != 3)
      file_.fail(array, "expected points of 3 components");
    piece.points = finite_points(file_.values<double>(array, 3 * point_count_),
                                 [&](const std::string& message) { file_.fail(array, message); });
  }

  pugi::xml_node required(const pugi::xml_node& section, const char* name) const {
    const pugi::xml_node array = find_array(section, name);
    if (!array) file_.fail(section ? section : piece_, fmt::format("expected an array '{}'", name));
    return array;
  }

  template <std::size_t n>
  void read_arrays(const pugi::xml_node& section, const std::array<std::string_view, n>& names,
                   std::size_t count, VtkPiece::Arrays& arrays) const {
    for (const std::string_view name : names)
      if (const pugi::xml_node array = find_array(section, std::string(name).c_str()))
        arrays.emplace(name, file_.values<std::int64_t>(array, count));
  }

  /// Appends the faces and edges that our files have in FieldData (`take_boundary`), unless the number of
  /// points or cells has changed since.
  void append_boundary(VtkPiece& piece) const {
    const pugi::xml_node data = piece_.parent().child("FieldData");
    const auto find = [&](std::string_view name) {
      return find_array(data, (std::string(vtk_boundary_prefix) + std::string(name)).c_str());
    };
    if (!find("of") || !find("connectivity") || !find("offsets") || !find("types")) return;
    const auto counts = file_.values<std::int64_t>(find("of"), 2);
    if (counts[0] != static_cast<std::int64_t>(point_count_) ||
        counts[1] != static_cast<std::int64_t>(cell_count_))
      return;
    const auto types = file_.values<std::int64_t>(find("types"));
    const auto ends = file_.values<std::int64_t>(find("offsets"), types.size());
    const auto corners = file_.values<std::int64_t>(find("connectivity"));
    const auto before = static_cast<std::int64_t>(piece.connectivity.size());
    piece.types.insert(piece.types.end(), types.begin(), types.end());
    for (const std::int64_t end : ends) piece.ends.push_back(end > 0 ? before + std::min(end, limit) : end);
    piece.connectivity.insert(piece.connectivity.end(), corners.begin(), corners.end());
    for (const std::string_view name : vtk_boundary_arrays)
      if (const pugi::xml_node array = find(name)) {
        const auto values = file_.values<std::int64_t>(array, types.size());
        auto& all = piece.cell_data[std::string(name)];
        all.resize(cell_count_);
        all.insert(all.end(), values.begin(), values.end());
      }
    for (auto& [name, values] : piece.cell_data) values.resize(piece.types.size());
  }
  static constexpr std::int64_t limit = std::int64_t{1} << 48;  // far above any number of corners

  pugi::xml_node place_of(std::string_view array) const {
    if (array == "connectivity") return find_array(piece_.child("Cells"), "connectivity");
    if (array == "types") return piece_.child("Cells");
    if (array == "feature_dimension") return find_array(piece_.child("PointData"), "feature_dimension");
    return piece_;
  }

  const VtuFile& file_;
  const pugi::xml_node piece_;
  bool polygons_;
  std::size_t point_count_, cell_count_;
};

}  // namespace

namespace {

TetMesh read_grid(const std::string& path, bool needs_tets) {
  const VtuFile file(path);
  TetMesh mesh;
  for (const pugi::xml_node& piece : file.grid().children("Piece")) PieceReader(file, piece).read(mesh);
  if (needs_tets && mesh.tets.empty()) file.fail(file.grid(), "expected tetrahedra, found none");
  complete_vtk_mesh(path, mesh);
  return mesh;
}

}  // namespace

TetMesh read_vtu(const std::string& path) { return read_grid(path, true); }

std::vector<VtkPiece> read_vtu_pieces(const std::string& path) {
  const VtuFile file(path);
  std::vector<VtkPiece> pieces;
  for (const pugi::xml_node& piece : file.grid().children("Piece"))
    pieces.push_back(PieceReader(file, piece).take());
  return pieces;
}

TetMesh read_vtu_cells(const std::string& path) { return read_grid(path, false); }

// Reads polygons of three corners and tags by cell, as ParaView saves surfaces.
TetMesh read_vtp_cells(const std::string& path) {
  const VtuFile file(path, "PolyData");
  TetMesh mesh;
  for (const pugi::xml_node& piece : file.grid().children("Piece")) PieceReader(file, piece, true).read(mesh);
  complete_vtk_mesh(path, mesh);
  return mesh;
}

// Reads a scalar field on points. Our own labels of points do not count as fields.
PointField read_vtu_field(const std::string& path, const std::string& name) {
  const VtuFile file(path);
  const auto pieces = file.grid().children("Piece");
  std::vector<std::string> names;
  if (!pieces.empty())
    for (const pugi::xml_node& array : pieces.begin()->child("PointData").children("DataArray")) {
      const std::string each = array.attribute("Name").value();
      const bool label =
          std::find(vtk_point_arrays.begin(), vtk_point_arrays.end(), each) != vtk_point_arrays.end();
      if (!label && array.attribute("NumberOfComponents").as_int(1) == 1) names.push_back(each);
    }
  PointField field;
  field.name = names.at(choose_field(path, names, name));
  for (const pugi::xml_node& piece : pieces) {
    PieceReader(file, piece).read(field.mesh);
    const pugi::xml_node array = find_array(piece.child("PointData"), field.name.c_str());
    if (!array) file.fail(piece, fmt::format("expected an array '{}' as in the first piece", field.name));
    const auto values = file.values<double>(array, file.number(piece, "NumberOfPoints"));
    field.values.insert(field.values.end(), values.begin(), values.end());
  }
  if (field.mesh.tets.empty()) file.fail(file.grid(), "expected tetrahedra, found none");
  complete_vtk_mesh(path, field.mesh);
  return field;
}

}  // namespace collarmesh::io
