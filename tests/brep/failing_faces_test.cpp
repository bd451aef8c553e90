// Faces that OpenCASCADE's tessellation fails on.
#include <gtest/gtest.h>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Wire.hxx>

#include <gp_Circ.hxx>
#include <gp_Pln.hxx>

#include <array>
#include <cmath>

#include "collarmesh/brep/cad_model.h"
#include "collarmesh/plc_builder.h"
#include "face_mending.h"
#include "outline_triangles.h"
#include "shapes.h"
#include "soup_measures.h"

namespace collarmesh::testing {
namespace {

using brep::CadModel;

/// A plate of 20 x 20 x 5 with a round hole of radius 2 that touches a side in a line: the outlines of two of its
/// faces touch themselves in a vertex.
TopoDS_Shape plate_with_touching_hole() {
  const gp_Pnt touching(10, 0, 0);
  const std::array<gp_Pnt, 5> corners{gp_Pnt(0, 0, 0), touching, gp_Pnt(20, 0, 0), gp_Pnt(20, 20, 0),
                                      gp_Pnt(0, 20, 0)};
  std::array<TopoDS_Vertex, 5> vertices;
  for (std::size_t i = 0; i < 5; ++i) vertices[i] = BRepBuilderAPI_MakeVertex(corners[i]);
  BRepBuilderAPI_MakeWire outline;
  for (std::size_t i = 0; i < 5; ++i) outline.Add(BRepBuilderAPI_MakeEdge(vertices[i], vertices[(i + 1) % 5]));
  const gp_Circ circle(gp_Ax2(gp_Pnt(10, 2, 0), -gp::DZ(), -gp::DY()), 2);
  BRepBuilderAPI_MakeWire hole(BRepBuilderAPI_MakeEdge(circle, vertices[1], vertices[1]));
  BRepBuilderAPI_MakeFace face(gp_Pln(gp::XOY()), outline);
  face.Add(hole);
  return BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, 5)).Shape();
}

bool is_cut(const TopoDS_Shape& face) {
  const BRepMesh_IncrementalMesh mesh(face, 0.01);
  TopLoc_Location location;
  const Handle(Poly_Triangulation) cut = BRep_Tool::Triangulation(TopoDS::Face(face), location);
  if (!cut.IsNull()) std::printf("nb %d\n", cut->NbTriangles());
  return !cut.IsNull() && cut->NbTriangles() > 0;
}

using Nodes = std::vector<std::array<double, 2>>;
using Chords = std::vector<std::array<Index, 2>>;

double area_of(const Nodes& nodes, const brep::OutlineTriangles& result) {
  Nodes all = nodes;
  all.insert(all.end(), result.crossings.begin(), result.crossings.end());
  double area = 0;
  for (const auto& [a, b, c] : result.triangles)
    area += 0.5 * ((all[b][0] - all[a][0]) * (all[c][1] - all[a][1]) -
                   (all[c][0] - all[a][0]) * (all[b][1] - all[a][1]));
  return area;
}

TEST(CadOutlines, HaveHolesAndInnerPoints) {
  const Nodes nodes{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 1}, {3, 1}, {3, 3}, {1, 3}, {0.5, 2}};
  const Chords chords{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}};
  const auto result = brep::triangulate_outline(nodes, chords);
  EXPECT_DOUBLE_EQ(area_of(nodes, result), 12);
  EXPECT_TRUE(brep::borders_on(result.triangles, chords));
  EXPECT_TRUE(result.crossings.empty());
}

TEST(CadOutlines, MayCrossThemselves) {
  const Nodes nodes{{0, 0}, {2, 2}, {2, 0}, {0, 2}};
  const Chords chords{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  const auto result = brep::triangulate_outline(nodes, chords);
  EXPECT_EQ(result.crossings.size(), 1U);
  EXPECT_DOUBLE_EQ(area_of(nodes, result), 2);
  EXPECT_FALSE(brep::borders_on(result.triangles, chords));
}

TEST(CadOutlines, ThatGoThereAndBackEncloseNothing) {
  const Nodes nodes{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 2}};
  const Chords chords{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {4, 0}};
  const auto result = brep::triangulate_outline(nodes, chords);
  EXPECT_DOUBLE_EQ(area_of(nodes, result), 16);
  EXPECT_TRUE(brep::triangulate_outline({{0, 0}, {1, 0}}, {{0, 1}, {1, 0}}).triangles.empty());
}

TEST(CadFailingFaces, AreCutInAnotherWay) {
  const TopoDS_Shape plate = plate_with_touching_hole();
  const auto faces = faces_of(plate);
  EXPECT_FALSE(is_cut(TopoDS::Face(faces.back())));
  CadModel model(plate, "plate");
  const auto soups = model.tessellate({});
  for (auto& n : model.notes()) std::puts(n.c_str());
  ASSERT_EQ(soups.size(), 1U);
  EXPECT_EQ(open_sides(soups[0]), 0U);
  EXPECT_NEAR(volume_of(soups[0]), 5 * (400 - 4 * M_PI), 1);
  const Plc plc = build_plc(soups);
  ASSERT_EQ(plc.regions.size(), 2U);
}

/// A box one of whose faces has no outline that encloses anything.
TEST(CadFailingFaces, WithoutAnOutlineAreLeftOutAndTold) {
  const std::vector<TopoDS_Shape> faces = faces_of(BRepPrimAPI_MakeBox(10, 20, 30).Shape());
  BRep_Builder builder;
  TopoDS_Wire wire;
  builder.MakeWire(wire);
  const TopExp_Explorer edge(faces[0], TopAbs_EDGE);
  builder.Add(wire, edge.Current());
  TopoDS_Face spoilt = TopoDS::Face(faces[0].EmptyCopied());
  builder.Add(spoilt, wire);
  TopoDS_Shell shell;
  TopoDS_Solid solid;
  builder.MakeShell(shell);
  builder.MakeSolid(solid);
  builder.Add(shell, spoilt);
  for (std::size_t f = 1; f < 6; ++f) builder.Add(shell, faces[f]);
  builder.Add(solid, shell);
  CadModel model(solid, "box");
  const auto soups = model.tessellate({});
  EXPECT_EQ(open_sides(soups.at(0)), 4U);
  EXPECT_NE(model.notes().back().find("Face1"), std::string::npos) << model.notes().back();
  EXPECT_NE(model.notes().back().find("left out"), std::string::npos) << model.notes().back();
}

}  // namespace
}  // namespace collarmesh::testing
