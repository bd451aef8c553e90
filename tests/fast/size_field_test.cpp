// Size fields from descriptions and background meshes.
#include "collarmesh/size_field.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/io/point_field_io.h"
#include "collarmesh/io/size_field_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/plc_builder.h"
#include "support/meshing.h"
#include "support/shapes.h"
#include "support/temporary_file.h"

namespace collarmesh::size_field_test {
namespace {

Plc cylinder() {
  const PolygonSoup soup = testing::cylinder(1, 2, 32);
  return build_plc(std::span(&soup, 1), {.feature_angle = 30});
}

TEST(SizeFieldJson, TakesTheSmallestOfItsSources) {
  const SizeField field = size_field_from_json(
      R"({"size": 2, "sources": [
            {"ball": {"centre": [0, 0, 0], "radius": 1}, "size": 0.1, "growth": 0.5},
            {"box": {"min": [5, 5, 5], "max": [6, 7, 8]}, "size": 0.2}]})",
      cylinder());
  EXPECT_DOUBLE_EQ(field({0, 0, 0.5}), 0.1);
  EXPECT_DOUBLE_EQ(field({0, 0, 3}), 0.1 + 0.5 * 2);
  EXPECT_DOUBLE_EQ(field({0, 0, 50}), 2);
  EXPECT_DOUBLE_EQ(field({5.5, 6, 6}), 0.2);
  EXPECT_DOUBLE_EQ(field({5.5, 6, 9}), 0.2 + 0.3 * 1);
}

TEST(SizeFieldJson, CylindersAndTurnedBoxes) {
  const SizeField cylinder_field = size_field_from_json(
      R"({"sources": [{"cylinder": {"from": [1, 0, 0], "to": [1, 4, 0], "radius": 2}, "size": 0.1, "growth": 0.5}]})",
      cylinder());
  EXPECT_DOUBLE_EQ(cylinder_field({1, 2, 0}), 0.1);                  // on the axis
  EXPECT_DOUBLE_EQ(cylinder_field({2, 3, 1}), 0.1);                  // inside
  EXPECT_DOUBLE_EQ(cylinder_field({1, 2, 5}), 0.1 + 0.5 * 3);        // beside it
  EXPECT_DOUBLE_EQ(cylinder_field({1, -2, 1}), 0.1 + 0.5 * 2);       // below it
  EXPECT_DOUBLE_EQ(cylinder_field({1, 6, 0}), 0.1 + 0.5 * 2);        // above it
  EXPECT_NEAR(cylinder_field({1 + 5, 8, 0}), 0.1 + 0.5 * 5, 1e-12);  // diagonally past the rim, at distance
                                                                     // 5: 3 outwards, 4 up

  const SizeField straight = size_field_from_json(
      R"({"sources": [{"box": {"min": [1, 2, 3], "max": [3, 3, 7]}, "size": 0.1}]})", cylinder());
  const SizeField same = size_field_from_json(
      R"({"sources": [{"box": {"corner": [1, 2, 3], "edges": [[0, 0, 4], [2, 0, 0], [0, 1, 0]]}, "size": 0.1}]})",
      cylinder());
  const SizeField turned = size_field_from_json(
      R"({"sources": [{"box": {"corner": [0, 0, 0], "edges": [[3, 3, 0], [-1, 1, 0], [0, 0, 1]]}, "size": 0.1,
                       "growth": 1}]})",
      cylinder());
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> around(-2, 9);
  for (int i = 0; i < 200; ++i) {
    const Point p{around(random), around(random), around(random)};
    EXPECT_NEAR(same(p), straight(p), 1e-12);
  }
  EXPECT_DOUBLE_EQ(turned({2, 2, 0.5}), 0.1);
  EXPECT_NEAR(turned({4, 4, 0.5}), 0.1 + std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(turned({2, 0, 0.5}), 0.1 + std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(turned({1.5, 1.5, 3}), 0.1 + 2, 1e-12);
}

TEST(SizeFieldJson, HoldsWithinADistance) {
  const SizeField field = size_field_from_json(
      R"({"sources": [{"ball": {"centre": [0, 0, 0], "radius": 1}, "size": 0.1, "growth": 0.5, "within": 2}]})",
      cylinder());
  EXPECT_DOUBLE_EQ(field({0, 0, 3}), 0.1);
  EXPECT_DOUBLE_EQ(field({0, 0, 5}), 0.1 + 0.5 * 2);
}

TEST(SizeFieldJson, GrowsAwayFromFeatures) {
  Plc plc = cylinder();
  Tag tag = 10;
  for (Plc::Curve& curve : plc.curves) curve.tag = tag++;
  for (Plc::Patch& patch : plc.patches) patch.tag = patch.planar ? 7 : 8;
  const SizeField from_curve =
      size_field_from_json(R"({"sources": [{"curves": [10], "size": 0.1, "growth": 1}]})", plc);
  const Point& on_it = plc.points[plc.curves[0].points[0]];
  EXPECT_DOUBLE_EQ(from_curve(on_it), 0.1);
  EXPECT_NEAR(from_curve({0, 0, on_it.z}), 0.1 + std::cos(std::numbers::pi / 32),
              1e-9);  // the polygon's inner radius
  const SizeField from_patches =
      size_field_from_json(R"({"sources": [{"patches": [7], "size": 0.1, "growth": 1}]})", plc);
  EXPECT_NEAR(from_patches({0, 0, plc.bounds.min.z + 0.4}), 0.5, 1e-12);
}

TEST(SizeFieldJson, SaysWhatIsWrongAndWhere) {
  const Plc plc = cylinder();
  const auto message = [&](const std::string& text) -> std::string {
    try {
      size_field_from_json(text, plc);
    } catch (const OptionError& error) {
      return error.what();
    }
    return "no error";
  };
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "line 1, column 1"},
      {"{\"size\": 1,\n \"sources\": [{]}", "line 2, column 15"},
      {"[]", "object"},
      {"{}", "asks for no size"},
      {R"({"sise": 1})", "'sise' is not known"},
      {R"({"size": 0})", "'size' must be positive"},
      {R"({"size": "1"})", "must be a number"},
      {R"({"sources": 1})", "expected a list"},
      {R"({"sources": [{"size": 1}]})", "sources[0]: expected one of ball"},
      {R"({"sources": [{"ball": {"centre": [0, 0], "radius": 1}, "size": 1}]})",
       "sources[0].ball: expected 'centre'"},
      {R"({"sources": [{"ball": {"centre": [0, 0, 0], "radius": -1}, "size": 1}]})", "'radius' is -1"},
      {R"({"sources": [{"ball": {"centre": [0, 0, 0]}, "size": 1}]})", "'radius' is missing"},
      {R"({"sources": [{"box": {"min": [1, 0, 0], "max": [0, 1, 1]}, "size": 1}]})", "'min' exceeds 'max'"},
      {R"({"sources": [{"box": {"corner": [0, 0, 0], "edges": [[1, 0, 0], [1, 1, 0], [0, 0, 1]]}, "size": 1}]})",
       "sources[0].box: edges 0 and 1 are not at right angles"},
      {R"({"sources": [{"box": {"corner": [0, 0, 0], "edges": [[1, 0, 0], [0, 1, 0]]}, "size": 1}]})",
       "sources[0].box: expected 'edges'"},
      {R"({"sources": [{"box": {"corner": [0, 0, 0], "edges": [[1, 0, 0], [0, 0, 0], [0, 0, 1]]}, "size": 1}]})",
       "sources[0].box: an edge has no length"},
      {R"({"sources": [{"cylinder": {"from": [0, 0, 1], "to": [0, 0, 1], "radius": 1}, "size": 1}]})",
       "sources[0].cylinder: 'from' and 'to' are the same point"},
      {R"({"sources": [{"cylinder": {"from": [0, 0, 1], "to": [0, 0, 2]}, "size": 1}]})",
       "'radius' is missing"},
      {R"({"sources": [{"ball": {}, "cylinder": {}, "size": 1}]})",
       "expected only one of ball, box, cylinder"},
      {R"({"sources": [{"patches": [1], "size": 1, "within": -1}]})", "'within' is -1"},
      {R"({"sources": [{"curves": [99], "size": 1}]})", "no curves have the tag 99"},
      {R"({"sources": [{"patches": ["a"], "size": 1}]})", "is no tag"},
      {R"({"sources": [{"curves": [], "size": 1}]})", "expected a list of tags"}};
  for (const auto& [text, expected] : cases)
    EXPECT_NE(message(text).find(expected), std::string::npos) << text << ": " << message(text);
}

double linear(const Point& p) { return 1 + 0.3 * p.x - 0.2 * p.y + 0.1 * p.z; }

TEST(SizeFieldOnAMesh, IsLinearInsideAndConstantBeyond) {
  const TetMesh mesh = testing::mesh_of(testing::box(), testing::with_size(0.3), 0).result.mesh;
  std::vector<double> values;
  for (const Point& p : mesh.points) values.push_back(linear(p));
  const SizeField field = size_field_on_mesh(mesh, values);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 500; ++i) {
    const Point p{unit(random), unit(random), unit(random)};
    EXPECT_NEAR(field(p), linear(p), 1e-9);
  }
  EXPECT_DOUBLE_EQ(field({-3, -3, -3}), linear({0, 0, 0}));
  EXPECT_THROW(size_field_on_mesh(mesh, {1, 2}), OptionError);
  values[5] = 0;
  EXPECT_THROW(size_field_on_mesh(mesh, values), OptionError);
}

std::string msh_text(const TetMesh& mesh, const std::string& version, const std::string& views) {
  std::string text =
      fmt::format("$MeshFormat\n{} 0 8\n$EndMeshFormat\n$Nodes\n{}\n", version, mesh.points.size());
  // Uses numbers with gaps, in descending order.
  const auto number = [&](std::size_t i) { return 3 * (mesh.points.size() - i); };
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Point& p = mesh.points[i];
    text += fmt::format("{} {} {} {}\n", number(i), p.x, p.y, p.z);
  }
  text += fmt::format("$EndNodes\n$Elements\n{}\n", mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& v = mesh.tets[t];
    text += fmt::format("{} 4 2 1 1 {} {} {} {}\n", t + 1, number(v[0]), number(v[1]), number(v[2]),
                        number(v[3]));
  }
  text += "$EndElements\n";
  for (const char view : views) {
    text += fmt::format("$NodeData\n1\n\"{}\"\n1\n0\n3\n0\n1\n{}\n", view, mesh.points.size());
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      text += fmt::format("{} {}\n", number(i), (view == 'a' ? 1 : 2) * linear(mesh.points[i]));
    text += "$EndNodeData\n";
  }
  return text;
}

TEST(PointField, OfGmsh) {
  const TetMesh mesh = testing::mesh_of(testing::box(), testing::with_size(0.5), 0).result.mesh;
  const testing::TemporaryFolder folder;
  const auto expect_field = [&](const std::string& path, const std::string& name, double factor) {
    const io::PointField field = io::read_point_field(path, name);
    ASSERT_EQ(field.values.size(), field.mesh.points.size());
    EXPECT_EQ(field.mesh.tets.size(), mesh.tets.size());
    for (std::size_t i = 0; i < field.values.size(); ++i)
      EXPECT_NEAR(field.values[i], factor * linear(field.mesh.points[i]), 1e-12);
  };
  expect_field(folder.write("one.msh", msh_text(mesh, "2.2", "a")), "", 1);
  const std::string two = folder.write("two.msh", msh_text(mesh, "2.2", "ab"));
  expect_field(two, "b", 2);
  EXPECT_THROW(io::read_point_field(two), ReadError);
  EXPECT_THROW(io::read_point_field(two, "c"), ReadError);
  EXPECT_THROW(io::read_point_field(folder.write("none.msh", msh_text(mesh, "2.2", ""))), ReadError);
  EXPECT_THROW(io::read_point_field(folder.write("x.mesh", "")), ReadError);
}

// read_size_field

TEST(ReadSizeField, IsTheFieldOfItsFile) {
  const testing::TemporaryFolder folder;
  const Plc plc = cylinder();
  const SizeField ball = io::read_size_field(
      folder.write("a.json", R"({"sources": [{"ball": {"centre": [0, 0, 0], "radius": 1}, "size": 0.1}]})"),
      plc);
  EXPECT_DOUBLE_EQ(ball({0, 0, 3}), 0.1 + 0.3 * 2);
  const TetMesh mesh = testing::mesh_of(testing::box(), testing::with_size(0.5), 0).result.mesh;
  const SizeField field = io::read_size_field(folder.write("a.msh", msh_text(mesh, "2.2", "a")), plc);
  for (const Point& p : {Point{0.1, 0.2, 0.3}, Point{0.9, 0.5, 0.7}}) EXPECT_NEAR(field(p), linear(p), 1e-9);
}

TEST(ReadSizeField, RecordsTheSourcesThatAskForLess) {
  const testing::TemporaryFolder folder;
  const Plc plc = cylinder();
  const auto use = std::make_shared<SizeFieldUse>(1.0);
  const SizeField both = io::read_size_field(folder.write("a.json", R"({"size": 3, "sources": [
                       {"ball": {"centre": [0, 0, 0], "radius": 1}, "size": 0.1},
                       {"box": {"min": [5, 5, 5], "max": [6, 6, 6]}, "size": 2}]})"),
                                             plc, use);
  both({0, 0, 0});
  EXPECT_EQ(use->without_effect(), (std::vector<std::string>{"sources[1] (box)"}));
  const TetMesh mesh = testing::mesh_of(testing::box(), testing::with_size(0.5), 0).result.mesh;
  const std::string path = folder.write("a.msh", msh_text(mesh, "2.2", "a"));
  for (const double size : {0.9, 1.5}) {  // the field is 1 at the origin and above 1 along x
    const auto of_mesh = std::make_shared<SizeFieldUse>(size);
    const SizeField field = io::read_size_field(path, plc, of_mesh);
    EXPECT_EQ(of_mesh->without_effect(), std::vector<std::string>{"the field"});
    EXPECT_NEAR(field({0.5, 0, 0}), 1.15, 1e-9);
    EXPECT_EQ(of_mesh->without_effect().empty(), size > 1.15);
  }
}

TEST(ReadSizeField, ErrorsNameTheFile) {
  const testing::TemporaryFolder folder;
  const Plc plc = cylinder();
  const auto refused = [&]<class Error>(Error*, const std::string& name, const std::string& content,
                                        const std::string& part) {
    const std::string path = folder.write(name, content);
    testing::expect_error<Error>([&] { io::read_size_field(path, plc); }, path, part);
  };
  OptionError* const option = nullptr;
  ReadError* const read = nullptr;
  refused(option, "a.json", "{", "this is not JSON");
  refused(option, "a.json", R"({"size": 1e999})", "larger than any double");
  refused(option, "a.json", "{}", "asks for no size");
  refused(read, "a.json", std::string(5000, '['), "nested deeper than");
  refused(read, "a.msh", "$Nodes\n", "");
  refused(read, "a.stl", "", "fields on points are read from .vtu and .msh only");
}

}  // namespace
}  // namespace collarmesh::size_field_test
