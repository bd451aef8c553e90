// Tetrahedral meshes: what is written is read back to the last bit, as far as the format can store it.
#include <gtest/gtest.h>

#include <sys/resource.h>
#include <algorithm>
#include <array>
#include <csignal>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/io/tet_mesh_io.h"
#include "common/thread_limit.h"
#include "support/comma_locale.h"
#include "support/meshes.h"
#include "support/replaced.h"
#include "support/sample_mesh.h"
#include "support/sanitized.h"
#include "support/second_order.h"
#include "support/temporary_file.h"
#include "support/tet_mesh_comparison.h"

namespace collarmesh::io_tet_mesh_test {
namespace {

using testing::CommaLocale;
using testing::expect_error;
using testing::expect_same;
using testing::replaced;
using testing::sample_mesh;
using testing::TemporaryFolder;

TetMesh round_trip(const TetMesh& mesh, const std::string& name) {
  const TemporaryFolder folder;
  io::write_tet_mesh(folder.file(name), mesh);
  EXPECT_EQ(folder.file_count(), 1);
  return io::read_tet_mesh(folder.file(name));
}

/// Returns the mesh as the format can store it: without features, with region numbers as tags.
TetMesh as_medit_keeps_it(TetMesh mesh) {
  mesh.features.clear();
  mesh.tet_tag.assign(mesh.tet_region.begin(), mesh.tet_region.end());
  std::fill(mesh.tet_collar.begin(), mesh.tet_collar.end(), 0);
  std::fill(mesh.tet_crease.begin(), mesh.tet_crease.end(), 0);
  mesh.tet_thin.clear();
  std::fill(mesh.face_patch.begin(), mesh.face_patch.end(), none);
  std::fill(mesh.edge_curve.begin(), mesh.edge_curve.end(), none);
  return mesh;
}

TEST(IoTetMesh, RoundTripOfMsh) {
  const TetMesh mesh = sample_mesh(3);
  expect_same(round_trip(mesh, "a.msh"), mesh);
}

TEST(IoTetMesh, FormatsAreNamedInAnyCase) {
  const TemporaryFolder folder;
  const TetMesh mesh = sample_mesh(3);
  io::write_tet_mesh(folder.file("a"), mesh, ".MSH");
  expect_same(io::read_tet_mesh(folder.file("a"), ".Msh"), mesh);
  EXPECT_TRUE(io::is_tet_mesh_format("a", ".MSH"));
}

TEST(IoTetMesh, RoundTripOfMedit) {
  const TetMesh mesh = sample_mesh(3);
  expect_same(round_trip(mesh, "a.mesh"), as_medit_keeps_it(mesh));
}

TEST(IoTetMesh, RoundTripWithoutFeatures) {
  TetMesh mesh = sample_mesh(2);
  mesh.features.clear();
  std::fill(mesh.face_patch.begin(), mesh.face_patch.end(), none);
  std::fill(mesh.edge_curve.begin(), mesh.edge_curve.end(), none);
  TetMesh by_tag = mesh;  // where features are unknown, regions are numbered by ascending tag
  for (Index& region : by_tag.tet_region) region = 3 - region;
  for (auto& regions : by_tag.face_regions)
    for (Index& region : regions) region = region == 0 ? 0 : 3 - region;
  expect_same(round_trip(mesh, "a.msh"), by_tag);
}

TEST(IoTetMesh, SameBytesWhateverTheLocale) {
  const TetMesh mesh = sample_mesh(2);
  for (const std::string name : {"a.msh", "a.mesh", "a.vtu"}) {
    const TemporaryFolder folder;
    io::write_tet_mesh(folder.file(name), mesh);
    const CommaLocale locale;
    io::write_tet_mesh(folder.file("b" + name), mesh);
    EXPECT_EQ(folder.read(name), folder.read("b" + name));
    EXPECT_EQ(io::read_tet_mesh(folder.file(name)).points, mesh.points);
  }
}

TEST(IoTetMesh, KnowsItsFormats) {
  for (const char* name : {"a.vtu", "b/A.MSH", "a.mesh", "a.INP", "a.ele"})
    EXPECT_TRUE(io::is_tet_mesh_format(name));
  for (const char* name : {"a.off", "a", "mesh", "a.node"}) EXPECT_FALSE(io::is_tet_mesh_format(name));
  expect_error<ReadError>([] { io::read_tet_mesh("a.xyz"); }, "a.xyz", "unknown kind of file");
  expect_error<WriteError>([] { io::write_tet_mesh("a.xyz", {}); }, "a.xyz", "unknown kind of file");
}

// Files of other programs

TetMesh read(const std::string& name, const std::string& content) {
  const TemporaryFolder folder;
  return io::read_tet_mesh(folder.write(name, content));
}

void expect_refused(const std::string& name, const std::string& content, const std::string& part) {
  SCOPED_TRACE(content.substr(0, 2000));
  const TemporaryFolder folder;
  const std::string path = folder.write(name, content);
  expect_error<ReadError>([&] { io::read_tet_mesh(path); }, path, part);
}

/// Expects two tets, the second one inverted in the file; the triangle between them, and one on the outside
/// that points inwards.
void expect_two_tets(const TetMesh& mesh) {
  ASSERT_EQ(mesh.points.size(), 5);
  ASSERT_EQ(mesh.tets.size(), 2);
  for (const auto& [a, b, c, d] : mesh.tets)
    EXPECT_GT(six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]), 0);
  EXPECT_EQ(mesh.tet_region, (std::vector<Index>{2, 1}));
  EXPECT_EQ(mesh.tet_tag, (std::vector<Tag>{9, 4}));
  ASSERT_EQ(mesh.faces.size(), 2);
  EXPECT_EQ(mesh.face_tag, (std::vector<Tag>{70, 80}));
  EXPECT_EQ(mesh.face_regions[0], (std::array<Index, 2>{2, 1}));
  EXPECT_EQ(mesh.face_regions[1], (std::array<Index, 2>{2, 0}));
  EXPECT_EQ(mesh.faces[1], (std::array<Index, 3>{0, 2, 1}));
  EXPECT_EQ(mesh.face_patch, (std::vector<Index>{none, none}));
  ASSERT_EQ(mesh.edges.size(), 1);
  EXPECT_EQ(mesh.edge_tag, (std::vector<Tag>{5}));
  EXPECT_TRUE(mesh.features.empty());
}

const std::string medit =
    "MeshVersionFormatted 1\nDimension\n3\n# comment\nVertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n1 1 1 "
    "1\n"
    "RequiredVertices\n2\n1\n2\nTriangles 2\n2 3 4 70\n1 2 3 80\n\nNormals\n1\n0 0 1e0\n"
    "Edges\n1\n1 2 5\nTetrahedra\n2\n1 2 3 4 9\n2 3 4 5 4\nEnd\n";

TEST(IoMedit, ReadsOthers) {
  expect_two_tets(read("a.mesh", medit));
  expect_two_tets(read("a.mesh", medit.substr(0, medit.find("End"))));
}

TEST(IoMedit, RefusesBadFiles) {
  expect_refused("a.mesh", "", "line 1: ");
  expect_refused("a.mesh", "garbage", "line 1: expected MeshVersionFormatted");
  expect_refused("a.mesh", replaced(medit, "Dimension\n3", "Dimension\n2"), "line 3: the dimension is 2");
  expect_refused("a.mesh", replaced(medit, "Vertices\n5", "Vertices\n2000000000"),
                 "line 6: the number of vertices is 2000000000");
  expect_refused("a.mesh", replaced(medit, "Vertices\n5", "Vertices\n6"), "line 12: expected a coordinate");
  expect_refused("a.mesh", replaced(medit, "Vertices\n5", "Vertices\n4"), "line 11: expected a keyword");
  expect_refused("a.mesh", replaced(medit, "1 0 0 1", "nan 0 0 1"), "line 8: expected a coordinate");
  expect_refused("a.mesh", replaced(medit, "1 2 3 4 9", "1 2 3 6 9"), "line 28: a corner is 6");
  expect_refused("a.mesh", replaced(medit, "1 2 3 4 9", "0 2 3 4 9"), "line 28: a corner is 0");
  expect_refused("a.mesh", replaced(medit, "Tetrahedra\n2", "Tetrahedra\n3"), "line 27: ");
  expect_refused("a.mesh", replaced(medit, "Tetrahedra\n2", "Tetrahedra\n2000000000"), "line 27: ");
  expect_refused("a.mesh", replaced(medit, "Normals\n1\n0 0 1e0", "Hexahedra\n1\n1 2 3 4 5 1 2 3 0"),
                 "line 21: Hexahedra");
  expect_refused("a.mesh", medit.substr(0, medit.find("5 4\nEnd")), "line 27: ");
  expect_refused("a.mesh", medit.substr(0, medit.find("Tetrahedra")), "expected tetrahedra, found none");
}

const std::string msh_41 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 9 \"lower part\"\n2 70 \"patch "
    "70\"\n$EndPhysicalNames\n"
    "$Entities\n1 1 2 2\n1 0 0 0 0\n3 0 0 0 1 0 0 1 5 0\n1 0 0 0 1 1 1 1 70 0\n2 0 0 0 1 1 0 1 80 0\n"
    "1 0 0 0 1 1 1 1 9 0\n4 0 0 0 1 1 1 0 0\n$EndEntities\n"
    "$Nodes\n2 5 3 70\n2 1 0 2\n30\n3\n0 1 0\n0 0 0\n3 1 1 3\n5\n70\n40\n1 0 0 .5 .5 .5\n1 1 1 .5 .5 .5\n0 0 "
    "1 .5 .5 .5\n"
    "$EndNodes\n"
    "$Elements\n6 6 1 100\n0 1 15 1\n100 3\n1 3 1 1\n1 3 5\n2 1 2 1\n2 5 30 40\n2 2 2 1\n3 3 5 30\n3 4 4 "
    "1\n11 5 30 40 70\n"
    "3 1 4 1\n10 3 5 30 40\n$EndElements\n$Unknown\nanything\n$EndUnknown\n";

const std::string msh_22 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 "
    "1\n$EndNodes\n"
    "$Elements\n6\n1 15 2 0 1 1\n2 1 2 5 1 1 2\n3 2 2 70 1 2 3 4\n4 2 2 80 2 1 2 3\n5 4 2 9 1 1 2 3 4\n6 4 3 "
    "0 4 1 2 3 4 5\n"
    "$EndElements\n";

TEST(IoMsh, ReadsOthers) {
  expect_two_tets(read("a.msh", msh_22));
  // Nodes are given in the order of their numbers 3, 5, 30, 40, 70.
  expect_two_tets(read("a.msh", msh_41));
}

TEST(IoMsh, RefusesBadFiles) {
  expect_refused("a.msh", "", "line 1: expected $MeshFormat");
  expect_refused("a.msh", "garbage", "line 1: expected a section");
  expect_refused("a.msh", "$Nodes\n$EndNodes\n", "line 2: expected $MeshFormat first");
  expect_refused("a.msh", replaced(msh_41, "4.1 0 8", "3 0 8"), "line 2: version 3 is not supported");
  expect_refused("a.msh", replaced(msh_41, "4.1 0 8", "4.1 0 4"), "line 2: numbers of 4 bytes");
  expect_refused("a.msh", replaced(msh_41, "$Entities\n1 1 2 2", "$Entities\n1 1 2 2000000000"), "line 10: ");
  expect_refused("a.msh", replaced(msh_41, "2 5 3 70", "2 2000000000 3 70"),
                 "line 19: the number of nodes is 2000000000");
  expect_refused("a.msh", replaced(msh_41, "2 5 3 70", "2 6 3 70"), "expected 6 nodes, found 5");
  expect_refused("a.msh", replaced(msh_41, "2 1 0 2\n", "2 1 0 2000000000\n"), "line 20: ");
  expect_refused("a.msh", replaced(msh_41, "2 1 0 2\n", "7 1 0 2\n"),
                 "line 20: the dimension of an entity is 7");
  expect_refused("a.msh", replaced(msh_41, "\n5\n70\n", "\n5\n30\n"), "two nodes have the number 30");
  expect_refused("a.msh", replaced(msh_41, "1 1 1 .5", "inf 1 1 .5"), "line 30: ");
  expect_refused("a.msh", replaced(msh_41, "6 6 1 100", "6 7 1 100"), "expected 7 elements, found 6");
  expect_refused("a.msh", replaced(msh_41, "6 6 1 100", "2000000000 6 1 100"), "line 34: ");
  expect_refused("a.msh", replaced(msh_41, "10 3 5 30 40", "10 3 5 30 41"),
                 "line 46: an element has the node 41");
  expect_refused("a.msh", replaced(msh_41, "3 1 4 1\n", "3 1 5 1\n"), "line 45: elements of type 5");
  expect_refused("a.msh", msh_41.substr(0, msh_41.find("$EndElements")),
                 "line 33: the section '$Elements' has no '$EndElements'");
  expect_refused("a.msh", replaced(msh_22, "5 4 2 9 1 1 2 3 4", "5 4 2 9 1 1 2 3"), "line ");
  expect_refused("a.msh", replaced(msh_22, "4 0 0 1", "4 0 0 x"), "line 9: ");
  expect_refused("a.msh", msh_22.substr(0, msh_22.find("$Elements")), "expected tetrahedra, found none");
}

TEST(IoTetMesh, SurvivesDamage) {
  const TemporaryFolder folder;
  io::write_tet_mesh(folder.file("ours.msh"), sample_mesh(1));
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.mesh", medit}, {"a.msh", msh_41}, {"b.msh", msh_22}, {"c.msh", folder.read("ours.msh")}};
  std::mt19937 random(5);
  for (const auto& [name, content] : files)
    for (int round = 0; round < 150; ++round) {
      std::string damaged = content.substr(0, round % 5 == 0 ? random() % content.size() : content.size());
      for (unsigned k = 0; k < 1 + random() % 3 && !damaged.empty(); ++k)
        damaged[random() % damaged.size()] = "0123456789-\n $.e"[random() % 16];
      try {
        const TetMesh mesh = io::read_tet_mesh(folder.write(name, damaged));
        for (const auto& tet : mesh.tets)
          for (const Index v : tet) ASSERT_LT(v, mesh.points.size());
      } catch (const ReadError&) {
      }
    }
}

// Writing

TEST(IoWrite, ReplacesAFileOrLeavesIt) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.mesh", "before");
  io::write_tet_mesh(path, sample_mesh(1));
  EXPECT_EQ(folder.file_count(), 1);
  EXPECT_TRUE(folder.read("a.mesh").starts_with("# Written by collarmesh."));
}

TEST(IoWrite, NamesTheReasonOfTheSystem) {
  const TemporaryFolder folder;
  const std::string path = folder.file("missing/a.vtu");
  expect_error<WriteError>([&] { io::write_tet_mesh(path, sample_mesh(1)); }, path,
                           "No such file or directory");
  std::filesystem::create_directory(folder.file("b.msh"));
  std::ofstream(folder.file("b.msh/x")) << "in the way";
  expect_error<WriteError>([&] { io::write_tet_mesh(folder.file("b.msh"), sample_mesh(1)); },
                           folder.file("b.msh"), "cannot be written: ");
  EXPECT_EQ(folder.file_count(), 1);
}

/// A limit on the file's size stands for a full disk.
TEST(IoWrite, LeavesNothingWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  const TetMesh mesh = sample_mesh(4);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  for (const std::string name : {"a.vtu", "a.msh", "a.mesh"})
    expect_error<WriteError>([&] { io::write_tet_mesh(folder.file(name), mesh); }, folder.file(name),
                             "cannot be written: File too large");
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(folder.file_count(), 0);
}

TEST(IoWrite, FormatsWithoutPlaceForGhostCellsAreNamed) {
  const TemporaryFolder folder;
  TetMesh mesh = sample_mesh(1);
  mesh.tet_partition.assign(mesh.tets.size(), 0);
  mesh.tet_partition.back() = 1;
  const std::vector<std::string> able = io::formats_with_ghost_cells();
  for (const std::string& format : io::written_tet_mesh_formats()) {
    const std::string path = folder.file("a" + format);
    if (std::count(able.begin(), able.end(), format) > 0)
      EXPECT_NO_THROW(io::write_tet_mesh(path, mesh, {}, GhostCells::one_layer)) << format;
    else
      expect_error<WriteError>([&] { io::write_tet_mesh(path, mesh, {}, GhostCells::one_layer); }, path,
                               "has no place for ghost cells");
  }
  EXPECT_EQ(io::formats_of_first_order(), (std::vector<std::string>{".su2", ".polymesh"}));
}

/// MFEM numbers the nodes of edges in the order ab, ac, ad, bc, bd, cd, element by element.
TEST(IoMfem, NodesOfSecondOrderFollowTheCorners) {
  const TemporaryFolder folder;
  const TetMesh mesh = testing::second_order(sample_mesh(1));
  io::write_tet_mesh(folder.file("a.mfem"), mesh);
  const std::string text = folder.read("a.mfem");
  std::istringstream elements(text.substr(text.find("\nelements\n") + 10)),
      nodes(text.substr(text.find("Ordering: 1\n") + 12)),
      vertices(text.substr(text.find("\nvertices\n") + 10));
  std::size_t tets = 0, corners = 0;
  elements >> tets;
  vertices >> corners;
  ASSERT_EQ(tets, mesh.tets.size());
  std::vector<Point> points;
  for (Point p; nodes >> p.x >> p.y >> p.z;) points.push_back(p);
  ASSERT_EQ(points.size(), mesh.points.size());
  std::set<std::pair<std::size_t, std::size_t>> known;
  for (std::size_t t = 0; t < tets; ++t) {
    std::size_t attribute = 0, geometry = 0;
    std::array<std::size_t, 4> tet;
    elements >> attribute >> geometry >> tet[0] >> tet[1] >> tet[2] >> tet[3];
    EXPECT_EQ(geometry, 4U);
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        if (known.insert(std::minmax(tet[i], tet[j])).second) {
          EXPECT_LT(distance(points[corners + known.size() - 1], 0.5 * (points[tet[i]] + points[tet[j]])),
                    1e-12);
        }
  }
  EXPECT_EQ(corners + known.size(), points.size());
}

// The mesh has so many cells that each thread writes several blocks of them; with sanitizers, some blocks.
TEST(IoTetMesh, AnyNumberOfThreadsWritesTheSame) {
  const testing::TemporaryFolder folder;
  const TetMesh mesh = testing::meshed_box(testing::sanitized ? 13 : 20).mesh;
  for (const char* extension : {".vtu", ".vtk", ".msh", ".msh2", ".mesh", ".ele", ".inp", ".unv"}) {
    SCOPED_TRACE(extension);
    for (const unsigned threads : {1U, 2U, 8U})
      ThreadLimit(threads).run(
          [&] { io::write_tet_mesh(folder.file(std::to_string(threads) + extension), mesh); });
    for (const char* part : {extension, extension == std::string(".ele") ? ".node" : extension}) {
      const std::string by_one = folder.read(std::string("1") + part);
      EXPECT_GT(by_one.size(), 100000U);
      EXPECT_TRUE(by_one == folder.read(std::string("2") + part));
      EXPECT_TRUE(by_one == folder.read(std::string("8") + part));
    }
  }
}

}  // namespace
}  // namespace collarmesh::io_tet_mesh_test
