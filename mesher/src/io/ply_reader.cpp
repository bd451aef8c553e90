// Our own reader, because CGAL 5.5.1's read_PLY accepts corners out of range, and rounds the numbers of a
// text file to 32 bits if its header says float.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <string_view>
#include <vector>

#include "io/byte_reader.h"
#include "io/file_bytes.h"
#include "io/number_bytes.h"
#include "io/soup_formats.h"
#include "io/text_scanner.h"

namespace collarmesh::io {

namespace {

using Type = NumberType;
constexpr std::pair<std::string_view, Type> type_names[] = {
    {"char", Type::i8},   {"uchar", Type::u8},   {"short", Type::i16},   {"ushort", Type::u16},
    {"int", Type::i32},   {"uint", Type::u32},   {"float", Type::f32},   {"double", Type::f64},
    {"int8", Type::i8},   {"uint8", Type::u8},   {"int16", Type::i16},   {"uint16", Type::u16},
    {"int32", Type::i32}, {"uint32", Type::u32}, {"float32", Type::f32}, {"float64", Type::f64}};

struct Property {
  std::string_view name;
  Type type = Type::unknown;
  Type list_size = Type::unknown;  ///< unknown: not a list
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  std::size_t line = 0;
  std::vector<Property> properties;
};

enum class Encoding { text, little, big };

struct Header {
  Encoding encoding = Encoding::text;
  std::vector<PlyElement> elements;
};

Type read_type(TextScanner& scan) {
  const std::string_view name = scan.word("a type");
  for (const auto& [known, type] : type_names)
    if (known == name) return type;
  scan.fail("a type such as float or uchar", name);
}

Encoding read_encoding(TextScanner& scan) {
  const std::string_view name = scan.word("a format");
  if (name == "ascii") return Encoding::text;
  if (name == "binary_little_endian") return Encoding::little;
  if (name == "binary_big_endian") return Encoding::big;
  scan.fail("ascii, binary_little_endian or binary_big_endian", name);
}

PlyElement read_element(TextScanner& scan) {
  PlyElement element;
  element.name = scan.word("the name of an element");
  element.line = scan.line();
  const std::int64_t count = scan.integer("the number of elements");
  if (count < 0 || count >= none)
    scan.fail(fmt::format("the number of elements is {}, but must be from 0 to {}", count, none - 1));
  element.count = static_cast<std::uint64_t>(count);
  return element;
}

Property read_property(TextScanner& scan) {
  Property property;
  if (scan.peek() == "list") {
    scan.word("list");
    property.list_size = read_type(scan);
    if (property.list_size == Type::f32 || property.list_size == Type::f64)
      scan.fail("the length of a list has to have an integer type");
  }
  property.type = read_type(scan);
  property.name = scan.word("the name of a property");
  return property;
}

Header read_header(TextScanner& scan) {
  Header header;
  if (const std::string_view magic = scan.word("ply"); magic != "ply") scan.fail("ply", magic);
  for (;;) {
    scan.skip_line();
    const std::string_view keyword = scan.word("end_header");
    if (keyword == "end_header") break;
    if (keyword == "format")
      header.encoding = read_encoding(scan);
    else if (keyword == "element")
      header.elements.push_back(read_element(scan));
    else if (keyword == "property" && !header.elements.empty())
      header.elements.back().properties.push_back(read_property(scan));
    else if (keyword != "comment" && keyword != "obj_info")
      scan.fail("element, property or end_header", keyword);
  }
  scan.skip_line();
  return header;
}

/// The values of a text file; `BinaryValues` has the same functions for a binary one.
struct TextValues {
  TextScanner& scan;
  double number(Type, std::string_view what) { return scan.number(what); }
  std::int64_t integer(Type, std::string_view what) { return scan.integer(what); }
  std::size_t left() const { return scan.left() + 1; }
  static std::size_t least_bytes(Type) { return 2; }
  void fail_at(const std::string& message) { scan.fail(message); }
  bool at_end() { return scan.at_end(); }
};

struct BinaryValues {
  ByteReader& bytes;
  double number(Type type, std::string_view what) {
    switch (type) {
      case Type::f32: return double{bytes.get<float>(what)};
      case Type::f64: return bytes.get<double>(what);
      default: return static_cast<double>(integer(type, what));
    }
  }
  std::int64_t integer(Type type, std::string_view what) {
    switch (type) {
      case Type::i8: return bytes.get<std::int8_t>(what);
      case Type::u8: return bytes.get<std::uint8_t>(what);
      case Type::i16: return bytes.get<std::int16_t>(what);
      case Type::u16: return bytes.get<std::uint16_t>(what);
      case Type::i32: return bytes.get<std::int32_t>(what);
      case Type::u32: return bytes.get<std::uint32_t>(what);
      default: bytes.fail(fmt::format("{} has to have an integer type", what));
    }
  }
  std::size_t left() const { return bytes.left(); }
  static std::size_t least_bytes(Type type) { return size_of(type); }
  void fail_at(const std::string& message) { bytes.fail(message); }
  bool at_end() { return bytes.rest().find_first_not_of(" \t\r\n") == std::string_view::npos; }
};

template <class Values>
class Body {
 public:
  Body(Values values, PolygonSoup& soup) : values_(values), soup_(soup) {}

  void read(const Header& header) {
    for (const PlyElement& element : header.elements) read(element);
    if (!values_.at_end()) values_.fail_at("expected the end of the file after the last element, found more");
    require_known_corners();
  }

 private:
  void read(const PlyElement& element) {
    if (element.properties.empty()) return;
    require_room(element);
    if (element.name == "vertex") {
      read_vertices(element);
    } else if (element.name == "face") {
      const std::size_t corners = column(element, "vertex_indices", "vertex_index"),
                        tag = tag_column(element);
      for (std::uint64_t i = 0; i < element.count; ++i) read_face(element, corners, tag);
    } else if (element.name == "edge") {
      const std::size_t a = column(element, "vertex1"), b = column(element, "vertex2");
      for (std::uint64_t i = 0; i < element.count; ++i) read_edge(element, a, b);
    } else if (element.name == "tristrips" && element.count > 0) {
      values_.fail_at("triangle strips are not supported; save the file with faces");
    } else {
      for (std::uint64_t i = 0; i < element.count; ++i)
        for (const Property& property : element.properties) skip(property);
    }
  }

  void require_room(const PlyElement& element) {
    std::size_t least = 0;
    for (const Property& p : element.properties)
      least += Values::least_bytes(p.list_size == Type::unknown ? p.type : p.list_size);
    if (element.count > values_.left() / least)
      values_.fail_at(fmt::format(
          "expected {} elements '{}' of at least {} bytes, found {} bytes; the file is cut off or "
          "its header is wrong",
          element.count, element.name, least, values_.left()));
  }

  std::size_t column(const PlyElement& element, std::string_view name, std::string_view other = {}) {
    for (std::size_t k = 0; k < element.properties.size(); ++k)
      if (element.properties[k].name == name || (!other.empty() && element.properties[k].name == other))
        return k;
    values_.fail_at(fmt::format("the elements '{}' have no property '{}'", element.name, name));
    return 0;
  }

  /// Returns the column of our tags; past the last column if there is none.
  static std::size_t tag_column(const PlyElement& element) {
    const auto found =
        std::find_if(element.properties.begin(), element.properties.end(), [](const Property& p) {
          return p.name == "tag" && p.type == Type::i32 && p.list_size == Type::unknown;
        });
    return static_cast<std::size_t>(found - element.properties.begin());
  }

  void read_vertices(const PlyElement& element) {
    const std::array<std::size_t, 3> columns{column(element, "x"), column(element, "y"),
                                             column(element, "z")};
    for (const std::size_t k : columns)
      if (element.properties[k].list_size != Type::unknown) values_.fail_at("a coordinate cannot be a list");
    soup_.points.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      Point p;
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const auto axis = std::find(columns.begin(), columns.end(), k);
        if (axis == columns.end())
          skip(element.properties[k]);
        else
          p[static_cast<std::size_t>(axis - columns.begin())] = coordinate(element.properties[k].type);
      }
      soup_.points.push_back(p);
    }
    points_known_ = true;
  }

  double coordinate(Type type) {
    const double value = values_.number(type, "a coordinate of a vertex");
    if (!std::isfinite(value)) values_.fail_at(fmt::format("expected a finite coordinate, found {}", value));
    return value;
  }

  void read_face(const PlyElement& element, std::size_t corners_column, std::size_t tag_column) {
    Tag tag = 0;
    for (std::size_t k = 0; k < element.properties.size(); ++k)
      if (k == corners_column)
        read_corners(element.properties[k]);
      else if (k == tag_column)
        tag = values_.integer(Type::i32, "a tag");
      else
        skip(element.properties[k]);
    if (corners_.size() < 2)
      values_.fail_at(fmt::format("expected a face of at least 2 corners, found {}", corners_.size()));
    if (corners_.size() == 2)
      soup_.segments.push_back({corners_[0], corners_[1]});
    else
      soup_.add_facet(corners_, tag);
  }

  void read_edge(const PlyElement& element, std::size_t a, std::size_t b) {
    PolygonSoup::Segment segment;
    for (std::size_t k = 0; k < element.properties.size(); ++k)
      if (k == a)
        segment.a = corner(element.properties[k].type);
      else if (k == b)
        segment.b = corner(element.properties[k].type);
      else
        skip(element.properties[k]);
    soup_.segments.push_back(segment);
  }

  void read_corners(const Property& property) {
    corners_.clear();
    if (property.list_size == Type::unknown) values_.fail_at("the corners of a face have to be a list");
    const std::size_t n = list_length(property);
    for (std::size_t i = 0; i < n; ++i) corners_.push_back(corner(property.type));
  }

  Index corner(Type type) {
    const std::int64_t value = values_.integer(type, "the index of a vertex");
    if (value < 0 || value >= none ||
        (points_known_ && value >= static_cast<std::int64_t>(soup_.points.size())))
      values_.fail_at(
          fmt::format("a corner is vertex {}, but the file has {} vertices", value, soup_.points.size()));
    largest_corner_ = std::max(largest_corner_, value);
    return static_cast<Index>(value);
  }

  std::size_t list_length(const Property& property) {
    const std::int64_t n = values_.integer(property.list_size, "the length of a list");
    if (n < 0 || static_cast<std::uint64_t>(n) > values_.left() / Values::least_bytes(property.type))
      values_.fail_at(
          fmt::format("a list of {} values does not fit into the {} bytes that follow", n, values_.left()));
    return static_cast<std::size_t>(n);
  }

  void skip(const Property& property) {
    const std::size_t n = property.list_size == Type::unknown ? 1 : list_length(property);
    for (std::size_t i = 0; i < n; ++i) values_.number(property.type, property.name);
  }

  /// Checks corners at the end, because faces may come before their vertices.
  void require_known_corners() {
    if (largest_corner_ >= static_cast<std::int64_t>(soup_.points.size()))
      values_.fail_at(fmt::format("a corner is vertex {}, but the file has {} vertices", largest_corner_,
                                  soup_.points.size()));
  }

  Values values_;
  PolygonSoup& soup_;
  std::vector<Index> corners_;
  std::int64_t largest_corner_ = -1;
  bool points_known_ = false;
};

}  // namespace

PolygonSoup read_ply(const std::string& path) {
  const std::string bytes = read_bytes(path);
  TextScanner scan(path, bytes, 0);
  const Header header = read_header(scan);
  PolygonSoup soup;
  if (header.encoding == Encoding::text) {
    Body(TextValues{scan}, soup).read(header);
  } else {
    const std::endian order = header.encoding == Encoding::big ? std::endian::big : std::endian::little;
    ByteReader reader(path, std::string_view(bytes).substr(scan.offset()), order, scan.offset());
    Body(BinaryValues{reader}, soup).read(header);
  }
  return soup;
}

}  // namespace collarmesh::io
