// Files of .inp, .vtk, .unv, .ele and binary .msh, as other programs write them and as nobody should: reading
// gives the right mesh, or an error with the line or byte.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/io/soup_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "support/replaced.h"
#include "support/sample_mesh.h"
#include "support/second_order.h"
#include "support/temporary_file.h"
#include "support/tet_mesh_comparison.h"

namespace collarmesh::io_hostile_test {
namespace {

using testing::expect_error;
using testing::expect_same;
using testing::replaced;
using testing::sample_mesh;
using testing::second_order;
using testing::TemporaryFolder;

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

// .inp

const std::string inp =
    "*HEADING\nanything, goes\n** comment\n*Node\n 10, 0, 0, 0\n20, 1., 0.\n30, 0, 1.D0, 0\n40, 0, 0, 1\n50, "
    "1, 1, "
    "1\n*ELEMENT, type=C3D4, ELSET=Part\n1, 10, 20, 30, 40\n2, 20, 30,\n40, 50\n*Element, TYPE=S3\n7, 10, "
    "20, 30\n"
    "*ELSET, ELSET=Upper\n2,\n*elset, elset=Both, generate\n1, 2, 1\n*SURFACE, NAME=Bottom, TYPE=ELEMENT\n1, "
    "S1\nUpper, S3\n*SURFACE, TYPE=NODE, NAME=x\n10,\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., "
    ".3\n*STEP\n*END STEP\n";

TEST(IoAbaqus, ReadsOthers) {
  const TetMesh mesh = read("a.inp", inp);
  EXPECT_EQ(mesh.points.size(), 5);
  EXPECT_EQ(mesh.points[2], (Point{0, 1, 0}));
  ASSERT_EQ(mesh.tets.size(), 2);
  EXPECT_EQ(mesh.tet_tag, (std::vector<Tag>{2, 1})) << "Upper comes first, then Both";
  EXPECT_EQ(mesh.faces.size(), 3) << "a shell and two sides of a surface";
  EXPECT_EQ(mesh.face_tag[0], 0);
  EXPECT_EQ(mesh.face_tag[1], mesh.face_tag[2]);
}

TEST(IoAbaqus, RefusesBadFiles) {
  expect_refused("a.inp", "", "line 1: expected tetrahedra");
  expect_refused("a.inp", "garbage", "line 1: expected a keyword such as *NODE");
  expect_refused("a.inp", replaced(inp, "20, 1., 0.", "20, nan, 0."), "line 6: expected a coordinate");
  expect_refused("a.inp", replaced(inp, "20, 1., 0.", "10, 1., 0."), "two nodes have the number 10");
  expect_refused("a.inp", replaced(inp, "1, 10, 20, 30, 40", "1, 10, 20, 30, 41"),
                 "line 11: element 1 has the node 41");
  expect_refused("a.inp", replaced(inp, "40, 50\n", "40\n"),
                 "line 14: expected an element of 4 nodes, found 3");
  expect_refused("a.inp", replaced(inp, "C3D4", "C3D20"),
                 "line 11: elements of type 'c3d20' are not supported");
  expect_refused("a.inp", replaced(inp, "C3D4", "C3D8"), "line 13: element 1 has the node 2, but");
  expect_refused("a.inp", replaced(inp, "7, 10", "1, 10"), "two elements have the number 1");
  expect_refused("a.inp", replaced(inp, "1, 2, 1", "1, 2000000000, 1"),
                 "line 19: the range from 1 to 2000000000");
  expect_refused("a.inp", replaced(inp, "Upper, S3", "Lower, S3"),
                 "line 22: no earlier element set has the name");
  expect_refused("a.inp", replaced(inp, "*STEP", "*INCLUDE, INPUT=x"), "*INCLUDE is not supported");
}

TEST(IoAbaqus, ReadsRangeUpToTheLargestNumber) {
  const std::string largest = "9223372036854775807";
  const TetMesh mesh = read("a.inp", replaced(inp, "1, 2, 1\n", largest + ", " + largest + ", 1\n"));
  EXPECT_EQ(mesh.tet_tag, (std::vector<Tag>{2, 1})) << "the set has no element that is there";
}

/// Each range and each name is short, but stands for all elements.
TEST(IoAbaqus, RefusesSetsThatGrowWithoutBound) {
  std::string ranges, names, sides;
  for (int i = 0; i < 200; ++i) {
    ranges += "1, 2, 1\n";
    names += "*ELSET, ELSET=set" + std::to_string(i) + "\nPart,\n";
    sides += "*SURFACE, NAME=surface" + std::to_string(i) + "\nPart, S1\n";
  }
  const std::string part = "have more than 64 times as many members as there are elements";
  expect_refused("a.inp", replaced(inp, "1, 2, 1\n", ranges), part);
  expect_refused("a.inp", replaced(inp, "*STEP\n", names + "*STEP\n"), part);
  expect_refused("a.inp", replaced(inp, "*STEP\n", sides + "*STEP\n"), part);
}

// .vtk

const std::string vtk =
    "# vtk DataFile Version 2.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 0 1 "
    "0\n0 0 1 1 "
    "1 1\nCELLS 3 14\n4 0 1 2 3\n4 1 2 3 4\n3 0 1 2\n\nCELL_TYPES 3\n10\n10\n5\nCELL_DATA 3\nSCALARS "
    "CellEntityIds int "
    "1\nLOOKUP_TABLE default\n7\n8\n9\nVECTORS v double\n1 2 3 4 5 6 7 8 9\nPOINT_DATA 5\nSCALARS s "
    "float\nLOOKUP_TABLE "
    "default\n1 2 3 4 5\n";

TEST(IoVtk, ReadsOthers) {
  const TetMesh mesh = read("a.vtk", vtk);
  EXPECT_EQ(mesh.points.size(), 5);
  EXPECT_EQ(mesh.tet_tag, (std::vector<Tag>{7, 8}));
  EXPECT_EQ(mesh.face_tag, (std::vector<Tag>{9}));
  const std::string version_5 =
      replaced(replaced(vtk, "Version 2.0", "Version 5.1"), "CELLS 3 14\n4 0 1 2 3\n4 1 2 3 4\n3 0 1 2\n",
               "METADATA\nINFORMATION 0\n\nCELLS 4 11\nOFFSETS vtktypeint64\n0 4 8 11\nCONNECTIVITY "
               "vtktypeint64\n0 1 2 3 1 "
               "2 3 4 0 1 2\n");
  expect_same(read("a.vtk", version_5), mesh);
}

/// Arrays that are no tags are skipped, by the length that each kind has.
TEST(IoVtk, SkipsOtherAttributes) {
  const std::string nine = "1 2 3 4 5 6 7 8 9\n",
                    kinds = "TENSORS t double\n" + nine + nine + nine + "TENSORS6 s float\n" + nine + nine +
                            "GLOBAL_IDS g vtkIdType\n1 2 3\nPEDIGREE_IDS p int\n4 5 6\n"
                            "TEXTURE_COORDINATES x 2 float\n1 2 3 4 5 6\nCOLOR_SCALARS c 4\n0 0 0 1 0 0 0 1 "
                            "1 1 1 1\nSCALARS more int 1\nLOOKUP_TABLE mine\n1 2 3\nLOOKUP_TABLE mine 2\n0 0 "
                            "0 1 1 1 1 1\nFIELD f 2\nMETADATA\nINFORMATION 0\n\nfirst 1 3 int\n1 2 3\n"
                            "METADATA\nINFORMATION 0\n\nsecond 1 3 int\n4 5 6\n";
  const TetMesh mesh = read("a.vtk", replaced(vtk, "VECTORS v", kinds + "VECTORS v"));
  expect_same(mesh, read("a.vtk", vtk));
  expect_refused("a.vtk", replaced(vtk, "VECTORS v", replaced(kinds, "x 2 float", "x 9 float") + "VECTORS v"),
                 "expected a ");
  expect_refused("a.vtk", replaced(vtk, "SCALARS CellEntityIds int", "SCALARS CellEntityIds double 100"),
                 "do not fit into the");
  expect_refused("a.vtk",
                 replaced(replaced(vtk, "CellEntityIds int", "CellEntityIds double"), "7\n8\n", "1e30\n8\n"),
                 "the value 1e+30 is not a number, or too large");
}

TEST(IoVtk, RefusesBadFiles) {
  expect_refused("a.vtk", "", "line 1: expected '# vtk DataFile Version'");
  expect_refused("a.vtk", replaced(vtk, "ASCII", "BASE64"), "line 3: expected ASCII or BINARY");
  expect_refused("a.vtk", replaced(vtk, "UNSTRUCTURED_GRID", "POLYDATA"),
                 "line 4: the dataset is 'polydata'");
  expect_refused("a.vtk", replaced(vtk, "POINTS 5", "POINTS 2000000000"),
                 "line 5: the number of points is 2000000000");
  expect_refused("a.vtk", replaced(vtk, "1 0 0 0 1 0", "1 0 nan 0 1 0"),
                 "point 1, (1, 0, nan), is not finite");
  expect_refused("a.vtk", replaced(vtk, "CELLS 3 14", "CELLS 3 2000000000"),
                 "line 8: the size of the cells is 2000000000");
  expect_refused("a.vtk", replaced(vtk, "4 1 2 3 4", "9 1 2 3 4"), "cell 1 of 3 reaches beyond");
  expect_refused("a.vtk", replaced(vtk, "4 1 2 3 4", "4 1 2 3 5"), "cell 1 has the corner 5");
  expect_refused("a.vtk", replaced(vtk, "10\n10\n5", "10\n12\n5"), "cell 1 has the type 12");
  expect_refused("a.vtk", replaced(vtk, "CELL_TYPES 3\n10\n", "CELL_TYPES 2\n"),
                 "expected the types of 3 cells");
  expect_refused("a.vtk", replaced(vtk, "CELL_DATA 3", "CELL_DATA 4"),
                 "expected data for 3 points or cells, found data for 4");
  expect_refused("a.vtk", replaced(vtk, "VECTORS", "WRECKERS"), "expected a section");
  expect_refused("a.vtk", vtk.substr(0, vtk.find("CELLS")), "expected tetrahedra, found none");
  const TemporaryFolder folder;
  io::write_tet_mesh(folder.file("b.vtk"), sample_mesh(1));
  const std::string binary = folder.read("b.vtk");
  expect_refused("a.vtk", binary.substr(0, 200), "byte ");
  expect_refused("a.vtk", replaced(binary, "POINTS 12", "POINTS 2000000000"),
                 "the number of points is 2000000000");
}

/// Cells after the data of other cells would have no data.
TEST(IoVtk, RefusesSectionsAfterTheirData) {
  const std::string more_cells =
      "CELLS 4 19\n4 0 1 2 3\n4 1 2 3 4\n4 0 1 2 3\n3 0 1 2\nCELL_TYPES 4\n10\n10\n10\n5\n";
  expect_refused("a.vtk", vtk + more_cells, "CELLS come after their data");
  const std::string features =
                        "FIELD x 2\nfeature_dimension 1 5 int\n3 3 3 3 3\nfeature 1 5 int\n1 1 1 1 1\n",
                    more_points = "POINTS 6 float\n0 0 0 1 0 0 0 1 0 0 0 1 1 1 1 2 2 2\n";
  EXPECT_EQ(read("a.vtk", vtk + features).features.size(), 5);
  expect_refused("a.vtk", vtk + features + more_points, "POINTS come after their data");
}

// .vtu

/// Makes pieces of some points and one tet that share their arrays.
std::string vtu_of_shared_pieces(std::size_t pieces, std::size_t points) {
  const std::string counts = "NumberOfPoints=\"" + std::to_string(points) + "\" NumberOfCells=\"1\"",
                    piece =
                        "<Piece " + counts +
                        "><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"appended\" "
                        "offset=\"0\"/></Points><Cells><DataArray type=\"Int8\" Name=\"connectivity\">0 1 2 "
                        "3</DataArray><DataArray type=\"Int8\" Name=\"offsets\">4</DataArray><DataArray "
                        "type=\"Int8\" Name=\"types\">10</DataArray></Cells></Piece>";
  std::string text = "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>";
  for (std::size_t i = 0; i < pieces; ++i) text += piece;
  const auto size = std::bit_cast<std::array<char, 4>>(static_cast<std::uint32_t>(12 * points));
  return text + "</UnstructuredGrid><AppendedData encoding=\"raw\">_" +
         std::string(size.data(), size.size()) + std::string(12 * points, '\0') + "</AppendedData></VTKFile>";
}

TEST(IoVtu, RefusesPiecesThatShareTheirBytes) {
  EXPECT_EQ(read("a.vtu", vtu_of_shared_pieces(1, 1000)).points.size(), 1000);
  expect_refused("a.vtu", vtu_of_shared_pieces(20, 1000),
                 "together the arrays hold more bytes than the file");
}

// .msh

TEST(IoMsh, RefusesNodesAfterElements) {
  const std::string nodes = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n",
                    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + nodes +
                           "$Elements\n1\n1 4 2 -2147483648 1 1 2 3 4\n$EndElements\n";
  EXPECT_EQ(read("a.msh", text).tet_tag, (std::vector<Tag>{2147483648}));
  expect_refused("a.msh", text + "$Nodes\n1\n0 5 5 5\n$EndNodes\n", "the nodes come after elements");
}

/// Numbers too large for an int, and the largest int.
TEST(IoHostile, HugeNumbersOfRegionsAndFeatures) {
  for (const Index huge : {Index{2147483647}, Index{4294967294}})
    for (const std::string& format : io::read_tet_mesh_formats()) {
      SCOPED_TRACE(format);
      TetMesh mesh = sample_mesh(1);
      mesh.tet_region[0] = huge;
      mesh.face_patch[0] = huge;
      mesh.edge_curve[0] = huge;
      const TemporaryFolder folder;
      io::write_tet_mesh(folder.file("a.vtu"), mesh);
      const TetMesh numbered = io::read_tet_mesh(folder.file("a.vtu"));
      EXPECT_EQ(*std::max_element(numbered.tet_region.begin(), numbered.tet_region.end()), 2) << "by tag";
      const std::string path = folder.file("b" + format);
      io::write_tet_mesh(path, numbered);
      const TetMesh again = io::read_tet_mesh(path);
      EXPECT_EQ(again.tets.size(), mesh.tets.size());
      EXPECT_EQ(again.points.size(), mesh.points.size());
    }
}

// .unv

std::string sample_file(const std::string& name, const TetMesh& mesh) {
  const TemporaryFolder folder;
  io::write_tet_mesh(folder.file(name), mesh);
  return folder.read(name);
}

/// I-DEAS has two lines for a rod; SALOME and FreeCAD write three, as for a beam.
TEST(IoUnv, RodsWithAndWithoutTheRecordOfBeams) {
  const TetMesh mesh = sample_mesh(1);
  const std::string record = "         0         1         1\n", beam = "        21", rod = "        11";
  std::string text = sample_file("a.unv", mesh);
  std::size_t rods = 0;
  for (std::size_t at = text.find("\n" + record); at != std::string::npos;
       at = text.find("\n" + record, at + 1), ++rods) {
    const std::size_t line = text.rfind('\n', at - 1) + 1;
    ASSERT_EQ(text.substr(line + 10, 10), beam);
    text.replace(line + 10, 10, rod);
  }
  ASSERT_EQ(rods, mesh.edges.size());
  EXPECT_EQ(read("a.unv", text).edges, mesh.edges);
  for (std::size_t at = text.find(record); at != std::string::npos; at = text.find(record))
    text.erase(at, record.size());
  EXPECT_EQ(read("a.unv", text).edges, mesh.edges);
}

TEST(IoUnv, RefusesBadFiles) {
  const std::string unv = sample_file("a.unv", sample_mesh(1));
  expect_refused("a.unv", "", "line 1: expected -1");
  expect_refused("a.unv", "garbage", "line 1: expected -1");
  expect_refused("a.unv", replaced(unv, "0.0000000000000000D+00", "                   nan"),
                 "line 4: expected a coordinate");
  expect_refused("a.unv", replaced(unv, "  2411", "  2400"), "an element has the node 1");
  expect_refused("a.unv", replaced(unv, "       111", "       115"), "elements of type 115 with 4 nodes");
  expect_refused("a.unv", unv.substr(0, unv.find("  2412")), "expected the number of a dataset");
  expect_refused("a.unv", replaced(unv, "\n         2         1", "\n         1         1"),
                 "two nodes have the number 1");
  const std::size_t groups = unv.find("  2467\n") + 7;
  expect_refused("a.unv", std::string(unv).replace(groups + 70, 10, " 200000000"),
                 "the number of members is 200000000");
}

TEST(IoUnv, RefusesDatasetsThatDoNotEndAndElementsThatOccurTwice) {
  const std::string unv = sample_file("a.unv", sample_mesh(1)), end = "    -1\n";
  const std::size_t second = unv.find(end, unv.find("  2411"));
  ASSERT_NE(second, std::string::npos);
  const std::size_t again = unv.find(end, second + end.size());
  ASSERT_NE(again, std::string::npos);
  expect_refused("a.unv", std::string(unv).replace(again, end.size(), "    -7\n"),
                 "expected -1, the beginning");
  const std::string empty = "    -1\n  2411\n    -1\n";
  expect_refused("a.unv", empty, "expected tetrahedra (111, 118), found none");
}

// .ele

TEST(IoTetgenMesh, RefusesBadFiles) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.ele");
  expect_error<ReadError>([&] { io::read_tet_mesh(path); }, folder.file("a.node"), "No such file");
  folder.write("a.node", "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 1\n");
  expect_error<ReadError>([&] { io::read_tet_mesh(path); }, path, "No such file");
  const auto refused = [&](const std::string& content, const std::string& part) {
    folder.write("a.ele", content);
    expect_error<ReadError>([&] { io::read_tet_mesh(path); }, path, part);
  };
  refused("", "line 1: ");
  refused("0 4 0\n", "expected tetrahedra, found none");
  refused("2000000000 4 0\n0 0 1 2 3\n", "line 1: the number of cells is 2000000000");
  refused("1 5 0\n0 0 1 2 3 4\n", "line 1: tetrahedra have 5 nodes");
  refused("1 4 0\n0 0 1 2 5\n", "line 2: a corner is 5");
  refused("1 4 1\n0 0 1 2 3 nan\n", "line 2: expected a marker or attribute");
  folder.write("a.ele", "1 4 1\n0 0 1 2 3 17.0\n");
  EXPECT_EQ(io::read_tet_mesh(path).tet_tag, (std::vector<Tag>{17}));
  folder.write("a.face", "1 1\n0 0 1 9 5\n");
  expect_error<ReadError>([&] { io::read_tet_mesh(path); }, folder.file("a.face"), "line 2: a corner is 9");
}

// All

const std::vector<std::string> text_formats{".msh", ".mesh", ".inp", ".unv"};

TEST(IoHostile, MixedLineEnds) {
  for (const std::string& format : text_formats) {
    SCOPED_TRACE(format);
    const std::string text = sample_file("a" + format, sample_mesh(1));
    std::string mixed;
    bool carriage = false;
    for (const char c : text) {
      if (c == '\n' && (carriage = !carriage)) mixed += '\r';
      mixed += c;
    }
    expect_same(read("a" + format, mixed), read("a" + format, text));
  }
}

TEST(IoHostile, CommentsEverywhere) {
  for (const auto& [format, comment] : {std::pair{".mesh", "\n# 1 2 3\n"}, {".inp", "\n** 1, 2, 3\n\n"}}) {
    SCOPED_TRACE(format);
    const std::string text = sample_file(std::string("a") + format, sample_mesh(1));
    std::string commented;
    for (const char c : text) commented += c == '\n' ? std::string(comment) : std::string(1, c);
    TetMesh mesh = read(std::string("a") + format, commented);
    const TetMesh wanted = read(std::string("a") + format, text);
    EXPECT_EQ(mesh.tets, wanted.tets);
    EXPECT_EQ(mesh.tet_tag, wanted.tet_tag);
    EXPECT_EQ(mesh.face_tag, wanted.face_tag);
  }
}

TEST(IoHostile, MixedOrdersAreRefused) {
  const std::string second = sample_file("a.mesh", second_order(sample_mesh(1)));
  expect_refused("a.mesh", replaced(second, "\nEnd", "\nTetrahedra\n1\n1 2 3 4 5\nEnd"),
                 "cells of first and second order are mixed");
}

/// Any truncated or damaged file gives a mesh with indices in range, or a ReadError. The sanitizers find
/// other faults.
TEST(IoHostile, EveryReaderSurvivesDamage) {
  std::mt19937 random(11);
  for (const std::string& format : io::read_tet_mesh_formats())
    for (const bool second : {false, true}) {
      SCOPED_TRACE(format);
      const TemporaryFolder folder;
      const std::string name = "a" + format, path = folder.file(name);
      io::write_tet_mesh(path, second ? second_order(sample_mesh(1)) : sample_mesh(1));
      const std::string content = folder.read(name);
      for (int round = 0; round < 150; ++round) {
        std::string damaged = content.substr(0, round % 3 == 0 ? random() % content.size() : content.size());
        for (unsigned k = 0; k < 1 + random() % 4 && !damaged.empty(); ++k)
          damaged[random() % damaged.size()] = "0123456789-\n $,*.e\xff\0"[random() % 20];
        try {
          const TetMesh mesh = io::read_tet_mesh(folder.write(name, damaged));
          for (const auto& tet : mesh.tets)
            for (const Index v : tet) ASSERT_LT(v, mesh.points.size());
          for (const auto& nodes : mesh.tet_mid_nodes)
            for (const Index v : nodes) ASSERT_LT(v, mesh.points.size());
          for (const auto& face : mesh.faces)
            for (const Index v : face) ASSERT_LT(v, mesh.points.size());
        } catch (const ReadError& error) {
          EXPECT_TRUE(std::string(error.what()).starts_with(folder.path().string())) << error.what();
        }
      }
    }
}

/// Bytes that are no mesh of any kind.
TEST(IoHostile, GarbageIsRefusedByEveryReader) {
  std::mt19937 random(12);
  std::string noise(5000, '\0');
  for (char& c : noise) c = static_cast<char>(random());
  for (const auto& formats : {io::read_tet_mesh_formats(), io::soup_formats()})
    for (const std::string& format : formats)
      for (const std::string& content :
           {std::string(), noise, std::string(100, '\0'), std::string(1000, '\n')}) {
        const TemporaryFolder folder;
        const std::string path = folder.write("a" + format, content);
        folder.write("a.node", content);
        const auto any = [&] {
          if (io::is_soup_format(path))
            io::read_soup(path);
          else
            io::read_tet_mesh(path);
        };
        EXPECT_THROW(any(), ReadError) << format << " of " << content.size() << " bytes";
      }
}

}  // namespace
}  // namespace collarmesh::io_hostile_test
