// Meshes of CAD shapes: the certificate, the tags, and vertices on the exact faces.
#include "cad_meshing.h"

#include <gtest/gtest.h>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Circ.hxx>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include "support/repair_shapes.h"
#include "support/sanitized.h"

namespace collarmesh::testing::cad_meshing_test {
namespace {

gp_Ax2 at(double x, double y, double z) { return {gp_Pnt(x, y, z), gp::DZ()}; }

TopoDS_Shape plate_with_hole() {
  const TopoDS_Shape plate = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 40, 30, 5).Shape();
  return BRepAlgoAPI_Cut(plate, BRepPrimAPI_MakeCylinder(at(20, 15, -1), 6, 7).Shape()).Shape();
}

TopoDS_Shape filleted_box() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(20, 15, 10).Shape();
  BRepFilletAPI_MakeFillet fillet(box);
  for (TopExp_Explorer edge(box, TopAbs_EDGE); edge.More(); edge.Next())
    fillet.Add(2, TopoDS::Edge(edge.Current()));
  return fillet.Shape();
}

TopoDS_Shape compound(std::initializer_list<TopoDS_Shape> parts) {
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& part : parts) builder.Add(compound, part);
  return compound;
}

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

int count(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return map.Extent();
}

std::set<Tag> tags(const std::vector<Tag>& all) { return {all.begin(), all.end()}; }

std::set<Tag> one_to(int n) {
  std::set<Tag> numbers;
  for (int i = 1; i <= n; ++i) numbers.insert(i);
  return numbers;
}

struct Case {
  const char* name;
  TopoDS_Shape (*make)();
  int features;  // number of edges except seams and degenerate ones
};

void PrintTo(const Case& shape, std::ostream* out) { *out << shape.name; }

class CadMeshing : public ::testing::TestWithParam<Case> {};

TEST_P(CadMeshing, PutsMidSideNodesOnFaces) {
  const TopoDS_Shape shape = GetParam().make();
  const CadMeshed meshed = mesh_of_shape(shape, 0.0926, 2);
  EXPECT_EQ(faults(meshed), "");
  // Sanitized meshes may be farther from the shape.
  constexpr std::size_t curved_per_straightened = sanitized ? 100 : 500;
  EXPECT_LE(meshed.second_order.straightened.size(), meshed.second_order.curved / curved_per_straightened);
  EXPECT_LT(farthest_from_faces(meshed, shape), 1e-9);
}

TEST_P(CadMeshing, KeepsGuaranteesTagsAndFaces) {
  const TopoDS_Shape shape = GetParam().make();
  const CadMeshed meshed = mesh_of_shape(shape);
  EXPECT_EQ(faults(meshed), "");
  const TetMesh& mesh = meshed.result.mesh;
  EXPECT_EQ(tags(mesh.face_tag), one_to(count(shape, TopAbs_FACE)));
  EXPECT_EQ(tags(mesh.edge_tag).size(), static_cast<std::size_t>(GetParam().features));
  EXPECT_EQ(tags(mesh.tet_tag), one_to(1));
  EXPECT_EQ(meshed.projection.exceptions.size(), 0U);
  EXPECT_LT(farthest_from_faces(meshed, shape), 1e-9);
  double volume = 0;
  for (const double v : meshed.report.region_volumes) volume += v;
  EXPECT_NEAR(volume, volume_of(shape), 0.02 * volume_of(shape));
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, CadMeshing,
    ::testing::Values(Case{"box", [] { return BRepPrimAPI_MakeBox(10, 20, 30).Shape(); }, 12},
                      Case{"cylinder", [] { return BRepPrimAPI_MakeCylinder(5, 20).Shape(); }, 2},
                      Case{"cone", [] { return BRepPrimAPI_MakeCone(5, 0, 6).Shape(); }, 1},
                      Case{"frustum", [] { return BRepPrimAPI_MakeCone(5, 2, 6).Shape(); }, 2},
                      Case{"sphere", [] { return BRepPrimAPI_MakeSphere(at(100, 200, 300), 7).Shape(); }, 0},
                      Case{"half_sphere", [] { return BRepPrimAPI_MakeSphere(7., 0., M_PI / 2).Shape(); }, 1},
                      Case{"torus", [] { return BRepPrimAPI_MakeTorus(10, 3).Shape(); }, 0},
                      Case{"plate_with_hole", plate_with_hole, 14}, Case{"filleted_box", filleted_box, 48}),
    [](const auto& info) { return std::string(info.param.name); });

/// Returns the sum of the chords of the mesh edges with a tag.
double length_of_edges(const TetMesh& mesh, Tag tag) {
  double length = 0;
  for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    if (mesh.edge_tag[e] == tag)
      length += distance(mesh.points[mesh.edges[e][0]], mesh.points[mesh.edges[e][1]]);
  return length;
}

bool has_node_at(const TetMesh& mesh, const Point& p, double within = 1e-12) {
  return std::any_of(mesh.points.begin(), mesh.points.end(),
                     [&](const Point& q) { return distance(p, q) < within; });
}

TEST(CadMeshingInside, PutsNodesOnLinesAndPoints) {
  const CadMeshed meshed =
      mesh_of_shape(compound({BRepPrimAPI_MakeBox(10, 20, 30).Shape(),
                              BRepBuilderAPI_MakeEdge(gp_Pnt(2, 5, 5), gp_Pnt(8, 15, 20)).Shape(),
                              BRepBuilderAPI_MakeVertex(gp_Pnt(5, 9, 25)).Shape()}));
  EXPECT_EQ(faults(meshed), "");
  const TetMesh& mesh = meshed.result.mesh;
  EXPECT_EQ(tags(mesh.edge_tag), one_to(13));
  EXPECT_NEAR(length_of_edges(mesh, 13), std::hypot(6, 10, 15), 1e-12);
  EXPECT_TRUE(has_node_at(mesh, {5, 9, 25}));
}

TEST(CadMeshingInside, PutsNodesOnExactCurves) {
  const gp_Pnt center(5, 10, 15);
  const double radius = 4;
  const TopoDS_Shape arc =
      BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(center, gp::DZ()), radius), 0, M_PI).Shape();
  for (const int order : {1, 2}) {
    const CadMeshed meshed =
        mesh_of_shape(compound({BRepPrimAPI_MakeBox(10, 20, 30).Shape(), arc}), 0.05, order);
    EXPECT_EQ(faults(meshed), "");
    const TetMesh& mesh = meshed.result.mesh;
    std::size_t edges = 0;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      if (mesh.edge_tag[e] != 13) continue;
      ++edges;
      std::vector<Index> nodes(mesh.edges[e].begin(), mesh.edges[e].end());
      if (order == 2) nodes.push_back(mesh.edge_mid_nodes[e]);
      for (const Index node : nodes) {
        EXPECT_NEAR(distance(mesh.points[node], {5, 10, 15}), radius, 1e-12);
        EXPECT_NEAR(mesh.points[node].z, 15, 1e-12);
      }
    }
    EXPECT_GT(edges, 5U);
    EXPECT_NEAR(length_of_edges(mesh, 13), M_PI * radius, 0.02 * M_PI * radius);
  }
}

TEST(CadMeshingInside, TakesWholeCirclesInOneOfTwoSolids) {
  const TopoDS_Shape ring =
      BRepBuilderAPI_MakeEdge(gp_Circ(gp_Ax2(gp_Pnt(5, 5, 5), gp_Dir(0, 0, 1)), 3)).Shape();
  const CadMeshed meshed =
      mesh_of_shape(compound({BRepPrimAPI_MakeBox(10, 10, 10).Shape(),
                              BRepPrimAPI_MakeBox(gp_Pnt(10, 2, 2), gp_Pnt(20, 8, 8)).Shape(), ring}));
  EXPECT_EQ(faults(meshed), "");
  const std::set<Tag> edges = tags(meshed.result.mesh.edge_tag);
  EXPECT_EQ(edges.count(25), 1U);  // its number comes after those of the boxes
  EXPECT_NEAR(length_of_edges(meshed.result.mesh, 25), 6 * M_PI, 0.05 * 6 * M_PI);
}

// A radius that continues outside, and a chord: both end on the exact lateral surface.
TEST(CadMeshingInside, EndsLinesOnCurvedFaces) {
  const double radius = 10, height = 8;
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(radius, 20).Shape(),
                     spoke = BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, height), gp_Pnt(-12, -9, height)).Shape();
  const Tag first = count(cylinder, TopAbs_EDGE) + 1;
  const double angle = 1.2;  // angle between the chord and the surface: too large for a crease
  const double depth = radius * std::cos(angle), half = radius * std::sin(angle);
  const TopoDS_Shape chord =
      BRepBuilderAPI_MakeEdge(gp_Pnt(depth, -2 * radius, height), gp_Pnt(depth, 2 * radius, height)).Shape();
  const CadMeshed meshed = mesh_of_shape(compound({cylinder, spoke, chord}));
  EXPECT_EQ(faults(meshed), "");
  const TetMesh& mesh = meshed.result.mesh;
  EXPECT_NEAR(length_of_edges(mesh, first), radius, 1e-9);
  EXPECT_NEAR(length_of_edges(mesh, first + 1), 2 * half, 1e-9);
  for (const Point& p : {Point{-8, -6, height}, Point{depth, half, height}, Point{depth, -half, height}})
    EXPECT_TRUE(has_node_at(mesh, p, 1e-9));
}

TEST(CadMeshingInside, LeavesOutWhatOfALineIsInAHole) {
  const TopoDS_Shape plate = plate_with_hole();
  const int number = count(plate, TopAbs_EDGE) + 1;
  const CadMeshed meshed =
      mesh_of_shape(compound({plate, BRepBuilderAPI_MakeEdge(gp_Pnt(5, 15, 2), gp_Pnt(35, 15, 2)).Shape()}));
  EXPECT_EQ(faults(meshed), "");
  EXPECT_NEAR(length_of_edges(meshed.result.mesh, number), 30 - 2 * 6, 1e-9);
  for (const double x : {5, 14, 26, 35}) EXPECT_TRUE(has_node_at(meshed.result.mesh, {x, 15, 2}, 1e-9));
}

// The face with tag N must be FreeCAD's FaceN: compares centres of mass.
TEST(CadTags, AreFreeCadsNumbers) {
  const TopoDS_Shape shape = BRepPrimAPI_MakeBox(gp_Pnt(1, 2, 3), 10, 20, 30).Shape();
  const CadMeshed meshed = mesh_of_shape(shape, 0.2);
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  const TetMesh& mesh = meshed.result.mesh;
  std::map<Tag, std::pair<double, Point>> moments;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    const double area = 0.5 * norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
    moments[mesh.face_tag[f]].first += area;
    moments[mesh.face_tag[f]].second =
        moments[mesh.face_tag[f]].second + area / 3 * (mesh.points[a] + mesh.points[b] + mesh.points[c]);
  }
  for (int i = 1; i <= 6; ++i) {
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(faces(i), properties);
    const auto& [area, moment] = moments.at(i);
    EXPECT_NEAR(area, properties.Mass(), 1e-9);
    const gp_Pnt centre = properties.CentreOfMass();
    EXPECT_LT(distance(moment / area, {centre.X(), centre.Y(), centre.Z()}), 1e-9) << "Face" << i;
  }
}

TEST(CadSolids, ThatTouchShareOneInterface) {
  // The small box stands in the middle of a face of the large one.
  const TopoDS_Shape large = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 20, 20, 10).Shape();
  const TopoDS_Shape small = BRepPrimAPI_MakeBox(gp_Pnt(5, 5, 10), 8, 8, 8).Shape();
  const CadMeshed meshed = mesh_of_shape(compound({large, small}));
  EXPECT_EQ(faults(meshed), "");
  EXPECT_NEAR(meshed.report.region_volumes.at(1), 4000, 1e-6);
  EXPECT_NEAR(meshed.report.region_volumes.at(2), 512, 1e-6);
  EXPECT_EQ(tags(meshed.result.mesh.tet_tag), one_to(2));
  double interface_area = 0;
  const TetMesh& mesh = meshed.result.mesh;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (mesh.face_regions[f][0] != 0 && mesh.face_regions[f][1] != 0) {
      const auto& [a, b, c] = mesh.faces[f];
      interface_area += 0.5 * norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
      EXPECT_TRUE(mesh.face_tag[f] >= 1 && mesh.face_tag[f] <= 12);
    }
  EXPECT_NEAR(interface_area, 64, 1e-9);
}

TEST(CadSolids, ThatTouchInAPointShareAVertex) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 10, 10, 10).Shape();
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(at(4, 6, 13), 3).Shape();
  const CadMeshed meshed = mesh_of_shape(compound({box, ball}));
  EXPECT_EQ(faults(meshed), "");
  EXPECT_EQ(meshed.plc.regions.size(), 3U);
}

TEST(CadSolids, HaveCavities) {
  const TopoDS_Shape shell = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 10, 10, 10).Shape(),
                                             BRepPrimAPI_MakeSphere(at(5, 5, 5), 3).Shape())
                                 .Shape();
  const CadMeshed meshed = mesh_of_shape(shell);
  EXPECT_EQ(faults(meshed), "");
  ASSERT_EQ(meshed.plc.regions.size(), 2U);
  EXPECT_NEAR(meshed.report.region_volumes[1], 1000 - 36 * M_PI, 3);
}

TEST(CadFaces, InsideASolidAreInternal) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 10, 10, 10).Shape();
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(BRepPrimAPI_MakeBox(gp_Pnt(3, 3, 3), 4, 4, 4).Shape(), TopAbs_FACE, faces);
  const CadMeshed meshed = mesh_of_shape(compound({box, faces(1)}));
  EXPECT_EQ(faults(meshed), "");
  EXPECT_EQ(meshed.plc.regions.size(), 2U);
  double area = 0;
  const TetMesh& mesh = meshed.result.mesh;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (mesh.face_regions[f] == std::array<Index, 2>{1, 1}) {
      const auto& [a, b, c] = mesh.faces[f];
      area += 0.5 * norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
      EXPECT_EQ(mesh.face_tag[f], 7);
    }
  EXPECT_NEAR(area, 16, 1e-9);
}

TEST(CadFaces, AloneAreSewn) {
  BRep_Builder builder;
  TopoDS_Compound faces;
  builder.MakeCompound(faces);
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
  for (TopExp_Explorer face(box, TopAbs_FACE); face.More(); face.Next()) builder.Add(faces, face.Current());
  const CadMeshed meshed = mesh_of_shape(faces);
  EXPECT_EQ(faults(meshed), "");
  EXPECT_NEAR(meshed.report.region_volumes.at(1), 6000, 1e-6);
  EXPECT_EQ(tags(meshed.result.mesh.face_tag), one_to(6));
}

// Meshes the CAD files of the corpus, with sanitizers a share of them. Vertices that stay off their face are
// few, and counted.
TEST(CadCorpus, VerticesLieOnTheirFaces) {
  const char* corpus = std::getenv("COLLARMESH_CORPUS");
  if (corpus == nullptr || *corpus == '\0') GTEST_SKIP() << "COLLARMESH_CORPUS is not set";
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(corpus))
    if (brep::is_cad_format(entry.path().string())) paths.push_back(entry.path().string());
  ASSERT_FALSE(paths.empty());
  std::ranges::sort(paths);
  paths.resize(faulty::members(static_cast<unsigned>(paths.size())));
  for (const std::string& path : paths) {
    const CadMeshed meshed = mesh_of_cad_file(path, 0.05, 2);
    EXPECT_EQ(faults(meshed), "") << path;
    EXPECT_LT(farthest_from_faces(meshed, shape_in(path), 400), 1e-9) << path;
    const std::size_t off = meshed.projection.exceptions.size(),
                      straightened = meshed.second_order.straightened.size();
    RecordProperty(std::filesystem::path(path).stem().string() + "_off",
                   std::to_string(off) + " of " + std::to_string(meshed.projection.vertices));
    EXPECT_LE(off, meshed.projection.vertices / 50) << path;
    EXPECT_LE(straightened, meshed.second_order.nodes / 100) << path;
  }
}

}  // namespace
}  // namespace collarmesh::testing::cad_meshing_test
