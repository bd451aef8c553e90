// .vtu: what is written is read back, and all ways in which other programs store arrays are understood.
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "collarmesh/io/tet_mesh_io.h"
#include "io/base64.h"
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
