// OpenMesh meshes to complexes and back: tags, regions, surfaces that OpenMesh cannot represent, and errors.
#include <gtest/gtest.h>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/error.h"
#include "collarmesh/mesher.h"
#include "collarmesh/openmesh_io.h"

namespace collarmesh::surfaces_test {
namespace {

namespace om = openmesh_io;

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
  VertexAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
};
using DoublePoly = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;
using DoubleTri = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;
using FloatTri = OpenMesh::TriMesh_ArrayKernelT<>;
using FloatPoly = OpenMesh::PolyMesh_ArrayKernelT<>;

const std::vector<std::array<std::size_t, 4>> sides{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                    {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

template <class Mesh>
std::vector<typename Mesh::VertexHandle> add_corners(Mesh& mesh, const Point& low, const Point& high) {
  std::vector<typename Mesh::VertexHandle> v;
  using Coordinate = typename Mesh::Point::value_type;
  for (const double z : {low.z, high.z})
    for (const auto& [x, y] : {std::array{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}})
      v.push_back(mesh.add_vertex(typename Mesh::Point(static_cast<Coordinate>(x), static_cast<Coordinate>(y),
                                                       static_cast<Coordinate>(z))));
  return v;
}

/// Makes a box of quads, which a TriMesh cuts into triangles.
template <class Mesh>
Mesh make_box(const Point& low = {0, 0, 0}, const Point& high = {1, 1, 1}) {
  Mesh mesh;
  const auto v = add_corners(mesh, low, high);
  for (const auto& [a, b, c, d] : sides) mesh.add_face(std::vector{v[a], v[b], v[c], v[d]});
  return mesh;
}

std::set<Tag> patch_tags(const Plc& plc) {
  std::set<Tag> tags;
  for (const Plc::Patch& patch : plc.patches) tags.insert(patch.tag);
  return tags;
}

template <class Mesh>
void expect_unit_box() {
  const om::SurfacesPlc result = om::to_plc(make_box<Mesh>());
  ASSERT_EQ(result.plc.regions.size(), 2);
  EXPECT_DOUBLE_EQ(result.plc.regions[1].volume, 1);
  EXPECT_EQ(result.plc.patches.size(), 6);
  EXPECT_EQ(result.plc.curves.size(), 12);
  EXPECT_EQ(result.plc.vertices.size(), 8);
  EXPECT_TRUE(result.notes.empty());
}

TEST(Surfaces, TakesEveryKindOfMesh) {
  expect_unit_box<DoublePoly>();
  expect_unit_box<DoubleTri>();
  expect_unit_box<FloatTri>();
  expect_unit_box<FloatPoly>();
}

TEST(Surfaces, KeepsTagsOfFacesEdgesAndVertices) {
  DoublePoly box = make_box<DoublePoly>();
  OpenMesh::FPropHandleT<unsigned> side;
  OpenMesh::EPropHandleT<std::int64_t> edge;
  OpenMesh::VPropHandleT<int> corner;
  box.add_property(side, "side");
  box.add_property(edge, "edge");
  box.add_property(corner, "corner");
  for (const auto f : box.faces()) box.property(side, f) = 10 + static_cast<unsigned>(f.idx());
  for (const auto e : box.edges()) box.property(edge, e) = 100 + e.idx();
  for (const auto v : box.vertices()) box.property(corner, v) = -v.idx();
  const Plc plc =
      om::to_plc(box, {.patch_property = "side", .curve_property = "edge", .vertex_property = "corner"}).plc;
  EXPECT_EQ(patch_tags(plc), (std::set<Tag>{10, 11, 12, 13, 14, 15}));
  for (const Plc::Curve& curve : plc.curves) {
    const auto handle = [](Index p) { return OpenMesh::VertexHandle(static_cast<int>(p)); };
    const auto h = box.find_halfedge(handle(curve.points.front()), handle(curve.points.back()));
    ASSERT_TRUE(h.is_valid());
    EXPECT_EQ(curve.tag, 100 + box.edge_handle(h).idx());
  }
  for (const Plc::Vertex& vertex : plc.vertices) EXPECT_EQ(vertex.tag, -static_cast<Tag>(vertex.point));
  EXPECT_THROW(om::to_plc(box, {.patch_property = "sied"}), OptionError);
  EXPECT_THROW(om::to_plc(box, {.region_property = "edge"}), OptionError)
      << "a property of edges, not of faces";
}

TEST(Surfaces, HonoursTheFeatureBit) {
  DoubleTri box = make_box<DoubleTri>();
  ASSERT_EQ(box.n_edges(), 18) << "each side has a diagonal";
  EXPECT_EQ(om::to_plc(box).plc.curves.size(), 12);
  std::size_t marked = 0;
  for (const auto e : box.edges())
    if (std::fabs(box.calc_edge_length(e) - 1) > 0.1 && marked < 2) {
      box.status(e).set_feature(true);
      ++marked;
    }
  const Plc plc = om::to_plc(box).plc;
  EXPECT_EQ(plc.curves.size(), 14);
  EXPECT_EQ(plc.patches.size(), 8) << "a marked diagonal cuts its side in two";
  EXPECT_EQ(om::to_plc(box, {.feature_edges = false}).plc.curves.size(), 12);
}

TEST(Surfaces, JoinsSeveralMeshesWithTheRegionOfEach) {
  om::Surfaces surfaces;
  surfaces.add(make_box<DoublePoly>(), {.name = "lower", .region = 7});
  surfaces.add(make_box<FloatTri>({0, 0, 1}, {1, 1, 3}), {.name = "upper", .region = -2});
  const om::SurfacesPlc result = surfaces.to_plc();
  ASSERT_EQ(result.plc.regions.size(), 3);
  EXPECT_EQ(result.plc.regions[1].tag, 7);
  EXPECT_EQ(result.plc.regions[2].tag, -2);
  EXPECT_DOUBLE_EQ(result.plc.regions[2].volume, 2);
  EXPECT_EQ(result.plc.patches.size(), 11) << "the side in common is one interface";
  EXPECT_EQ(result.plc.cleanup.welded_points, 4);
  EXPECT_GT(result.plc.cleanup.shared_triangles, 0);
  EXPECT_EQ(result.notes.size(), 2);
}

TEST(Surfaces, SplitsAMeshByItsRegionProperty) {
  DoublePoly mesh = make_box<DoublePoly>();
  const auto v = add_corners(mesh, {5, 0, 0}, {7, 1, 1});
  for (const auto& [a, b, c, d] : sides) mesh.add_face(std::vector{v[a], v[b], v[c], v[d]});
  OpenMesh::FPropHandleT<int> solid;
  mesh.add_property(solid, "solid");
  for (const auto f : mesh.faces()) mesh.property(solid, f) = f.idx() < 6 ? 40 : 30;
  const Plc plc = om::to_plc(mesh, {.region_property = "solid"}).plc;
  ASSERT_EQ(plc.regions.size(), 3);
  EXPECT_EQ(plc.regions[1].tag, 40);
  EXPECT_EQ(plc.regions[2].tag, 30);
  EXPECT_DOUBLE_EQ(plc.regions[2].volume, 2);
}

TEST(Surfaces, LeavesOutWhatIsDeletedOrIsolated) {
  DoublePoly mesh = make_box<DoublePoly>();
  const auto v = add_corners(mesh, {5, 0, 0}, {7, 1, 1});
  for (const auto& [a, b, c, d] : sides) mesh.add_face(std::vector{v[a], v[b], v[c], v[d]});
  mesh.add_vertex({100, 100, 100});
  for (const auto corner : v) mesh.delete_vertex(corner, false);
  const om::SurfacesPlc result = om::to_plc(mesh, {.name = "mesh"});
  EXPECT_EQ(result.plc.regions.size(), 2);
  EXPECT_EQ(result.surfaces[0].deleted_faces, 6);
  EXPECT_EQ(result.surfaces[0].isolated_vertices, 1);
  EXPECT_EQ(result.surfaces[0].faces, 6);
  EXPECT_EQ(result.plc.bounds.max, (Point{1, 1, 1}));
  EXPECT_EQ(result.notes, (std::vector<std::string>{"mesh: 6 faces are marked as deleted and were left out",
                                                    "mesh: 1 vertices without a face were left out"}));
}

TEST(Surfaces, OpenBordersAreAClearError) {
  DoublePoly mesh = make_box<DoublePoly>();
  mesh.delete_face(mesh.face_handle(1), false);
  try {
    om::to_plc(mesh);
    FAIL();
  } catch (const PlcError& error) {
    ASSERT_EQ(error.faults.size(), 1);
    EXPECT_EQ(error.faults[0].kind, PlcFault::Kind::open_boundary);
    EXPECT_NE(std::string(error.what()).find("(0, 0, 1)"), std::string::npos) << error.what();
  }
  EXPECT_EQ(om::to_plc(mesh, {}, {.require_solid = false}).plc.regions.size(), 1);
  EXPECT_THROW(om::to_plc(DoublePoly()), PlcError);
  DoublePoly bad = make_box<DoublePoly>();
  bad.set_point(bad.vertex_handle(3), {std::nan(""), 0, 0});
  EXPECT_THROW(om::to_plc(bad), PlcError);
}

/// OpenMesh can represent several fans around a vertex only while each of them is open.
TEST(Surfaces, NonManifoldVerticesAreTaken) {
  DoublePoly mesh;
  std::vector<DoublePoly::VertexHandle> v;
  for (const auto& [x, y] : {std::array{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}})
    v.push_back(mesh.add_vertex(OpenMesh::Vec3d(x, y, 0)));
  ASSERT_TRUE(mesh.add_face(v[0], v[1], v[2]).is_valid());
  ASSERT_TRUE(mesh.add_face(v[0], v[3], v[4]).is_valid());
  const om::SurfacesPlc result = om::to_plc(mesh, {.name = "fans"}, {.require_solid = false});
  EXPECT_EQ(result.plc.patches.size(), 2);
  EXPECT_EQ(result.plc.vertices.size(), 5);
  EXPECT_EQ(result.surfaces[0].non_manifold_vertices, 1);
  EXPECT_EQ(result.surfaces[0].border_edges, 6);
  EXPECT_EQ(result.notes.size(), 2);
}

/// Two boxes that share the edge from (1, 1, 0) to (1, 1, 1). OpenMesh refuses the fourth face at that edge,
/// so its readers give the face separate vertices and mark it.
TEST(Surfaces, ComplexEdgesAreWeldedAgainAndReported) {
  DoublePoly mesh = make_box<DoublePoly>();
  auto v = add_corners(mesh, {1, 1, 0}, {2, 2, 1});
  v[0] = mesh.vertex_handle(2);
  v[4] = mesh.vertex_handle(6);
  std::size_t detached = 0;
  for (const auto& [a, b, c, d] : sides) {
    std::vector corners{v[a], v[b], v[c], v[d]};
    auto face = mesh.add_face(corners);
    if (face.is_valid()) continue;
    for (auto& corner : corners) {
      const auto place = mesh.point(corner);  // adding a vertex may move points in memory
      corner = mesh.add_vertex(place);
    }
    face = mesh.add_face(corners);
    ASSERT_TRUE(face.is_valid());
    mesh.status(face).set_fixed_nonmanifold(true);
    ++detached;
  }
  ASSERT_GT(detached, 0);
  const om::SurfacesPlc result = om::to_plc(mesh, {.name = "boxes"});
  ASSERT_EQ(result.plc.regions.size(), 3);
  EXPECT_DOUBLE_EQ(result.plc.regions[1].volume, 1);
  EXPECT_DOUBLE_EQ(result.plc.regions[2].volume, 1);
  EXPECT_EQ(result.plc.vertices.size(), 14);
  EXPECT_EQ(result.surfaces[0].detached_faces, detached);
  EXPECT_GE(result.plc.cleanup.welded_points, 4 * detached);
  EXPECT_GE(result.notes.size(), 2);
}

// From meshes

TetMesh mesh_of(const Plc& plc) {
  MeshOptions options;
  options.size = 0.4;
  MeshResult result = generate(plc, options);
  EXPECT_EQ(result.status, MeshStatus::complete) << result.message;
  return std::move(result.mesh);
}

Plc two_boxes() {
  DoublePoly lower = make_box<DoublePoly>();
  OpenMesh::FPropHandleT<int> side;
  lower.add_property(side, "side");
  for (const auto f : lower.faces()) lower.property(side, f) = 1 + f.idx();
  om::Surfaces surfaces;
  surfaces.add(lower, {.region = 7, .patch_property = "side"});
  surfaces.add(make_box<DoublePoly>({0, 0, 1}, {1, 1, 2}), {.region = 9});
  return surfaces.to_plc().plc;
}

template <class Mesh>
double volume(const Mesh& mesh) {
  double sum = 0;
  for (const auto f : mesh.faces()) {
    std::vector<Point> p;
    for (const auto v : mesh.fv_range(f)) p.push_back({mesh.point(v)[0], mesh.point(v)[1], mesh.point(v)[2]});
    sum += six_volume({0, 0, 0}, p[0], p[1], p[2]) / 6;
  }
  return sum;
}

TEST(BoundarySurface, SelectsBoundaryRegionAndInterface) {
  const TetMesh mesh = mesh_of(two_boxes());
  const auto whole = om::boundary_surface<DoubleTri>(mesh);
  EXPECT_NEAR(volume(whole), 2, 1e-12);
  for (const auto e : whole.edges()) EXPECT_FALSE(whole.is_boundary(e));
  for (const Index region : {1U, 2U}) {
    const auto one = om::boundary_surface<FloatPoly>(mesh, om::SurfaceSelection::region(region));
    EXPECT_NEAR(volume(one), 1, 1e-6);
    OpenMesh::FPropHandleT<int> back;
    ASSERT_TRUE(one.get_property_handle(back, om::region_back));
    for (const auto f : one.faces()) EXPECT_EQ(one.property(back, f), static_cast<int>(region));
  }
  const auto up = om::boundary_surface<DoubleTri>(mesh, om::SurfaceSelection::interface(1, 2));
  const auto down = om::boundary_surface<DoubleTri>(mesh, om::SurfaceSelection::interface(2, 1));
  EXPECT_EQ(up.n_faces(), down.n_faces());
  double area = 0;
  for (const auto f : up.faces()) {
    EXPECT_NEAR(up.calc_face_normal(f)[2], 1, 1e-12);
    area += up.calc_face_area(f);
  }
  for (const auto f : down.faces()) EXPECT_NEAR(down.calc_face_normal(f)[2], -1, 1e-12);
  EXPECT_NEAR(area, 1, 1e-12);
  EXPECT_THROW(om::boundary_surface<DoubleTri>(mesh, om::SurfaceSelection::region(3)), OptionError);
}

TEST(BoundarySurface, NamesWhereItCameFrom) {
  const TetMesh mesh = mesh_of(two_boxes());
  const auto surface = om::boundary_surface<DoubleTri>(mesh);
  OpenMesh::VPropHandleT<int> point;
  OpenMesh::FPropHandleT<int> face;
  OpenMesh::FPropHandleT<std::int64_t> tag;
  ASSERT_TRUE(surface.get_property_handle(point, om::mesh_point));
  ASSERT_TRUE(surface.get_property_handle(face, om::mesh_face));
  ASSERT_TRUE(surface.get_property_handle(tag, om::patch_tag));
  for (const auto v : surface.vertices()) {
    const Point& p = mesh.points[static_cast<std::size_t>(surface.property(point, v))];
    EXPECT_EQ(surface.point(v), OpenMesh::Vec3d(p.x, p.y, p.z));
  }
  for (const auto f : surface.faces())
    EXPECT_EQ(surface.property(tag, f), mesh.face_tag[static_cast<std::size_t>(surface.property(face, f))]);
  std::size_t features = 0;
  for (const auto e : surface.edges()) features += surface.status(e).feature() ? 1 : 0;
  EXPECT_EQ(features, mesh.edges.size());
}

/// Surface, tets, surface, complex: the same features with the same tags.
TEST(BoundarySurface, RoundTripKeepsTags) {
  const Plc before = two_boxes();
  TetMesh mesh = mesh_of(before);
  om::Surfaces surfaces;
  for (Index r = 1; r < before.regions.size(); ++r)
    surfaces.add(om::boundary_surface<DoubleTri>(mesh, om::SurfaceSelection::region(r)),
                 {.region = before.regions[r].tag});
  const Plc after = surfaces.to_plc().plc;
  ASSERT_EQ(after.regions.size(), before.regions.size());
  for (std::size_t r = 0; r < before.regions.size(); ++r) {
    EXPECT_EQ(after.regions[r].tag, before.regions[r].tag);
    EXPECT_NEAR(after.regions[r].volume, before.regions[r].volume, 1e-12);
  }
  EXPECT_EQ(after.patches.size(), before.patches.size());
  EXPECT_EQ(after.curves.size(), before.curves.size());
  EXPECT_EQ(patch_tags(after), patch_tags(before));
  mesh.features.clear();  // features have different numbers in the other complex
  std::fill(mesh.face_patch.begin(), mesh.face_patch.end(), none);
  std::fill(mesh.edge_curve.begin(), mesh.edge_curve.end(), none);
  const CheckReport report = check(mesh, after);
  EXPECT_TRUE(report.passed()) << report.findings.front().message;
}

/// The boundary of two boxes with one common edge: in OpenMesh its vertices are copied.
TEST(BoundarySurface, CutsWhereOpenMeshCannotFollow) {
  om::Surfaces surfaces;
  surfaces.add(make_box<DoublePoly>());
  surfaces.add(make_box<DoublePoly>({1, 1, 0}, {2, 2, 1}));
  const Plc before = surfaces.to_plc().plc;
  const TetMesh mesh = mesh_of(before);
  EXPECT_GT(om::select_surface(mesh, om::SurfaceSelection::boundary()).copied_vertices, 0);
  const auto surface = om::boundary_surface<DoubleTri>(mesh);
  for (const auto v : surface.vertices()) EXPECT_TRUE(surface.is_manifold(v));
  const Plc after = om::to_plc(surface).plc;
  EXPECT_EQ(after.regions.size(), 3);
  EXPECT_EQ(after.vertices.size(), before.vertices.size());
  EXPECT_GT(after.cleanup.welded_points, 0);
}

}  // namespace
}  // namespace collarmesh::surfaces_test
