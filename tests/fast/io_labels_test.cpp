// Labels of groups, and small files of surfaces with segments, holes and regions.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/io/mesh_surface_io.h"
#include "collarmesh/io/soup_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "io/label_names.h"
#include "support/replaced.h"
#include "support/sample_mesh.h"
#include "support/shapes.h"
#include "support/temporary_file.h"

namespace collarmesh::io_labels_test {
namespace {

using namespace testing;

TEST(DistinctNames, AreCutBetweenCharacters) {
  io::DistinctNames names(5);
  EXPECT_EQ(names.add("abcde"), "abcde");
  EXPECT_EQ(names.add("abcdef"), "abc_2") << "the beginning is known";
  EXPECT_EQ(names.add("gr\xc3\xbc\xc3\xbc"), "gr\xc3\xbc") << "the second umlaut has its first byte within";
  EXPECT_EQ(names.add("gr\xc3\xbc"), "gr_2");
  EXPECT_EQ(names.add("x"), "x");
}

TEST(IoSmesh, KeepsSegmentsHolesAndRegionsWithoutSize) {
  PolygonSoup soup = box();
  soup.segments.push_back({0, 7, 12});
  soup.hole_points = {{0.25, 0.5, 0.5}, {0.75, 0.5, 0.5}};
  soup.region_points = {{{0.5, 0.5, 0.5}, 8, 0}, {{0.5, 0.5, 0.25}, 9, 0.125}};
  const TemporaryFolder folder;
  for (const char* name : {"a.smesh", "a.poly"}) {
    io::write_soup(folder.file(name), soup);
    const PolygonSoup again = io::read_soup(folder.file(name));
    EXPECT_EQ(again.points, soup.points);
    EXPECT_EQ(again.facet_count(), soup.facet_count());
    ASSERT_EQ(again.segments.size(), 1U);
    EXPECT_EQ(again.segments[0].a, 0U);
    EXPECT_EQ(again.segments[0].b, 7U);
    EXPECT_EQ(again.segments[0].tag, 12);
    EXPECT_EQ(again.hole_points, soup.hole_points);
    ASSERT_EQ(again.region_points.size(), 2U);
    EXPECT_EQ(again.region_points[0].size, 0);
    EXPECT_NEAR(again.region_points[1].size, 0.125, 1e-12);
    EXPECT_EQ(again.region_points[1].tag, 9);
  }
}

TEST(IoPly, SegmentsAreWrittenAsEdges) {
  PolygonSoup soup = box();
  soup.segments.push_back({0, 7, 0});
  const TemporaryFolder folder;
  io::write_soup(folder.file("a.ply"), soup);
  const PolygonSoup again = io::read_soup(folder.file("a.ply"));
  EXPECT_EQ(again.facet_count(), soup.facet_count());
  ASSERT_EQ(again.segments.size(), 1U);
  EXPECT_EQ(again.segments[0].a, 0U);
  EXPECT_EQ(again.segments[0].b, 7U);
}

TEST(IoMeshSurface, MeshesWithoutTrianglesAreRefused) {
  TetMesh mesh = sample_mesh(1);
  mesh.faces.clear(), mesh.face_tag.clear(), mesh.face_patch.clear(), mesh.face_regions.clear();
  const TemporaryFolder folder;
  io::write_tet_mesh(folder.file("a.msh"), mesh);
  expect_error<ReadError>([&] { io::read_mesh_surface(folder.file("a.msh")); }, folder.file("a.msh"),
                          "expected triangles of a surface");
}

// A triangle of first order beside tets of second order.
TEST(IoMsh, CellsOfTwoOrdersAreRefused) {
  const std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n11\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 .5 0 0\n6 .5 "
      ".5 "
      "0\n7 0 .5 0\n8 0 0 .5\n9 0 .5 .5\n10 .5 0 .5\n11 2 2 2\n$EndNodes\n$Elements\n2\n1 11 2 9 1 1 2 3 4 5 "
      "6 7 8 "
      "9 10\n2 2 2 7 1 1 3 2\n$EndElements\n";
  const TemporaryFolder folder;
  const TetMesh mesh = io::read_tet_mesh(folder.write("a.msh", text));
  EXPECT_EQ(mesh.order(), 2);
  ASSERT_EQ(mesh.face_mid_nodes.size(), 1U);
  for (std::size_t k = 0; k < 3; ++k) {
    const Point &a = mesh.points[mesh.faces[0][k]], &b = mesh.points[mesh.faces[0][(k + 1) % 3]];
    EXPECT_EQ(mesh.points[mesh.face_mid_nodes[0][k]], 0.5 * (a + b));
  }
  const std::string path = folder.write("b.msh", replaced(text, "7 1 1 3 2", "7 1 1 3 11"));
  expect_error<ReadError>([&] { io::read_tet_mesh(path); }, path,
                          "is no face or edge of a cell of second order");
}

}  // namespace
}  // namespace collarmesh::io_labels_test
