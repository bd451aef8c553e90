// Solids that overlap: volumes by inclusion and exclusion, and the owners of common parts.
#include <gtest/gtest.h>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <OSD_ThreadPool.hxx>
#include <gp_Ax2.hxx>
#include <gp_Trsf.hxx>

#include <array>
#include <cmath>
#include <set>
#include <variant>

#include "arguments.h"
#include "cad_meshing.h"
#include "collarmesh/brep/cad_model.h"
#include "collarmesh/plc_builder.h"
#include "files/complex_input.h"
#include "shapes.h"
#include "soup_measures.h"
#include "support/temporary_file.h"

namespace collarmesh::testing::overlapping_solids_test {
namespace {

using brep::CadModel;
using brep::Overlap;
using Volumes = std::map<Tag, double>;

TopoDS_Shape box(double x, double y, double z, double dx, double dy, double dz) {
  return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), dx, dy, dz).Shape();
}

struct Read {
  std::vector<PolygonSoup> soups;
  std::vector<std::string> notes;
};

Read read(const TopoDS_Shape& shape, Overlap overlap = Overlap::first) {
  CadModel model(shape, "part", {.overlap = overlap});
  EXPECT_TRUE(model.fused());
  std::vector<PolygonSoup> soups = model.tessellate({});
  return {std::move(soups), model.notes()};
}

void expect_volumes(const Read& part, const Volumes& expected, double relative = 1e-9) {
  const Volumes found = volumes_of(part.soups);
  ASSERT_EQ(found.size(), expected.size());
  for (const auto& [tag, volume] : expected)
    EXPECT_NEAR(found.at(tag), volume, relative * volume) << "Solid" << tag;
  for (const PolygonSoup& soup : part.soups)
    if (soup.region_tag) {
      EXPECT_EQ(open_sides(soup), 0U) << soup.name;
    }
}

/// Expects that the complex of the soups is valid and has this volume.
void expect_complex(const Read& part, double volume, double relative = 1e-9) {
  const Plc plc = build_plc(part.soups);
  double sum = 0;
  for (std::size_t r = 1; r < plc.regions.size(); ++r) sum += plc.regions[r].volume;
  EXPECT_NEAR(sum, volume, relative * volume);
}

std::string joined(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += note + "\n";
  return text;
}

TEST(CadOverlaps, OfTwoBoxesBelongToTheFirst) {
  // Volumes of 6000 each, 5 x 15 x 25 in common.
  const TopoDS_Shape two = compound({box(0, 0, 0, 10, 20, 30), box(5, 5, 5, 10, 20, 30)});
  const Read part = read(two);
  expect_volumes(part, {{1, 6000}, {2, 6000 - 1875}});
  expect_complex(part, 12000 - 1875);
  ASSERT_EQ(part.notes.size(), 1U);
  EXPECT_EQ(
      part.notes[0],
      "part: Solid1 and Solid2 overlap around (7.5, 12.5, 17.5); their common part, of volume 1875, belongs "
      "to Solid1");
}

TEST(CadOverlaps, OfTwoBoxesAreARegion) {
  const TopoDS_Shape two = compound({box(0, 0, 0, 10, 20, 30), box(5, 5, 5, 10, 20, 30)});
  const Read part = read(two, Overlap::region);
  expect_volumes(part, {{1, 6000 - 1875}, {2, 6000 - 1875}, {3, 1875}});
  expect_complex(part, 12000 - 1875);
}

TEST(CadOverlaps, OfThreeBoxes) {
  // Cubes of edge 10 at a distance of 4 along the diagonal: 216, 8 and 216 in common in pairs, 8 in all
  // three.
  const TopoDS_Shape three =
      compound({box(0, 0, 0, 10, 10, 10), box(4, 4, 4, 10, 10, 10), box(8, 8, 8, 10, 10, 10)});
  const Read first = read(three);
  expect_volumes(first, {{1, 1000}, {2, 1000 - 216}, {3, 1000 - 216}});
  expect_complex(first, 3000 - 216 - 216);
  const Read region = read(three, Overlap::region);
  double sum = 0;
  const Volumes volumes = volumes_of(region.soups);
  for (const auto& [tag, volume] : volumes) sum += volume;
  EXPECT_EQ(volumes.size(), 6U);  // three solids, two pairs, all three
  EXPECT_NEAR(sum, 3000 - 216 - 216, 1e-6);
  expect_complex(region, 3000 - 216 - 216);
}

TEST(CadOverlaps, OfTwoCylinders) {
  // Steinmetz: two crossing cylinders of radius r have 16/3 r^3 in common.
  const double r = 3, pi = M_PI;
  const TopoDS_Shape upright = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -10), gp::DZ()), r, 20).Shape();
  const TopoDS_Shape lying = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-10, 0, 0), gp::DX()), r, 20).Shape();
  const Read part = read(compound({upright, lying}));
  const double whole = pi * r * r * 20, common = 16. / 3 * r * r * r;
  expect_volumes(part, {{1, whole}, {2, whole - common}}, 2e-3);
  expect_complex(part, 2 * whole - common, 2e-3);
}

TEST(CadOverlaps, KeepNumbersOfFacesAndMesh) {
  const TopoDS_Shape bolt = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(10, 10, 3), gp::DZ()), 3, 12).Shape();
  const CadMeshed meshed = mesh_of_shape(compound({box(0, 0, 0, 20, 20, 10), bolt}));
  EXPECT_EQ(faults(meshed), "");
  EXPECT_NEAR(meshed.report.region_volumes.at(1), 4000, 1e-6);
  EXPECT_NEAR(meshed.report.region_volumes.at(2), M_PI * 9 * 5, 1);
  std::set<Tag> tags(meshed.result.mesh.face_tag.begin(), meshed.result.mesh.face_tag.end());
  EXPECT_EQ(tags, (std::set<Tag>{1, 2, 3, 4, 5, 6, 7, 8}));  // the bolt's lower end is inside the box
}

TEST(CadOverlaps, WhatLiesInsideStaysARegion) {
  const Read apart = read(compound({box(0, 0, 0, 10, 10, 10), box(3, 3, 3, 2, 2, 2)}));
  expect_complex(apart, 1000);
  EXPECT_NE(joined(apart.notes).find("Solid2 lies inside Solid1"), std::string::npos);
  const Read touching = read(compound({box(0, 0, 0, 10, 10, 10), box(3, 3, 0, 2, 2, 2)}));
  expect_volumes(touching, {{1, 992}, {2, 8}});
}

TEST(CadOverlaps, OfTheSameSolidLeaveOne) {
  const Read part = read(compound({box(0, 0, 0, 10, 10, 10), box(0, 0, 0, 10, 10, 10)}));
  expect_volumes(part, {{1, 1000}});
  EXPECT_NE(joined(part.notes).find("nothing is left of Solid2"), std::string::npos);
}

TEST(CadOverlaps, KeepFacesInside) {
  // A face inside the first solid that reaches into the common part.
  const TopoDS_Shape face = faces_of(box(2, 1, 1, 5, 3, 3)).at(4);
  const Read part = read(compound({box(0, 0, 0, 10, 10, 10), box(5, 0, 0, 10, 10, 10), face}));
  expect_volumes(part, {{1, 1000}, {2, 500}});
  ASSERT_EQ(part.soups.size(), 3U);
  EXPECT_GT(part.soups.back().facet_count(), 0U);
  expect_complex(part, 1500);
}

// General fuse would return other sub-shapes; those that were not fused must be the ones in the file.
TEST(CadSolids, ThatDoNotTouchAreNotFused) {
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(30, 0, 0), 3).Shape();
  const Read part = read(compound({box(0, 0, 0, 10, 10, 10), ball, box(0, 30, 0, 10, 10, 10)}));
  EXPECT_TRUE(part.notes.empty());
  EXPECT_EQ(part.soups.size(), 3U);
  EXPECT_EQ(part.soups.front().facet_count(), 12U);
  expect_complex(part, 2000 + 36 * M_PI, 1e-2);
}

TEST(CadSolids, OfGroupsApartShareFacesWithinEach) {
  const Read part =
      read(compound({box(0, 0, 0, 10, 10, 10), box(10, 0, 0, 5, 5, 5), box(50, 0, 0, 10, 10, 10),
                     box(60, 0, 0, 5, 5, 5), box(100, 0, 0, 1, 1, 1)}));
  expect_volumes(part, {{1, 1000}, {2, 125}, {3, 1000}, {4, 125}, {5, 1}});
  expect_complex(part, 2251);
}

// Reads a file as the program does: the option `--overlap` reaches the module that reads CAD files.
TEST(CadOverlaps, OptionOfTheProgram) {
  const TemporaryFolder folder;
  const std::string path = folder.file("boxes.brep");
  BRepTools::Write(compound({box(0, 0, 0, 10, 20, 30), box(5, 5, 5, 10, 20, 30)}), path.c_str());
  const process::Console console;
  const auto volumes = [&](const std::vector<const char*>& options) {
    std::vector<const char*> words{"collarmesh", "info", path.c_str()};
    words.insert(words.end(), options.begin(), options.end());
    const auto parsed = cli::parse(console, static_cast<int>(words.size()), words.data());
    const auto& info = std::get<cli::InfoArguments>(std::get<cli::Arguments>(parsed));
    files::ComplexInput input(info.inputs, {.format = {}, .overlap = info.overlap});
    return volumes_of(input.soups());
  };
  const Volumes first{{1, 6000}, {2, 6000 - 1875}}, region{{1, 6000 - 1875}, {2, 6000 - 1875}, {3, 1875}};
  const auto expect_near = [](const Volumes& found, const Volumes& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [tag, volume] : expected) EXPECT_NEAR(found.at(tag), volume, 1e-6) << "Solid" << tag;
  };
  expect_near(volumes({}), first);
  expect_near(volumes({"--overlap", "first"}), first);
  expect_near(volumes({"--overlap", "region"}), region);
  const std::array wrong{"collarmesh", "info", path.c_str(), "--overlap", "both"};
  EXPECT_EQ(std::get<process::ExitCode>(cli::parse(console, static_cast<int>(wrong.size()), wrong.data())),
            process::ExitCode::usage);
}

bool same(const std::vector<PolygonSoup>& a, const std::vector<PolygonSoup>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t s = 0; s < a.size(); ++s) {
    if (a[s].points != b[s].points || a[s].facet_count() != b[s].facet_count()) return false;
    for (Index f = 0; f < a[s].facet_count(); ++f)
      if (!std::equal(a[s].polygon(f).begin(), a[s].polygon(f).end(), b[s].polygon(f).begin())) return false;
  }
  return true;
}

TEST(CadSolids, AreTheSameWithAnyNumberOfThreads) {
  std::vector<TopoDS_Shape> parts;
  for (int i = 0; i < 4; ++i) {
    parts.push_back(box(8. * i, 0, 0, 10, 10, 10));
    parts.push_back(BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(8. * i + 3, 5, -2), gp::DZ()), 2, 14).Shape());
    parts.push_back(BRepPrimAPI_MakeSphere(gp_Pnt(8. * i + 6, 6, 11), 3).Shape());
  }
  const Handle(OSD_ThreadPool)& pool = OSD_ThreadPool::DefaultPool();
  pool->Init(0);
  const Read alone = read(compound(parts));
  for (const int threads : {2, 3, 7}) {
    pool->Init(threads);
    const Read several = read(compound(parts));
    EXPECT_TRUE(same(alone.soups, several.soups)) << threads;
    EXPECT_EQ(alone.notes, several.notes);
  }
}

}  // namespace
}  // namespace collarmesh::testing::overlapping_solids_test
