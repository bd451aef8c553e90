// Faces that OpenCASCADE's tessellation fails on.
#include <gtest/gtest.h>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Ax2.hxx>

#include <array>
#include <cmath>

#include "collarmesh/brep/cad_model.h"
#include "collarmesh/plc_builder.h"
#include "face_mending.h"
#include "outline_triangles.h"
#include "shapes.h"
#include "soup_measures.h"

namespace collarmesh::testing::failing_faces_test {
namespace {

using brep::CadModel;

TopoDS_Shape solid_of(const std::vector<TopoDS_Shape>& faces) {
  BRep_Builder builder;
  TopoDS_Shell shell;
  TopoDS_Solid solid;
  builder.MakeShell(shell);
  builder.MakeSolid(solid);
  for (const TopoDS_Shape& face : faces) builder.Add(shell, face);
  builder.Add(solid, shell);
  return solid;
}

/// Reverses the second outline of a face, its hole: some programs write such faces.
TopoDS_Face with_turned_hole(const TopoDS_Shape& face) {
  TopoDS_Face result = TopoDS::Face(face.Oriented(TopAbs_FORWARD).EmptyCopied());
  BRep_Builder builder;
  int wires = 0;
  for (TopExp_Explorer wire(face.Oriented(TopAbs_FORWARD), TopAbs_WIRE); wire.More(); wire.Next())
    builder.Add(result, ++wires == 2 ? wire.Current().Reversed() : wire.Current());
  return TopoDS::Face(result.Oriented(face.Orientation()));
}

/// A plate of 20 x 20 x 5 with a round hole of radius 2.
TopoDS_Shape plate_with_turned_holes() {
  const TopoDS_Shape plate =
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(20, 20, 5).Shape(),
                      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(10, 10, -1), gp::DZ()), 2, 7).Shape())
          .Shape();
  std::vector<TopoDS_Shape> faces;
  for (const TopoDS_Shape& face : faces_of(plate)) faces.push_back(with_turned_hole(face));
  return solid_of(faces);
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
  EXPECT_EQ(brep::sides_off(result.triangles, chords), 0U);
  EXPECT_TRUE(result.crossings.empty());
}

TEST(CadOutlines, MayCrossThemselves) {
  const Nodes nodes{{0, 0}, {2, 2}, {2, 0}, {0, 2}};
  const Chords chords{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  const auto result = brep::triangulate_outline(nodes, chords);
  EXPECT_EQ(result.crossings.size(), 1U);
  EXPECT_DOUBLE_EQ(area_of(nodes, result), 2);
  EXPECT_GT(brep::sides_off(result.triangles, chords), 0U);
}

TEST(CadOutlines, ThatGoThereAndBackEncloseNothing) {
  const Nodes nodes{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {2, 2}};
  const Chords chords{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {4, 0}};
  const auto result = brep::triangulate_outline(nodes, chords);
  EXPECT_DOUBLE_EQ(area_of(nodes, result), 16);
  EXPECT_TRUE(brep::triangulate_outline({{0, 0}, {1, 0}}, {{0, 1}, {1, 0}}).triangles.empty());
}

TEST(CadFailingFaces, AreCutInAnotherWay) {
  CadModel model(plate_with_turned_holes(), "plate");
  const auto soups = model.tessellate({});
  ASSERT_EQ(model.notes().size(), 2U);
  EXPECT_NE(model.notes()[0].find(
                "around (10, 10, 5) cannot be cut into triangles together with its neighbours; it was "
                "triangulated alone after shape healing"),
            std::string::npos)
      << model.notes()[0];
  ASSERT_EQ(soups.size(), 1U);
  EXPECT_EQ(open_sides(soups[0]), 0U);
  EXPECT_NEAR(volume_of(soups[0]), 5 * (400 - 4 * M_PI), 1);
  const Plc plc = build_plc(soups);
  ASSERT_EQ(plc.regions.size(), 2U);
  EXPECT_EQ(plc.patches.size(), 7U);
}

// The side of a cylinder without the edges of its outline: only the outline in the neighbours' points is
// left.
TEST(CadFailingFaces, AreCutInTheParameterPlane) {
  const TopoDS_Shape rod = BRepPrimAPI_MakeCylinder(5, 20).Shape();
  const TopoDS_Face side = TopoDS::Face(faces_of(rod).front().EmptyCopied());
  constexpr Index n = 24;
  brep::Outline outline;
  for (const double v : {0., 20.})
    for (Index i = 0; i <= n; ++i) {
      const double u = 2 * M_PI * i / n;
      outline.points.push_back((v > 0 ? n : 0) + i % n);
      outline.places.push_back({5 * std::cos(u), 5 * std::sin(u), v});
      outline.parameters.push_back({u, v});
    }
  for (Index i = 0; i < n; ++i)
    outline.chords.insert(outline.chords.end(), {{i, i + 1}, {n + 2 + i, n + 1 + i}});
  outline.chords.insert(outline.chords.end(), {{n, 2 * n + 1}, {n + 1, 0}});
  const brep::MendedFace mended = brep::mend_face(side, outline, 0.05, 0.3);
  EXPECT_TRUE(mended.fits);
  EXPECT_EQ(mended.how, "from its outline in the parameter plane");
  double area = 0;
  for (const auto& [a, b, c] : mended.triangles) {
    const Vector normal = cross(mended.points[b] - mended.points[a], mended.points[c] - mended.points[a]);
    EXPECT_GT(dot(normal, mended.points[a] - Point{0, 0, mended.points[a].z}), 0);
    area += 0.5 * norm(normal);
  }
  EXPECT_NEAR(area, 200 * M_PI, 10);
  for (const Point& p : mended.points) EXPECT_NEAR(std::hypot(p.x, p.y), 5, 1e-9);
}

/// A box with a face whose outline encloses nothing.
TEST(CadFailingFaces, WithoutAnOutlineAreLeftOutAndTold) {
  const std::vector<TopoDS_Shape> faces = faces_of(BRepPrimAPI_MakeBox(10, 20, 30).Shape());
  BRep_Builder builder;
  TopoDS_Wire wire;
  builder.MakeWire(wire);
  const TopExp_Explorer edge(faces[0], TopAbs_EDGE);
  builder.Add(wire, edge.Current());
  TopoDS_Face spoilt = TopoDS::Face(faces[0].EmptyCopied());
  builder.Add(spoilt, wire);
  std::vector<TopoDS_Shape> with_spoilt = faces;
  with_spoilt[0] = spoilt;
  CadModel model(solid_of(with_spoilt), "box");
  const auto soups = model.tessellate({});
  EXPECT_EQ(open_sides(soups.at(0)), 4U);
  EXPECT_NE(model.notes().back().find("Face1"), std::string::npos) << model.notes().back();
  EXPECT_NE(model.notes().back().find("left out"), std::string::npos) << model.notes().back();
}

}  // namespace
}  // namespace collarmesh::testing::failing_faces_test
