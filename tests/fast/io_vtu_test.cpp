// .vtu: what is written is read back, and all ways in which other programs store arrays are understood.
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "collarmesh/io/mesh_surface_io.h"
#include "collarmesh/io/point_field_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "io/base64.h"
#include "io/number_bytes.h"
#include "io/vtk_array.h"
#include "support/comma_locale.h"
#include "support/replaced.h"
#include "support/sample_mesh.h"
#include "support/temporary_file.h"
#include "support/tet_mesh_comparison.h"

namespace collarmesh::io_vtu_test {
namespace {

using testing::CommaLocale;
using testing::expect_error;
using testing::expect_same;
using testing::replaced;
using testing::sample_mesh;
using testing::TemporaryFolder;

TetMesh read(const std::string& content) {
  const TemporaryFolder folder;
  return io::read_tet_mesh(folder.write("a.vtu", content));
}

void expect_refused(const std::string& content, const std::string& part) {
  SCOPED_TRACE(content.substr(0, 2000));
  const TemporaryFolder folder;
  const std::string path = folder.write("a.vtu", content);
  expect_error<ReadError>([&] { io::read_tet_mesh(path); }, path, part);
}

TEST(IoVtu, RoundTrip) {
  const TemporaryFolder folder;
  const TetMesh mesh = sample_mesh(3);
  const CommaLocale locale;
  io::write_tet_mesh(folder.file("a.vtu"), mesh);
  expect_same(io::read_tet_mesh(folder.file("a.vtu")), mesh);
}

TEST(IoVtu, RoundTripOfManyBlocksAndWithoutFeatures) {
  const TemporaryFolder folder;
  TetMesh mesh = sample_mesh(16);
  mesh.features.clear();
  io::write_tet_mesh(folder.file("a.vtu"), mesh);
  expect_same(io::read_tet_mesh(folder.file("a.vtu")), mesh);
}

/// A way to store arrays, for writing the same grid in every possible way.
struct Storage {
  std::string format = "ascii";  ///< or binary, or appended
  bool base64 = true, compressed = false, wide_headers = false, header_apart = false, big_endian = false;
};

class ForeignFile {
 public:
  explicit ForeignFile(Storage storage) : storage_(std::move(storage)) {}

  std::string text() {
    const std::string head =
        std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"") +
        (storage_.big_endian ? " byte_order=\"BigEndian\"" : " byte_order=\"LittleEndian\"") +
        (storage_.wide_headers ? " header_type=\"UInt64\"" : "") +
        (storage_.compressed ? " compressor=\"vtkZLibDataCompressor\"" : "") +
        ">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"5\" NumberOfCells=\"6\">\n";
    const std::string points =
        array<double>("Points", "Float64", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0.1}, 3);
    const std::string cells =
        array<std::int64_t>("connectivity", "Int64", {0, 1, 2, 3, 1, 2, 3, 4, 1, 2, 3, 0, 1, 2, 0, 1, 0}) +
        array<std::int32_t>("offsets", "Int32", {4, 8, 11, 14, 16, 17}) +
        array<std::uint8_t>("types", "UInt8", {10, 10, 5, 5, 3, 1});
    const std::string data = array<std::int32_t>("gmsh:physical", "Int32", {9, 4, 70, 80, 5, 0}) +
                             array<float>("unused", "Float32", {1, 2, 3, 4, 5, 6});
    return head + "<Points>\n" + points + "</Points>\n<Cells>\n" + cells + "</Cells>\n<CellData>\n" + data +
           "</CellData>\n</Piece>\n</UnstructuredGrid>\n" + tail();
  }

 private:
  template <class T>
  std::string array(const std::string& name, const std::string& type, const std::vector<T>& values,
                    int components = 1) {
    std::string tag =
        "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"" + storage_.format + "\"";
    if (components > 1) tag += " NumberOfComponents=\"" + std::to_string(components) + "\"";
    if (storage_.format == "appended") {
      tag += " offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
      appended_ += encoded(bytes_of(values));
      return tag;
    }
    std::string content;
    if (storage_.format == "binary")
      content = encoded(bytes_of(values));
    else
      for (const T value : values) content += std::to_string(value) + ' ';
    return tag + ">\n  " + content + "\n</DataArray>\n";
  }

  template <class T>
  std::string bytes_of(const std::vector<T>& values) const {
    std::string bytes;
    for (const T value : values) {
      auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
      if (storage_.big_endian) std::reverse(raw.begin(), raw.end());
      bytes.append(raw.data(), raw.size());
    }
    return bytes;
  }

  std::string header(const std::vector<std::uint64_t>& numbers) const {
    return storage_.wide_headers ? bytes_of(numbers)
                                 : bytes_of(std::vector<std::uint32_t>(numbers.begin(), numbers.end()));
  }

  std::string as_text(const std::string& bytes) const {
    return storage_.base64 ? io::base64_encode(bytes) : bytes;
  }

  std::string encoded(const std::string& bytes) const {
    if (!storage_.compressed) {
      const std::string size = header({bytes.size()});
      return storage_.header_apart ? as_text(size) + as_text(bytes) : as_text(size + bytes);
    }
    constexpr std::size_t block = 16;
    std::vector<std::uint64_t> numbers{(bytes.size() + block - 1) / block, block, bytes.size() % block};
    std::string packed;
    for (std::size_t at = 0; at < bytes.size(); at += block) {
      const std::string part = bytes.substr(at, block);
      std::array<Bytef, 100> buffer;
      uLongf size = buffer.size();
      compress(buffer.data(), &size, reinterpret_cast<const Bytef*>(part.data()), part.size());
      packed.append(reinterpret_cast<const char*>(buffer.data()), size);
      numbers.push_back(size);
    }
    return as_text(header(numbers)) + as_text(packed);
  }

  std::string tail() const {
    if (storage_.format != "appended") return "</VTKFile>\n";
    return std::string("<AppendedData encoding=\"") + (storage_.base64 ? "base64" : "raw") + "\">\n  _" +
           appended_ + "\n</AppendedData>\n</VTKFile>\n";
  }

  Storage storage_;
  std::string appended_;
};

/// Expects two tets, the second one inverted in the file, and the triangles between and on them.
void expect_two_tets(const TetMesh& mesh) {
  ASSERT_EQ(mesh.points.size(), 5);
  EXPECT_EQ(mesh.points[4], (Point{1, 1, 0.1}));
  ASSERT_EQ(mesh.tets.size(), 2);
  for (const auto& [a, b, c, d] : mesh.tets)
    EXPECT_GT(six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]), 0);
  EXPECT_EQ(mesh.tet_tag, (std::vector<Tag>{9, 4}));
  EXPECT_EQ(mesh.tet_region, (std::vector<Index>{2, 1}));
  EXPECT_EQ(mesh.tet_collar, (std::vector<std::uint8_t>{0, 0}));
  EXPECT_EQ(mesh.face_tag, (std::vector<Tag>{70, 80}));
  EXPECT_EQ(mesh.face_regions, (std::vector<std::array<Index, 2>>{{2, 1}, {2, 0}}));
  EXPECT_EQ(mesh.faces[1], (std::array<Index, 3>{0, 2, 1}));
  EXPECT_EQ(mesh.edge_tag, (std::vector<Tag>{5}));
  EXPECT_TRUE(mesh.features.empty());
}

TEST(IoVtu, ReadsEveryStorage) {
  for (const char* format : {"ascii", "binary", "appended"})
    for (unsigned bits = 0; bits < 32; ++bits) {
      const auto bit = [bits](unsigned k) { return (bits >> k & 1) != 0; };
      const Storage storage{format, bit(0) || std::string(format) != "appended", bit(1), bit(2), bit(3),
                            bit(4)};
      SCOPED_TRACE(std::string(format) + " " + std::to_string(bits));
      expect_two_tets(read(ForeignFile(storage).text()));
    }
}

TEST(IoVtu, ReadsSeveralPieces) {
  std::string text = ForeignFile({}).text();
  const std::size_t begin = text.find("<Piece"), end = text.find("</UnstructuredGrid>");
  const TetMesh mesh = read(text.insert(end, text.substr(begin, end - begin)));
  EXPECT_EQ(mesh.points.size(), 10);
  ASSERT_EQ(mesh.tets.size(), 4);
  EXPECT_EQ(mesh.tets[2], (std::array<Index, 4>{5, 6, 7, 8}));
  EXPECT_EQ(mesh.tet_tag, (std::vector<Tag>{9, 4, 9, 4}));
}

TEST(IoVtu, RefusesBadXml) {
  const std::string text = ForeignFile({}).text();
  expect_refused("", "line 1: ");
  expect_refused("garbage", "line 1: ");
  expect_refused("<VTKFile", "line 1: the XML is malformed");
  expect_refused("<a/>", "line 1: expected a VTKFile");
  expect_refused(text.substr(0, text.size() / 2), "the XML is malformed");
  expect_refused(replaced(text, "UnstructuredGrid\"", "PolyData\""),
                 "line 2: expected the type UnstructuredGrid");
  expect_refused(replaced(text, "byte_order", "compressor=\"vtkLZMADataCompressor\" byte_order"),
                 "line 2: the compressor");
  expect_refused(replaced(text, "byte_order", "header_type=\"Int7\" byte_order"),
                 "line 2: expected the header type");
}

TEST(IoVtu, RefusesBadValues) {
  const std::string text = ForeignFile({}).text();
  expect_refused(replaced(text, "NumberOfPoints=\"5\"", "NumberOfPoints=\"2000000000\""),
                 "line 6: expected 6000000000 values");
  expect_refused(replaced(text, "NumberOfPoints=\"5\"", "NumberOfPoints=\"-5\""),
                 "line 4: expected NumberOfPoints");
  expect_refused(replaced(text, "NumberOfCells=\"6\"", "NumberOfCells=\"2000000000\""),
                 "expected 2000000000 values");
  expect_refused(replaced(text, "NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""), "line 6: ");
  expect_refused(replaced(text, "0.100000", "nan"), "line 6: point 4");
  expect_refused(replaced(text, "0.100000", "x"), "line 7: expected a value, found 'x'");
  expect_refused(replaced(text, "Float64", "Float63"), "line 6: unknown type of values");
  expect_refused(replaced(text, "\"ascii\"", "\"klingon\""), "line 6: expected the format");
  expect_refused(replaced(text, "0 1 2 3 1", "0 1 2 5 1"), "line 11: cell 0 has the corner 5");
  expect_refused(replaced(text, "0 1 2 3 1", "0 1 2 -1 1"), "line 11: cell 0 has the corner -1");
  expect_refused(replaced(text, "0 1 2 3 1", "1 2 3 1"),
                 "cell 5 of type 1 has 1 node, but its part of the connectivity goes from 16 to 17, of 16");
  expect_refused(replaced(text, "4 8 11", "5 8 11"),
                 "line 10: cell 0 of type 10 has 4 nodes, but its part of the connectivity goes from 0 to 5");
  expect_refused(replaced(text, "10 10 5", "10 12 5"), "cell 1 has the type 12");
  expect_refused(replaced(text, "9 4 70", "4 70"), "expected 6 values of 'gmsh:physical', found 5");
  expect_refused(replaced(text, "\"types\"", "\"kinds\""), "line 10: expected an array 'types'");
}

TEST(IoVtu, RefusesBadAppendedValues) {
  const std::string plain = ForeignFile({"appended", false, false, true}).text();
  const std::size_t first = plain.find('_', plain.find("<AppendedData")) + 1;
  const std::string byte = "byte " + std::to_string(first) + ": values of 'Points': ";
  const std::string huge(8, '\x7f');
  expect_refused(std::string(plain).replace(first, 8, huge), byte + "expected 9187201950435737471 bytes");
  expect_refused(replaced(plain, "offset=\"0\"", "offset=\"99999\""), "line 6: the offset '99999'");
  expect_refused(plain.substr(0, first + 30), byte);
  const std::string packed = ForeignFile({"appended", false, true, true}).text();
  const std::size_t start = packed.find('_', packed.find("<AppendedData")) + 1;
  for (const std::size_t field : {0, 1, 2, 3})
    expect_refused(std::string(packed).replace(start + 8 * field, 8, huge),
                   "byte " + std::to_string(start) + ": ");
  // A block of a few bytes that claims to be a gigabyte.
  const std::string gigabyte("\0\0\0\x40\0\0\0\0", 8);
  expect_refused(std::string(packed).replace(start + 8, 8, gigabyte), "cannot hold 1073741824");
  const std::string base64 = ForeignFile({"binary"}).text();
  expect_refused(replaced(base64, "eAAAAA", "e!AAAA"), "the values are not base64");
}

// Other kinds of contents

/// Adds arrays of points to the file, behind its cells' data.
std::string with_point_data(const std::string& text, const std::string& arrays) {
  return replaced(text, "</CellData>\n", "</CellData>\n<PointData>\n" + arrays + "</PointData>\n");
}

std::string field(const std::string& name, const std::string& values, const std::string& more = "") {
  return "<DataArray type=\"Float64\" Name=\"" + name + "\" format=\"ascii\"" + more + ">" + values +
         "</DataArray>\n";
}

TEST(IoVtu, HasFieldsOnPoints) {
  const TemporaryFolder folder;
  const auto read_field = [&](const std::string& text, const std::string& name = "") {
    return io::read_point_field(folder.write("a.vtu", text), name);
  };
  const std::string text = ForeignFile({}).text(), size = field("size", "1 2 3 4 5.5"),
                    vectors = field("v", "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15", " NumberOfComponents=\"3\""),
                    other = field("other", "9 8 7 6 5");
  const io::PointField only = read_field(with_point_data(text, size + vectors));
  EXPECT_EQ(only.name, "size");
  EXPECT_EQ(only.values, (std::vector<double>{1, 2, 3, 4, 5.5}));
  expect_two_tets(only.mesh);
  EXPECT_EQ(read_field(with_point_data(text, size + other), "other").values,
            (std::vector<double>{9, 8, 7, 6, 5}));
  const std::string path = folder.file("a.vtu");
  const auto refused = [&](const std::string& content, const std::string& name, const std::string& part) {
    expect_error<ReadError>([&] { read_field(content, name); }, path, part);
  };
  refused(with_point_data(text, size + other), "", "expected one scalar field on points; its points have");
  refused(with_point_data(text, size + other), "third", "no field 'third'");
  refused(text, "", "its points have no scalar field");
  refused(with_point_data(text, field("size", "1 2 3")), "", "expected 5 values");
  // Each piece has to have the field.
  const std::string with = with_point_data(text, size);
  const std::size_t begin = text.find("<Piece"), end = text.find("</UnstructuredGrid>");
  const std::string without = text.substr(begin, end - begin);
  const std::size_t behind = with.find("</UnstructuredGrid>");
  refused(std::string(with).insert(behind, without), "", "expected an array 'size' as in the first piece");
  const io::PointField two = read_field(
      std::string(with).insert(behind, with.substr(with.find("<Piece"), behind - with.find("<Piece"))));
  EXPECT_EQ(two.values, (std::vector<double>{1, 2, 3, 4, 5.5, 1, 2, 3, 4, 5.5}));
  EXPECT_EQ(two.mesh.points.size(), 10U);
}

TEST(IoVtu, OurOwnLabelsAreNoFields) {
  const TemporaryFolder folder;
  io::write_tet_mesh(folder.file("a.vtu"), sample_mesh(1));
  expect_error<ReadError>([&] { io::read_point_field(folder.file("a.vtu")); }, folder.file("a.vtu"),
                          "its points have no scalar field");
}

const std::string polygons =
    "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData><Piece NumberOfPoints=\"4\" "
    "NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"2\"><Points><DataArray "
    "type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 1 1 0 0 1 0</DataArray></Points>"
    "<Polys><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 0 2 "
    "3</DataArray><DataArray "
    "type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 6</DataArray></Polys><CellData><DataArray "
    "type=\"Int32\" Name=\"gmsh:physical\" format=\"ascii\">8 5</DataArray></CellData></Piece></PolyData>"
    "</VTKFile>";

TEST(IoVtp, TrianglesHaveTheirTags) {
  const TemporaryFolder folder;
  const PolygonSoup soup = io::read_mesh_surface(folder.write("a.vtp", polygons));
  ASSERT_EQ(soup.facet_count(), 2U);
  EXPECT_EQ(soup.facet_tag(0), 8);
  EXPECT_EQ(soup.facet_tag(1), 5);
  double area = 0;
  for (Index f = 0; f < 2; ++f) {
    const auto corners = soup.polygon(f);
    ASSERT_EQ(corners.size(), 3U);
    const Point &a = soup.points[corners[0]], &b = soup.points[corners[1]], &c = soup.points[corners[2]];
    area += 0.5 * cross(b - a, c - a).z;
  }
  EXPECT_EQ(area, 1);
  EXPECT_TRUE(io::is_mesh_surface_format("a.vtp"));
  EXPECT_FALSE(io::is_mesh_surface_format("a.stl"));
}

TEST(IoVtp, OtherCellsAreRefused) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& content, const std::string& part) {
    const std::string path = folder.write("a.vtp", content);
    expect_error<ReadError>([&] { io::read_mesh_cells(path); }, path, part);
  };
  for (const char* kind : {"NumberOfVerts", "NumberOfLines", "NumberOfStrips"})
    refused(replaced(polygons, std::string(kind) + "=\"0\"", std::string(kind) + "=\"1\""),
            std::string(kind) + " is not 0; save the triangles alone");
  refused(replaced(polygons, "3 6<", "4 6<"), "cell 0 of type 5 has 3 nodes");
  refused(replaced(polygons, "type=\"PolyData\"", "type=\"UnstructuredGrid\""), "expected the type PolyData");
  refused(replaced(polygons, "0 1 2 0 2 3", "0 1 2 0 2 4"), "cell 1 has the corner 4");
}

// .pvtu

/// A piece as text. Cells are tets; a cell that is a ghost belongs to another piece.
struct AsciiPiece {
  std::string points, point_ids, connectivity, offsets, cell_ids, ghosts;
  std::size_t point_count = 4, cell_count = 1;

  std::string text(const std::string& name_of_ids = "GlobalPointIds") const {
    const auto array = [](const std::string& type, const std::string& name, const std::string& values,
                          const std::string& more = "") {
      return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" format=\"ascii\"" + more + ">" + values +
             "</DataArray>\n";
    };
    std::string types;
    for (std::size_t i = 0; i < cell_count; ++i) types += "10 ";
    return "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece "
           "NumberOfPoints=\"" +
           std::to_string(point_count) + "\" NumberOfCells=\"" + std::to_string(cell_count) + "\"><Points>" +
           array("Float64", "Points", points, " NumberOfComponents=\"3\"") + "</Points><Cells>" +
           array("Int64", "connectivity", connectivity) + array("Int64", "offsets", offsets) +
           array("UInt8", "types", types) + "</Cells><PointData>" + array("Int64", name_of_ids, point_ids) +
           "</PointData><CellData>" + array("Int64", "GlobalCellIds", cell_ids) +
           array("UInt8", "vtkGhostType", ghosts) + "</CellData></Piece></UnstructuredGrid></VTKFile>\n";
  }
};

// The second piece has the first one's tet as a ghost.
const AsciiPiece first_piece{"0 0 0 1 0 0 0 1 0 0 0 1", "0 1 2 3", "0 1 2 3", "4", "0", "0"},
    second_piece{"1 0 0 0 1 0 0 0 1 1 1 1 0 0 0", "1 2 3 4 0", "0 1 2 3 4 0 1 2", "4 8", "1 0", "0 1", 5, 2};

const std::string list_of_pieces =
    "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"1.vtu\"/><Piece "
    "Source=\"2.vtu\"/></PUnstructuredGrid></VTKFile>\n";

TEST(IoPvtu, PiecesArePutTogetherByTheNumbersOfPointsAndCells) {
  const TemporaryFolder folder;
  folder.write("1.vtu", first_piece.text());
  folder.write("2.vtu", second_piece.text());
  const TetMesh mesh = io::read_tet_mesh(folder.write("a.pvtu", list_of_pieces));
  EXPECT_EQ(mesh.points, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}));
  EXPECT_EQ(mesh.tets, (std::vector<std::array<Index, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
}

TEST(IoPvtu, PiecesThatDoNotFitAreRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.pvtu", list_of_pieces);
  const auto refused = [&](const std::string& first, const std::string& second, const std::string& file,
                           const std::string& part) {
    folder.write("1.vtu", first);
    folder.write("2.vtu", second);
    expect_error<ReadError>([&] { io::read_tet_mesh(path); }, folder.file(file), part);
  };
  const std::string first = first_piece.text(), second = second_piece.text();
  refused(first, second_piece.text("Ids"), "2.vtu",
          "expected an array 'GlobalPointIds', by which the pieces");
  AsciiPiece changed = second_piece;
  changed.points = "1 0 0 0 1 0 0 0 2 1 1 1 0 0 0";
  refused(first, changed.text(), "2.vtu", "point 3 is at (0, 0, 2), but in another piece at (0, 0, 1)");
  changed = second_piece;
  changed.ghosts = "0 0";
  refused(first, changed.text(), "2.vtu", "cell 0 occurs twice, and neither copy is marked as a ghost");
  changed = second_piece;
  changed.offsets = "9 8";
  refused(first, changed.text(), "2.vtu", "the connectivity of cell 0 goes from 0 to 9, of 8 entries");
  changed = second_piece;
  changed.connectivity = "0 1 2 7 4 0 1 2";
  refused(first, changed.text(), "2.vtu", "cell 0 has the corner 7, but there are 5 points");
  changed = second_piece;
  changed.connectivity = "0 1 2";
  changed.offsets = "3 3";
  refused(first, changed.text(), "a.pvtu", "has 4 nodes");
}

// Values

template <class T>
void expect_converted(io::NumberType type) {
  EXPECT_EQ(io::size_of(type), sizeof(T));
  const std::vector<T> values{0, 1, std::numeric_limits<T>::lowest(), static_cast<T>(100)};
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    std::string bytes;
    for (const T value : values) {
      const auto raw = io::bytes_of(value, order);
      bytes.append(raw.data(), raw.size());
    }
    std::vector<double> doubles;
    std::vector<std::int64_t> integers;
    for (const T value : values) {
      doubles.push_back(static_cast<double>(value));
      integers.push_back(static_cast<std::int64_t>(value));
    }
    EXPECT_EQ(io::convert_vtk_values<double>(bytes, type, order), doubles);
    EXPECT_EQ(io::convert_vtk_values<std::int64_t>(bytes, type, order), integers);
  }
}

TEST(VtkValues, OfAllIntegerTypesAreConverted) {
  using Type = io::NumberType;
  expect_converted<std::int8_t>(Type::i8);
  expect_converted<std::uint8_t>(Type::u8);
  expect_converted<std::int16_t>(Type::i16);
  expect_converted<std::uint16_t>(Type::u16);
  expect_converted<std::int32_t>(Type::i32);
  expect_converted<std::uint32_t>(Type::u32);
  expect_converted<std::int64_t>(Type::i64);
  expect_converted<std::uint64_t>(Type::u64);
  EXPECT_TRUE(io::convert_vtk_values<double>("12345678", Type::unknown, std::endian::little).empty());
}

/// A base64 run with padding one character too early is one byte too short.
TEST(IoVtu, RefusesHeaderThatIsPaddedEarly) {
  std::string text = ForeignFile({"binary", true, true}).text();
  constexpr std::size_t header_bytes = 44;  // 8 blocks
  const std::size_t begin = text.find_first_not_of(" \n", text.find(">", text.find("Name=\"Points\"")) + 1),
                    padding = begin + io::base64_size(header_bytes) - 1;
  ASSERT_EQ(text[padding], '=');
  text[padding - 1] = '=';
  expect_refused(text, "values of 'Points': expected 44 bytes of values, found 43");
}

TEST(IoVtu, SurvivesDamage) {
  const TemporaryFolder folder;
  io::write_tet_mesh(folder.file("ours.vtu"), sample_mesh(1));
  const std::vector<std::string> files{ForeignFile({}).text(), ForeignFile({"binary", true, true}).text(),
                                       ForeignFile({"appended", false, false, true}).text(),
                                       ForeignFile({"appended", false, true, false}).text(),
                                       folder.read("ours.vtu")};
  std::mt19937 random(5);
  for (const std::string& content : files)
    for (int round = 0; round < 150; ++round) {
      std::string damaged = content.substr(0, round % 5 == 0 ? random() % content.size() : content.size());
      for (unsigned k = 0; k < 1 + random() % 3 && !damaged.empty(); ++k)
        damaged[random() % damaged.size()] =
            static_cast<char>(round % 2 == 0 ? random() % 256 : "0123456789<>\"A="[random() % 15]);
      try {
        const TetMesh mesh = io::read_tet_mesh(folder.write("a.vtu", damaged));
        for (const auto& tet : mesh.tets)
          for (const Index v : tet) ASSERT_LT(v, mesh.points.size());
      } catch (const ReadError&) {
      }
    }
}

}  // namespace
}  // namespace collarmesh::io_vtu_test
