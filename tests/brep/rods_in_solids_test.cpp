// Thin wires and rings in CAD solids get sheaths; their vertices move onto the exact shapes.
#include <gtest/gtest.h>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <STEPControl_Writer.hxx>
#include <gp_Ax2.hxx>

#include <algorithm>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "collarmesh/mesh_files.h"
#include "shapes.h"
#include "support/temporary_file.h"

namespace collarmesh::testing::rods_in_solids_test {
namespace {

constexpr double radius = 0.05, large_radius = 1.5;

TopoDS_Shape wire_in_block() {
  const gp_Pnt centre(2, 2, 0);
  return compound({BRepPrimAPI_MakeCylinder(gp_Ax2(centre, gp::DZ()), radius, 2).Shape(),
                   BRepPrimAPI_MakeBox(4, 4, 2).Shape()});
}
TopoDS_Shape ring_in_block() {
  const gp_Pnt centre(2.5, 2.5, 2.5);
  return compound({BRepPrimAPI_MakeTorus(gp_Ax2(centre, gp::DZ()), large_radius, radius).Shape(),
                   BRepPrimAPI_MakeBox(5, 5, 5).Shape()});
}

/// Meshes a shape in a STEP file, with elements of this order. Expects a rod of this volume.
void expect_good(const TopoDS_Shape& shape, unsigned order, double volume) {
  const TemporaryFolder folder;
  const std::string path = folder.file("part.step");
  STEPControl_Writer writer;
  ASSERT_EQ(writer.Transfer(shape, STEPControl_AsIs), IFSelect_RetDone);
  ASSERT_EQ(writer.Write(path.c_str()), IFSelect_RetDone);
  RunOptions options;
  options.mesh.size = 1;
  options.order = order;
  const FilesResult made = mesh_files({path}, options);
  EXPECT_EQ(made.missed(), "");
  EXPECT_TRUE(std::ranges::any_of(made.check.notes, [](const std::string& note) {
    return note.find("in and around rods") != std::string::npos;
  }));
  ASSERT_EQ(made.check.of_mesh.volumes.size(), 3U);
  EXPECT_NEAR(made.check.of_mesh.volumes[1], volume, (order == 1 ? 0.02 : 0.01) * volume);
  const std::vector<Tag>& tags = made.result.mesh.tet_tag;
  EXPECT_EQ(std::set<Tag>(tags.begin(), tags.end()), (std::set<Tag>{1, 2}));
}

TEST(RodsInSolids, MayBeWires) {
  constexpr double volume = std::numbers::pi * radius * radius * 2;
  for (const unsigned order : {1U, 2U}) expect_good(wire_in_block(), order, volume);
}

TEST(RodsInSolids, MayBeRings) {
  constexpr double volume = 2 * std::numbers::pi * std::numbers::pi * radius * radius * large_radius;
  expect_good(ring_in_block(), 2, volume);
}

}  // namespace
}  // namespace collarmesh::testing::rods_in_solids_test
