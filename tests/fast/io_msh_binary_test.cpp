// Binary files of Gmsh, versions 2.2 and 4.1, in both byte orders: they are the same mesh as text, and errors
// have the byte.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/io/point_field_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "support/temporary_file.h"
#include "support/tet_mesh_comparison.h"

namespace collarmesh::io_msh_binary_test {
namespace {

using namespace testing;

/// Values as bytes or as text.
class Values {
 public:
  Values(bool binary, bool swapped) : binary_(binary), swapped_(swapped) {}

  Values& integer(std::int32_t value) { return add(value); }
  Values& number(std::uint64_t value) { return add(value); }
  Values& real(double value) { return add(value); }
  Values& line(const std::string& line) {
    text_ += line + "\n";
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  template <class T>
  Values& add(T value) {
    if (!binary_) {
      text_ += std::to_string(value) + " ";
      return *this;
    }
    auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (swapped_) std::reverse(raw.begin(), raw.end());
    text_.append(raw.data(), raw.size());
    return *this;
  }

  bool binary_, swapped_;
  std::string text_;
};

struct Kind {
  bool binary, swapped;

  Values values() const { return {binary, swapped}; }
  std::string format(const std::string& version) const {
    std::string text = "$MeshFormat\n" + version + (binary ? " 1 8\n" : " 0 8\n");
    if (binary) text += values().integer(1).text() + "\n";
    return text + "$EndMeshFormat\n";
  }
};

const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
constexpr std::array<std::array<int, 4>, 2> tets{{{1, 2, 3, 4}, {2, 3, 4, 5}}};

std::string section(const std::string& name, const std::string& body) {
  return "$" + name + "\n" + body + "\n$End" + name + "\n";
}

/// Two tets with the physical groups 9 and 4, and a triangle with 70.
std::string version_2(const Kind& kind, double last = 1, std::int32_t of_block = 2) {
  Values nodes = kind.values();
  nodes.line("5");
  for (int i = 0; i < 5; ++i)
    nodes.integer(i + 1).real(points[i].x).real(points[i].y).real(i == 4 ? last : points[i].z);
  Values elements = kind.values();
  elements.line("3");
  if (kind.binary) {
    elements.integer(2).integer(1).integer(2).integer(1).integer(70).integer(1);
    for (const int v : {2, 3, 4}) elements.integer(v);
    elements.integer(4).integer(of_block).integer(2);
    for (int t = 0; t < 2; ++t) {
      elements.integer(t + 2).integer(t == 0 ? 9 : 4).integer(t + 1);
      for (const int v : tets[t]) elements.integer(v);
    }
  } else {
    elements.line("1 2 2 70 1 2 3 4").line("2 4 2 9 1 1 2 3 4").line("3 4 2 4 2 2 3 4 5");
  }
  return kind.format("2.2") + section("Nodes", nodes.text()) + section("Elements", elements.text());
}

std::string version_4(const Kind& kind, std::uint64_t nodes_of_block = 5) {
  Values entities = kind.values();
  for (const std::uint64_t count : {0, 0, 1, 2}) entities.number(count);
  for (int entity = 1; entity <= 3; ++entity) {
    entities.integer(entity == 3 ? 2 : 1);
    for (int i = 0; i < 6; ++i) entities.real(i < 3 ? 0 : 1);
    entities.number(1).integer(entity == 1 ? 70 : entity == 2 ? 9 : 4).number(0);
  }
  Values nodes = kind.values();
  nodes.number(1).number(5).number(1).number(5);
  nodes.integer(3).integer(1).integer(0).number(nodes_of_block);
  for (std::uint64_t i = 1; i <= 5; ++i) nodes.number(i);
  for (const Point& p : points) nodes.real(p.x).real(p.y).real(p.z);
  Values elements = kind.values();
  elements.number(3).number(3).number(1).number(3);
  elements.integer(2).integer(1).integer(2).number(1).number(1);
  for (const std::uint64_t v : {2, 3, 4}) elements.number(v);
  for (int t = 0; t < 2; ++t) {
    elements.integer(3).integer(t + 1).integer(4).number(1).number(static_cast<std::uint64_t>(t) + 2);
    for (const int v : tets[t]) elements.number(static_cast<std::uint64_t>(v));
  }
  return kind.format("4.1") + section("Entities", entities.text()) + section("Nodes", nodes.text()) +
         section("Elements", elements.text());
}

TetMesh read(const std::string& text) {
  const TemporaryFolder folder;
  return io::read_tet_mesh(folder.write("a.msh", text));
}

void expect_refused(const std::string& text, const std::string& part) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.msh", text);
  expect_error<ReadError>([&] { io::read_tet_mesh(path); }, path, part);
}

constexpr Kind as_text{false, false}, as_bytes{true, false}, as_swapped_bytes{true, true};

TEST(IoMshBinary, IsTheSameMeshAsText) {
  const TetMesh mesh = read(version_2(as_text));
  EXPECT_EQ(mesh.points, points);
  EXPECT_EQ(mesh.tet_tag, (std::vector<Tag>{9, 4}));
  EXPECT_EQ(mesh.face_tag, (std::vector<Tag>{70}));
  expect_same(read(version_4(as_text)), read(version_4(as_bytes)));
  expect_same(read(version_4(as_text)), read(version_4(as_swapped_bytes)));
  expect_same(mesh, read(version_2(as_bytes)));
  expect_same(mesh, read(version_2(as_swapped_bytes)));
  EXPECT_EQ(read(version_4(as_bytes)).tet_tag, mesh.tet_tag);
  EXPECT_EQ(read(version_4(as_bytes)).points, mesh.points);
}

TEST(IoMshBinary, ErrorsHaveTheByte) {
  expect_refused(version_2(as_bytes, std::numeric_limits<double>::quiet_NaN()), "is not finite");
  expect_refused(version_2(as_bytes, 1, 3), "a block has 3 elements with 2 tags each");
  expect_refused(version_4(as_bytes, 1000), "the number of nodes of a block is 1000, but only ");
  std::string many = version_2(as_bytes);
  const std::string count = "$Nodes\n5\n";
  many.replace(many.find(count), count.size(), "$Nodes\n2000000000\n");
  expect_refused(many, "the number of nodes is 2000000000, but only ");
  std::string negative = version_2(as_bytes);
  negative.replace(negative.find(count) + count.size(), 4, "\xff\xff\xff\xff");
  expect_refused(negative, "is negative");
}

TEST(IoMshBinary, HasFields) {
  const TemporaryFolder folder;
  for (const Kind& kind : {as_text, as_bytes, as_swapped_bytes}) {
    Values data = kind.values();
    data.line("1").line("\"size\"").line("1").line("0").line("3").line("0").line("1").line("5");
    for (int i = 0; i < 5; ++i) data.integer(5 - i).real(0.5 + i);
    const io::PointField field = io::read_point_field(
        folder.write("a.msh", version_2(kind) + section("NodeData", data.text())), "size");
    EXPECT_EQ(field.values, (std::vector<double>{4.5, 3.5, 2.5, 1.5, 0.5}));
    EXPECT_EQ(field.mesh.points, points);
  }
}

}  // namespace
}  // namespace collarmesh::io_msh_binary_test
