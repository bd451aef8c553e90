// Reads VTK's XML format for unstructured grids: arrays as text, inline or appended, base64 or raw,
// compressed with zlib or not, with 32- or 64-bit headers; tetrahedra, triangles and lines.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <pugixml.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "io/complete_mesh.h"
#include "io/file_bytes.h"
#include "io/number_text.h"
#include "io/tet_mesh_formats.h"
#include "io/text_scanner.h"
#include "io/vtk_array.h"
#include "io/vtu_format.h"

namespace collarmesh::io {

namespace {

/// A file taken apart: its XML, and the appended bytes, which need not be XML.
class VtuFile {
 public:
  explicit VtuFile(const std::string& path) : path_(path), text_(read_bytes(path)) {
    parse_xml();
    read_storage();
    find_appended();
  }

  pugi::xml_node grid() const {
    const pugi::xml_node node = document_.child("VTKFile").child("UnstructuredGrid");
    if (!node) fail(document_.child("VTKFile"), "expected an UnstructuredGrid");
    return node;
  }

  /// The values of an array. `count`: how many there have to be; any number if not given.
  template <class T>
  std::vector<T> values(const pugi::xml_node& array, std::size_t count = any) const {
    const VtkType type = vtk_type(array.attribute("type").value());
    if (type == VtkType::unknown)
      fail(array, fmt::format("unknown type of values {}", quoted(array.attribute("type").value())));
    const std::string_view format = array.attribute("format").as_string("ascii");
    std::vector<T> result = format == "ascii" ? text_values<T>(array) : stored_values<T>(array, type, format);
    if (count != any && result.size() != count)
      fail(array, fmt::format("expected {} values of {}, found {}", count, name(array), result.size()));
    return result;
  }

  std::size_t number(const pugi::xml_node& node, const char* attribute) const {
    std::size_t value = 0;
    if (!parse(node.attribute(attribute).value(), value) || value >= none)
      fail(node, fmt::format("expected {}, a number of things, found {}", attribute,
                             quoted(node.attribute(attribute).value())));
    return value;
  }

  /// Line of a node of the XML.
  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& message) const {
    fail_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)), message);
  }

  static constexpr std::size_t any = std::numeric_limits<std::size_t>::max();

 private:
  static std::string name(const pugi::xml_node& array) {
    return quoted(array.attribute("Name").as_string("Points"));
  }

  [[noreturn]] void fail_at(std::size_t offset, const std::string& message) const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(std::min(offset, text_.size()));
    throw ReadError(fmt::format("{}: line {}: {}", path_, std::count(text_.begin(), end, '\n') + 1, message));
  }

  /// Appended raw bytes would break the XML: only what is before them is parsed.
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
    if (const std::string_view type = root.attribute("type").value(); type != "UnstructuredGrid")
      fail(root, fmt::format("expected the type UnstructuredGrid, found {}", quoted(type)));
  }

  void read_storage() {
    const pugi::xml_node root = document_.child("VTKFile");
    const std::string_view header = root.attribute("header_type").as_string("UInt32");
    if (header != "UInt32" && header != "UInt64")
      fail(root, fmt::format("expected the header type UInt32 or UInt64, found {}", quoted(header)));
    storage_.header_bytes = header == "UInt64" ? 8 : 4;
    const std::string_view compressor = root.attribute("compressor").value();
    if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
      fail(root, fmt::format("the compressor {} is not supported; save with vtkZLibDataCompressor or none",
                             quoted(compressor)));
    storage_.compressed = !compressor.empty();
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
    const auto begin = text_.begin(), at = begin + static_cast<std::ptrdiff_t>(text_offset(array));
    TextScanner scan(path_, text, 0, static_cast<std::size_t>(std::count(begin, at, '\n')) + 1);
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
  std::vector<T> stored_values(const pugi::xml_node& array, VtkType type, std::string_view format) const {
    std::size_t first_byte = 0;
    const std::string bytes = format == "binary"     ? inline_bytes(array, first_byte)
                              : format == "appended" ? appended_bytes(array, first_byte)
                                                     : unknown_format(array, format);
    if (bytes.size() % vtk_size(type) != 0)
      fail_byte(first_byte, array, fmt::format("{} bytes are no whole number of values", bytes.size()));
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
                              quoted(array.attribute("offset").value()), appended_.size()));
    first_byte = appended_begin_ + offset;
    return decode(array, appended_.substr(offset), appended_is_base64_, first_byte);
  }

  std::string decode(const pugi::xml_node& array, std::string_view stored, bool base64,
                     std::size_t first_byte) const {
    try {
      return decode_vtk_array(stored, base64, storage_);
    } catch (const VtkArrayError& error) {
      fail_byte(first_byte, array, error.message);
    }
  }

  [[noreturn]] std::string unknown_format(const pugi::xml_node& array, std::string_view format) const {
    fail(array, fmt::format("expected the format ascii, binary or appended, found {}", quoted(format)));
  }

  [[noreturn]] void fail_byte(std::size_t byte, const pugi::xml_node& array,
                              const std::string& message) const {
    throw ReadError(fmt::format("{}: byte {}: values of {}: {}", path_, byte, name(array), message));
  }

  const std::string& path_;
  std::string text_;
  pugi::xml_document document_;
  VtkStorage storage_;
  std::size_t appended_begin_ = 0;
  bool appended_is_base64_ = false;
  std::string_view appended_;
};

pugi::xml_node find_array(const pugi::xml_node& section, const char* name) {
  return section.find_child_by_attribute("DataArray", "Name", name);
}

/// The cells of one piece by kind, as positions in its arrays.
struct CellKinds {
  std::vector<std::size_t> tets, faces, edges;
};

class PieceReader {
 public:
  PieceReader(const VtuFile& file, const pugi::xml_node& piece, TetMesh& mesh)
      : file_(file),
        piece_(piece),
        mesh_(mesh),
        first_point_(static_cast<Index>(mesh.points.size())),
        point_count_(file.number(piece, "NumberOfPoints")),
        cell_count_(file.number(piece, "NumberOfCells")) {}

  void read() {
    if (point_count_ + first_point_ >= none) file_.fail(piece_, "more points than can be numbered");
    read_points();
    read_cells();
    read_labels();
    read_features();
  }

 private:
  void read_points() {
    const pugi::xml_node array = piece_.child("Points").child("DataArray");
    if (!array) file_.fail(piece_, "expected Points");
    if (point_count_ > 0 && array.attribute("NumberOfComponents").as_int(3) != 3)
      file_.fail(array, "expected points of 3 components");
    const std::vector<double> values = file_.values<double>(array, 3 * point_count_);
    for (std::size_t i = 0; i < point_count_; ++i) {
      const Point p{values[3 * i], values[3 * i + 1], values[3 * i + 2]};
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        file_.fail(array, fmt::format("point {}, ({}, {}, {}), is not finite", i, p.x, p.y, p.z));
      mesh_.points.push_back(p);
    }
  }

  pugi::xml_node required(const pugi::xml_node& section, const char* name) const {
    const pugi::xml_node array = find_array(section, name);
    if (!array) file_.fail(section ? section : piece_, fmt::format("expected an array '{}'", name));
    return array;
  }

  void read_cells() {
    const pugi::xml_node section = piece_.child("Cells");
    const std::vector<std::int64_t> types =
                                        file_.values<std::int64_t>(required(section, "types"), cell_count_),
                                    ends =
                                        file_.values<std::int64_t>(required(section, "offsets"), cell_count_);
    const pugi::xml_node array = required(section, "connectivity");
    const std::vector<std::int64_t> corners = file_.values<std::int64_t>(array);
    std::int64_t begin = 0;
    for (std::size_t i = 0; i < cell_count_; ++i) {
      const std::size_t n = corners_of_type(section, i, types[i]);
      if (ends[i] - begin != static_cast<std::int64_t>(n) ||
          ends[i] > static_cast<std::int64_t>(corners.size()))
        file_.fail(section, fmt::format("cell {} of type {} ends at {} of {} corners, but begins at {}", i,
                                        types[i], ends[i], corners.size(), begin));
      add_cell(array, i, {corners.data() + begin, n});
      begin = ends[i];
    }
    if (begin != static_cast<std::int64_t>(corners.size()))
      file_.fail(array, fmt::format("expected {} corners, found {}", begin, corners.size()));
  }

  std::size_t corners_of_type(const pugi::xml_node& section, std::size_t cell, std::int64_t type) const {
    switch (type) {
      case vtk_vertex: return 1;
      case vtk_line: return 2;
      case vtk_triangle: return 3;
      case vtk_tet: return 4;
      default:
        file_.fail(section,
                   fmt::format("cell {} has the type {}, which is not supported, only first-order tetrahedra "
                               "(10), triangles (5) and lines (3)",
                               cell, type));
    }
  }

  void add_cell(const pugi::xml_node& array, std::size_t cell, std::span<const std::int64_t> corners) {
    std::array<Index, 4> c{};
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (corners[k] < 0 || corners[k] >= static_cast<std::int64_t>(point_count_))
        file_.fail(array, fmt::format("cell {} has the corner {}, but there are {} points", cell, corners[k],
                                      point_count_));
      c[k] = first_point_ + static_cast<Index>(corners[k]);
    }
    if (corners.size() == 4) {
      mesh_.tets.push_back(c);
      kinds_.tets.push_back(cell);
    } else if (corners.size() == 3) {
      mesh_.faces.push_back({c[0], c[1], c[2]});
      kinds_.faces.push_back(cell);
    } else if (corners.size() == 2) {
      mesh_.edges.push_back({c[0], c[1]});
      kinds_.edges.push_back(cell);
    }
  }

  /// A cell array by the first of these names that is there; empty if none is.
  std::vector<std::int64_t> cell_values(std::initializer_list<const char*> names) const {
    for (const char* name : names)
      if (const pugi::xml_node array = find_array(piece_.child("CellData"), name))
        return file_.values<std::int64_t>(array, cell_count_);
    return {};
  }

  template <class T>
  static void pick(const std::vector<std::int64_t>& values, const std::vector<std::size_t>& cells,
                   std::vector<T>& to) {
    if (!values.empty())
      for (const std::size_t cell : cells) to.push_back(static_cast<T>(values[cell]));
  }

  /// Ours, or the names that meshio gives to the labels of other formats.
  void read_labels() {
    const auto tags = cell_values({"tag", "gmsh:physical", "medit:ref", "region"});
    pick(tags, kinds_.tets, mesh_.tet_tag);
    pick(tags, kinds_.faces, mesh_.face_tag);
    pick(tags, kinds_.edges, mesh_.edge_tag);
    const auto regions = cell_values({"region"});
    if (std::all_of(regions.begin(), regions.end(), [](std::int64_t r) { return r >= 0 && r < none; }))
      pick(regions, kinds_.tets, mesh_.tet_region);
    pick(cell_values({"collar"}), kinds_.tets, mesh_.tet_collar);
    const auto features = cell_values({"feature"});
    pick(features, kinds_.faces, mesh_.face_patch);
    pick(features, kinds_.edges, mesh_.edge_curve);
    const auto back = cell_values({"region_back"}), front = cell_values({"region_front"});
    if (!back.empty() && !front.empty())
      for (const std::size_t cell : kinds_.faces)
        mesh_.face_regions.push_back({static_cast<Index>(back[cell]), static_cast<Index>(front[cell])});
  }

  void read_features() {
    const pugi::xml_node section = piece_.child("PointData");
    const pugi::xml_node dimension = find_array(section, "feature_dimension"),
                         feature = find_array(section, "feature");
    if (!dimension || !feature) return;
    const auto dimensions = file_.values<std::int64_t>(dimension, point_count_),
               features = file_.values<std::int64_t>(feature, point_count_);
    for (std::size_t i = 0; i < point_count_; ++i) {
      if (dimensions[i] < 0 || dimensions[i] > 3)
        file_.fail(dimension, fmt::format("point {} has the feature dimension {}", i, dimensions[i]));
      mesh_.features.push_back({static_cast<std::uint8_t>(dimensions[i]), static_cast<Index>(features[i])});
    }
  }

  const VtuFile& file_;
  const pugi::xml_node piece_;
  TetMesh& mesh_;
  Index first_point_;
  std::size_t point_count_, cell_count_;
  CellKinds kinds_;
};

/// Arrays that only some pieces have are of no use.
template <class T>
void drop_partial(std::vector<T>& values, std::size_t count) {
  if (values.size() != count) values.clear();
}

}  // namespace

TetMesh read_vtu(const std::string& path) {
  const VtuFile file(path);
  TetMesh mesh;
  for (const pugi::xml_node& piece : file.grid().children("Piece")) PieceReader(file, piece, mesh).read();
  if (mesh.tets.empty()) file.fail(file.grid(), "expected tetrahedra, found none");
  drop_partial(mesh.features, mesh.points.size());
  drop_partial(mesh.tet_tag, mesh.tets.size());
  drop_partial(mesh.tet_region, mesh.tets.size());
  drop_partial(mesh.tet_collar, mesh.tets.size());
  drop_partial(mesh.face_tag, mesh.faces.size());
  drop_partial(mesh.face_patch, mesh.faces.size());
  drop_partial(mesh.face_regions, mesh.faces.size());
  drop_partial(mesh.edge_tag, mesh.edges.size());
  drop_partial(mesh.edge_curve, mesh.edges.size());
  complete_mesh(mesh);
  return mesh;
}

}  // namespace collarmesh::io
