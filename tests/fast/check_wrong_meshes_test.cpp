// For each guarantee, a mesh that breaks it: the certificate names it and no guarantee that holds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>

#include "check/guarantees.h"
#include "collarmesh/check.h"
#include "support/meshes.h"

namespace collarmesh::check_wrong_meshes_test {
namespace {

using namespace collarmesh::testing;
using namespace collarmesh::guarantee;
using Names = std::set<std::string>;

// Expects that the findings equal those of one thread, in the same order.
void expect_same_findings(const CheckReport& a, const CheckReport& b) {
  EXPECT_EQ(a.findings_total, b.findings_total);
  ASSERT_EQ(a.findings.size(), b.findings.size());
  for (std::size_t i = 0; i < a.findings.size(); ++i) EXPECT_EQ(a.findings[i].message, b.findings[i].message);
}

Names broken(const TetMesh& mesh, const Plc& plc, CheckOptions options = {}) {
  const CheckReport report = check(mesh, plc, options);
  options.threads = 1;
  expect_same_findings(report, check(mesh, plc, options));
  Names names;
  for (const Finding& f : report.findings) {
    names.insert(f.guarantee);
    EXPECT_FALSE(f.message.empty());
  }
  EXPECT_EQ(report.passed(), names.empty());
  return names;
}
Names broken(const MeshedComplex& m, const CheckOptions& options = {}) {
  return broken(m.mesh, m.plc, options);
}

template <class Predicate>
Index first_index(std::size_t n, const Predicate& predicate) {
  for (Index i = 0; i < n; ++i)
    if (predicate(i)) return i;
  ADD_FAILURE() << "the mesh has no such entity";
  return 0;
}

Index point_of_dimension(const TetMesh& mesh, unsigned dimension) {
  return first_index(mesh.points.size(), [&](Index p) { return mesh.features[p].dimension == dimension; });
}

Index inner_tet(const TetMesh& mesh) {
  return first_index(mesh.tets.size(), [&](Index t) {
    return std::all_of(mesh.tets[t].begin(), mesh.tets[t].end(),
                       [&](Index p) { return mesh.features[p].dimension == 3; });
  });
}

template <class T>
void erase(std::vector<T>& list, Index i) {
  list.erase(list.begin() + i);
}

void erase_tet(TetMesh& mesh, Index t) {
  erase(mesh.tets, t);
  erase(mesh.tet_region, t);
  erase(mesh.tet_tag, t);
  erase(mesh.tet_collar, t);
  erase(mesh.tet_crease, t);
}

void erase_face(TetMesh& mesh, Index f) {
  erase(mesh.faces, f);
  erase(mesh.face_regions, f);
  erase(mesh.face_patch, f);
  erase(mesh.face_tag, f);
}

void add_face(TetMesh& mesh, const std::array<Index, 3>& corners, const std::array<Index, 2>& regions,
              Index like) {
  mesh.faces.push_back(corners);
  mesh.face_regions.push_back(regions);
  mesh.face_patch.push_back(mesh.face_patch[like]);
  mesh.face_tag.push_back(mesh.face_tag[like]);
}

void erase_edge(TetMesh& mesh, Index e) {
  erase(mesh.edges, e);
  erase(mesh.edge_curve, e);
  erase(mesh.edge_tag, e);
}

Index patch_with_tag(const Plc& plc, Tag tag) {
  return first_index(plc.patches.size(), [&](Index p) { return plc.patches[p].tag == tag; });
}

// Arrays

TEST(CheckWrongMeshes, ArrayTooShort) {
  MeshedComplex m = meshed_box(2);
  m.mesh.tet_region.pop_back();
  EXPECT_EQ(broken(m), Names{valid_arrays});
}

TEST(CheckWrongMeshes, IndexOutOfRange) {
  for (const auto& spoil :
       {std::function([](TetMesh& mesh) { mesh.tets[3][1] = 1000; }),
        std::function([](TetMesh& mesh) { mesh.faces[0][0] = none; }),
        std::function([](TetMesh& mesh) { mesh.edges[0][1] = mesh.edges[0][0]; }),
        std::function([](TetMesh& mesh) { mesh.tet_region[5] = 0; }),
        std::function([](TetMesh& mesh) { mesh.tet_region[5] = 2; }),
        std::function([](TetMesh& mesh) { mesh.face_patch[5] = 6; }),
        std::function([](TetMesh& mesh) { mesh.face_regions[5][1] = 9; }),
        std::function([](TetMesh& mesh) { mesh.edge_curve[5] = 12; }), std::function([](TetMesh& mesh) {
          mesh.features[0] = {1, 12};
        })}) {
    MeshedComplex m = meshed_box(2);
    spoil(m.mesh);
    EXPECT_EQ(broken(m), Names{valid_arrays});
  }
}

TEST(CheckWrongMeshes, PointNotFinite) {
  MeshedComplex m = meshed_box(2);
  m.mesh.points[4].y = NAN;
  EXPECT_EQ(broken(m), Names{finite_points});
}

TEST(CheckWrongMeshes, TwoPointsAtOnePlace) {
  MeshedComplex m = meshed_box(4);
  TetMesh& mesh = m.mesh;
  const Index tet = inner_tet(mesh);
  mesh.points.push_back(mesh.points[mesh.tets[tet][0]]);
  mesh.features.push_back({});
  mesh.tets[tet][0] = static_cast<Index>(mesh.points.size() - 1);
  EXPECT_EQ(broken(m), (Names{distinct_points, listed_faces}));
}

TEST(CheckWrongMeshes, PointsAtOnePlaceAreNamedInPairs) {
  MeshedComplex m = meshed_box(2);
  const auto first = static_cast<Index>(m.mesh.points.size());
  for (const double x : {0.0, 5.0, -0.0, 0.0, 5.0}) {
    m.mesh.points.push_back({x, -0.0, 7});
    m.mesh.features.push_back({});
  }
  std::vector<std::vector<Index>> pairs;
  for (const auto& finding : check(m.mesh, m.plc).findings)
    if (finding.guarantee == distinct_points) pairs.push_back(finding.ids);
  EXPECT_EQ(pairs, (std::vector<std::vector<Index>>{
                       {first, first + 2}, {first + 1, first + 4}, {first + 2, first + 3}}));
}

TEST(CheckWrongMeshes, PointWithoutTet) {
  MeshedComplex m = meshed_box(2);
  m.mesh.points.push_back({0.123, 0.4, 0.5});
  m.mesh.features.push_back({});
  EXPECT_EQ(broken(m), Names{referenced_points});
}

TEST(CheckWrongMeshes, WrongTagOfTet) {
  MeshedComplex m = meshed_box(2);
  m.mesh.tet_tag[7] += 1;
  EXPECT_EQ(broken(m), Names{region_tag});
}

TEST(CheckWrongMeshes, WrongFeatureOfPoint) {
  for (const unsigned dimension : {0U, 1U, 2U, 3U}) {
    MeshedComplex m = meshed_box(3);
    auto& feature = m.mesh.features[point_of_dimension(m.mesh, dimension)];
    feature = dimension == 3 ? TetMesh::VertexFeature{2, 0} : TetMesh::VertexFeature{};
    EXPECT_EQ(broken(m), Names{vertex_feature}) << dimension;
  }
}

// Tets

TEST(CheckWrongMeshes, InvertedTet) {
  MeshedComplex m = meshed_box(4);
  auto& tet = m.mesh.tets[inner_tet(m.mesh)];
  std::swap(tet[0], tet[1]);
  EXPECT_EQ(broken(m), (Names{positive_volume, conforming, region_volume}));
}

TEST(CheckWrongMeshes, FlatTet) {
  MeshedComplex m = meshed_box(4);
  TetMesh& mesh = m.mesh;
  const Index p = point_of_dimension(mesh, 3);
  const auto& tet = mesh.tets[first_index(mesh.tets.size(), [&](Index t) { return mesh.tets[t][0] == p; })];
  mesh.points[p] = 0.5 * (mesh.points[tet[1]] + mesh.points[tet[2]]);
  EXPECT_EQ(broken(m), (Names{positive_volume, radius_edge}));
}

TEST(CheckWrongMeshes, TetTwice) {
  MeshedComplex m = meshed_box(4);
  TetMesh& mesh = m.mesh;
  const Index t = inner_tet(mesh);
  const auto [a, b, c, d] = mesh.tets[t];
  mesh.tets.push_back({b, c, a, d});
  mesh.tet_region.push_back(mesh.tet_region[t]);
  mesh.tet_tag.push_back(mesh.tet_tag[t]);
  mesh.tet_collar.push_back(0);
  mesh.tet_crease.push_back(0);
  EXPECT_EQ(broken(m), (Names{distinct_tets, region_volume}));
}

TEST(CheckWrongMeshes, ThreeTetsAtAFace) {
  MeshedComplex m = meshed_box(4);
  TetMesh& mesh = m.mesh;
  const Index t = inner_tet(mesh);
  mesh.points.push_back(mesh.points[mesh.tets[t][3]] + Point{0.01, 0.02, 0.015});
  mesh.features.push_back({});
  mesh.tets.push_back(mesh.tets[t]);
  mesh.tets.back()[3] = static_cast<Index>(mesh.points.size() - 1);
  mesh.tet_region.push_back(mesh.tet_region[t]);
  mesh.tet_tag.push_back(mesh.tet_tag[t]);
  mesh.tet_collar.push_back(0);
  mesh.tet_crease.push_back(0);
  EXPECT_EQ(broken(m), (Names{conforming, listed_faces, region_volume}));
}

TEST(CheckWrongMeshes, RadiusEdgeAboveTheBound) {
  EXPECT_EQ(broken(meshed_box(2), {.bounds = {.radius_edge = 0.866}}), Names{radius_edge});
  MeshedComplex m = meshed_box(3);
  const Index p = point_of_dimension(m.mesh, 3);
  const Index t = first_index(m.mesh.tets.size(), [&](Index i) { return m.mesh.tets[i][0] == p; });
  m.mesh.points[p] = m.mesh.points[p] + 0.9 * (m.mesh.points[m.mesh.tets[t][1]] - m.mesh.points[p]);
  EXPECT_EQ(broken(m), Names{radius_edge});
}

// Regions

TEST(CheckWrongMeshes, MissingTet) {
  MeshedComplex m = meshed_box(4);
  erase_tet(m.mesh, inner_tet(m.mesh));
  EXPECT_EQ(broken(m), (Names{listed_faces, region_volume}));
}

TEST(CheckWrongMeshes, TetInTheWrongRegion) {
  MeshedComplex m = meshed_two_boxes(4);
  const Index t = inner_tet(m.mesh);
  m.mesh.tet_region[t] = 3 - m.mesh.tet_region[t];
  EXPECT_EQ(broken(m), (Names{region_tag, listed_faces, region_volume}));
  m.mesh.tet_tag[t] = m.plc.regions[m.mesh.tet_region[t]].tag;
  EXPECT_EQ(broken(m), (Names{listed_faces, region_volume}));
}

TEST(CheckWrongMeshes, MissingBoundaryFace) {
  MeshedComplex m = meshed_box(3);
  erase_face(m.mesh, 0);
  EXPECT_EQ(broken(m), (Names{listed_faces, watertight, patch_border, patch_area}));
}

TEST(CheckWrongMeshes, MissingInterfaceFace) {
  MeshedComplex m = meshed_two_boxes(3);
  erase_face(m.mesh,
             first_index(m.mesh.faces.size(), [&](Index f) { return m.mesh.face_regions[f][1] != 0; }));
  EXPECT_EQ(broken(m), (Names{listed_faces, watertight, patch_border, patch_area}));
}

TEST(CheckWrongMeshes, FaceTwice) {
  MeshedComplex m = meshed_box(3);
  add_face(m.mesh, m.mesh.faces[5], m.mesh.face_regions[5], 5);
  const Names names = broken(m);
  EXPECT_EQ(names.count(listed_faces), 1U);
  EXPECT_EQ(names.count(patch_area), 1U);
}

TEST(CheckWrongMeshes, FaceTurnedRound) {
  MeshedComplex m = meshed_box(3);
  std::swap(m.mesh.faces[5][0], m.mesh.faces[5][1]);
  EXPECT_EQ(broken(m), (Names{face_regions, watertight, patch_orientation}));
  std::swap(m.mesh.face_regions[5][0], m.mesh.face_regions[5][1]);
  EXPECT_EQ(broken(m), Names{}) << "a face may be listed either way, with its regions";
}

TEST(CheckWrongMeshes, FaceWithWrongRegions) {
  MeshedComplex m = meshed_two_boxes(2);
  const Index f = first_index(m.mesh.faces.size(), [&](Index i) { return m.mesh.face_regions[i][1] == 0; });
  m.mesh.face_regions[f][0] = 3 - m.mesh.face_regions[f][0];
  EXPECT_EQ(broken(m), (Names{face_regions, watertight, patch_regions}));
}

TEST(CheckWrongMeshes, RegionsExchanged) {
  MeshedComplex m = meshed_two_boxes(2);
  for (Index t = 0; t < m.mesh.tets.size(); ++t) {
    m.mesh.tet_region[t] = 3 - m.mesh.tet_region[t];
    m.mesh.tet_tag[t] = m.plc.regions[m.mesh.tet_region[t]].tag;
  }
  for (auto& regions : m.mesh.face_regions)
    for (Index& r : regions) r = r == 0 ? 0 : 3 - r;
  EXPECT_EQ(broken(m).count(patch_regions), 1U);
  EXPECT_EQ(broken(m).count(region_volume), 0U);
}

// Vertices and curves

TEST(CheckWrongMeshes, VertexOfTheComplexMissing) {
  MeshedComplex m = meshed_box(2);
  m.plc.points.push_back({0.1, 0.2, 0.3});
  m.plc.vertices.push_back({static_cast<Index>(m.plc.points.size() - 1), 0, {}, {}});
  EXPECT_EQ(broken(m), Names{vertex_present});
  m.plc.points.back() = {3, 3, 3};
  EXPECT_EQ(broken(m), Names{}) << "outside all regions the mesh has no vertices";
}

TEST(CheckWrongMeshes, CornerMoved) {
  MeshedComplex m = meshed_box(2);
  Point& corner = m.mesh.points[point_of_dimension(m.mesh, 0)];
  corner = corner + Point{1e-9, 1e-9, 1e-9};
  EXPECT_EQ(broken(m).count(vertex_present), 1U);
}

TEST(CheckWrongMeshes, LooseCurveMissing) {
  MeshedComplex m = meshed_box(2);
  const auto first = static_cast<Index>(m.plc.points.size());
  m.plc.points.insert(m.plc.points.end(), {{0.3, 0.3, 0.3}, {0.6, 0.4, 0.5}, {0.5, 0.7, 0.4}});
  m.plc.curves.push_back({{first, first + 1, first + 2}, {none, none}, true, false, 0, {}});
  EXPECT_EQ(broken(m), Names{curve_cover});
}

TEST(CheckWrongMeshes, MissingEdge) {
  MeshedComplex m = meshed_box(3);
  erase_edge(m.mesh, first_index(m.mesh.edges.size(), [&](Index e) {
               return m.mesh.features[m.mesh.edges[e][0]].dimension == 1 &&
                      m.mesh.features[m.mesh.edges[e][1]].dimension == 1;
             }));
  EXPECT_EQ(broken(m), (Names{curve_cover, patch_border}));
  EXPECT_EQ(broken(without_features(m.mesh), m.plc).count(curve_cover), 1U);
}

TEST(CheckWrongMeshes, MissingEdgeOfAClosedCurve) {
  MeshedComplex m = meshed_cylinder(12, 4);
  ASSERT_EQ(broken(m, {.bounds = {.distance = 0.05}}), Names{});
  erase_edge(m.mesh, 4);
  EXPECT_EQ(broken(m, {.bounds = {.distance = 0.05}}), (Names{curve_cover, patch_border}));
}

TEST(CheckWrongMeshes, EdgeTwice) {
  MeshedComplex m = meshed_box(3);
  m.mesh.edges.push_back(m.mesh.edges[2]);
  m.mesh.edge_curve.push_back(m.mesh.edge_curve[2]);
  m.mesh.edge_tag.push_back(m.mesh.edge_tag[2]);
  EXPECT_EQ(broken(m), (Names{listed_edges, curve_cover}));
}

TEST(CheckWrongMeshes, EdgeOfNoTet) {
  // Two edges of a curve become one: the curve is covered, but no tet has that edge.
  MeshedComplex m = meshed_box(2);
  TetMesh& mesh = m.mesh;
  const Index p = point_of_dimension(mesh, 1);
  std::vector<Index> at;
  for (Index e = 0; e < mesh.edges.size(); ++e)
    if (mesh.edges[e][0] == p || mesh.edges[e][1] == p) at.push_back(e);
  ASSERT_EQ(at.size(), 2U);
  const auto other = [&](Index e) { return mesh.edges[e][0] == p ? mesh.edges[e][1] : mesh.edges[e][0]; };
  mesh.edges[at[0]] = {other(at[0]), other(at[1])};
  erase_edge(mesh, at[1]);
  mesh.features.clear();
  EXPECT_EQ(broken(m), (Names{listed_edges, patch_border}));
}

TEST(CheckWrongMeshes, WrongTagOfEdge) {
  MeshedComplex m = meshed_box(2);
  m.mesh.edge_tag[3] = 77;
  EXPECT_EQ(broken(m), Names{curve_tag});
  EXPECT_EQ(broken(without_features(m.mesh), m.plc).count(curve_tag), 1U);
}

TEST(CheckWrongMeshes, CurveVertexOffTheCurve) {
  for (const double off : {1e-2, 1e-10}) {
    MeshedComplex m = meshed_box(3);
    const Index p = first_index(m.mesh.points.size(), [&](Index i) {
      const Point& q = m.mesh.points[i];
      return m.mesh.features[i].dimension == 1 && q.y == 0 && q.z == 0;
    });
    m.mesh.points[p].z += off;  // the vertex stays in the plane of one patch and leaves the other patch's
                                // plane
    const Names names = broken(m);
    EXPECT_EQ(names.count(curve_distance), 1U) << off;
    EXPECT_EQ(names.count(patch_plane), 1U) << off;
    EXPECT_EQ(names.count(curve_cover), 0U) << off;
  }
}

TEST(CheckWrongMeshes, CurveVertexMovedAlongTheCurveIsRight) {
  MeshedComplex m = meshed_box(3);
  const Index p = first_index(m.mesh.points.size(), [&](Index i) {
    const Point& q = m.mesh.points[i];
    return m.mesh.features[i].dimension == 1 && q.y == 0 && q.z == 0;
  });
  m.mesh.points[p].x += 0.05;
  EXPECT_EQ(broken(m), Names{});
}

TEST(CheckWrongMeshes, SmoothCurveTooCoarse) {
  // 1 - cos(15 degrees) = 0.034
  EXPECT_EQ(broken(meshed_cylinder(12, 4), {.bounds = {.distance = 0.04}}), Names{});
  const Names names = broken(meshed_cylinder(12, 4), {.bounds = {.distance = 0.03}});
  EXPECT_EQ(names.count(curve_distance), 1U);
  EXPECT_EQ(names.count(patch_distance), 1U);
}

TEST(CheckWrongMeshes, CurveLeavesALoopOut) {
  // The curve makes a detour that no vertex or edge of the mesh follows.
  MeshedComplex m = meshed_cylinder(12, 4);
  const Plc::Curve& curve = m.plc.curves[0];
  const Index i = curve.points[2];  // a point between two vertices of the mesh
  m.plc.points[i] = 1.5 * m.plc.points[i];
  EXPECT_EQ(broken(m, {.bounds = {.distance = 0.05}}).count(curve_distance), 1U);
}

// Patches

TEST(CheckWrongMeshes, WrongTagOfFace) {
  MeshedComplex m = meshed_box(2);
  m.mesh.face_tag[3] = 77;
  EXPECT_EQ(broken(m), Names{patch_tag});
}

TEST(CheckWrongMeshes, FaceOfAnotherPatch) {
  MeshedComplex m = meshed_box(3);
  m.mesh.face_patch[0] = (m.mesh.face_patch[0] + 1) % 6;
  m.mesh.face_tag[0] = m.plc.patches[m.mesh.face_patch[0]].tag;
  m.mesh.features.clear();
  const Names names = broken(m);
  for (const char* name : {patch_border, patch_plane, patch_area}) EXPECT_EQ(names.count(name), 1U) << name;
  EXPECT_EQ(names.count(watertight), 0U);
}

TEST(CheckWrongMeshes, PatchVertexOffThePlane) {
  for (const double off : {1e-6, -1e-9}) {
    MeshedComplex m = meshed_box(3);
    const Index p = first_index(m.mesh.points.size(), [&](Index i) {
      return m.mesh.features[i].dimension == 2 && m.mesh.points[i].z == 0;
    });
    m.mesh.points[p].z -= off;
    EXPECT_EQ(broken(m), (Names{patch_plane, region_volume})) << off;
  }
}

TEST(CheckWrongMeshes, SurfaceFoldsBack) {
  MeshedComplex m = meshed_box(4);
  const Index p = first_index(m.mesh.points.size(), [&](Index i) {
    return m.mesh.features[i].dimension == 2 && m.mesh.points[i].z == 0;
  });
  m.mesh.points[p].x += 0.4;
  const Names names = broken(m);
  for (const char* name : {patch_orientation, patch_area, positive_volume})
    EXPECT_EQ(names.count(name), 1U) << name;
  EXPECT_EQ(names.count(patch_plane), 0U);
}

TEST(CheckWrongMeshes, DanglingFacet) {
  MeshedComplex m = meshed_box_with_facet(4);
  const Index patch = patch_with_tag(m.plc, 7);
  const auto on_facet = [&](Index f) { return m.mesh.face_patch[f] == patch; };
  const Index face = first_index(m.mesh.faces.size(), on_facet);

  MeshedComplex missing = m;
  erase_face(missing.mesh, face);
  EXPECT_EQ(broken(missing), (Names{patch_border, patch_area}));

  MeshedComplex one_turned = m;
  std::swap(one_turned.mesh.faces[face][0], one_turned.mesh.faces[face][1]);
  EXPECT_EQ(broken(one_turned), Names{patch_orientation});

  MeshedComplex all_turned = m;
  for (Index f = 0; f < m.mesh.faces.size(); ++f)
    if (on_facet(f)) std::swap(all_turned.mesh.faces[f][0], all_turned.mesh.faces[f][1]);
  EXPECT_EQ(broken(all_turned), Names{}) << "inside a region either side may be the front";

  MeshedComplex lost = m;
  for (Index f = static_cast<Index>(m.mesh.faces.size()); f-- > 0;)
    if (on_facet(f)) erase_face(lost.mesh, f);
  lost.mesh.features.clear();
  EXPECT_EQ(broken(lost), Names{patch_border});
}

TEST(CheckWrongMeshes, PatchWithABubble) {
  // The four sides of a tet that touches the facet in one point.
  MeshedComplex m = meshed_box_with_facet(4);
  TetMesh& mesh = m.mesh;
  const Index patch = patch_with_tag(m.plc, 7);
  const Index face = first_index(mesh.faces.size(), [&](Index f) { return mesh.face_patch[f] == patch; });
  const Index centre = first_index(mesh.points.size(), [&](Index p) {
    return mesh.points[p] == Point{0.5, 0.5, 0.5};
  });
  const Index tet = first_index(mesh.tets.size(), [&](Index t) {
    const auto& corners = mesh.tets[t];
    return std::count(corners.begin(), corners.end(), centre) == 1 &&
           std::count_if(corners.begin(), corners.end(), [&](Index p) { return mesh.points[p].z == 0.5; }) ==
               1;
  });
  const auto [a, b, c, d] = mesh.tets[tet];
  for (const auto& side : {std::array{b, c, d}, {a, d, c}, {a, b, d}, {a, c, b}})
    add_face(mesh, side, {1, 1}, face);
  mesh.features.clear();
  m.plc.patches[patch].planar = false;
  EXPECT_EQ(broken(m, {.bounds = {.distance = 1}}), Names{patch_manifold});
}

TEST(CheckWrongMeshes, PatchWithAFin) {
  MeshedComplex m = meshed_box_with_facet(4);
  TetMesh& mesh = m.mesh;
  const Index patch = patch_with_tag(m.plc, 7);
  const Index face = first_index(mesh.faces.size(), [&](Index f) { return mesh.face_patch[f] == patch; });
  const auto on_facet = [&](Index p) {
    const Point& q = mesh.points[p];
    return q.z == 0.5 && std::abs(q.x - 0.5) < 0.3 && std::abs(q.y - 0.5) < 0.3;
  };
  const Index tet = first_index(mesh.tets.size(), [&](Index t) {
    const auto& corners = mesh.tets[t];
    return std::count_if(corners.begin(), corners.end(), on_facet) == 2 &&
           std::any_of(corners.begin(), corners.end(), [&](Index p) {
             return mesh.points[p] == Point{0.5, 0.5, 0.5};
           });
  });
  std::array<Index, 3> fin{};
  unsigned low = 0;
  for (const Index p : mesh.tets[tet]) {
    if (on_facet(p))
      fin[low++] = p;
    else
      fin[2] = p;
  }
  add_face(mesh, fin, {1, 1}, face);
  mesh.features.clear();
  m.plc.patches[patch].planar = false;
  EXPECT_EQ(broken(m, {.bounds = {.distance = 1}}), (Names{patch_manifold, patch_border}));
}

TEST(CheckWrongMeshes, SmoothPatchTooCoarse) {
  const MeshedComplex m = meshed_ball(4, 4);
  const double found = check(m.mesh, m.plc, {.bounds = {.distance = 1}}).max_surface_distance;
  EXPECT_EQ(broken(m, {.bounds = {.distance = 1.001 * found}}), Names{});
  EXPECT_EQ(broken(m, {.bounds = {.distance = 0.95 * found}}), Names{patch_distance});
}

TEST(CheckWrongMeshes, LostSpike) {
  MeshedComplex m = meshed_ball(4, 4);
  const Index tip = first_index(m.plc.points.size(), [&](Index i) {
    return std::none_of(m.mesh.points.begin(), m.mesh.points.end(),
                        [&](const Point& p) { return distance(p, m.plc.points[i]) < 0.05; });
  });
  m.plc.points[tip] = 1.3 * m.plc.points[tip];
  EXPECT_EQ(broken(m, {.bounds = {.distance = 0.05}}), Names{patch_distance});
}

// Presses tets against one face of the box, and others, less, against an inner layer of vertices.
TEST(CheckWrongMeshes, AnglesAreMissedAtFeaturesThatHaveNames) {
  MeshedComplex m = meshed_box(8);
  m.mesh.tet_thin.assign(m.mesh.tets.size(), 1);
  const auto move = [&](const Point& from, const Point& to) {
    m.mesh.points[first_index(m.mesh.points.size(), [&](Index p) { return m.mesh.points[p] == from; })] = to;
  };
  move({0.5, 0.5, 0.125}, {0.5, 0.5, 1e-3});
  move({0.5, 0.5, 0.5}, {0.5, 0.5, 0.38});
  const Index floor = first_index(m.plc.patches.size(), [&](Index p) {
    return std::fabs(m.plc.patches[p].normal.z) > 0.9 && std::fabs(m.plc.patches[p].origin.z) < 0.1;
  });
  m.plc.names.set(2, m.plc.patches[floor].tag, "bed plate");
  const CheckReport report = check(m.mesh, m.plc, {.bounds = {.radius_edge = 1}});
  ASSERT_FALSE(report.findings.empty());
  const auto is_said = [&](const Finding& finding, const std::string& text) {
    return finding.message.find(text) != std::string::npos;
  };
  for (const Finding& finding : report.findings) {
    EXPECT_EQ(finding.guarantee, thin_angles);
    EXPECT_TRUE(is_said(finding, "in region 1 (tag 1) and touching ")) << finding.message;
    const bool at_floor = finding.where.z < 0.1;
    EXPECT_EQ(is_said(finding, "bed plate"), at_floor) << finding.message;
    EXPECT_EQ(is_said(finding, "no feature"), !at_floor) << finding.message;
  }
  EXPECT_LT(report.findings.front().where.z, 0.1) << "the worst ones come first";
  EXPECT_GT(report.findings.back().where.z, 0.1);
}

TEST(CheckWrongMeshes, FindingsAreCountedBeyondThoseListed) {
  const CheckReport report = check(meshed_box(3).mesh, meshed_box(3).plc,
                                   {.bounds = {.radius_edge = 0.5}, .findings_per_guarantee = 4});
  EXPECT_EQ(report.findings.size(), 4U);
  EXPECT_EQ(report.findings_total, 6 * 27U);
}

// Makes many findings in a mesh that is large enough for every thread to get a part of it.
TEST(CheckWrongMeshes, AnyNumberOfThreadsFindsTheSame) {
  MeshedComplex m = meshed_box(20);
  TetMesh& mesh = m.mesh;
  for (std::size_t t = 0, count = mesh.tets.size(); t < count; t += 977) {
    mesh.tets.push_back(mesh.tets[t]);
    mesh.tet_region.push_back(mesh.tet_region[t]);
    mesh.tet_tag.push_back(mesh.tet_tag[t]);
    mesh.tet_collar.push_back(0);
    mesh.tet_crease.push_back(0);
    if (!mesh.tet_thin.empty()) mesh.tet_thin.push_back(0);
    std::swap(mesh.tets[t + 100][0], mesh.tets[t + 100][1]);
  }
  for (std::size_t f = 0; f < mesh.faces.size(); f += 211)
    std::swap(mesh.face_regions[f][0], mesh.face_regions[f][1]);
  CheckOptions options{.findings_per_guarantee = 10000, .threads = 1};
  const CheckReport by_one = check(mesh, m.plc, options);
  EXPECT_GT(by_one.findings_total, 100U);
  for (const unsigned threads : {2U, 3U, 8U}) {
    options.threads = threads;
    const CheckReport by_several = check(mesh, m.plc, options);
    expect_same_findings(by_one, by_several);
    EXPECT_EQ(by_one.median_edge, by_several.median_edge);
    EXPECT_EQ(by_one.region_volumes, by_several.region_volumes);
  }
}

}  // namespace
}  // namespace collarmesh::check_wrong_meshes_test
