// Exact lengths, areas and volumes against formulas, and their use in the complex.
#include <gtest/gtest.h>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeHalfSpace.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pln.hxx>
#include <gp_Trsf.hxx>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/brep/cad_model.h"
#include "command/make_mesh.h"
#include "files/complex_input.h"
#include "shapes.h"
#include "support/temporary_file.h"

namespace collarmesh::testing::measures_test {
namespace {

constexpr double pi = M_PI;

struct Expected {
  std::vector<double> lengths, areas, volumes;  // sorted by size
};

std::vector<double> exact(const std::map<Tag, brep::CadMeasure>& measures) {
  std::vector<double> values;
  for (const auto& [number, measure] : measures) values.push_back(measure.exact);
  std::sort(values.begin(), values.end());
  return values;
}

void expect_near(const std::vector<double>& found, const std::vector<double>& expected, const char* what) {
  ASSERT_EQ(found.size(), expected.size()) << what;
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], 1e-9 * expected[i]) << what << " " << i;
}

/// Expects these measures with any tessellation and at any place.
void expect_measures(const TopoDS_Shape& shape, const Expected& expected) {
  gp_Trsf away;
  away.SetTranslation(gp_Vec(1000, 2000, 3000));
  for (const TopoDS_Shape& placed : {shape, BRepBuilderAPI_Transform(shape, away).Shape()})
    for (const double deflection : {0.3, 0.02}) {
      brep::CadModel model(placed, "part");
      model.tessellate({.deflection = deflection});
      const brep::CadMeasures measures = model.measures();
      expect_near(exact(measures.lengths), expected.lengths, "length");
      expect_near(exact(measures.areas), expected.areas, "area");
      std::vector<double> volumes;
      for (const auto& volume : measures.volumes) volumes.push_back(volume.value().exact);
      std::sort(volumes.begin(), volumes.end());
      expect_near(volumes, expected.volumes, "volume");
    }
}

TEST(CadMeasures, OfASphere) {
  expect_measures(BRepPrimAPI_MakeSphere(5).Shape(), {{}, {4 * pi * 25}, {4. / 3 * pi * 125}});
}

TEST(CadMeasures, OfATorus) {
  expect_measures(BRepPrimAPI_MakeTorus(10, 3).Shape(), {{}, {4 * pi * pi * 30}, {2 * pi * pi * 90}});
}

TEST(CadMeasures, OfACylinder) {
  expect_measures(BRepPrimAPI_MakeCylinder(3, 7).Shape(),
                  {{6 * pi, 6 * pi}, {9 * pi, 9 * pi, 42 * pi}, {63 * pi}});
}

TEST(CadMeasures, OfACone) {
  expect_measures(BRepPrimAPI_MakeCone(3, 0, 4).Shape(), {{6 * pi}, {9 * pi, 15 * pi}, {12 * pi}});
}

TEST(CadMeasures, OfAShell) {
  const TopoDS_Shape outer = BRepPrimAPI_MakeSphere(5).Shape(), inner = BRepPrimAPI_MakeSphere(4.9).Shape();
  expect_measures(BRepAlgoAPI_Cut(outer, inner).Shape(),
                  {{}, {4 * pi * 4.9 * 4.9, 4 * pi * 25}, {4. / 3 * pi * (125 - std::pow(4.9, 3))}});
}

TEST(CadMeasures, OfASolidThatIsInsideOut) {
  expect_measures(BRepPrimAPI_MakeCylinder(3, 7).Solid().Reversed(),
                  {{6 * pi, 6 * pi}, {9 * pi, 9 * pi, 42 * pi}, {63 * pi}});
}

TEST(CadMeasures, OfWhatTwoCylindersHaveInCommon) {
  const TopoDS_Shape along_x = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-9, 0, 0), gp::DX()), 3, 18).Shape();
  const TopoDS_Shape along_z = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -9), gp::DZ()), 3, 18).Shape();
  brep::CadModel model(BRepAlgoAPI_Common(along_x, along_z).Shape(), "part");
  model.tessellate({.deflection = 0.1});
  const brep::CadMeasures measures = model.measures();
  ASSERT_EQ(measures.volumes.size(), 1U);
  EXPECT_NEAR(measures.volumes[0].value().exact, 16. / 3 * 27, 1e-9 * 144);
  const std::vector<double> areas = exact(measures.areas);
  EXPECT_NEAR(std::accumulate(areas.begin(), areas.end(), 0.), 16 * 9, 1e-9 * 144);
}

TEST(CadMeasures, OfACapThatNoParameterLinesBound) {
  const TopoDS_Shape beyond = BRepPrimAPI_MakeBox(gp_Pnt(-9, 2, -9), 18, 9, 18).Shape();
  brep::CadModel model(BRepAlgoAPI_Common(BRepPrimAPI_MakeSphere(5).Shape(), beyond).Shape(), "part");
  model.tessellate({.deflection = 0.1});
  const brep::CadMeasures measures = model.measures();
  ASSERT_EQ(measures.volumes.size(), 1U);
  EXPECT_NEAR(measures.volumes[0].value().exact, 36 * pi, 1e-7 * 36 * pi);
  const std::vector<double> areas = exact(measures.areas);
  ASSERT_EQ(areas.size(), 2U);
  EXPECT_NEAR(areas[0], 21 * pi, 1e-7 * 21 * pi);
  EXPECT_NEAR(areas[1], 30 * pi, 1e-9 * 30 * pi);
}

/// Returns the areas of all faces and the volume by OpenCASCADE's integrals over faces.
std::pair<std::vector<double>, double> integrated(const TopoDS_Shape& shape) {
  constexpr double error = 1e-9;  // OpenCASCADE's estimate
  std::vector<double> areas;
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(faces.Current(), properties, error);
    areas.push_back(properties.Mass());
  }
  std::sort(areas.begin(), areas.end());
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties, error);
  return {areas, properties.Mass()};
}

/// Expects the areas and the volume of OpenCASCADE, with any tessellation.
void expect_as_integrated(const TopoDS_Shape& shape, double error) {
  const auto [areas, volume] = integrated(shape);
  brep::CadModel model(shape, "part");
  for (const double deflection : {0.05, 0.2}) {
    model.tessellate({.deflection = deflection});
    const brep::CadMeasures measures = model.measures();
    const std::vector<double> found = exact(measures.areas);
    ASSERT_EQ(found.size(), areas.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], areas[i], error * areas.back());
    ASSERT_EQ(measures.volumes.size(), 1U);
    EXPECT_NEAR(measures.volumes[0].value().exact, volume, error * volume);
  }
}

TopoDS_Shape mirrored(const TopoDS_Shape& shape) {
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(3, 1, 0), gp_Dir(1, 1, 2)));
  return BRepBuilderAPI_Transform(shape, mirror, true).Shape();
}

TEST(CadMeasures, OfCutPrimitivesAreThoseOfOpenCascade) {
  const gp_Ax2 tilted(gp_Pnt(0.5, 0.3, 1), gp_Dir(1, 2, 3));
  const TopoDS_Shape rod =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-4, -8, -11), gp_Dir(1, 2, 3)), 0.8, 30).Shape();
  const TopoDS_Shape tip = BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(1, 0, -9), gp::DZ()), 2, 0, 20).Shape();
  for (const TopoDS_Shape& whole :
       {BRepPrimAPI_MakeCone(tilted, 5, 2, 7).Shape(), BRepPrimAPI_MakeSphere(tilted, 5).Shape(),
        BRepPrimAPI_MakeTorus(tilted, 5, 2).Shape(), BRepPrimAPI_MakeTorus(tilted, 5, 2, 1.5).Shape(),
        BRepPrimAPI_MakeCylinder(tilted, 4, 6).Shape()})
    for (const TopoDS_Shape& tool : {rod, tip}) {
      const TopoDS_Shape cut = BRepAlgoAPI_Cut(whole, tool).Shape();
      expect_as_integrated(cut, 1e-6);
      expect_as_integrated(mirrored(cut), 1e-6);
      const TopoDS_Shape of_splines = BRepBuilderAPI_NurbsConvert(cut, true).Shape();
      expect_as_integrated(of_splines, 1e-5);
      expect_as_integrated(mirrored(of_splines), 1e-5);
    }
}

/// Makes a spline through points of a plane curve, for t from 0 to 1.
template <class Curve>
TopoDS_Edge spline_through(int count, bool closed, const Curve& curve) {
  const Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, count);
  for (int i = 0; i < count; ++i) points->SetValue(i + 1, curve(double(i) / (closed ? count : count - 1)));
  GeomAPI_Interpolate interpolation(points, closed, 1e-9);
  interpolation.Perform();
  return BRepBuilderAPI_MakeEdge(interpolation.Curve()).Edge();
}

double exact_volume(const TopoDS_Shape& shape) {
  brep::CadModel model(shape, "part");
  model.tessellate({.deflection = 0.01});
  return model.measures().volumes.at(0).value().exact;
}

/// A disk with a wavy outline.
struct WavyDisk {
  int teeth;
  double radius = 6, height = 0.3;

  double area() const { return pi * (radius * radius + height * height / 2); }
  TopoDS_Shape extruded(double thickness) const {
    const TopoDS_Edge outline = spline_through(24 * teeth, true, [&](double t) {
      const double a = 2 * pi * t, r = radius + height * std::sin(teeth * a);
      return gp_Pnt(r * std::cos(a), r * std::sin(a), 0);
    });
    const TopoDS_Face face = BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(outline).Wire(), true).Face();
    return BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, thickness)).Shape();
  }
};

TEST(CadMeasures, OfAWaveThatIsExtruded) {
  constexpr double thickness = 2;
  const WavyDisk disk{.teeth = 20};
  const double expected = thickness * disk.area();
  EXPECT_NEAR(exact_volume(disk.extruded(thickness)), expected, 1e-5 * expected);
}

/// The volume below an oblique plane is the area times the plane's height above the centre, as the disk is
/// symmetric about its centre.
TEST(CadMeasures, OfAWaveThatIsExtrudedAndCutObliquely) {
  constexpr double middle = 4;
  const WavyDisk disk{.teeth = 6};
  const gp_Pln plane(gp_Pnt(0, 0, middle), gp_Dir(0.3, 0.1, 1));
  const TopoDS_Shape above =
      BRepPrimAPI_MakeHalfSpace(BRepBuilderAPI_MakeFace(plane).Face(), gp_Pnt(0, 0, 3 * middle)).Solid();
  const double expected = middle * disk.area();
  EXPECT_NEAR(exact_volume(BRepAlgoAPI_Cut(disk.extruded(3 * middle), above).Shape()), expected,
              1e-5 * expected);
}

/// Exact boxes of most spline faces are left out, which must not change the box of the shape.
TEST(CadModel, HasTheDiagonalOfTheExactBox) {
  const TopoDS_Shape ball = BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeSphere(5).Shape(), true).Shape();
  const TopoDS_Shape disk = BRepBuilderAPI_NurbsConvert(WavyDisk{.teeth = 6}.extruded(3), true).Shape();
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-9, -9, -2), gp_Pnt(9, 2, 2)).Shape();
  gp_Trsf turned;
  turned.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), gp_Dir(0.3, 0.5, 0.8)), 0.7);
  for (const TopoDS_Shape& shape : {ball, disk, WavyDisk{.teeth = 6}.extruded(3), box,
                                    BRepAlgoAPI_Fuse(ball, box).Shape(), BRepAlgoAPI_Cut(box, ball).Shape()})
    for (const TopoDS_Shape& placed : {shape, BRepBuilderAPI_Transform(shape, turned).Shape()}) {
      Bnd_Box exact;
      exact.SetGap(0);
      BRepBndLib::AddOptimal(placed, exact, false, false);
      EXPECT_DOUBLE_EQ(brep::CadModel(placed, "part").diagonal(), std::sqrt(exact.SquareExtent()));
    }
}

TEST(CadMeasures, OfAWaveThatIsRevolved) {
  const int waves = 12;
  const double length = 12, radius = 3, height = 0.3;
  const TopoDS_Edge profile = spline_through(24 * waves + 1, false, [&](double t) {
    return gp_Pnt(radius + height * std::sin(2 * pi * waves * t), 0, length * t);
  });
  BRepBuilderAPI_MakeWire outline(profile);
  const gp_Pnt corners[] = {gp_Pnt(radius, 0, length), gp_Pnt(0, 0, length), gp_Pnt(), gp_Pnt(radius, 0, 0)};
  for (int i = 0; i < 3; ++i) outline.Add(BRepBuilderAPI_MakeEdge(corners[i], corners[i + 1]).Edge());
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(outline.Wire(), true).Face();
  const double expected = length * pi * (radius * radius + height * height / 2);
  EXPECT_NEAR(exact_volume(BRepPrimAPI_MakeRevol(face, gp_Ax1(gp_Pnt(), gp::DZ())).Shape()), expected,
              1e-5 * expected);
}

TEST(CadMeasures, OfOverlappingSolids) {
  // A pin half inside a plate. The plate gets the common part.
  const TopoDS_Shape plate = BRepPrimAPI_MakeBox(gp_Pnt(-10, -10, 0), 20, 20, 4).Shape();
  const TopoDS_Shape pin = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, 2), gp::DZ()), 3, 4).Shape();
  brep::CadModel model(compound({plate, pin}), "part");
  model.tessellate({.deflection = 0.3});
  const brep::CadMeasures measures = model.measures();
  ASSERT_EQ(measures.volumes.size(), 2U);
  EXPECT_NEAR(measures.volumes[0].value().exact, 1600, 1e-6);
  EXPECT_NEAR(measures.volumes[1].value().exact, 18 * pi, 1e-6);
}

/// The complex that the program makes of a shape, with its measures.
struct Known {
  Plc plc;
  ShapeMeasures measures;
};

Known known_of(const TopoDS_Shape& shape) {
  const TemporaryFolder folder;
  const std::string path = folder.file("shape.brep");
  BRepTools::Write(shape, path.c_str());
  files::InputReading reading;
  reading.distance = [](double diagonal) { return 0.01 * diagonal; };
  files::ComplexInput input({path}, reading);
  Known known;
  known.plc = input.build({});
  known.measures = input.exact_measures(known.plc);
  return known;
}

std::map<Tag, double> by_region(const Known& known) {
  std::map<Tag, double> volumes;
  for (Index r = 1; r < known.plc.regions.size(); ++r)
    volumes[known.plc.regions[r].tag] = known.measures.volumes.at(r);
  return volumes;
}

TEST(CadMeasures, ReachTheComplex) {
  const Known known = known_of(BRepPrimAPI_MakeCylinder(3, 7).Shape());
  EXPECT_LT(known.plc.regions[1].volume, 62.9 * pi);
  ASSERT_EQ(known.measures.volumes.size(), 2U);
  EXPECT_TRUE(std::isnan(known.measures.volumes[0]));
  EXPECT_NEAR(known.measures.volumes[1], 63 * pi, 1e-9);
  ASSERT_EQ(known.measures.areas.size(), 3U);
  for (Index p = 0; p < 3; ++p)
    EXPECT_NEAR(known.measures.areas[p], known.plc.patches[p].planar ? 9 * pi : 42 * pi, 1e-9);
  ASSERT_EQ(known.measures.lengths.size(), 2U);
  for (const double length : known.measures.lengths) EXPECT_NEAR(length, 6 * pi, 1e-9);
}

TEST(CadMeasures, OfASolidLackWhatLiesInside) {
  const double ball = 4. / 3 * pi * 8;
  const Known known = known_of(
      compound({BRepPrimAPI_MakeSphere(10).Shape(), BRepPrimAPI_MakeSphere(gp_Pnt(5, 0, 0), 2).Shape(),
                BRepPrimAPI_MakeSphere(gp_Pnt(5, 0, 0), 1).Shape()}));
  const std::map<Tag, double> volumes = by_region(known);
  ASSERT_EQ(volumes.size(), 3U);
  EXPECT_NEAR(volumes.at(1), 4. / 3 * pi * 1000 - ball, 1e-6);
  EXPECT_NEAR(volumes.at(2), ball * 7 / 8, 1e-6);
  EXPECT_NEAR(volumes.at(3), ball / 8, 1e-6);
}

TEST(CadMeasures, OfAFaceThatIsTwoPatches) {
  // A block stands on a plate: its foot divides the plate's top, whose pieces keep one number.
  const Known known =
      known_of(compound({BRepPrimAPI_MakeBox(10, 10, 1).Shape(),
                         BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5, 5, 1), gp::DZ()), 2, 3).Shape()}));
  std::map<Tag, std::vector<double>> areas;
  for (Index p = 0; p < known.plc.patches.size(); ++p)
    areas[known.plc.patches[p].tag].push_back(known.measures.areas.at(p));
  std::size_t several = 0;
  for (const auto& [face, pieces] : areas) {
    if (pieces.size() == 1) continue;
    ++several;
    EXPECT_NEAR(std::accumulate(pieces.begin(), pieces.end(), 0.), 100, 1e-6);
    EXPECT_NEAR(*std::min_element(pieces.begin(), pieces.end()), 4 * pi, 0.1);
  }
  EXPECT_EQ(several, 1U);
  const std::map<Tag, double> volumes = by_region(known);
  EXPECT_NEAR(volumes.at(1), 100, 1e-6);
  EXPECT_NEAR(volumes.at(2), 12 * pi, 1e-6);
}

TEST(CadMeasures, AreNotKnownOfOtherFiles) {
  const TemporaryFolder folder;
  const std::string block = folder.file("block.brep");
  BRepTools::Write(BRepPrimAPI_MakeBox(10, 10, 10).Shape(), block.c_str());
  const std::string corner = folder.write(
      "corner.off", "OFF\n4 4 0\n20 0 0\n21 0 0\n20 1 0\n20 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  files::ComplexInput input({block, corner});
  const Plc plc = input.build({});
  const ShapeMeasures measures = input.exact_measures(plc);
  for (Index r = 1; r < plc.regions.size(); ++r) {
    const bool is_block = plc.regions[r].volume > 1;
    EXPECT_EQ(std::isnan(measures.volumes.at(r)), !is_block);
    if (is_block) {
      EXPECT_NEAR(measures.volumes[r], 1000, 1e-9);
    }
  }
  EXPECT_EQ(std::count_if(measures.areas.begin(), measures.areas.end(), [](double a) { return a == a; }), 6);
  EXPECT_EQ(measures.areas.size(), 10U);
  EXPECT_EQ(std::count_if(measures.lengths.begin(), measures.lengths.end(), [](double a) { return a == a; }),
            12);
  EXPECT_EQ(measures.lengths.size(), 18U);
}

TEST(CadMeasures, ReachTheCertificate) {
  const TemporaryFolder folder;
  const std::string path = folder.file("rod.brep");
  BRepTools::Write(BRepPrimAPI_MakeCylinder(3, 7).Shape(), path.c_str());
  command::MeshArguments arguments;
  arguments.inputs = {path};
  arguments.mesh.size = 3;
  process::Process process;
  const ShapeMeasures exact = command::make_mesh(process, arguments).run.check.of_input;
  ASSERT_EQ(exact.volumes.size(), 2U);
  EXPECT_NEAR(exact.volumes[1], 63 * pi, 1e-9);
  EXPECT_EQ(exact.areas.size(), 3U);
  EXPECT_EQ(exact.lengths.size(), 2U);
}

// This tube is meshed from constrained tetrahedra, and the first mesh loses 3% of the volume.
TEST(CadMeasures, OfATubeAreNearInAMeshOfConstrainedTetrahedra) {
  constexpr double radius = 0.005, inner = 0.9 * radius, length = 20;
  const double expected = pi * (radius * radius - inner * inner) * length;
  const TemporaryFolder folder;
  const std::string path = folder.file("tube.brep");
  BRepTools::Write(BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(radius, length).Shape(),
                                   BRepPrimAPI_MakeCylinder(inner, length).Shape())
                       .Shape(),
                   path.c_str());
  command::MeshArguments arguments;
  arguments.inputs = {path};
  arguments.mesh.size = 10;
  process::Process process;
  const PipelineResult made = command::make_mesh(process, arguments).run;
  EXPECT_EQ(made.missed(), "");
  EXPECT_NEAR(made.check.of_mesh.volumes.at(1), expected, 0.02 * expected);
  const auto& notes = made.check.notes;
  for (const std::string start : {"begun with", "made nearer"})
    EXPECT_EQ(std::ranges::count_if(notes, [&](const std::string& n) { return n.starts_with(start); }), 1);
}

}  // namespace
}  // namespace collarmesh::testing::measures_test
