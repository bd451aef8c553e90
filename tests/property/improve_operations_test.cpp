// Every local operation of the improvement, one by one: each keeps the certificate and does what it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>

#include "remesh/operations.h"
#include "support/acute_shapes.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::improve_operations_test {
namespace {

using remeshing::Change;
using remeshing::EditableMesh;
using remeshing::Operations;
using remeshing::TetComplex;
using testing::mesh_of;
using testing::Meshed;
using testing::with_size;

struct Shape {
  std::string name;
  std::vector<PolygonSoup> soups;
  double size;
  double feature_angle;
};

std::vector<Shape> shapes() {
  using namespace testing;
  return {{"box", {box()}, 0.25, 0},
          {"fine box", {box()}, 0.18, 0},
          {"two boxes", {two_boxes()}, 0.35, 0},
          {"dangling facet", {box_with_dangling_facet()}, 0.3, 0},
          {"plate", {plate_with_hole(1, 16)}, 0.6, 0},
          {"sphere in a box", {box({-1, -1, -1}, {1, 1, 1}), icosphere(0.6, 8)}, 0.35, 30},
          {"cylinder", {cylinder(0.5, 1, 40, 4)}, 0.2, 30},
          {"torus", {torus(1, 0.4, 40, 20)}, 0.3, 30},
          {"touching boxes", boxes_touching_in_an_edge(), 0.6, 30},
          {"touching rings", rings_touching_in_a_circle(), 0.5, 30},
          {"wedge", acute::wedge(40).soups, 0.25, 0}};
}

constexpr double radius_edge = 2;
constexpr double distance = 2e-3;       // about a thousandth of the diagonals
constexpr std::size_t attempts = 1000;  // attempts on each mesh
constexpr std::size_t single_steps = 2;

/// A complex, and operations on a mesh of its own.
struct Workbench {
  Workbench(const Meshed& meshed, const TetMesh& of)
      : mesh(of), edited(mesh, meshed.plc, SurfaceTolerance(distance)), operations(edited, rule) {}

  double worst(std::span<const Index> tets) const {
    double quality = INFINITY;
    for (const Index t : tets)
      quality = std::min(quality, remeshing::shape_quality(edited.complex.corners(t)));
    return quality;
  }

  TetMesh mesh;
  EditableMesh edited;
  const TetComplex& complex = edited.complex;
  remeshing::SliverRule rule{radius_edge};
  Operations operations;
};

/// Asks for an operation at a tet and two of its corners.
using Ask = std::function<void(Workbench&, Index tet, unsigned i, unsigned j, Change&)>;

struct Operation {
  std::string name;
  Ask ask;
  Change::Kind kind;
  std::vector<unsigned> dimensions;  ///< dimensions of the features on which the operation must occur
  bool anyhow = false;               ///< the worst tet need not become better, only better than `least`
};

constexpr double least = 0.02;

std::vector<Operation> all_operations() {
  const auto corner = [](Workbench& on, Index tet, unsigned i) { return on.complex[tet].corners[i]; };
  const Ask remove = [](Workbench& on, Index tet, unsigned i, unsigned j, Change& change) {
    on.operations.remove_edge(tet, i, j, change);
  };
  return {{"edge removal", remove, Change::Kind::edge_removal, {3}},
          {"boundary flip", remove, Change::Kind::boundary_flip, {2}},
          {"move",
           [=](Workbench& on, Index tet, unsigned i, unsigned, Change& change) {
             on.operations.move_vertex(corner(on, tet, i), change);
           },
           Change::Kind::move,
           {1, 2, 3}},
          {"insertion",
           [=](Workbench& on, Index tet, unsigned i, unsigned j, Change& change) {
             on.operations.split_edge(corner(on, tet, i), corner(on, tet, j), 0, change);
           },
           Change::Kind::insertion,
           {2, 3}},
          {"collapse",
           [=](Workbench& on, Index tet, unsigned i, unsigned j, Change& change) {
             on.operations.collapse_edge(corner(on, tet, i), corner(on, tet, j), change);
           },
           Change::Kind::collapse,
           {1, 2, 3}},
          {"edge removal anyhow",
           [](Workbench& on, Index tet, unsigned i, unsigned j, Change& change) {
             on.operations.remove_edge(tet, i, j, change, least);
           },
           Change::Kind::edge_removal,
           {3},
           true},
          {"insertion anyhow",
           [=](Workbench& on, Index tet, unsigned i, unsigned j, Change& change) {
             on.operations.split_edge_anyhow(corner(on, tet, i), corner(on, tet, j), least, change);
           },
           Change::Kind::insertion,
           {2, 3},
           true},
          {"collapse anyhow",
           [=](Workbench& on, Index tet, unsigned i, unsigned j, Change& change) {
             on.operations.collapse_edge(corner(on, tet, i), corner(on, tet, j), change, least);
           },
           Change::Kind::collapse,
           {1, 2, 3},
           true}};
}

unsigned dimension_of(const Workbench& on, const Change& change) {
  switch (change.kind) {
    case Change::Kind::move:
    case Change::Kind::collapse: return on.mesh.features[change.vertex].dimension;
    case Change::Kind::insertion: return change.feature.dimension;
    case Change::Kind::boundary_flip: return 2;
    default: return 3;
  }
}

/// Applies a change, and checks that the worst tet of the cavity is as good as promised.
void apply(Workbench& on, const Change& change, bool anyhow = false) {
  std::vector<Index> before = change.replacement.old;
  if (change.kind == Change::Kind::move) on.complex.star(change.vertex, before);
  const double worst = on.worst(before);
  const auto& changed = on.edited.apply(change);
  EXPECT_GT(on.worst(changed), anyhow ? least : worst);
  if (changed.empty()) return;  // a sliver was given to the other side
  EXPECT_NEAR(on.worst(changed), change.quality, 1e-12);
}

std::string faults_of(const Meshed& meshed, TetMesh mesh) {
  Meshed changed{meshed.plc, {}, {}};
  changed.result.mesh = std::move(mesh);
  changed.report = check(changed.result.mesh, changed.plc, {.bounds = {.distance = distance}});
  return testing::faults(changed);
}

/// Finds a place where the operation is possible, on features of this dimension if one is given.
/// `Change::Kind::none` if there is none.
Change find(Workbench& on, const Operation& operation, std::mt19937& random,
            std::optional<unsigned> dimension = {}) {
  for (std::size_t attempt = 0; attempt < attempts; ++attempt) {
    const Index tet = static_cast<Index>(random() % on.complex.size());
    const unsigned i = random() % 4, j = (i + 1 + random() % 3) % 4;
    if (!on.complex[tet].alive || on.complex[tet].collar) continue;
    Change change;
    operation.ask(on, tet, i, j, change);
    if (change.kind == operation.kind &&
        dimension_of(on, change) == dimension.value_or(dimension_of(on, change)))
      return change;
  }
  return {};
}

class ImproveOperations : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    for (const Shape& shape : shapes()) {
      MeshOptions options = with_size(shape.size);
      options.bounds.distance = distance;
      meshes().emplace_back(shape.name, mesh_of(shape.soups, options, shape.feature_angle));
      ASSERT_EQ(testing::faults(meshes().back().second), "") << shape.name;
    }
  }
  static void TearDownTestSuite() { meshes().clear(); }
  static std::vector<std::pair<std::string, Meshed>>& meshes() {
    static std::vector<std::pair<std::string, Meshed>> all;
    return all;
  }
};

/// A rule with which all shapes are equally good.
class AnyShape final : public remeshing::ShapeRule {
 public:
  double quality(const remeshing::Corners&, const std::array<Index, 4>&) const override { return 1; }
  bool allows(const remeshing::Corners&, const std::array<Index, 4>&, double) const override { return true; }
};

/// The link: vertices and pairs, sorted, that cells at a vertex contribute.
using Link = std::set<std::vector<Index>>;

template <class Cells>
Link link_of(const Cells& cells, std::vector<Index> of) {
  Link link;
  for (const auto& cell : cells) {
    std::vector<Index> others;
    for (const Index v : cell)
      if (std::find(of.begin(), of.end(), v) == of.end()) others.push_back(v);
    if (others.size() + of.size() != cell.size()) continue;
    std::sort(others.begin(), others.end());
    for (std::size_t i = 0; i < others.size(); ++i) {
      link.insert({others[i]});
      for (std::size_t j = i + 1; j < others.size(); ++j) link.insert({others[i], others[j]});
    }
  }
  return link;
}

/// Returns whether everything in the links of both ends is in the link of the edge.
template <class Cells>
bool link_condition(const Cells& cells, Index a, Index b) {
  const Link of_a = link_of(cells, {a}), of_b = link_of(cells, {b}), of_edge = link_of(cells, {a, b});
  const auto has = [](const std::vector<Index>& simplex, Index v) {
    return std::find(simplex.begin(), simplex.end(), v) != simplex.end();
  };
  return std::all_of(of_a.begin(), of_a.end(), [&](const std::vector<Index>& simplex) {
    return has(simplex, b) || !of_b.contains(simplex) || of_edge.contains(simplex);
  });
}

// Whatever the shapes, collapses must keep the link condition in the tets and in the mesh's faces.
TEST_F(ImproveOperations, CollapsesOnFeaturesKeepTheLinkCondition) {
  const AnyShape rule;
  std::size_t proposed = 0, forbidden = 0;
  for (const auto& [name, meshed] : meshes()) {
    SCOPED_TRACE(name);
    Workbench on(meshed, meshed.result.mesh);
    Operations operations(on.edited, rule);
    std::set<std::array<Index, 2>> edges;
    for (const auto& face : on.mesh.faces)
      for (unsigned i = 0; i < 3; ++i)
        for (const unsigned j : {(i + 1) % 3, (i + 2) % 3}) edges.insert({face[i], face[j]});
    for (const auto& [vertex, onto] : edges) {
      if (on.mesh.features[vertex].dimension == 0) continue;
      std::vector<std::array<Index, 4>> tets;
      std::vector<std::array<Index, 3>> faces;
      for (const Index end : {vertex, onto}) {
        std::vector<Index> star;
        on.complex.star(end, star);
        for (const Index t : star) tets.push_back(on.complex[t].corners);
        for (const Index t : star)
          for (unsigned corner = 0; corner < 4; ++corner)
            if (on.complex[t].faces[corner] != none && on.complex[t].corners[corner] != end)
              faces.push_back(on.mesh.faces[on.complex[t].faces[corner]]);
      }
      const bool holds = link_condition(tets, vertex, onto) && link_condition(faces, vertex, onto);
      forbidden += holds ? 0 : 1;
      Change change;
      operations.collapse_edge(vertex, onto, change, 0);
      if (change.kind == Change::Kind::none) continue;
      ++proposed;
      EXPECT_TRUE(holds) << vertex << " onto " << onto;
    }
  }
  EXPECT_GT(proposed, 1000U);
  EXPECT_GT(forbidden, 100U);
}

/// Makes a body of these tets. For operations without demands on shapes its whole surface is one plane patch.
TetMesh body(const std::vector<std::array<Index, 4>>& tets, std::vector<Point> points) {
  TetMesh mesh;
  mesh.points = std::move(points);
  mesh.features.resize(mesh.points.size());
  std::map<std::array<Index, 3>, std::pair<unsigned, std::array<Index, 3>>> sides;
  for (std::array<Index, 4> tet : tets) {
    const auto& p = mesh.points;
    if (six_volume(p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]]) < 0) std::swap(tet[0], tet[1]);
    mesh.tets.push_back(tet);
    for (unsigned corner = 0; corner < 4; ++corner) {
      const auto side = side_corners(tet, corner);
      auto key = side;
      std::sort(key.begin(), key.end());
      auto& [count, corners] = sides[key];
      ++count;
      corners = side;
    }
  }
  for (const auto& [key, side] : sides) {
    if (side.first > 1) continue;
    mesh.faces.push_back(side.second);
    for (const Index v : key) mesh.features[v] = {2, 0};
  }
  mesh.tet_region.assign(mesh.tets.size(), 1);
  mesh.tet_tag.assign(mesh.tets.size(), 1);
  mesh.tet_collar.assign(mesh.tets.size(), 0);
  mesh.tet_crease.assign(mesh.tets.size(), 0);
  mesh.face_regions.assign(mesh.faces.size(), {1, 0});
  mesh.face_patch.assign(mesh.faces.size(), 0);
  mesh.face_tag.assign(mesh.faces.size(), 1);
  return mesh;
}

// Bodies in which vertex 0 may be moved onto vertex 1, or in which only one part of the link condition
// forbids the move.
TEST(CollapsesOnFeatures, EachPartOfTheLinkConditionForbidsSome) {
  // Vertex 0 is far away, so that no edge becomes too long.
  const std::vector<Point> points{{9, 8, 7},       {1, 0, 0},      {0, 1, 0.1},    {0, 0.2, 1},
                                  {0.5, 0.5, 0.6}, {-1, 0.4, 0.2}, {-0.5, -1, 0.3}};
  struct Case {
    std::string name;
    std::vector<std::array<Index, 4>> tets;
    bool allowed;
  };
  const std::vector<Case> cases{
      {"octahedron around an axis", {{2, 3, 0, 1}, {2, 3, 1, 4}, {2, 3, 4, 5}, {2, 3, 5, 0}}, true},
      {"two faces would coincide", {{0, 1, 2, 3}}, false},
      {"two tets would coincide",
       {{0, 1, 2, 4}, {0, 1, 3, 4}, {0, 2, 3, 4}, {1, 2, 3, 4}, {0, 2, 3, 5}, {1, 2, 3, 6}},
       false},
      {"on the surface a vertex is joined to both ends beside the edge",
       {{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 2, 3, 5}, {0, 3, 4, 6}},
       false}};
  Plc plc;
  plc.patches.resize(1);
  plc.patches[0].planar = true;
  const AnyShape rule;
  for (const auto& [name, tets, allowed] : cases) {
    SCOPED_TRACE(name);
    TetMesh mesh = body(tets, points);
    EXPECT_EQ(link_condition(mesh.tets, 0, 1) && link_condition(mesh.faces, 0, 1), allowed);
    EditableMesh edited(mesh, plc, SurfaceTolerance(distance));
    Operations operations(edited, rule);
    Change change;
    operations.collapse_edge(0, 1, change, 0);
    EXPECT_EQ(change.kind, allowed ? Change::Kind::collapse : Change::Kind::none);
  }
}

// The mesh passes after each single operation.
TEST_F(ImproveOperations, EachKeepsTheCertificate) {
  for (const Operation& operation : all_operations())
    for (const unsigned dimension : operation.dimensions) {
      std::size_t seen = 0;
      for (const auto& [name, meshed] : meshes()) {
        SCOPED_TRACE(operation.name + ", " + name);
        std::mt19937 random(7);
        for (std::size_t step = 0; step < single_steps; ++step) {
          Workbench on(meshed, meshed.result.mesh);
          const Change change = find(on, operation, random, dimension);
          if (change.kind == Change::Kind::none) break;
          ++seen;
          apply(on, change, operation.anyhow);
          on.edited.store();
          ASSERT_EQ(faults_of(meshed, on.mesh), "");
        }
      }
      EXPECT_GT(seen, 0U) << operation.name << " on features of dimension " << dimension;
    }
}

// The mesh also passes after many operations of all kinds, each applied to the result of earlier ones.
TEST_F(ImproveOperations, ManyKeepTheCertificate) {
  const std::vector<Operation> operations = all_operations();
  for (const auto& [name, meshed] : meshes()) {
    SCOPED_TRACE(name);
    std::mt19937 random(11);
    TetMesh mesh = meshed.result.mesh;
    std::size_t done = 0;
    for (unsigned round = 0; round < 2; ++round) {
      Workbench on(meshed, mesh);
      for (std::size_t step = 0; step < on.complex.size() / 10; ++step) {
        const Operation& operation = operations[random() % operations.size()];
        const Change change = find(on, operation, random);
        if (change.kind == Change::Kind::none) continue;
        apply(on, change, operation.anyhow);
        ++done;
      }
      on.edited.store();
      mesh = on.mesh;
      ASSERT_EQ(faults_of(meshed, mesh), "");
    }
    EXPECT_GT(done, mesh.tets.size() / 40);
  }
}

}  // namespace
}  // namespace collarmesh::improve_operations_test
