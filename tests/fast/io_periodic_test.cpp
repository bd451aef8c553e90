// The maps of periodic faces in files: links of Gmsh, equations for CalculiX.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "check/periodic.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "collarmesh/second_order.h"
#include "support/meshes.h"
#include "support/periodic.h"
#include "support/temporary_file.h"

namespace collarmesh::io_periodic_test {
namespace {

using namespace collarmesh::testing;

TetMesh periodic_box(Index n, unsigned order) {
  MeshedComplex made = meshed_box(n);
  if (order == 2) make_second_order(made.mesh, made.plc);
  make_box_periodic(made.mesh, {1, 1, 1});
  return made.mesh;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Returns a tet whose side on y = 0 is turned onto the one on x = 0.
TetMesh turned_tet() {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0.5}, {0, 1, 0.5}};
  mesh.tets = {{0, 1, 3, 2}};
  mesh.tet_region = {1};
  mesh.tet_tag = {1};
  mesh.tet_collar = {0};
  mesh.tet_crease = {0};
  mesh.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  mesh.face_tag = {1, 2, 3, 4};
  mesh.face_patch = {0, 1, 2, 3};
  mesh.face_regions.assign(4, {1, 0});
  mesh.periodic = {mapped_faces(mesh, {1}, {2}, quarter_turn())};
  return mesh;
}

TEST(PeriodicFiles, MshHoldsTheMap) {
  const TemporaryFolder folder;
  const std::string path = folder.file("cell.msh");
  for (const unsigned order : {1U, 2U}) {
    const TetMesh mesh = periodic_box(3, order);
    io::write_tet_mesh(path, mesh);
    const TetMesh read = io::read_tet_mesh(path);
    ASSERT_EQ(read.periodic.size(), 3U);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(read.periodic[k].first, mesh.periodic[k].first);
      EXPECT_EQ(read.periodic[k].second, mesh.periodic[k].second);
      EXPECT_EQ(read.periodic[k].motion.rows, mesh.periodic[k].motion.rows);
      EXPECT_EQ(read.periodic[k].motion.shift, mesh.periodic[k].motion.shift);
      EXPECT_EQ(read.periodic[k].nodes, mesh.periodic[k].nodes);
    }
    CheckReport report;
    checks::check_periodic(read, report);
    EXPECT_TRUE(report.passed());
  }
  io::write_tet_mesh(path, meshed_box(2).mesh);
  EXPECT_EQ(text_of(path).find("$Periodic"), std::string::npos);
}

TEST(PeriodicFiles, MshOfVersion2HasLinksOfSurfacesAndCurves) {
  const TemporaryFolder folder;
  const std::string path = folder.file("cell.msh2");
  io::write_tet_mesh(path, periodic_box(2, 1));
  const std::string text = text_of(path);
  std::istringstream links(text.substr(text.find("$Periodic\n") + 10));
  std::size_t count = 0, dimension = 0, entity = 0, master = 0, nodes = 0;
  links >> count;
  std::map<std::size_t, std::size_t> of_dimension;
  for (std::size_t i = 0; i < count; ++i) {
    std::string word;
    links >> dimension >> entity >> master >> word;
    EXPECT_EQ(word, "Affine");
    EXPECT_NE(entity, master);
    ++of_dimension[dimension];
    for (int k = 0; k < 16; ++k) links >> word;
    links >> nodes;
    for (std::size_t k = 0; k < 2 * nodes; ++k) links >> word;
  }
  EXPECT_EQ(of_dimension, (std::map<std::size_t, std::size_t>{{1, 9}, {2, 3}}))
      << "of 12 edges 3 are masters";
  std::string end;
  links >> end;
  EXPECT_EQ(end, "$EndPeriodic");
}

/// The contents of a file of conditions: references by pair, and rows of (node, direction, factor).
struct Conditions {
  std::vector<Index> references;  // numbers from 1
  struct Term {
    Index node;
    std::size_t direction;
    double factor;
  };
  std::vector<std::vector<Term>> equations;
  std::string text;
};

Conditions conditions_of(const std::string& path) {
  Conditions found;
  found.text = text_of(path);
  std::string text = found.text;
  for (char& c : text)
    if (c == ',') c = ' ';
  for (std::size_t at = 0; (at = text.find("_REFERENCE\n", at)) != std::string::npos;) {
    at += std::string("_REFERENCE\n").size();
    found.references.push_back(static_cast<Index>(std::stoul(text.substr(at))));
  }
  std::istringstream rows(text.substr(text.find("*EQUATION\n") + 10));
  for (std::size_t terms = 0; rows >> terms;) {
    found.equations.emplace_back(terms);
    for (Conditions::Term& term : found.equations.back()) rows >> term.node >> term.direction >> term.factor;
  }
  return found;
}

/// Expects that displacements satisfy all equations. They are a strain for moved faces, a rotation for turned
/// ones.
void expect_solved(const Conditions& found, const std::map<Index, Vector>& displacements) {
  std::set<std::pair<Index, std::size_t>> dependent;
  for (const auto& equation : found.equations) {
    double sum = 0, largest = 0;
    for (const Conditions::Term& term : equation) {
      const double part = term.factor * displacements.at(term.node)[term.direction - 1];
      sum += part;
      largest = std::max(largest, std::fabs(part));
    }
    EXPECT_NEAR(sum, 0, 1e-11 * (1 + largest));
    EXPECT_TRUE(dependent.insert({equation[0].node, equation[0].direction}).second) << "it depends twice";
  }
  for (const auto& equation : found.equations)
    for (std::size_t k = 1; k < equation.size(); ++k)
      EXPECT_FALSE(dependent.contains({equation[k].node, equation[k].direction}))
          << "others depend on what depends itself";
}

TEST(PeriodicFiles, EquationsLeaveStrainsAndDependOnce) {
  const TemporaryFolder folder;
  constexpr std::array<Vector, 3> strain{Vector{0.3, -0.2, 0.5}, Vector{0.7, 0.1, -0.4},
                                         Vector{-0.6, 0.9, 0.2}};
  const auto strained = [&](const Point& p) {
    return Vector{dot(strain[0], p), dot(strain[1], p), dot(strain[2], p)};
  };
  for (const unsigned order : {1U, 2U}) {
    const TetMesh mesh = periodic_box(3, order);
    io::write_tet_mesh(folder.file("cell.inp"), mesh);
    const Conditions found = conditions_of(folder.file("cell_periodic.inp"));
    ASSERT_EQ(found.references.size(), 3U);
    std::map<Index, Vector> displacements;
    for (Index v = 0; v < mesh.points.size(); ++v) displacements[v + 1] = strained(mesh.points[v]);
    for (std::size_t k = 0; k < 3; ++k)
      displacements[found.references[k]] = strained(mesh.periodic[k].motion.shift);
    expect_solved(found, displacements);
    std::set<Index> images;
    for (const TetMesh::PeriodicFaces& faces : mesh.periodic)
      for (const auto& each : faces.nodes) images.insert(each[1]);
    EXPECT_EQ(found.equations.size(), 3 * images.size());
    const std::string held = "*NSET, NSET=PERIODIC_HELD\n";
    ASSERT_NE(found.text.find(held), std::string::npos);
    const auto node = static_cast<Index>(std::stoul(found.text.substr(found.text.find(held) + held.size())));
    EXPECT_FALSE(images.contains(node - 1)) << "it depends on another";
  }
}

TEST(PeriodicFiles, EquationsTurnAndLeaveTheAxisOut) {
  const TemporaryFolder folder;
  const TetMesh mesh = turned_tet();
  io::write_tet_mesh(folder.file("cell.inp"), mesh);
  const Conditions found = conditions_of(folder.file("cell_periodic.inp"));
  EXPECT_NE(found.text.find("*NSET, NSET=PERIODIC_1_AXIS\n1,\n2,\n"), std::string::npos);
  ASSERT_EQ(found.equations.size(), 3U);
  std::map<Index, Vector> displacements{{3, {0.2, 0.5, 0.7}}, {found.references.at(0), {0, 0, 0}}};
  displacements[4] = {-0.5, 0.2, 0.7};
  expect_solved(found, displacements);
}

TEST(PeriodicFiles, OtherFormatsHaveNoPlaceForTheMap) {
  const TemporaryFolder folder;
  io::write_tet_mesh(folder.file("cell.vtu"), periodic_box(1, 1));
  EXPECT_TRUE(io::read_tet_mesh(folder.file("cell.vtu")).periodic.empty());
}

}  // namespace
}  // namespace collarmesh::io_periodic_test
