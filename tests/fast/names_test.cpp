// Numbers and names of features without a tag: from files, given by users, and in output.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/io/soup_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/name_features.h"
#include "collarmesh/pipeline.h"
#include "io/names_text.h"
#include "support/shapes.h"
#include "support/temporary_file.h"

namespace collarmesh::names_test {
namespace {

using testing::box;
using testing::TemporaryFolder;

PolygonSoup untagged(const PolygonSoup& soup) {
  PolygonSoup result;
  result.points = soup.points;
  for (Index f = 0; f < soup.facet_count(); ++f) result.add_facet(soup.polygon(soup.facet_polygons(f)[0]));
  return result;
}

Plc plc_of(const PolygonSoup& soup) { return build_plc({&soup, 1}); }

template <class Features>
std::vector<Tag> tags_of(const Features& features) {
  std::vector<Tag> tags;
  for (const auto& feature : features) tags.push_back(feature.tag);
  return tags;
}

std::vector<Tag> one_to(Tag n) {
  std::vector<Tag> tags;
  for (Tag i = 1; i <= n; ++i) tags.push_back(i);
  return tags;
}

TEST(Numbers, UntaggedPatchesAndCurvesAreNumbered) {
  const Plc plc = plc_of(untagged(box()));
  EXPECT_EQ(tags_of(plc.patches), one_to(6));
  EXPECT_EQ(tags_of(plc.curves), one_to(12));
}

TEST(Numbers, TagsThatAreThereStay) {
  PolygonSoup soup;
  const PolygonSoup plain = box();
  soup.points = plain.points;
  for (Index f = 0; f < plain.facet_count(); ++f)
    soup.add_facet(plain.polygon(plain.facet_polygons(f)[0]), f == 0 ? 7 : 0);
  const std::vector<Tag> tags = tags_of(plc_of(soup).patches);
  EXPECT_EQ(std::set<Tag>(tags.begin(), tags.end()), (std::set<Tag>{0, 7}));
}

TEST(Numbers, WhatFillsAHoleHasItsOwn) {
  const PolygonSoup whole = untagged(box());
  PolygonSoup open;
  open.points = whole.points;
  for (Index f = 2; f < whole.facet_count(); ++f) open.add_facet(whole.polygon(whole.facet_polygons(f)[0]));
  const RepairedPlc repaired = build_repaired_plc({&open, 1});
  ASSERT_FALSE(repaired.report.filled.empty());
  std::vector<Tag> tags = tags_of(repaired.plc.patches);
  EXPECT_EQ(std::set<Tag>(tags.begin(), tags.end()).size(), tags.size());
  EXPECT_EQ(std::count(tags.begin(), tags.end(), 0), 0);
}

TEST(Names, SolidsOfStlArePatches) {
  const TemporaryFolder folder;
  const auto facet = [](int z) {
    return fmt::format(
        " facet normal 0 0 0\n outer loop\n vertex 0 0 {0}\n vertex 1 0 {0}\n vertex 0 1 {0}\n endloop\n "
        "endfacet\n",
        z);
  };
  const PolygonSoup soup = io::read_soup(
      folder.write("a.stl", "solid inlet of air\n" + facet(0) + facet(1) + "endsolid\nsolid outlet\n" +
                                facet(2) + "endsolid outlet\nsolid inlet of air\n" + facet(3) +
                                "endsolid\nsolid\n" + facet(4) + "endsolid\n"));
  ASSERT_EQ(soup.facet_count(), 5U);
  std::vector<Tag> tags;
  for (Index f = 0; f < 5; ++f) tags.push_back(soup.facet_tag(f));
  EXPECT_EQ(tags, (std::vector<Tag>{1, 1, 2, 1, 3}));
  ASSERT_NE(soup.tag_names.find(2, 1), nullptr);
  EXPECT_EQ(*soup.tag_names.find(2, 1), "inlet of air");
  EXPECT_EQ(*soup.tag_names.find(2, 2), "outlet");
  const PolygonSoup alone = io::read_soup(folder.write("b.stl", "solid part\n" + facet(0) + "endsolid\n"));
  EXPECT_EQ(alone.facet_tag(0), 0);
  EXPECT_TRUE(alone.tag_names.empty());
}

TEST(Names, GroupsOfObjElseMaterialsArePatches) {
  const TemporaryFolder folder;
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const auto tags = [](const PolygonSoup& soup) {
    std::vector<Tag> result;
    for (Index f = 0; f < soup.facet_count(); ++f) result.push_back(soup.facet_tag(f));
    return result;
  };
  const PolygonSoup groups = io::read_soup(folder.write(
      "a.obj",
      points + "usemtl red\ng wall\nf 1 2 3\ng lid\nf 1 2 4\ng wall\nf 1 3 4\ng patch_9\nf 2 3 4\n"));
  EXPECT_EQ(groups.tag_names.of(2).size(), 2U);
  EXPECT_EQ(tags(groups)[0], tags(groups)[2]);
  EXPECT_EQ(tags(groups)[3], 9);
  EXPECT_EQ(*groups.tag_names.find(2, tags(groups)[1]), "lid");
  const PolygonSoup materials = io::read_soup(
      folder.write("b.obj", points + "g all\nusemtl red\nf 1 2 3\nf 1 2 4\nusemtl blue\nf 1 3 4\nf 2 3 4\n"));
  EXPECT_EQ(tags(materials), (std::vector<Tag>{1, 1, 2, 2}));
  EXPECT_EQ(*materials.tag_names.find(2, 2), "blue");
  const PolygonSoup plain =
      io::read_soup(folder.write("c.obj", points + "g all\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"));
  EXPECT_EQ(tags(plain), (std::vector<Tag>{0, 0, 0, 0}));
  io::write_soup(folder.file("d.obj"), groups);
  const PolygonSoup again = io::read_soup(folder.file("d.obj"));
  EXPECT_EQ(again.tag_names.of(2).size(), 2U);
  EXPECT_EQ(tags(again)[3], 9);
}

TEST(Names, AreGivenByNumberAndByPoint) {
  Plc plc = plc_of(untagged(box()));
  const auto patch_at = [&](std::size_t axis, double value) {
    for (const Plc::Patch& patch : plc.patches)
      if (std::fabs(patch.normal[axis]) > 0.5 && std::fabs(patch.origin[axis] - value) < 1e-9) return &patch;
    return static_cast<const Plc::Patch*>(nullptr);
  };
  const Tag left = patch_at(0, 0)->tag, right = patch_at(0, 1)->tag, top = patch_at(2, 1)->tag;
  name_features(R"({"patches": {"inlet": )" + std::to_string(left) +
                    R"(, "walls": [{"at": [1, 0.5, 0.5]}, {"at": [0.5, 0.5, 1]}]},
                    "regions": {"air": {"at": [0.5, 0.5, 0.5]}}, "curves": {"rim": {"at": [0, 0, 0.5]}}})",
                plc);
  EXPECT_EQ(*plc.names.find(2, left), "inlet");
  EXPECT_EQ(*plc.names.find(2, std::min(right, top)), "walls");
  EXPECT_EQ(patch_at(0, 1)->tag, std::min(right, top));
  EXPECT_EQ(patch_at(2, 1)->tag, std::min(right, top));
  EXPECT_EQ(*plc.names.find(3, 1), "air");
  EXPECT_EQ(plc.names.of(1).size(), 1U);
}

TEST(Names, MistakesAreTold) {
  const Plc plc = plc_of(untagged(box()));
  for (const auto& [text, says] : std::vector<std::pair<std::string, std::string>>{
           {"[]", "object"},
           {"{", "line 1, column 2: this is not JSON"},
           {R"({"faces": {}})", "faces"},
           {R"({"patches": {"a": 77}})", "77"},
           {R"({"patches": {"a": "b"}})", "patches.a"},
           {R"({"patches": {"a": []}})", "empty"},
           {R"({"patches": {"a": 1, "b": 1}})", "already has a name"},
           {R"({"patches": {"a": {"at": [5, 5, 5]}}})", "away"},
           {R"({"regions": {"a": {"at": [5, 5, 5]}}})", "no region"},
           {R"({"patches": {"a": {"at": [5, 5]}}})", "number"}}) {
    Plc copy = plc;
    try {
      name_features(text, copy);
      ADD_FAILURE() << text;
    } catch (const OptionError& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  }
}

TEST(Names, AreInWhatIsWritten) {
  const TemporaryFolder folder;
  Plc plc = plc_of(untagged(box()));
  name_features(R"({"patches": {"Inlet 1": 1}, "curves": {"rim": 1}, "regions": {"steel": 1}})", plc);
  const TetMesh mesh = run_pipeline(plc).result.mesh;
  const auto written = [&](const std::string& name) {
    io::write_tet_mesh(folder.file(name), mesh);
    return folder.read(name);
  };
  for (const char* name : {"a.msh", "a.msh2", "a.unv"}) {
    const std::string text = written(name);
    for (const char* word : {"Inlet 1", "steel", "rim", "patch_2"})
      EXPECT_NE(text.find(word), std::string::npos) << name << " " << word;
    EXPECT_EQ(text.find("curve_0"), std::string::npos);
    EXPECT_EQ(text.find("patch_1\""), std::string::npos);
  }
  const std::string abaqus = written("a.inp");
  for (const char* word :
       {"SURFACE, NAME=INLET_1,", "NSET=INLET_1_NODES", "ELSET=STEEL", "NSET=RIM_NODES", "NAME=PATCH_2,"})
    EXPECT_NE(abaqus.find(word), std::string::npos) << word;
  EXPECT_EQ(std::set<Tag>(mesh.face_tag.begin(), mesh.face_tag.end()).size(), 6U);
}

TEST(Names, OfUnvAreKept) {
  const TemporaryFolder folder;
  Plc plc = plc_of(untagged(box()));
  name_features(R"({"patches": {"Inlet 1": 1}, "curves": {"rim": 1}, "regions": {"steel": 1}})", plc);
  TetMesh mesh = run_pipeline(plc).result.mesh;
  io::write_tet_mesh(folder.file("a.unv"), mesh);
  const TetMesh again = io::read_tet_mesh(folder.file("a.unv"));
  for (std::size_t dimension = 1; dimension < 4; ++dimension)
    EXPECT_EQ(again.names.of(dimension), mesh.names.of(dimension)) << dimension;
  EXPECT_EQ(again.face_tag, mesh.face_tag);
  mesh.names = {};
  mesh.group_names = GroupNames::cad;  // as FreeCAD writes a mesh that it got from us
  io::write_tet_mesh(folder.file("b.unv"), mesh);
  io::write_tet_mesh(folder.file("b.msh"), io::read_tet_mesh(folder.file("b.unv")));
  for (const char* word : {"\"Face6\"", "\"Edge12\"", "\"Solid1\""})
    EXPECT_NE(folder.read("b.msh").find(word), std::string::npos) << word;
}

TEST(Names, OfVtkAreKept) {
  const TemporaryFolder folder;
  Plc plc = plc_of(untagged(box()));
  name_features(R"({"patches": {"Inlet 1": 1}, "curves": {"rim": 1}, "regions": {"steel": 1}})", plc);
  TetMesh mesh = run_pipeline(plc).result.mesh;
  for (const std::string& format : io::read_tet_mesh_formats()) {
    if (format != ".vtu" && format != ".vtk" && format != ".pvtu" && format != ".xdmf") continue;
    SCOPED_TRACE(format);
    mesh.group_names = GroupNames::complex;
    io::write_tet_mesh(folder.file("a" + format), mesh);
    const TetMesh again = io::read_tet_mesh(folder.file("a" + format));
    for (std::size_t dimension = 0; dimension < 4; ++dimension)
      EXPECT_EQ(again.names.of(dimension), mesh.names.of(dimension)) << dimension;
    EXPECT_EQ(again.group_names, GroupNames::complex);
    if (format == ".xdmf") continue;  // has no place for the names of CAD shapes
    mesh.group_names = GroupNames::cad;
    io::write_tet_mesh(folder.file("b" + format), mesh);
    const TetMesh of_cad = io::read_tet_mesh(folder.file("b" + format));
    EXPECT_EQ(of_cad.group_names, GroupNames::cad);
    EXPECT_EQ(of_cad.names.of(2), mesh.names.of(2));
  }
}

TEST(Names, LinesThatAreNoNamesAreIgnored) {
  TetMesh mesh;
  io::take_names("patch 7 a name of words\n\npatch\npatch 8\npatch x y\nplanet 3 mars\nregion -2 ends", mesh);
  EXPECT_EQ(mesh.names.of(2), (std::map<Tag, std::string>{{7, "a name of words"}}));
  EXPECT_EQ(mesh.names.of(3), (std::map<Tag, std::string>{{-2, "ends"}}));
  EXPECT_TRUE(mesh.names.of(0).empty() && mesh.names.of(1).empty());
  EXPECT_EQ(mesh.group_names, GroupNames::complex);
}

TEST(Names, OfMsh2HaveNumbersOfTheirOwn) {
  const TemporaryFolder folder;
  const Plc plc = plc_of(untagged(box()));
  const TetMesh mesh = run_pipeline(plc).result.mesh;
  io::write_tet_mesh(folder.file("a.msh2"), mesh);
  const TetMesh again = io::read_tet_mesh(folder.file("a.msh2"));
  EXPECT_EQ(again.face_tag, mesh.face_tag);
  EXPECT_EQ(again.tet_tag, mesh.tet_tag);
  EXPECT_EQ(again.edge_tag, mesh.edge_tag);
  EXPECT_TRUE(check(again, plc).passed());
}

}  // namespace
}  // namespace collarmesh::names_test
