// Faces that do not share their edges, and shapes with holes.
#include <gtest/gtest.h>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Trsf.hxx>

#include <cmath>
#include <set>

#include "collarmesh/brep/cad_model.h"
#include "collarmesh/error.h"
#include "collarmesh/plc_builder.h"
#include "files/complex_input.h"
#include "shapes.h"
#include "soup_measures.h"
#include "support/temporary_file.h"

namespace collarmesh::testing::open_shapes_test {
namespace {

using brep::CadModel;

TopoDS_Shape box() { return BRepPrimAPI_MakeBox(10, 20, 30).Shape(); }

/// Returns the faces of a box, each moved away from its middle: gaps along all edges.
std::vector<TopoDS_Shape> loose_faces(double gap) {
  std::vector<TopoDS_Shape> faces;
  for (const TopoDS_Shape& face : faces_of(box())) {
    gp_Trsf move;
    const int k = static_cast<int>(faces.size()) / 2;
    const double along = faces.size() % 2 == 0 ? -gap : gap;
    move.SetTranslation(gp_Vec(k == 0 ? along : 0, k == 1 ? along : 0, k == 2 ? along : 0));
    faces.push_back(BRepBuilderAPI_Transform(face, move, /*Copy=*/true).Shape());
  }
  return faces;
}

TopoDS_Shell shell_of(const std::vector<TopoDS_Shape>& faces) {
  BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  for (const TopoDS_Shape& face : faces) builder.Add(shell, face);
  return shell;
}

TopoDS_Solid solid_of(const TopoDS_Shell& shell) {
  BRep_Builder builder;
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  return solid;
}

void expect_mentions(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
}

void expect_closed_box(CadModel& model) {
  const auto soups = model.tessellate({});
  ASSERT_EQ(soups.size(), 1U);
  EXPECT_EQ(open_sides(soups[0]), 0U);
  EXPECT_NEAR(volume_of(soups[0]), 6000, 20);
  EXPECT_EQ(model.open_edges_text(), "");
}

class CadGaps : public ::testing::TestWithParam<double> {};

TEST_P(CadGaps, OfFacesAreSewn) {
  const double gap = GetParam() * std::sqrt(1400.);
  CadModel faces(compound(loose_faces(gap)), "part");
  expect_closed_box(faces);
  expect_mentions(faces.notes().at(0), {"part", "sewn into 1 solid"});
  std::set<Tag> tags;
  const auto soups = faces.tessellate({});
  for (Index f = 0; f < soups[0].facet_count(); ++f) tags.insert(soups[0].facet_tag(f));
  EXPECT_EQ(tags, (std::set<Tag>{1, 2, 3, 4, 5, 6}));
}

TEST_P(CadGaps, OfSolidsAreSewn) {
  const double gap = GetParam() * std::sqrt(1400.);
  CadModel solid(solid_of(shell_of(loose_faces(gap))), "part");
  expect_closed_box(solid);
  expect_mentions(solid.notes().at(0), {"Solid1 was open", "sewn with a tolerance of"});
}

INSTANTIATE_TEST_SUITE_P(Relative, CadGaps, ::testing::Values(0., 3e-6, 3e-5, 1e-4, 3e-4));

// A box without its last face, as a solid and as loose faces: the soups have the hole.
TEST(CadHoles, NameEdgesFacesAndPlaces) {
  std::vector<TopoDS_Shape> faces = faces_of(box());
  faces.pop_back();
  CadModel solid(solid_of(shell_of(faces)), "part");
  expect_mentions(solid.open_edges_text(), {"Solid1 is open", "4 edges", "Edge", " of Face", "30)"});
  CadModel shell(shell_of(faces), "part");
  expect_mentions(shell.open_edges_text(), {"part", "no solid", "4 edges", "Edge", "Face"});
  for (CadModel* model : {&solid, &shell}) {
    EXPECT_EQ(model->notes().size(), 1U);
    const auto soups = model->tessellate({});
    ASSERT_EQ(soups.size(), 1U);
    EXPECT_EQ(open_sides(soups[0]), 4U);
    EXPECT_EQ(soups[0].facet_count(), 10U);
    EXPECT_EQ(soups[0].region_tag, Tag{1});
    EXPECT_TRUE(soups[0].given_features);
  }
}

TEST(CadHoles, OfOneSolidLeaveTheOthersAlone) {
  std::vector<TopoDS_Shape> faces = faces_of(BRepPrimAPI_MakeBox(gp_Pnt(20, 0, 0), 10, 10, 10).Shape());
  faces.pop_back();
  CadModel model(compound({box(), solid_of(shell_of(faces))}), "part");
  const auto soups = model.tessellate({});
  ASSERT_EQ(soups.size(), 2U);
  EXPECT_EQ(open_sides(soups[0]), 0U);
  EXPECT_EQ(open_sides(soups[1]), 4U);
  expect_mentions(model.open_edges_text(), {"Solid2 is open"});
}

TEST(CadHoles, AreInTheMessageWhenNoComplexCanBeMade) {
  const TemporaryFolder folder;
  const std::string path = folder.file("sheet.brep");
  BRepTools::Write(faces_of(box()).front(), path.c_str());
  files::ComplexInput input({path});
  try {
    input.build({});
    FAIL() << "a sheet is no complex";
  } catch (const PlcError& error) {
    expect_mentions(error.what(), {"holds no solid", "4 edges border one face only", "Edge1 of Face1"});
  }
}

TEST(CadFaces, AloneMayEncloseASolid) {
  CadModel model(faces_of(BRepPrimAPI_MakeSphere(5).Shape()).front(), "ball");
  const auto soups = model.tessellate({});
  ASSERT_EQ(soups.size(), 1U);
  EXPECT_EQ(open_sides(soups[0]), 0U);
  EXPECT_NEAR(volume_of(soups[0]), 500 * M_PI / 3, 1);
}

}  // namespace
}  // namespace collarmesh::testing::open_shapes_test
