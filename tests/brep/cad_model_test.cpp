// Reading CAD files, and faults of shapes.
#include "collarmesh/brep/cad_model.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Writer.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <gp.hxx>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>
#include <gp_Lin.hxx>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <random>
#include <set>
#include <thread>

#include "collarmesh/error.h"
#include "collarmesh/plc_builder.h"
#include "collarmesh/repair.h"
#include "files/cad_files.h"
#include "files/complex_input.h"
#include "shapes.h"
#include "soup_measures.h"
#include "support/leaks_allowed.h"
#include "support/temporary_file.h"

namespace collarmesh::testing::cad_model_test {
namespace {

using brep::CadModel;

TopoDS_Shape box() { return BRepPrimAPI_MakeBox(10, 20, 30).Shape(); }

std::string fault_of(const TopoDS_Shape& shape, PlcFault::Kind kind) {
  try {
    const CadModel model(shape, "part");
  } catch (const PlcError& error) {
    EXPECT_EQ(error.faults.at(0).kind, kind);
    return error.what();
  }
  return "no fault";
}

void expect_mentions(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
}

double volume_in(CadModel model) {
  const auto soups = model.tessellate({});
  const Plc plc = build_plc(soups);
  double volume = 0;
  for (std::size_t r = 1; r < plc.regions.size(); ++r) volume += plc.regions[r].volume;
  return volume;
}

// Writes a file in inches: the numbers stay, and only the unit changes.
void write_in_inches(const TopoDS_Shape& shape, const std::string& path) {
  const LeaksAllowed of_writer;
  STEPControl_Writer writer;
  Interface_Static::SetCVal("write.step.unit", "INCH");
  writer.Transfer(shape, STEPControl_AsIs);
  ASSERT_EQ(writer.Write(path.c_str()), IFSelect_RetDone);
  Interface_Static::SetCVal("write.step.unit", "MM");
}

TEST(CadFiles, StepInInchesBecomesMillimetres) {
  const TemporaryFolder folder;
  const std::string path = folder.file("box.step");
  write_in_inches(box(), path);
  EXPECT_NE(folder.read("box.step").find("INCH"), std::string::npos);
  EXPECT_NEAR(volume_in(brep::read_cad(path)), 6000 * 25.4 * 25.4 * 25.4, 1);
}

void write_iges(const TopoDS_Shape& shape, const std::string& path) {
  const LeaksAllowed of_writer;
  IGESControl_Writer writer("MM", 0);
  writer.AddShape(shape);
  writer.ComputeModel();
  ASSERT_TRUE(writer.Write(path.c_str()));
}

TEST(CadFiles, IgesHoldsFacesThatAreSewn) {
  const TemporaryFolder folder;
  const std::string path = folder.file("box.igs");
  write_iges(box(), path);
  CadModel model = brep::read_cad(path);
  EXPECT_EQ(model.notes().size(), 1U);
  EXPECT_NEAR(volume_in(std::move(model)), 6000, 1e-6);
}

std::ptrdiff_t count_threads() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"),
                       std::filesystem::directory_iterator());
}

// Runs in separate processes, because OpenCASCADE's threads never end, and earlier tests may have started
// some.
TEST(CadFilesDeathTest, AreReadWithTheThreadsThatAreAllowed) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "there is one core";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const TemporaryFolder folder;
  const std::string path = folder.file("box.brep");
  BRepTools::Write(box(), path.c_str());
  const auto read = [&](unsigned threads) {
    files::InputReading reading;
    reading.threads = threads;
    const files::ComplexInput input({path}, reading);
    std::_Exit(static_cast<int>(count_threads()));  // leaks do not matter
  };
  int with_one = 0, with_all = 0;
  const auto keep = [](int& count) {
    return [&count](int status) {
      count = WEXITSTATUS(status);
      return WIFEXITED(status);
    };
  };
  EXPECT_EXIT(read(1), keep(with_one), "");
  EXPECT_EXIT(read(0), keep(with_all), "");
  EXPECT_LT(with_one, with_all);
}

TEST(CadFiles, ThatAreNoneAreReadErrors) {
  const TemporaryFolder folder;
  for (const char* name : {"a.step", "a.igs", "a.brep"})
    for (const char* content : {"", "nonsense\n", "ISO-10303-21;\nHEADER;\n"})
      EXPECT_THROW(brep::read_cad(folder.write(name, content)), Error) << name << ": " << content;
  EXPECT_THROW(brep::read_cad(folder.file("missing.step")), ReadError);
  // OpenCASCADE's own message on a truncated file must be part of the error and printed nowhere else.
  BRepTools::Write(box(), folder.file("whole.brep").c_str());
  const std::string whole = folder.read("whole.brep");
  ::testing::internal::CaptureStdout();
  for (const std::size_t length : {whole.size() / 4, whole.size() / 2, whole.size() - 40})
    EXPECT_THROW(brep::read_cad(folder.write("cut.brep", whole.substr(0, length))), ReadError) << length;
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_FALSE(brep::is_cad_format("part.stl"));
  EXPECT_TRUE(brep::is_cad_format("PART.STP"));
  EXPECT_TRUE(brep::is_cad_format("-", ".brep"));
}

TEST(CadFaults, NullAndEmptyShapes) {
  expect_mentions(fault_of(TopoDS_Shape(), PlcFault::Kind::empty), {"part", "null"});
  expect_mentions(fault_of(BRepBuilderAPI_MakeVertex(gp_Pnt(0, 0, 0)).Shape(), PlcFault::Kind::empty),
                  {"part", "no solid"});
}

TopoDS_Shape line(const gp_Pnt& from, const gp_Pnt& to) { return BRepBuilderAPI_MakeEdge(from, to).Shape(); }
TopoDS_Shape point(double x, double y, double z) {
  return BRepBuilderAPI_MakeVertex(gp_Pnt(x, y, z)).Shape();
}

// Edges alone become one soup of segments with the edges' numbers, for meshes of lines.
TEST(CadModel, EdgesAloneAreLines) {
  CadModel model(compound({line(gp_Pnt(0, 0, 0), gp_Pnt(4, 0, 0)), line(gp_Pnt(4, 0, 0), gp_Pnt(4, 3, 0)),
                           line(gp_Pnt(0, 3, 0), gp_Pnt(4, 1, 0))}),
                 "part");
  EXPECT_TRUE(model.notes().empty());
  const std::vector<PolygonSoup> soups = model.tessellate({});
  ASSERT_EQ(soups.size(), 1U);
  EXPECT_EQ(soups[0].facet_count(), 0U);
  std::set<Tag> tags;
  for (const PolygonSoup::Segment& segment : soups[0].segments) tags.insert(segment.tag);
  EXPECT_EQ(tags, (std::set<Tag>{1, 2, 3}));
  const auto nearest = model.nearest(1, 2, {4.001, 2, 0});
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(distance(*nearest, {4, 2, 0}), 0, 1e-12);
}

// Wires and points that belong to no face and lie outside solids are not meshed, and a note says so.
TEST(CadModel, TellsOfEdgesAndPointsOutsideOfSolids) {
  const TopoDS_Shape solid = box();
  EXPECT_TRUE(CadModel(solid, "part").notes().empty());
  const TopoDS_Shape edge_of_face = TopExp_Explorer(solid, TopAbs_EDGE).Current();
  EXPECT_TRUE(CadModel(compound({solid, edge_of_face}), "part").notes().empty());
  const TopoDS_Shape edge = line(gp_Pnt(20, 5, 5), gp_Pnt(28, 5, 5)), vertex = point(5, 9, -5);
  const CadModel with_edge(compound({solid, edge}), "part"),
      with_both(compound({solid, vertex, edge}), "part");
  ASSERT_EQ(with_edge.notes().size(), 1U);
  expect_mentions(
      with_edge.notes()[0],
      {"part", "Edge13 at (24, 5, 5)",
       "is left out, because only edges and vertices of faces or inside closed solids are meshed", ".poly"});
  ASSERT_EQ(with_both.notes().size(), 1U);
  expect_mentions(with_both.notes()[0],
                  {"Edge13 at (24, 5, 5) and 1 more are left out, because only edges and vertices"});
}

double length_of(const PolygonSoup& soup) {
  double length = 0;
  for (const PolygonSoup::Segment& segment : soup.segments)
    length += distance(soup.points[segment.a], soup.points[segment.b]);
  return length;
}

/// Returns whether the soup has a vertex there, with a tag of its own.
bool has_vertex_at(const PolygonSoup& soup, const Point& p) {
  return std::any_of(soup.vertices.begin(), soup.vertices.end(),
                     [&](Index v) { return soup.point_tags[v] != 0 && distance(soup.points[v], p) < 1e-12; });
}

TEST(CadModel, CutsEdgesInsideWhereTheyMeetOneAnother) {
  const TopoDS_Shape first = line(gp_Pnt(2, 5, 5), gp_Pnt(8, 5, 5));
  struct Meeting {
    TopoDS_Shape other;
    double length;              // length of both edges, with their common part counted once
    std::size_t curves;         // number of curves that they are cut into
    std::vector<Point> places;  // places where they meet
    const char* note = nullptr;
  };
  const Meeting meetings[] = {
      {line(gp_Pnt(5, 2, 5), gp_Pnt(5, 8, 5)), 12, 4, {{5, 5, 5}}},
      {line(gp_Pnt(5, 5, 5), gp_Pnt(5, 5, 8)), 9, 3, {{5, 5, 5}}},
      {line(gp_Pnt(2, 5, 5), gp_Pnt(7, 5, 5)),
       6,
       2,
       {{2, 5, 5}, {7, 5, 5}},
       "Edge14 at (4.5, 5, 5) lies on Edge13 and gets the number of the latter there"},
      {line(gp_Pnt(2, 5, 5), gp_Pnt(8, 5, 5)),
       6,
       1,
       {{2, 5, 5}, {8, 5, 5}},
       "Edge14 at (5, 5, 5) lies on Edge13 and gets the number of the latter there"},
      {point(5, 5, 5), 6, 2, {{5, 5, 5}}}};
  for (const Meeting& meeting : meetings) {
    CadModel model(compound({box(), first, meeting.other}), "part");
    ASSERT_EQ(model.notes().size(), meeting.note == nullptr ? 0U : 1U);
    if (meeting.note != nullptr) expect_mentions(model.notes()[0], {meeting.note});
    const std::vector<PolygonSoup> soups = model.tessellate({});
    ASSERT_EQ(soups.size(), 2U);
    EXPECT_NEAR(length_of(soups[1]), meeting.length, 1e-12);
    EXPECT_EQ(build_plc(soups).curves.size(), 12 + meeting.curves);
    for (const Point& place : meeting.places) EXPECT_TRUE(has_vertex_at(soups[1], place));
  }
}

// The face gets a vertex where the line meets it; the part of the line outside is left out.
TEST(CadModel, EndsEdgesAtTheFacesThatTheyMeet) {
  const double top = 30, inside = 10;
  for (const double end : {top, 2 * top}) {
    CadModel model(compound({box(), line(gp_Pnt(5, 5, top - inside), gp_Pnt(5, 5, end))}), "part");
    ASSERT_EQ(model.notes().size(), end > top ? 1U : 0U);
    if (end > top)
      expect_mentions(model.notes()[0],
                      {"part: Edge13 at (5, 5, 40) is partly outside of the closed solids"});
    const std::vector<PolygonSoup> soups = model.tessellate({});
    ASSERT_EQ(soups.size(), 2U);
    for (const PolygonSoup& soup : soups) EXPECT_TRUE(has_vertex_at(soup, {5, 5, top}));
    EXPECT_NEAR(length_of(soups[1]), inside, 1e-12);
    EXPECT_EQ(open_sides(soups[0]), 0U);
    EXPECT_NEAR(volume_of(soups[0]), 6000, 1e-9);
    EXPECT_NEAR(model.measures().lengths.at(13).exact, inside, 1e-9);
  }
}

// Edges are kept even if only a short piece is inside.
TEST(CadModel, KeepsEdgesThroughThinPlates) {
  const TopoDS_Shape plate = BRepPrimAPI_MakeBox(20, 20, 1).Shape();
  CadModel model(compound({plate, line(gp_Pnt(10, 10, -100), gp_Pnt(10, 10, 100))}), "part");
  EXPECT_NEAR(length_of(model.tessellate({}).at(1)), 1, 1e-12);
  ASSERT_EQ(model.notes().size(), 1U);
  expect_mentions(model.notes()[0], {"is partly outside of the closed solids"});
  // Lines on faces make no vertices there, and lines beside faces are outside.
  for (const TopoDS_Shape& beside :
       {line(gp_Pnt(-5, 5, 1), gp_Pnt(15, 5, 1)), line(gp_Pnt(21, 10, -100), gp_Pnt(21, 10, 100))}) {
    CadModel without(compound({plate, beside}), "part");
    EXPECT_EQ(build_plc(without.tessellate({})).vertices.size(), 8U);
    expect_mentions(without.notes().at(0),
                    {"because only edges and vertices of faces or inside closed solids"});
  }
}

// Faces and edges keep their numbers, including those that come later in the file.
TEST(CadModel, KeepsNumbersWhereEdgesMeetFaces) {
  const TopoDS_Shape solids[] = {BRepPrimAPI_MakeBox(10, 10, 10).Shape(),
                                 BRepPrimAPI_MakeBox(gp_Pnt(10, 0, 0), gp_Pnt(20, 10, 10)).Shape()};
  const TopoDS_Shape wire = line(gp_Pnt(3, 3, 3), gp_Pnt(15, 6, 7)),
                     stray = line(gp_Pnt(0, 0, -5), gp_Pnt(1, 0, -5));
  CadModel without(compound({solids[0], solids[1]}), "part"),
      with(compound({solids[0], solids[1], wire, stray}), "part");
  const std::vector<PolygonSoup> before = without.tessellate({}), after = with.tessellate({});
  ASSERT_EQ(after.size(), before.size() + 1);
  const auto numbers = [](const std::vector<PolygonSoup>& soups) {
    std::set<std::pair<int, Tag>> all;
    for (std::size_t s = 0; s < 2; ++s) {
      for (Index f = 0; f < soups[s].facet_count(); ++f) all.emplace(2, soups[s].facet_tag(f));
      for (const PolygonSoup::Segment& segment : soups[s].segments) all.emplace(1, segment.tag);
    }
    return all;
  };
  EXPECT_EQ(numbers(after), numbers(before));
  for (const PolygonSoup::Segment& segment : after[2].segments) EXPECT_EQ(segment.tag, 25);
  EXPECT_NEAR(length_of(after[2]), 13, 1e-12);
  expect_mentions(with.notes().at(0),
                  {"Edge26 at (0.5, 0, -5) is left out, because only edges and vertices"});
}

// Also joins edges of a wire that are given separately.
TEST(CadModel, JoinsEdgesInsideAtTheirEnds) {
  CadModel model(
      compound({box(), line(gp_Pnt(2, 5, 5), gp_Pnt(8, 5, 5)), line(gp_Pnt(8, 5, 5), gp_Pnt(8, 9, 5)),
                line(gp_Pnt(8, 9, 5), gp_Pnt(2, 5, 5)), point(8, 9, 5), point(5, 15, 15)}),
      "part");
  EXPECT_TRUE(model.notes().empty());
  const std::vector<PolygonSoup> soups = model.tessellate({});
  ASSERT_EQ(soups.size(), 2U);
  EXPECT_EQ(soups[1].segments.size(), 3U);
  EXPECT_EQ(soups[1].vertices.size(), 4U);
  const Plc plc = build_plc(soups);
  EXPECT_EQ(plc.curves.size(), 15U);
  EXPECT_EQ(plc.vertices.size(), 12U);
}

TEST(CadModel, KeepsLinesAndPointsInsideWhereFacetsAreRepaired) {
  const Point probe{3, 3, 3};
  std::vector<PolygonSoup> soups =
      CadModel(compound({box(), line(gp_Pnt(2, 5, 5), gp_Pnt(8, 5, 5)), point(probe.x, probe.y, probe.z)}),
               "part")
          .tessellate({});
  const TopoDS_Shape across = BRepPrimAPI_MakeBox(gp_Pnt(5, 15, 25), gp_Pnt(15, 25, 35)).Shape();
  soups.push_back(CadModel(across, "other").tessellate({}).at(0));
  const RepairedPlc repaired = build_repaired_plc(soups);
  EXPECT_TRUE(repaired.report.repaired);
  EXPECT_TRUE(std::any_of(repaired.plc.curves.begin(), repaired.plc.curves.end(),
                          [](const Plc::Curve& curve) { return curve.tag == 13 && curve.patches.empty(); }));
  EXPECT_TRUE(std::any_of(
      repaired.plc.vertices.begin(), repaired.plc.vertices.end(),
      [&](const Plc::Vertex& v) { return distance(repaired.plc.points[v.point], probe) < 1e-12; }));
}

TEST(CadModel, TellsOfLinesInsideThatRepairLost) {
  const TopoDS_Shape across = BRepPrimAPI_MakeBox(gp_Pnt(5, 15, 25), gp_Pnt(15, 25, 35)).Shape();
  bool some_lost = false;
  for (const double length : {1e-6, 1e-4, 1e-2}) {
    std::vector<PolygonSoup> soups =
        CadModel(compound({box(), line(gp_Pnt(2, 5, 5), gp_Pnt(2 + length, 5, 5))}), "part")
            .tessellate({.deflection = 1e-3});
    for (PolygonSoup::Segment& segment : soups.at(1).segments) segment.tag = 99;
    soups.push_back(CadModel(across, "other").tessellate({}).at(0));
    const Plc plc = build_repaired_plc(soups).plc;
    const bool kept = std::any_of(plc.curves.begin(), plc.curves.end(),
                                  [](const Plc::Curve& curve) { return curve.tag == 99; });
    const bool told = std::any_of(plc.warnings.begin(), plc.warnings.end(), [](const Plc::Warning& warning) {
      return warning.message.starts_with("Nothing is left of the line with tag 99 at (2, 5, 5)");
    });
    EXPECT_NE(kept, told) << length;
    some_lost = some_lost || told;
  }
  EXPECT_TRUE(some_lost);
}

TEST(CadModel, LeavesOutEdgesNearerToFacesThanTheTriangles) {
  CadModel model(compound({box(), line(gp_Pnt(2, 5, 0.1), gp_Pnt(8, 5, 0.1))}), "part");
  EXPECT_NEAR(length_of(model.tessellate({.deflection = 0.01}).at(1)), 6, 1e-12);
  EXPECT_TRUE(model.notes().empty());
  const std::vector<PolygonSoup> coarse = model.tessellate({.deflection = 0.1});
  EXPECT_TRUE(coarse.at(1).segments.empty());
  EXPECT_EQ(build_plc(coarse).curves.size(), 12U);
  ASSERT_EQ(model.notes().size(), 1U);
  expect_mentions(model.notes()[0],
                  {"Edge13 at (5, 5, 0.1) is left out, because it is so near to faces", "--distance"});
}

// The ends are on the exact face, so with coarse triangles the whole chord may be outside. Its middle is
// 0.3^2 / 80 below the face.
TEST(CadModel, LeavesOutChordsOfCurvedFacesThatAreNearerThanTheTriangles) {
  const double radius = 10, length = 0.3, half = std::asin(length / (2 * radius));
  const auto at = [&](double angle) { return gp_Pnt(radius * std::cos(angle), radius * std::sin(angle), 8); };
  const TopoDS_Shape chord = line(at(1 - half), at(1 + half));
  CadModel model(compound({BRepPrimAPI_MakeCylinder(radius, 20).Shape(), chord}), "part");
  EXPECT_TRUE(model.tessellate({.deflection = 0.01}).at(1).segments.empty());
  ASSERT_EQ(model.notes().size(), 1U);
  expect_mentions(model.notes()[0],
                  {"Edge4", "it is so near to faces that their triangles may cross it", "--distance"});
  EXPECT_NEAR(length_of(model.tessellate({.deflection = 1e-4}).at(1)), length, 1e-9);
  EXPECT_TRUE(model.notes().empty());
}

// The chords of curved edges may cross; those of straight lines are the lines themselves.
TEST(CadModel, LeavesOutCurvedEdgesNearToOthers) {
  const double radius = 4, apart = 0.002, deflection = 0.01;
  const auto circle = [](double r, double turned) {
    const gp_Ax2 axis(gp_Pnt(5, 10, 15), gp::DZ(), gp_Dir(std::cos(turned), std::sin(turned), 0));
    return BRepBuilderAPI_MakeEdge(gp_Circ(axis, r)).Shape();
  };
  CadModel circles(compound({box(), circle(radius, 0), circle(radius + apart, 0.1)}), "part");
  const double one = length_of(circles.tessellate({.deflection = deflection}).at(1));
  EXPECT_NEAR(one, 2 * M_PI * radius, 0.1);
  ASSERT_EQ(circles.notes().size(), 1U);
  expect_mentions(circles.notes()[0],
                  {"Edge14", "is so near to other edges that their chords may cross it", "--distance"});
  const std::vector<PolygonSoup> fine = circles.tessellate({.deflection = apart / 3});
  EXPECT_TRUE(circles.notes().empty());
  EXPECT_NEAR(length_of(fine.at(1)), 2 * one, 0.1);
  EXPECT_EQ(build_plc(fine).curves.size(), 14U);
  CadModel lines(compound({box(), line(gp_Pnt(2, 5, 5), gp_Pnt(8, 5, 5)),
                           line(gp_Pnt(2, 5, 5 + apart), gp_Pnt(8, 5, 5 + apart))}),
                 "part");
  EXPECT_EQ(lines.tessellate({.deflection = deflection}).at(1).segments.size(), 2U);
  EXPECT_TRUE(lines.notes().empty());
}

// Coarse triangles of the pin cross those of the hole. The wire near the plate's top is kept only with finer
// triangles.
TEST(CadFiles, HaveAsManySoupsWhenCutAgain) {
  const gp_Ax2 axis(gp_Pnt(20, 15, 0), gp::DZ()), turned(axis.Location(), gp::DZ(), gp_Dir(1, 0.2, 0));
  const TopoDS_Shape plate = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(40, 30, 10).Shape(),
                                             BRepPrimAPI_MakeCylinder(axis, 6, 10).Shape())
                                 .Shape(),
                     pin = BRepPrimAPI_MakeCylinder(turned, 5.97, 10).Shape(),
                     wire = line(gp_Pnt(3, 3, 9.9), gp_Pnt(3, 8, 9.9));
  const TemporaryFolder folder;
  const std::string path = folder.file("pin.brep");
  BRepTools::Write(compound({plate, pin, wire}), path.c_str());
  files::CadFiles cad;
  std::vector<PolygonSoup> soups(1);  // soups of another file
  cad.read(path, {}, {.deflection = [](double) { return 0.1; }}, soups);
  ASSERT_EQ(soups.size(), 4U);
  EXPECT_TRUE(soups[3].segments.empty());
  for (const double finer : {4.0, 1.0, 4.0}) {
    cad.tessellate(finer, soups);
    ASSERT_EQ(soups.size(), 4U);
    EXPECT_EQ(soups[3].segments.size(), finer > 1 ? 1U : 0U);
  }
  files::InputReading reading;
  reading.distance = [](double) { return 1; };
  files::ComplexInput input({path}, reading);
  const Plc plc = input.build({}, {});
  EXPECT_EQ(plc.regions.size(), 3U);
}

TEST(CadFiles, GetFinerTrianglesOnlyWhereTheyCross) {
  const gp_Ax2 axis(gp_Pnt(20, 15, 0), gp::DZ()), turned(axis.Location(), gp::DZ(), gp_Dir(1, 0.2, 0)),
      apart(gp_Pnt(60, 15, 0), gp::DZ());
  const TopoDS_Shape plate =
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(40, 30, 10).Shape(), BRepPrimAPI_MakeCylinder(axis, 6, 10).Shape())
          .Shape();
  const TemporaryFolder folder;
  const std::string path = folder.file("pins.brep");
  BRepTools::Write(compound({plate, BRepPrimAPI_MakeCylinder(turned, 5.995, 10).Shape(),
                             BRepPrimAPI_MakeCylinder(apart, 6, 10).Shape()}),
                   path.c_str());
  files::InputReading reading;
  reading.distance = [](double) { return 1; };
  files::ComplexInput input({path}, reading);
  const auto counts = [&] {
    std::vector<Index> facets;
    for (const PolygonSoup& soup : input.soups()) facets.push_back(soup.facet_count());
    return facets;
  };
  const std::vector<Index> before = counts();
  ASSERT_EQ(before.size(), 3U);
  EXPECT_EQ(input.build({}, {}).regions.size(), 4U);
  const std::vector<Index> after = counts();
  ASSERT_EQ(after.size(), 3U);
  EXPECT_FALSE(input.repaired().repaired);
  EXPECT_GT(after[0] + after[1], before[0] + before[1]);
  EXPECT_EQ(after[2], before[2]);
}

TEST(CadTessellation, KeepsTheDeflection) {
  const double radius = 10;
  CadModel model(BRepPrimAPI_MakeSphere(radius).Shape(), "ball");
  for (const double deflection : {0.1, 0.01}) {
    for (const PolygonSoup& soup : model.tessellate({.deflection = deflection})) {
      ASSERT_GT(soup.facet_count(), 0U);
      for (Index f = 0; f < soup.facet_count(); ++f) {
        Point centroid;
        for (const Index p : soup.polygon(f)) {
          centroid = centroid + soup.points[p] / 3;
          EXPECT_NEAR(norm(soup.points[p]), radius, 1e-12);
        }
        EXPECT_GT(norm(centroid), radius - 2 * deflection);
      }
    }
  }
}

TEST(CadTessellation, SomeFacesMayBeFiner) {
  const double radius = 5, deflection = 0.3, finer = 16;
  CadModel model(BRepAlgoAPI_Fuse(BRepPrimAPI_MakeCylinder(radius, 20).Shape(),
                                  BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 20), radius).Shape())
                     .Shape(),
                 "pin");
  // Returns the largest distance of the centres of a face's triangles from the cylinder or the ball.
  const auto off = [&](const PolygonSoup& soup, Tag face) {
    double off = 0;
    for (Index f = 0; f < soup.facet_count(); ++f) {
      if (soup.facet_tag(f) != face) continue;
      Point centre;
      for (const Index p : soup.polygon(f)) centre = centre + soup.points[p] / 3;
      off = std::max(off, radius - norm(Vector{centre.x, centre.y, std::max(0.0, centre.z - 20)}));
    }
    return off;
  };
  std::set<Tag> curved;
  const std::vector<PolygonSoup> coarse = model.tessellate({.deflection = deflection, .angle = 60});
  ASSERT_EQ(coarse.size(), 1U);
  for (Index f = 0; f < coarse[0].facet_count(); ++f)
    if (const Tag face = coarse[0].facet_tag(f); off(coarse[0], face) < radius / 2) curved.insert(face);
  ASSERT_EQ(curved.size(), 2U);
  for (const Tag face : curved) {
    const std::vector<PolygonSoup> soups =
        model.tessellate({.deflection = deflection, .angle = 60, .finer_faces = {face}, .finer = finer});
    ASSERT_EQ(soups.size(), 1U);
    EXPECT_EQ(open_sides(soups[0]), 0U);
    for (const Tag other : curved) {
      if (other == face)
        EXPECT_LT(off(soups[0], other), 2 * deflection / finer);
      else
        EXPECT_GT(off(soups[0], other), 2 * deflection / finer);
    }
  }
}

TEST(CadTessellation, SeamsAreNoFeatures) {
  CadModel model(BRepPrimAPI_MakeCylinder(5, 20).Shape(), "rod");
  const Plc plc = build_plc(model.tessellate({}));
  EXPECT_EQ(plc.patches.size(), 3U);
  EXPECT_EQ(plc.curves.size(), 2U);
  EXPECT_EQ(plc.vertices.size(), 2U);  // where the circles begin
}

TEST(CadNearest, LiesOnTheShape) {
  const gp_Ax2 axes(gp_Pnt(1, 2, 3), gp_Dir(1, 1, 1), gp_Dir(1, -1, 0));
  CadModel model(BRepPrimAPI_MakeCylinder(axes, 5, 20).Shape(), "rod");
  model.tessellate({});
  int found = 0;
  const gp_Lin axis(gp_Pnt(1, 2, 3), gp_Dir(1, 1, 1));
  for (Tag face = 1; face <= 3; ++face) {
    const auto nearest = model.nearest(2, face, {7, 3, 9});
    ASSERT_TRUE(nearest.has_value());
    const double off = axis.Distance(gp_Pnt(nearest->x, nearest->y, nearest->z));
    if (std::fabs(off - 5) < 1e-12) ++found;
  }
  EXPECT_EQ(found, 1);  // the other two are planes
  EXPECT_FALSE(model.nearest(2, 4, {0, 0, 0}).has_value());
  EXPECT_FALSE(model.nearest(3, 1, {0, 0, 0}).has_value());
}

/// Returns a prism over a closed spline: a narrow slot, whose two long sides are nearer to each other than
/// coarse chords are to the spline.
TopoDS_Shape slot(double width) {
  constexpr int count = 41;
  const Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, count);
  for (int i = 0; i < count; ++i) {
    const double a = 2 * M_PI * i / count;
    points->SetValue(i + 1, gp_Pnt(10 * std::cos(a), width * std::sin(a) + std::cos(3 * std::cos(a)), 0));
  }
  GeomAPI_Interpolate spline(points, true, 1e-9);
  spline.Perform();
  const TopoDS_Edge outline = BRepBuilderAPI_MakeEdge(spline.Curve()).Edge();
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(outline).Wire(), true).Face();
  return BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, 2)).Shape();
}

// Compares with many samples of each edge, at points as far away as mesh vertices may be.
TEST(CadNearest, OnAnEdgeIsTheNearestOfAllItsPoints) {
  const gp_Ax2 across(gp_Pnt(-10, 1, 10), gp_Dir(1, 0.2, 0.1));
  const TopoDS_Shape shape = compound({BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(5, 20).Shape(),
                                                       BRepPrimAPI_MakeCylinder(across, 3, 20).Shape())
                                           .Shape(),
                                       slot(0.1)});
  CadModel model(shape, "rod");
  model.tessellate({.deflection = 0.2});
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> offset(-0.5, 0.5);
  int splines = 0;
  for (int number = 1; number <= edges.Extent(); ++number) {
    const BRepAdaptor_Curve curve(TopoDS::Edge(edges(number)));
    if (curve.GetType() == GeomAbs_BSplineCurve) ++splines;
    constexpr int count = 5000;
    std::vector<Point> samples;
    double spacing = 0;
    for (int i = 0; i <= count; ++i) {
      const gp_Pnt p =
          curve.Value(curve.FirstParameter() + (curve.LastParameter() - curve.FirstParameter()) * i / count);
      samples.push_back({p.X(), p.Y(), p.Z()});
      if (i > 0) spacing = std::max(spacing, distance(samples[samples.size() - 2], samples.back()));
    }
    const auto from_samples = [&](const Point& p) {
      double least = INFINITY;
      for (const Point& sample : samples) least = std::min(least, squared_distance(p, sample));
      return std::sqrt(least);
    };
    for (std::size_t i = 0; i < samples.size(); i += 50) {
      const Point p = samples[i] + Vector{offset(random), offset(random), offset(random)};
      const auto nearest = model.nearest(1, number, p);
      ASSERT_TRUE(nearest.has_value());
      EXPECT_LE(distance(p, *nearest), from_samples(p) + 1e-12);
      EXPECT_LE(from_samples(*nearest), spacing);
    }
  }
  EXPECT_GE(splines, 3);  // two of them closed
}

}  // namespace
}  // namespace collarmesh::testing::cad_model_test
