// Surfaces: well-formed files are read to the last bit, all others give an error with its place.
#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "collarmesh/io/mesh_surface_io.h"
#include "collarmesh/io/soup_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/plc_builder.h"
#include "support/comma_locale.h"
#include "support/replaced.h"
#include "support/sample_mesh.h"
#include "support/temporary_file.h"

namespace collarmesh::io_soup_test {
namespace {

using testing::CommaLocale;
using testing::expect_error;
using testing::replaced;
using testing::TemporaryFolder;

const std::string points = "0.1 0 0\n1 0 0\n0 1 0\n0 0 1e-3\n";
const std::string faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

std::string all_replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}
std::string each_line(const std::string& text, const std::string& prefix, const std::string& suffix) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    result += prefix + text.substr(at, end - at) + suffix + "\n";
    at = end + 1;
  }
  return result;
}
std::string crlf(const std::string& text) { return all_replaced(text, "\n", "\r\n"); }

template <class T>
std::string raw(T value, std::endian order = std::endian::little) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return {bytes.begin(), bytes.end()};
}

std::vector<std::vector<Index>> polygons_of(const PolygonSoup& soup) {
  std::vector<std::vector<Index>> result;
  for (Index q = 0; q < soup.polygon_count(); ++q) {
    const auto corners = soup.polygon(q);
    result.emplace_back(corners.begin(), corners.end());
  }
  return result;
}

const std::vector<Point> expected_points{{0.1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e-3}};
const std::vector<std::vector<Index>> expected_faces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

void expect_tetrahedron(const std::string& name, const std::string& content) {
  SCOPED_TRACE(name + ":\n" + content.substr(0, 300));
  const TemporaryFolder folder;
  const std::string path = folder.write(name, content);
  const PolygonSoup soup = io::read_soup(path);
  EXPECT_EQ(soup.name, path);
  EXPECT_EQ(soup.points, expected_points);
  EXPECT_EQ(polygons_of(soup), expected_faces);
  EXPECT_EQ(soup.facet_count(), expected_faces.size());
}

void expect_refused(const std::string& name, const std::string& content, const std::string& part) {
  SCOPED_TRACE(name + ":\n" + content.substr(0, 300));
  const TemporaryFolder folder;
  const std::string path = folder.write(name, content);
  expect_error<ReadError>([&] { io::read_soup(path); }, path, part);
}

// .off

const std::string off = "OFF\n4 4 0\n" + points + faces;

TEST(IoOff, ReadsVariants) {
  expect_tetrahedron("a.off", off);
  expect_tetrahedron("a.OFF", crlf(off));
  expect_tetrahedron("a.off", "OFF 4 4 6\n" + points + faces);
  expect_tetrahedron("a.off", "4 4 6\n" + points + faces);
  expect_tetrahedron(
      "a.off", "OFF # a comment\n# another\n\n4 4 0 # counts\n\n" + points + "# faces\n" + faces + "\n\n");
  expect_tetrahedron("a.off", off.substr(0, off.size() - 1));
  expect_tetrahedron(
      "a.off", "COFF\n4 4 0\n" + each_line(points, "", " 255 0 0 255") + each_line(faces, "", " 0.5 1 0"));
  expect_tetrahedron("a.off", "NOFF\n4 4 0\n" + each_line(points, "", " 0 0 1") + faces);
  expect_tetrahedron("a.off", "STCNOFF\n4 4 0\n" + each_line(points, "  +", " 0 0 1 1 0 0 0.5 0.5") + faces);
}

TEST(IoOff, ReadsPolygonsAndLooseEdges) {
  const TemporaryFolder folder;
  const PolygonSoup soup =
      io::read_soup(folder.write("a.off", "OFF\n4 2 0\n" + points + "4 0 1 2 3\n2 3 0\n"));
  EXPECT_EQ(polygons_of(soup), (std::vector<std::vector<Index>>{{0, 1, 2, 3}}));
  ASSERT_EQ(soup.segments.size(), 1);
  EXPECT_EQ(soup.segments[0].a, 3);
  EXPECT_EQ(soup.segments[0].b, 0);
}

TEST(IoOff, RefusesBadFiles) {
  expect_refused("a.off", "", "line 1: ");
  expect_refused("a.off", std::string("\0\1\2\3garbage", 11), "line 1: expected the keyword OFF");
  expect_refused("a.off", "OFF BINARY\n", "line 1: binary");
  expect_refused("a.off", "4OFF\n1 0 0\n0 0 0 1\n", "line 1: ");
  expect_refused("a.off", "OFF\n4 4 0\n" + points.substr(0, 20), "line 6: expected a coordinate");
  expect_refused("a.off", off.substr(0, off.size() - 3), "line 10: ");
  expect_refused("a.off", replaced(off, "4 4", "4 3"), "line 10: expected the end of the file");
  expect_refused("a.off", replaced(off, "4 4", "4 5"), "line 11: ");
  expect_refused("a.off", replaced(off, "4 4", "3 4"), "line 6: ");
  expect_refused("a.off", replaced(off, "4 4", "2000000000 4"),
                 "line 2: the number of vertices is 2000000000");
  expect_refused("a.off", replaced(off, "4 4", "4 2000000000"), "line 2: the number of faces is 2000000000");
  expect_refused("a.off", replaced(off, "4 4", "-4 4"), "line 2: ");
  expect_refused("a.off", replaced(off, "4 4", "99999999999999999999 4"), "line 2: ");
  expect_refused("a.off", replaced(off, "3 1 2 3", "2000000000 1 2 3"), "line 9: ");
  expect_refused("a.off", replaced(off, "3 1 2 3", "3 1 2 4"), "line 9: a corner of a face is 4");
  expect_refused("a.off", replaced(off, "3 1 2 3", "3 1 2 -1"), "line 9: a corner of a face is -1");
  expect_refused("a.off", replaced(off, "3 1 2 3", "1 1"), "line 9: ");
  expect_refused("a.off", replaced(off, "3 1 2 3", "3 1 2.5 3"), "line 9: ");
  for (const char* bad : {"nan", "inf", "-INF", "1e999", "0x10", "1,5", "1.5.5", "--1", "abc"})
    expect_refused("a.off", replaced(off, "0.1", bad), "line 3: expected a coordinate");
}

// .obj

const std::string obj_points = each_line(points, "v ", "");
const std::string obj = obj_points + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

TEST(IoObj, ReadsVariants) {
  expect_tetrahedron("a.obj", obj);
  expect_tetrahedron("a.Obj", crlf("# a comment\n\nmtllib x.mtl\no name\n" + obj + "\n\n"));
  expect_tetrahedron("a.obj", obj_points +
                                  "s off\nusemtl m\nvt 0 0\nvn 0 0 1\nf 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\n"
                                  "g part\nf 2/1 3/1 4/1\nf 1 4 3 # last");
  expect_tetrahedron("a.obj", obj_points + "f -4 -2 -3\nf -4 -3 -1\nf 2 3 -1\nf 1 -1 -2\n");
  expect_tetrahedron("a.obj", "f 1 3 2\nf 1 2 4\n" + obj_points + "f 2 3 4\nf 1 4 3\n");
  expect_tetrahedron("a.obj", obj_points + "f 1 3 \\\n 2\nf 1 2 4\nf \\\n2 3 4\nf 1 4 3\n");
  expect_tetrahedron("a.obj", each_line(points, "v ", " 1 0 0") + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
}

TEST(IoObj, ReadsPolygonsAndLines) {
  const TemporaryFolder folder;
  const PolygonSoup soup = io::read_soup(folder.write("a.obj", obj_points + "f 1 2 3 4\nl 1 2 4\n"));
  EXPECT_EQ(polygons_of(soup), (std::vector<std::vector<Index>>{{0, 1, 2, 3}}));
  ASSERT_EQ(soup.segments.size(), 2);
  EXPECT_EQ(soup.segments[1].a, 1);
  EXPECT_EQ(soup.segments[1].b, 3);
}

TEST(IoObj, RefusesBadFiles) {
  expect_refused("a.obj", "", "line 1: ");
  // A vertex must not get lost if its line ends with only a carriage return.
  expect_refused("a.obj", "v 0 0 0\rv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n",
                 "line 1: expected a weight or colour");
  expect_refused("a.obj", std::string("\0\1\2\3garbage", 11), "line 1: expected a keyword");
  expect_refused("a.obj", obj_points + "f 1 3", "line 5: expected a face of at least 3 corners, found 2");
  expect_refused("a.obj", obj + "f 1 2 5\n", "line 9: a corner is vertex 5, but the file has 4");
  expect_refused("a.obj", obj + "f 0 1 2\n", "line 9: ");
  expect_refused("a.obj", obj + "f -5 1 2\n", "line 9: ");
  expect_refused("a.obj", obj + "f 1 x 2\n", "line 9: ");
  expect_refused("a.obj", obj + "f 1 99999999999999999999 2\n", "line 9: ");
  expect_refused("a.obj", "v 0 0", "line 1: ");
  for (const char* bad : {"nan", "inf", "1e999", "abc"})
    expect_refused("a.obj", replaced(obj, "0.1", bad), "line 1: expected a coordinate");
}

// .stl

std::string stl_text() {
  std::string text = "solid a name\n";
  for (const auto& face : expected_faces) {
    text += " facet normal 0 0 0\n  outer loop\n";
    for (const Index v : face) {
      const Point& p = expected_points[v];
      text +=
          "   vertex " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z) + '\n';
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid a name\n";
}

std::string stl_binary(std::string header = "binary", std::uint32_t claimed = 4) {
  header.resize(80, ' ');
  std::string bytes = header + raw(claimed);
  for (const auto& face : expected_faces) {
    bytes += std::string(12, '\0');
    for (const Index v : face)
      for (std::size_t k = 0; k < 3; ++k) bytes += raw(static_cast<float>(expected_points[v][k]));
    bytes += std::string(2, '\0');
  }
  return bytes;
}

/// Points are merged and numbered by first use.
void expect_stl_tetrahedron(const std::string& content, bool floats) {
  SCOPED_TRACE(content.substr(0, 100));
  const TemporaryFolder folder;
  const PolygonSoup soup = io::read_soup(folder.write("a.stl", content));
  ASSERT_EQ(soup.points.size(), 4);
  const std::array<Index, 4> first_use{0, 2, 1, 3};
  for (Index i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double c = expected_points[first_use[i]][k];
      EXPECT_EQ(soup.points[i][k], floats ? double{static_cast<float>(c)} : c);
    }
  EXPECT_EQ(polygons_of(soup), (std::vector<std::vector<Index>>{{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {0, 3, 1}}));
}

TEST(IoStl, ReadsVariants) {
  const std::string text = stl_text();
  expect_stl_tetrahedron(text, false);
  expect_stl_tetrahedron(crlf(text), false);
  expect_stl_tetrahedron(all_replaced(text, "facet", "FACET"), false);
  expect_stl_tetrahedron("solid\n" + text.substr(text.find('\n') + 1), false);
  expect_stl_tetrahedron(replaced(text, "endsolid", "end solid"), false);
  expect_stl_tetrahedron(stl_binary(), true);
  expect_stl_tetrahedron(stl_binary("solid but binary"), true);
  expect_stl_tetrahedron(stl_binary(std::string(80, '\0')), true);
}

TEST(IoStl, ReadsSeveralSolidsAndMergesZeros) {
  const TemporaryFolder folder;
  const std::string triangle =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex -0 1 -0\nendloop\nendfacet\n";
  const PolygonSoup soup =
      io::read_soup(folder.write("a.stl", "solid a\n" + triangle + "endsolid\nsolid b\n" +
                                              all_replaced(triangle, "-0", "0") + "endsolid b\n"));
  EXPECT_EQ(soup.points.size(), 3);
  EXPECT_EQ(soup.facet_count(), 2);
}

TEST(IoStl, RefusesBadFiles) {
  const std::string text = stl_text(), binary = stl_binary();
  expect_refused("a.stl", "", "byte 0: ");
  expect_refused("a.stl", "short", "byte 0: ");
  expect_refused("a.stl", std::string(1000, '\7'), "byte 84: ");
  expect_refused("a.stl", text.substr(0, 200), "line ");
  expect_refused("a.stl", text.substr(0, text.find("endsolid")),
                 "line 30: expected facet or endsolid, found the end");
  expect_refused("a.stl", replaced(text, "vertex", "vertx"), "line 4: expected vertex, found 'vertx'");
  expect_refused("a.stl", replaced(text, "  endloop", "   vertex 1 1 1\n  endloop"),
                 "line 7: expected endloop");
  expect_refused("a.stl", text + "more", "line 31: expected solid, found 'more'");
  expect_refused("a.stl", replaced(text, "0.100000", "nan"), "line 4: expected a coordinate");
  expect_refused("a.stl", binary.substr(0, binary.size() - 1), "byte 84: ");
  expect_refused("a.stl", binary + "x", "byte 84: ");
  expect_refused("a.stl", stl_binary("b", 3), "byte 84: expected 3 triangles");
  expect_refused("a.stl", stl_binary("b", 2000000000), "byte 84: expected 2000000000 triangles");
  const std::string nan = raw(std::numeric_limits<float>::quiet_NaN());
  expect_refused("a.stl", std::string(binary).replace(84 + 12, 4, nan), "byte 108: ");
}

// .ply

std::string ply_header(const std::string& format, const std::string& type = "double",
                       const std::string& vertices = "4", const std::string& face_count = "4") {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\nelement vertex " + vertices + "\nproperty " +
         type + " x\nproperty " + type + " y\nproperty " + type + " z\nelement face " + face_count +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string ply_body(std::endian order) {
  std::string body;
  for (const Point& p : expected_points)
    for (std::size_t k = 0; k < 3; ++k) body += raw(p[k], order);
  for (const auto& face : expected_faces) {
    body += '\3';
    for (const Index v : face) body += raw(static_cast<std::int32_t>(v), order);
  }
  return body;
}

TEST(IoPly, ReadsVariants) {
  expect_tetrahedron("a.ply", ply_header("ascii") + points + faces);
  expect_tetrahedron("a.ply", crlf(ply_header("ascii", "float") + points + faces));
  expect_tetrahedron("a.ply", ply_header("binary_little_endian") + ply_body(std::endian::little));
  expect_tetrahedron("a.ply", ply_header("binary_big_endian", "float64") + ply_body(std::endian::big));
  expect_tetrahedron(
      "a.ply",
      "ply\nformat ascii 1.0\nobj_info x\nelement face 4\nproperty int q\nproperty list uchar uint "
      "vertex_index\n"
      "element vertex 4\nproperty uchar red\nproperty double x\nproperty double y\nproperty double z\n"
      "property list uchar int foo\nelement other 2\nproperty float a\nend_header\n" +
          each_line(faces, "7 ", "") + each_line(points, "255 ", " 2 1 1") + "1\n2\n");
}

TEST(IoPly, ReadsEdges) {
  const TemporaryFolder folder;
  const std::string header =
      replaced(ply_header("ascii"), "end_header",
               "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header");
  const PolygonSoup soup = io::read_soup(folder.write("a.ply", header + points + faces + "1 3\n"));
  ASSERT_EQ(soup.segments.size(), 1);
  EXPECT_EQ(soup.segments[0].b, 3);
}

/// Numbers of all types in binary files, before and behind those that are read.
TEST(IoPly, SkipsAndReadsNumbersOfAllTypes) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    std::string header = order == std::endian::little ? "ply\nformat binary_little_endian 1.0\n"
                                                      : "ply\nformat binary_big_endian 1.0\n";
    header +=
        "element vertex 4\nproperty char a\nproperty double x\nproperty ushort b\nproperty float y\nproperty "
        "short z\nelement face 4\nproperty list int16 double c\nproperty list ushort uint "
        "vertex_index\nproperty "
        "int tag\nelement edge 1\nproperty uchar vertex1\nproperty double d\nproperty uint "
        "vertex2\nend_header\n";
    const std::vector<std::array<int, 3>> places{{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, -5}};
    std::string body;
    for (const auto& [x, y, z] : places)
      body += raw(std::int8_t{-1}, order) + raw(double(x), order) + raw(std::uint16_t{9}, order) +
              raw(float(y), order) + raw(static_cast<std::int16_t>(z), order);
    for (std::size_t f = 0; f < expected_faces.size(); ++f) {
      body += raw(std::int16_t{1}, order) + raw(7.5, order) + raw(std::uint16_t{3}, order);
      for (const Index v : expected_faces[f]) body += raw(static_cast<std::uint32_t>(v), order);
      body += raw(static_cast<std::int32_t>(10 * f), order);
    }
    body += raw(std::uint8_t{1}, order) + raw(2.5, order) + raw(std::uint32_t{3}, order);
    const TemporaryFolder folder;
    const PolygonSoup soup = io::read_soup(folder.write("a.ply", header + body));
    ASSERT_EQ(soup.points.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(soup.points[i], (Point{double(places[i][0]), double(places[i][1]), double(places[i][2])}));
    ASSERT_EQ(soup.facet_count(), expected_faces.size());
    for (Index f = 0; f < soup.facet_count(); ++f) {
      EXPECT_TRUE(std::ranges::equal(soup.polygon(f), expected_faces[f]));
      EXPECT_EQ(soup.facet_tag(f), 10 * static_cast<Tag>(f));
    }
    ASSERT_EQ(soup.segments.size(), 1U);
    EXPECT_EQ(soup.segments[0].a, 1U);
    EXPECT_EQ(soup.segments[0].b, 3U);
  }
}

TEST(IoPly, FacesOfTwoCornersAreSegments) {
  const TemporaryFolder folder;
  const PolygonSoup soup = io::read_soup(
      folder.write("a.ply", ply_header("ascii", "double", "4", "5") + points + faces + "2 1 3\n"));
  EXPECT_EQ(soup.facet_count(), 4U);
  ASSERT_EQ(soup.segments.size(), 1U);
  EXPECT_EQ(soup.segments[0].a, 1U);
  EXPECT_EQ(soup.segments[0].b, 3U);
}

TEST(IoPly, RefusesStripsAndListsOfFractionalLength) {
  const std::string text = ply_header("ascii") + points + faces;
  expect_refused("a.ply", replaced(text, "list uchar int", "list float int"),
                 "the length of a list has to have an integer type");
  expect_refused(
      "a.ply",
      replaced(text, "end_header", "element tristrips 1\nproperty list int int s\nend_header") + "3 0 1 2\n",
      "triangle strips are not supported");
}

TEST(IoPly, RefusesBadFiles) {
  const std::string text = ply_header("ascii") + points + faces;
  const std::string header = ply_header("binary_little_endian"), body = ply_body(std::endian::little);
  const auto byte = [](std::size_t n) { return "byte " + std::to_string(n) + ": "; };
  expect_refused("a.ply", "", "line 1: expected ply");
  expect_refused("a.ply", "ply\n\1\2\3\4", "line 2: ");
  expect_refused("a.ply", text.substr(0, 60), "line ");
  expect_refused("a.ply", replaced(text, "ascii", "binary_middle_endian"), "line 2: ");
  expect_refused("a.ply", replaced(text, "double", "quad"), "line 5: expected a type");
  expect_refused("a.ply", replaced(text, "property double x\n", ""), "no property 'x'");
  expect_refused("a.ply", replaced(text, "vertex_indices", "something"), "no property 'vertex_indices'");
  expect_refused("a.ply", text.substr(0, text.size() - 5), "line 18: ");
  expect_refused("a.ply", text + "3 0 1 2\n", "line 19: expected the end");
  expect_refused("a.ply", replaced(text, "3 1 2 3", "3 1 2 9"), "line 17: a corner is vertex 9");
  expect_refused("a.ply", replaced(text, "3 1 2 3", "3 1 2 -1"), "line 17: ");
  expect_refused("a.ply", replaced(text, "3 1 2 3", "2000000000 1 2 3"), "line 17: ");
  expect_refused("a.ply", replaced(text, "0.1", "nan"), "line 11: ");
  expect_refused("a.ply", ply_header("ascii", "double", "2000000000") + points + faces, "line ");
  expect_refused("a.ply", ply_header("ascii", "double", "4", "2000000000") + points + faces, "line ");
  expect_refused("a.ply", ply_header("binary_little_endian", "double", "2000000000") + body, "byte ");
  expect_refused("a.ply", ply_header("binary_little_endian", "double", "4", "2000000000") + body, "byte ");
  expect_refused("a.ply", header + body.substr(0, body.size() - 1), "byte ");
  expect_refused("a.ply", header + body + "more", byte(header.size() + body.size()));
  std::string bad = body;
  bad.replace(0, 8, raw(std::numeric_limits<double>::infinity()));
  expect_refused("a.ply", header + bad, byte(header.size() + 8));
  bad = body;
  bad[96] = '\xff';
  expect_refused("a.ply", header + bad, byte(header.size() + 97));
  bad = body;
  bad[97] = '\7';
  expect_refused("a.ply", header + bad, byte(header.size() + 101) + "a corner is vertex 7");
}

// All

TEST(IoSoup, KnowsItsFormats) {
  for (const char* name : {"a.off", "b/A.OBJ", "a.stl", "a.Ply", "a.poly", "a.smesh"})
    EXPECT_TRUE(io::is_soup_format(name));
  for (const char* name : {"a.om", "a", "a.off.gz", "off"}) EXPECT_FALSE(io::is_soup_format(name));
  expect_error<ReadError>([] { io::read_soup("a.xyz"); }, "a.xyz", "unknown kind of file");
}

TEST(IoSoup, NamesTheReasonOfTheSystem) {
  const TemporaryFolder folder;
  const std::string missing = folder.file("missing.off");
  expect_error<ReadError>([&] { io::read_soup(missing); }, missing, "No such file");
  std::filesystem::create_directory(folder.file("folder.off"));
  expect_error<ReadError>([&] { io::read_soup(folder.file("folder.off")); }, folder.file("folder.off"),
                          "is a folder");
}

TEST(IoSoup, KeepsEveryBitWhateverTheLocale) {
  std::mt19937_64 random(7);
  std::vector<Point> wanted;
  std::string text = "OFF\n1000 0 0\n";
  while (wanted.size() < 1000) {
    Point p;
    for (std::size_t k = 0; k < 3; ++k) {
      do p[k] = std::bit_cast<double>(random());
      while (!std::isfinite(p[k]));
      char number[40];
      std::snprintf(number, sizeof number, "%.17g ", p[k]);
      text += number;
    }
    text += '\n';
    wanted.push_back(p);
  }
  const TemporaryFolder folder;
  const std::string path = folder.write("a.off", text);
  EXPECT_EQ(io::read_soup(path).points, wanted);
  const CommaLocale locale;
  EXPECT_EQ(io::read_soup(path).points, wanted);
}

using CgalPoint = CGAL::Simple_cartesian<double>::Point_3;

template <class Read>
void expect_as_cgal(const std::string& path, Read read) {
  SCOPED_TRACE(path);
  std::vector<CgalPoint> cgal_points;
  std::vector<std::vector<std::size_t>> cgal_faces;
  ASSERT_TRUE(read(path, cgal_points, cgal_faces));
  const PolygonSoup soup = io::read_soup(path);
  ASSERT_EQ(soup.points.size(), cgal_points.size());
  for (std::size_t i = 0; i < cgal_points.size(); ++i)
    EXPECT_EQ(soup.points[i], (Point{cgal_points[i].x(), cgal_points[i].y(), cgal_points[i].z()}));
  ASSERT_EQ(soup.polygon_count(), cgal_faces.size());
  for (Index q = 0; q < soup.polygon_count(); ++q) {
    const auto corners = soup.polygon(q);
    EXPECT_EQ(std::vector<std::size_t>(corners.begin(), corners.end()), cgal_faces[q]);
  }
}

TEST(IoSoup, AgreesWithCgalOnWellFormedFiles) {
  const TemporaryFolder folder;
  expect_as_cgal(folder.write("a.off", off),
                 [](const std::string& f, auto& p, auto& t) { return CGAL::IO::read_OFF(f, p, t); });
  expect_as_cgal(folder.write("a.obj", obj),
                 [](const std::string& f, auto& p, auto& t) { return CGAL::IO::read_OBJ(f, p, t); });
  for (const std::string& content : {stl_text(), stl_binary()})
    expect_as_cgal(folder.write("a.stl", content),
                   [](const std::string& f, auto& p, auto& t) { return CGAL::IO::read_STL(f, p, t); });
  for (const std::string& content : {ply_header("ascii") + points + faces,
                                     ply_header("binary_little_endian") + ply_body(std::endian::little)})
    expect_as_cgal(folder.write("a.ply", content),
                   [](const std::string& f, auto& p, auto& t) { return CGAL::IO::read_PLY(f, p, t); });
}

/// Any bytes give a soup or a ReadError. The sanitizers find other faults.
TEST(IoSoup, SurvivesDamage) {
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.off", off},
      {"a.obj", obj},
      {"a.stl", stl_text()},
      {"b.stl", stl_binary()},
      {"a.ply", ply_header("ascii") + points + faces},
      {"b.ply", ply_header("binary_big_endian") + ply_body(std::endian::big)}};
  const TemporaryFolder folder;
  std::mt19937 random(1);
  for (const auto& [name, content] : files)
    for (int round = 0; round < 100; ++round) {
      std::string damaged = content.substr(0, round % 3 == 0 ? random() % content.size() : content.size());
      for (unsigned k = 0; k < random() % 4 && !damaged.empty(); ++k)
        damaged[random() % damaged.size()] = "0123456789-\n \xff\0e"[random() % 17];
      try {
        const PolygonSoup soup = io::read_soup(folder.write(name, damaged));
        for (const auto& polygon : polygons_of(soup))
          for (const Index corner : polygon) ASSERT_LT(corner, soup.points.size());
      } catch (const ReadError&) {
      }
    }
}

TEST(IoSoup, ReadsTheCorpus) {
  const char* corpus = std::getenv("COLLARMESH_CORPUS");
  if (corpus == nullptr || *corpus == '\0') GTEST_SKIP() << "COLLARMESH_CORPUS names no folder";
  for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
    const std::string path = entry.path().string();
    if (!io::is_soup_format(path)) continue;
    EXPECT_NO_THROW(EXPECT_GT(io::read_soup(path).facet_count(), 0) << path) << path;
  }
}

// A mesh of tets as a surface: its regions keep their tags.
TEST(IoMeshSurface, KeepsTagsOfRegions) {
  const TetMesh mesh = testing::sample_mesh(2);
  const TemporaryFolder folder;
  io::write_tet_mesh(folder.file("a.msh"), mesh);
  const PolygonSoup soup = io::read_mesh_surface(folder.file("a.msh"));
  ASSERT_EQ(soup.named_regions.size(), 2U);
  const Plc plc = build_plc({&soup, 1});
  std::map<Tag, double> expected, volumes;
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    expected[mesh.tet_tag[t]] +=
        six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) / 6;
  }
  for (std::size_t r = 1; r < plc.regions.size(); ++r) volumes[plc.regions[r].tag] = plc.regions[r].volume;
  ASSERT_EQ(volumes.size(), expected.size());
  for (const auto& [tag, volume] : expected) EXPECT_NEAR(volumes[tag], volume, 1e-12) << tag;
}

}  // namespace
}  // namespace collarmesh::io_soup_test
