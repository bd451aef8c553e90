// Abaqus' files of triangles, of lines, and of patches that are split, by a reader of keywords in this file.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/io/interfaces_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/shells.h"
#include "support/any_complex.h"
#include "support/meshes.h"
#include "support/second_order.h"
#include "support/shapes.h"
#include "support/temporary_file.h"

namespace collarmesh::io_abaqus_test {
namespace {

using namespace testing;

/// A keyword with its parameters, and the fields of its lines.
struct Block {
  std::string name;
  std::map<std::string, std::string> parameters;
  std::vector<std::vector<std::string>> lines;

  std::vector<std::string> fields() const {
    std::vector<std::string> all;
    for (const auto& line : lines) all.insert(all.end(), line.begin(), line.end());
    return all;
  }
};

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) {
    field.erase(0, field.find_first_not_of(' '));
    if (!field.empty()) fields.push_back(field);
  }
  return fields;
}

std::vector<Block> blocks_of(const std::string& text) {
  std::vector<Block> blocks;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const std::vector<std::string> fields = fields_of(line);
    if (!line.starts_with("*")) {
      blocks.back().lines.push_back(fields);
      continue;
    }
    Block block{fields[0].substr(1), {}, {}};
    for (std::size_t i = 1; i < fields.size(); ++i)
      block.parameters[fields[i].substr(0, fields[i].find('='))] = fields[i].substr(fields[i].find('=') + 1);
    blocks.push_back(std::move(block));
  }
  return blocks;
}

std::vector<Block> named(const std::vector<Block>& blocks, const std::string& name) {
  std::vector<Block> found;
  for (const Block& block : blocks)
    if (block.name == name) found.push_back(block);
  return found;
}

std::vector<Point> nodes_of(const std::vector<Block>& blocks) {
  std::vector<Point> nodes;
  const std::vector<Block> found = named(blocks, "NODE");
  for (const auto& line : found.at(0).lines)
    nodes.push_back({std::stod(line.at(1)), std::stod(line.at(2)), std::stod(line.at(3))});
  return nodes;
}

/// The nodes of elements by their numbers, both from 0, and their sets.
struct Elements {
  std::map<Index, std::vector<Index>> nodes;
  std::map<Index, std::string> set, type;
};

Elements elements_of(const std::vector<Block>& blocks) {
  Elements elements;
  for (const Block& block : named(blocks, "ELEMENT"))
    for (const auto& line : block.lines) {
      const auto number = static_cast<Index>(std::stoul(line.at(0)) - 1);
      EXPECT_FALSE(elements.nodes.contains(number)) << "the number " << line[0] << " occurs twice";
      for (std::size_t i = 1; i < line.size(); ++i)
        elements.nodes[number].push_back(static_cast<Index>(std::stoul(line[i]) - 1));
      elements.set[number] = block.parameters.at("ELSET");
      elements.type[number] = block.parameters.at("TYPE");
    }
  return elements;
}

std::vector<Block> written(const TetMesh& mesh, const Interfaces& interfaces = {}) {
  const TemporaryFolder folder;
  io::write_tet_mesh(folder.file("a.inp"), mesh, interfaces);
  return blocks_of(folder.read("a.inp"));
}

TetMesh surface(const PolygonSoup& soup, unsigned order, unsigned dimension = 2) {
  PipelineOptions options;
  options.mesh.size = 0.4;
  options.order = order;
  options.dimension = dimension;
  return mesh_shells(complex_of(soup), options).result.mesh;
}

TEST(AbaqusShells, TrianglesAreElementsInASetForEachTag) {
  for (const unsigned order : {1U, 2U}) {
    const TetMesh mesh = surface(box(), order);
    const std::vector<Block> blocks = written(mesh);
    EXPECT_EQ(nodes_of(blocks), mesh.points);
    const Elements elements = elements_of(blocks);
    ASSERT_EQ(elements.nodes.size(), mesh.faces.size());
    for (Index f = 0; f < mesh.faces.size(); ++f) {
      std::vector<Index> nodes(mesh.faces[f].begin(), mesh.faces[f].end());
      if (order == 2) nodes.insert(nodes.end(), mesh.face_mid_nodes[f].begin(), mesh.face_mid_nodes[f].end());
      EXPECT_EQ(elements.nodes.at(f), nodes);
      EXPECT_EQ(elements.set.at(f), "PATCH_" + std::to_string(mesh.face_tag[f]));
      EXPECT_EQ(elements.type.at(f), order == 1 ? "S3" : "S6");
    }
    const std::vector<std::string> all = named(blocks, "ELSET").at(0).fields();
    EXPECT_EQ(all.size(), 6U) << "all patches are in EALL";
    EXPECT_EQ(std::set(all.begin(), all.end()).size(), 6U);
  }
}

/// The unit square in the plane z = 0, as seen from above or below.
PolygonSoup square(bool from_below, double z = 0) {
  PolygonSoup soup;
  soup.points = {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}};
  if (from_below)
    soup.add_facet(std::array<Index, 4>{3, 2, 1, 0}, 4);
  else
    soup.add_facet(std::array<Index, 4>{0, 1, 2, 3}, 4);
  return soup;
}

TEST(AbaqusShells, PlaneElementsAreCounterclockwise) {
  for (const bool from_below : {false, true})
    for (const unsigned order : {1U, 2U})
      for (const TriangleElements kind : {TriangleElements::plane_stress, TriangleElements::plane_strain}) {
        TetMesh mesh = surface(square(from_below), order);
        if (from_below && !mesh.faces.empty()) {
          std::swap(mesh.faces[0][1], mesh.faces[0][2]);
          if (order == 2) std::swap(mesh.face_mid_nodes[0][0], mesh.face_mid_nodes[0][2]);
        }
        mesh.triangle_elements = kind;
        const std::vector<Block> blocks = written(mesh);
        const std::vector<Point> points = nodes_of(blocks);
        const Elements elements = elements_of(blocks);
        ASSERT_EQ(elements.nodes.size(), mesh.faces.size());
        double area = 0;
        for (const auto& [number, nodes] : elements.nodes) {
          EXPECT_EQ(
              elements.type.at(number),
              std::string(kind == TriangleElements::plane_stress ? "CPS" : "CPE") + (order == 1 ? "3" : "6"));
          const Point &a = points[nodes[0]], &b = points[nodes[1]], &c = points[nodes[2]];
          EXPECT_GT(cross(b - a, c - a).z, 0);
          area += 0.5 * cross(b - a, c - a).z;
          for (std::size_t k = 0; order == 2 && k < 3; ++k)
            EXPECT_LT(distance(points[nodes[3 + k]], 0.5 * (points[nodes[k]] + points[nodes[(k + 1) % 3]])),
                      1e-12);
        }
        EXPECT_NEAR(area, 1, 1e-12);
      }
}

TEST(AbaqusShells, PlaneElementsOffThePlaneAreRefused) {
  TetMesh mesh = surface(square(false, 0.25), 1);
  const TemporaryFolder folder;
  io::write_tet_mesh(folder.file("shells.inp"), mesh);
  mesh.triangle_elements = TriangleElements::plane_strain;
  expect_error<WriteError>([&] { io::write_tet_mesh(folder.file("a.inp"), mesh); }, folder.file("a.inp"),
                           "there is a node at (0, 0, 0.25)");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(AbaqusShells, LinesAreBeamsWithTheMiddleNodeSecond) {
  for (const unsigned order : {1U, 2U}) {
    const TetMesh mesh = surface(box(), order, 1);
    const std::vector<Block> blocks = written(mesh);
    const Elements elements = elements_of(blocks);
    ASSERT_EQ(elements.nodes.size(), mesh.edges.size());
    for (Index e = 0; e < mesh.edges.size(); ++e) {
      const auto& [a, b] = mesh.edges[e];
      EXPECT_EQ(elements.nodes.at(e),
                order == 1 ? std::vector<Index>({a, b}) : std::vector<Index>({a, mesh.edge_mid_nodes[e], b}));
      EXPECT_EQ(elements.type.at(e), order == 1 ? "B31" : "B32");
      EXPECT_EQ(elements.set.at(e), "CURVE_" + std::to_string(mesh.edge_tag[e]));
    }
  }
}

TEST(AbaqusShells, FormatsWithoutPlaceForThemAreNamed) {
  const TetMesh triangles = surface(square(false), 1), lines = surface(square(false), 1, 1);
  const std::vector<std::string> formats = io::formats_of_surfaces();
  const TemporaryFolder folder;
  for (const std::string& format : io::written_tet_mesh_formats()) {
    const std::string path = folder.file("a" + format);
    if (std::ranges::count(formats, format) == 0) {
      expect_error<WriteError>([&] { io::write_tet_mesh(path, triangles); }, path,
                               "a mesh of triangles alone");
      expect_error<WriteError>([&] { io::write_tet_mesh(path, lines); }, path, "a mesh of lines alone");
    } else {
      EXPECT_NO_THROW(io::write_tet_mesh(path, triangles)) << format;
    }
  }
  EXPECT_GT(folder.file_count(), 4U);
}

/// Two boxes, one on the other, that are kept apart, and the interface between them.
struct Apart {
  TetMesh mesh;
  SplitReport report;
};

Apart apart(unsigned order, Interaction interaction, bool cohesive) {
  Apart made{meshed_two_boxes(2).mesh, {}};
  if (order == 2) made.mesh = second_order(made.mesh);
  made.report = split(made.mesh, {.keep_apart = true, .interaction = interaction, .cohesive = cohesive});
  return made;
}

std::set<Index> nodes_with_tag(const TetMesh& mesh, Tag tag) {
  std::set<Index> nodes;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.face_tag[f] != tag) continue;
    nodes.insert(mesh.faces[f].begin(), mesh.faces[f].end());
    if (mesh.order() == 2) nodes.insert(mesh.face_mid_nodes[f].begin(), mesh.face_mid_nodes[f].end());
  }
  return nodes;
}

TEST(AbaqusInterfaces, TiesJoinAllNodesOfThePlusSideToTheMinusSide) {
  for (const unsigned order : {1U, 2U}) {
    const auto [mesh, report] = apart(order, Interaction::tie, false);
    ASSERT_EQ(report.interfaces.sides.size(), 1U);
    const std::vector<Block> blocks = written(mesh, report.interfaces);
    const std::vector<Block> ties = named(blocks, "TIE");
    ASSERT_EQ(ties.size(), 1U);
    const std::string slave = ties[0].lines.at(0).at(0), master = ties[0].lines[0].at(1);
    std::set<Index> tied;
    bool has_surface = false, has_master = false;
    for (const Block& block : blocks) {
      if (block.name == "NSET" && block.parameters.at("NSET") == slave)
        for (const std::string& node : block.fields()) tied.insert(static_cast<Index>(std::stoul(node) - 1));
      if (block.name != "SURFACE") continue;
      has_surface |= block.parameters.at("NAME") == slave && block.parameters.at("TYPE") == "NODE";
      has_master |= block.parameters.at("NAME") == master && block.parameters.at("TYPE") == "ELEMENT";
    }
    EXPECT_TRUE(has_surface && has_master);
    EXPECT_EQ(tied, nodes_with_tag(mesh, report.interfaces.sides[0].plus));
    for (const Index node : tied) EXPECT_NEAR(mesh.points[node].z, 1, 1e-12);
    EXPECT_TRUE(named(blocks, "CONTACT PAIR").empty());
  }
}

TEST(AbaqusInterfaces, NodesOfAFrontAreNotTied) {
  TetMesh mesh = meshed_box_with_facet(4).mesh;
  const SplitReport report = split(mesh, {.patches = {"7"}, .interaction = Interaction::tie});
  ASSERT_EQ(report.interfaces.sides.size(), 1U);
  EXPECT_GT(report.front_nodes, 0U);
  const std::vector<Block> blocks = written(mesh, report.interfaces);
  const auto set = std::ranges::find_if(blocks, [](const Block& block) {
    return block.name == "NSET" && block.parameters.at("NSET").ends_with("_TIED");
  });
  ASSERT_NE(set, blocks.end());
  std::set<Index> tied, both;
  for (const std::string& node : set->fields()) tied.insert(static_cast<Index>(std::stoul(node) - 1));
  const std::set<Index> minus = nodes_with_tag(mesh, report.interfaces.sides[0].minus);
  for (const Index node : nodes_with_tag(mesh, report.interfaces.sides[0].plus)) {
    if (minus.contains(node))
      both.insert(node);
    else
      EXPECT_TRUE(tied.contains(node));
  }
  EXPECT_FALSE(both.empty());
  EXPECT_LE(both.size(), report.front_nodes)
      << "some corners of the facet have only triangles that stay closed";
  for (const Index node : both) EXPECT_FALSE(tied.contains(node));
  EXPECT_EQ(tied.size(), report.new_nodes);
}

TEST(AbaqusInterfaces, ContactPairsNameBothSurfaces) {
  const auto [mesh, report] = apart(1, Interaction::contact, false);
  const std::vector<Block> blocks = written(mesh, report.interfaces);
  const std::vector<Block> pairs = named(blocks, "CONTACT PAIR");
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].parameters.at("INTERACTION"), "CONTACT");
  std::map<std::string, std::size_t> sides;
  for (const Block& block : named(blocks, "SURFACE")) sides[block.parameters.at("NAME")] = block.lines.size();
  for (const std::string& name : pairs[0].lines.at(0))
    EXPECT_EQ(sides[name], report.patches.at(0).faces) << name;
  EXPECT_NE(pairs[0].lines[0].at(0), pairs[0].lines[0].at(1));
}

TEST(AbaqusInterfaces, CohesiveElementsFillTheInterface) {
  for (const unsigned order : {1U, 2U}) {
    const auto [mesh, report] = apart(order, Interaction::free, true);
    const std::vector<Block> blocks = written(mesh, report.interfaces);
    const std::vector<Point> points = nodes_of(blocks);
    const Elements elements = elements_of(blocks);
    EXPECT_EQ(elements.nodes.size(),
              mesh.tets.size() + (order == 1 ? 1 : 4) * report.interfaces.prisms.size());
    double area = 0;
    for (const auto& [number, nodes] : elements.nodes) {
      if (elements.type.at(number) != "COH3D6") continue;
      EXPECT_TRUE(elements.set.at(number).starts_with("COHESIVE_"));
      ASSERT_EQ(nodes.size(), 6U);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(points[nodes[k]], points[nodes[k + 3]]);
        EXPECT_NE(nodes[k], nodes[k + 3]);
      }
      const Vector n = cross(points[nodes[1]] - points[nodes[0]], points[nodes[2]] - points[nodes[0]]);
      EXPECT_EQ(std::hypot(n.x, n.y), 0);
      area += 0.5 * n.z;
    }
    EXPECT_NEAR(std::fabs(area), 1, 1e-12);
  }
}

TEST(AbaqusInterfaces, OtherFormatsHaveNoPlaceForThem) {
  io::require_place_for_interfaces("a.inp", {.interaction = Interaction::tie});
  io::require_place_for_interfaces("a.vtu", {.keep_apart = true});
  io::require_place_for_interfaces("a", {.cohesive = true}, ".INP");
  for (const SplitOptions& options :
       {SplitOptions{.interaction = Interaction::tie}, SplitOptions{.interaction = Interaction::contact},
        SplitOptions{.cohesive = true}})
    expect_error<WriteError>([&] { io::require_place_for_interfaces("a.vtu", options); }, "a.vtu",
                             "no place for ties");
  const TemporaryFolder folder;
  const auto [mesh, report] = apart(1, Interaction::free, false);
  io::write_tet_mesh(folder.file("a.msh"), mesh, report.interfaces);
  EXPECT_EQ(io::read_tet_mesh(folder.file("a.msh")).points, mesh.points);
}

}  // namespace
}  // namespace collarmesh::io_abaqus_test
