// OpenMesh's .om: files saved by OpenMesh are read in full; damaged ones give an error and never a crash.
#include <gtest/gtest.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "collarmesh/openmesh_io/read_om.h"
#include "support/temporary_file.h"

namespace collarmesh::read_om_test {
namespace {

using openmesh_io::read_om;
using testing::expect_error;
using testing::TemporaryFolder;

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using DoubleMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;
using FloatMesh = OpenMesh::TriMesh_ArrayKernelT<>;

const std::vector<Point> points{{0.1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.0 / 3}};
const std::vector<std::vector<Index>> faces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

template <class Mesh>
Mesh tetrahedron() {
  Mesh mesh;
  using Coordinate = typename Mesh::Point::value_type;
  for (const Point& p : points)
    mesh.add_vertex(typename Mesh::Point(static_cast<Coordinate>(p.x), static_cast<Coordinate>(p.y),
                                         static_cast<Coordinate>(p.z)));
  for (const auto& face : faces) {
    std::vector<typename Mesh::VertexHandle> corners;
    for (const Index v : face) corners.emplace_back(static_cast<int>(v));
    mesh.add_face(corners);
  }
  return mesh;
}

template <class Mesh>
std::string save(const TemporaryFolder& folder, Mesh& mesh, OpenMesh::IO::Options::Flag more) {
  const std::string path = folder.file("a.om");
  OpenMesh::IO::Options options(OpenMesh::IO::Options::Binary);
  options += more;
  EXPECT_TRUE(OpenMesh::IO::write_mesh(mesh, path, options));
  return path;
}

std::string saved_tetrahedron() {
  const TemporaryFolder folder;
  DoubleMesh mesh = tetrahedron<DoubleMesh>();
  save(folder, mesh, OpenMesh::IO::Options::Default);
  return folder.read("a.om");
}

/// Rotates corners to a common start, because OpenMesh may begin a face at another corner.
std::vector<Index> rotated(std::vector<Index> corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

void expect_faces(const PolygonSoup& soup, const std::vector<std::vector<Index>>& expected) {
  ASSERT_EQ(soup.facet_count(), expected.size());
  for (Index q = 0; q < soup.polygon_count(); ++q) {
    const auto corners = soup.polygon(q);
    EXPECT_EQ(rotated({corners.begin(), corners.end()}), rotated(expected[q]));
  }
}

TEST(ReadOm, KeepsDoubles) {
  const TemporaryFolder folder;
  DoubleMesh mesh = tetrahedron<DoubleMesh>();
  const PolygonSoup soup = read_om(save(folder, mesh, OpenMesh::IO::Options::Default));
  EXPECT_EQ(soup.name, folder.file("a.om"));
  EXPECT_EQ(soup.points, points);
  expect_faces(soup, faces);
}

TEST(ReadOm, ReadsFloatsAndPolygons) {
  const TemporaryFolder folder;
  FloatMesh triangles = tetrahedron<FloatMesh>();
  const PolygonSoup soup = read_om(save(folder, triangles, OpenMesh::IO::Options::Default));
  EXPECT_EQ(soup.points[0].x, double{0.1F});
  expect_faces(soup, faces);
  DoubleMesh polygon;
  std::vector<DoubleMesh::VertexHandle> corners;
  for (int i = 0; i < 5; ++i) corners.push_back(polygon.add_vertex(OpenMesh::Vec3d(i % 3, i, 0)));
  polygon.add_face(corners);
  expect_faces(read_om(save(folder, polygon, OpenMesh::IO::Options::Default)), {{0, 1, 2, 3, 4}});
}

TEST(ReadOm, LeavesOutDeletedFacesAndProperties) {
  const TemporaryFolder folder;
  DoubleMesh mesh = tetrahedron<DoubleMesh>();
  mesh.request_vertex_status();
  mesh.request_edge_status();
  mesh.request_face_status();
  mesh.request_vertex_normals();
  mesh.request_face_normals();
  mesh.update_normals();
  OpenMesh::VPropHandleT<std::string> property;
  mesh.add_property(property, "label");
  mesh.property(property).set_persistent(true);
  mesh.delete_face(OpenMesh::FaceHandle(1), false);
  const auto options = static_cast<OpenMesh::IO::Options::Flag>(OpenMesh::IO::Options::Status |
                                                                OpenMesh::IO::Options::VertexNormal |
                                                                OpenMesh::IO::Options::FaceNormal);
  const PolygonSoup soup = read_om(save(folder, mesh, options));
  EXPECT_EQ(soup.points, points);
  expect_faces(soup, {faces[0], faces[2], faces[3]});
}

void expect_refused(const std::string& content, const std::string& part) {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.om", content);
  expect_error<ReadError>([&] { read_om(path); }, path, part);
}

TEST(ReadOm, RefusesBadFiles) {
  const std::string good = saved_tetrahedron();
  expect_refused("", "byte 0: expected an OpenMesh file");
  expect_refused("garbage that is longer than a header", "byte 0: ");
  for (const std::size_t count : {4U, 8U})
    expect_refused(std::string(good).replace(count, 4, "\xff\xff\xff\x7f"), "byte 16: expected");
  expect_refused(std::string(good).replace(12, 4, "\xff\xff\xff\x7f"), "byte ");
  const auto nan = std::bit_cast<std::array<char, 8>>(std::numeric_limits<double>::quiet_NaN());
  expect_refused(std::string(good).replace(18, 8, nan.data(), 8), "vertex 0, (nan, 0, 0), is not finite");
  expect_error<ReadError>([] { read_om("missing.om"); }, "missing.om", "No such file");
}

/// Before version 2 the halfedges are made from the corners of faces, so a vertex cannot refer to one yet.
TEST(ReadOm, RefusesHalfedgesOfVerticesInOldFiles) {
  const auto chunk = [](unsigned bits) {
    return std::string{static_cast<char>(bits & 255), static_cast<char>(bits >> 8)};
  };
  const std::string header("OMT\1\3\0\0\0\1\0\0\0\3\0\0\0", 16);
  std::string positions = chunk(1U << 10 | 2U << 11);
  for (const float c : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) {
    const auto raw = std::bit_cast<std::array<char, 4>>(c);
    positions.append(raw.data(), raw.size());
  }
  const std::string faces_of_corners = chunk(2U << 2 | 7U << 5) + std::string("\0\1\2", 3),
                    halfedges_of_vertices = chunk(7U << 5) + std::string("\5\5\5", 3);
  const TemporaryFolder folder;
  expect_faces(read_om(folder.write("a.om", header + positions + faces_of_corners)), {{0, 1, 2}});
  expect_refused(header + positions + halfedges_of_vertices + faces_of_corners,
                 "the chunks are not in the order that OpenMesh writes");
}

TEST(ReadOm, RefusesEveryTruncation) {
  const std::string good = saved_tetrahedron();
  constexpr std::size_t sentinel = 2;
  for (std::size_t size = 0; size < good.size() - sentinel; ++size)
    expect_refused(good.substr(0, size), "byte ");
}

/// The sanitizers find faults.
TEST(ReadOm, SurvivesDamage) {
  const std::string good = saved_tetrahedron();
  const TemporaryFolder folder;
  std::mt19937 random(2);
  for (int round = 0; round < 1000; ++round) {
    std::string damaged = good;
    for (unsigned k = 0; k < 1 + random() % 3; ++k)
      damaged[random() % damaged.size()] = "\0\1\2\x7f\x80\xff"[random() % 6];
    try {
      const PolygonSoup soup = read_om(folder.write("a.om", damaged));
      for (Index q = 0; q < soup.polygon_count(); ++q)
        for (const Index corner : soup.polygon(q)) ASSERT_LT(corner, soup.points.size());
    } catch (const ReadError&) {
    }
  }
}

}  // namespace
}  // namespace collarmesh::read_om_test
