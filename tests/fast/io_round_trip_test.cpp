// Every format of tetrahedral meshes with the same list of small meshes: what is written is read back, as far
// as the format can store it.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "collarmesh/io/tet_mesh_io.h"
#include "support/sample_mesh.h"
#include "support/second_order.h"
#include "support/temporary_file.h"
#include "support/tet_mesh_comparison.h"

namespace collarmesh::io_round_trip_test {
namespace {

using testing::expect_same;
using testing::sample_mesh;
using testing::second_order;
using testing::TemporaryFolder;

struct NamedMesh {
  const char* name;
  TetMesh mesh;
};

TetMesh one_tet() {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1e-30, 0, 3}, {1, 1e7, 0}, {-0.1, 0, 1.0 / 3}};
  mesh.tets = {{0, 1, 2, 3}};
  if (six_volume(mesh.points[0], mesh.points[1], mesh.points[2], mesh.points[3]) < 0)
    std::swap(mesh.tets[0][2], mesh.tets[0][3]);
  mesh.tet_region = {1};
  mesh.tet_tag = {5};
  mesh.tet_collar = {0};
  mesh.tet_crease = {0};
  return mesh;
}

TetMesh without_features(TetMesh mesh) {
  mesh.features.clear();
  std::fill(mesh.face_patch.begin(), mesh.face_patch.end(), none);
  std::fill(mesh.edge_curve.begin(), mesh.edge_curve.end(), none);
  return mesh;
}

TetMesh with_one_tag(TetMesh mesh) {
  std::fill(mesh.tet_tag.begin(), mesh.tet_tag.end(), 3);
  std::fill(mesh.face_tag.begin(), mesh.face_tag.end(), 4);
  return mesh;
}

/// Divides a mesh arbitrarily; some partition numbers are unused.
TetMesh partitioned(TetMesh mesh) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    mesh.tet_partition.push_back(static_cast<Index>(t * t % 5 + (t > mesh.tets.size() / 2 ? 7 : 1)));
  return mesh;
}

std::vector<NamedMesh> small_meshes() {
  return {{"one tet", one_tet()},
          {"two regions, mixed tags", sample_mesh(1)},
          {"finer", sample_mesh(3)},
          {"features unknown", without_features(sample_mesh(2))},
          {"two regions of one tag", with_one_tag(sample_mesh(2))},
          {"one tet of second order", second_order(one_tet())},
          {"second order", second_order(sample_mesh(2))},
          {"one tet in a partition", partitioned(one_tet())},
          {"partitions", partitioned(sample_mesh(2))},
          {"partitions, features unknown", partitioned(without_features(sample_mesh(2)))},
          {"partitions of second order", partitioned(second_order(sample_mesh(2)))},
          {"second order, features unknown", second_order(without_features(sample_mesh(1)))}};
}

/// The data that a format can store besides points, cells and the tags of faces.
struct Format {
  const char* extension;
  bool all_digits = true, regions = true, tet_tags = true, edges = true, collar = false, features = false,
       partitions = false;
};

const std::vector<Format> always_there{
    {.extension = ".vtu", .collar = true, .features = true, .partitions = true},
    {.extension = ".pvtu", .collar = true, .features = true, .partitions = true},
    {.extension = ".vtk", .collar = true, .features = true, .partitions = true},
    {.extension = ".msh", .collar = true, .features = true, .partitions = true},
    {.extension = ".mesh", .tet_tags = false},
    {.extension = ".inp", .all_digits = false, .edges = false},
    {.extension = ".unv"},
    {.extension = ".msh2", .regions = false, .partitions = true},
    {.extension = ".ele", .regions = false}};

/// Returns the formats, including those that need HDF5.
std::vector<Format> formats_built_in() {
  std::vector<Format> all = always_there;
  for (const Format& format :
       std::vector<Format>{{.extension = ".xdmf", .collar = true, .features = true, .partitions = true},
                           {.extension = ".med", .regions = false, .partitions = true}})
    if (io::is_tet_mesh_format(std::string("a") + format.extension)) all.push_back(format);
  return all;
}

const std::vector<Format> formats = formats_built_in();

/// Renumbers regions by ascending tag.
void number_regions_by_tag(TetMesh& mesh) {
  std::vector<Tag> tags = mesh.tet_tag;
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  std::vector<Index> number(1 + *std::max_element(mesh.tet_region.begin(), mesh.tet_region.end()), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    number[mesh.tet_region[t]] =
        static_cast<Index>(std::lower_bound(tags.begin(), tags.end(), mesh.tet_tag[t]) - tags.begin() + 1);
  for (Index& region : mesh.tet_region) region = number[region];
  for (auto& regions : mesh.face_regions)
    for (Index& region : regions) region = number[region];
}

TetMesh as_kept(TetMesh mesh, const Format& format) {
  if (!format.tet_tags) mesh.tet_tag.assign(mesh.tet_region.begin(), mesh.tet_region.end());
  // In .msh a region is an entity, which is known only together with the features.
  if (!format.regions || (format.extension == std::string(".msh") && mesh.features.empty()))
    number_regions_by_tag(mesh);
  if (!format.collar) {
    std::fill(mesh.tet_collar.begin(), mesh.tet_collar.end(), 0);
    std::fill(mesh.tet_crease.begin(), mesh.tet_crease.end(), 0);
    mesh.tet_thin.clear();
  }
  if (!format.features) mesh = without_features(std::move(mesh));
  if (!format.partitions) mesh.tet_partition.clear();
  if (!format.edges) {
    mesh.edges.clear();
    mesh.edge_tag.clear();
    mesh.edge_curve.clear();
    mesh.edge_mid_nodes.clear();
  }
  return mesh;
}

template <class T>
void permute(std::vector<T>& values, const std::vector<std::size_t>& order) {
  if (values.empty()) return;
  std::vector<T> result;
  for (const std::size_t i : order) result.push_back(values[i]);
  values = std::move(result);
}

template <class Cells>
std::vector<std::size_t> order_of(const Cells& cells) {
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cells[a] < cells[b]; });
  return order;
}

/// Returns the mesh with cells sorted by their corners; each face begins with its smallest corner.
TetMesh canonical(TetMesh mesh) {
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    auto& face = mesh.faces[f];
    const auto turn = std::min_element(face.begin(), face.end()) - face.begin();
    std::rotate(face.begin(), face.begin() + turn, face.end());
    if (!mesh.face_mid_nodes.empty())
      std::rotate(mesh.face_mid_nodes[f].begin(), mesh.face_mid_nodes[f].begin() + turn,
                  mesh.face_mid_nodes[f].end());
  }
  const auto tets = order_of(mesh.tets), faces = order_of(mesh.faces), edges = order_of(mesh.edges);
  permute(mesh.tet_region, tets);
  permute(mesh.tet_tag, tets);
  permute(mesh.tet_collar, tets);
  permute(mesh.tet_crease, tets);
  permute(mesh.tet_thin, tets);
  permute(mesh.tet_partition, tets);
  permute(mesh.tet_mid_nodes, tets);
  permute(mesh.tets, tets);
  permute(mesh.face_regions, faces);
  permute(mesh.face_patch, faces);
  permute(mesh.face_tag, faces);
  permute(mesh.face_mid_nodes, faces);
  permute(mesh.faces, faces);
  permute(mesh.edge_curve, edges);
  permute(mesh.edge_tag, edges);
  permute(mesh.edge_mid_nodes, edges);
  permute(mesh.edges, edges);
  return mesh;
}

TEST(IoRoundTrip, EveryFormatOnEverySmallMesh) {
  for (const Format& format : formats)
    for (const auto& [name, mesh] : small_meshes()) {
      SCOPED_TRACE(std::string(format.extension) + ": " + name);
      const TemporaryFolder folder;
      const std::string path = folder.file(std::string("a") + format.extension);
      io::write_tet_mesh(path, mesh);
      TetMesh read = io::read_tet_mesh(path);
      TetMesh wanted = as_kept(mesh, format);
      if (!format.all_digits) {
        ASSERT_EQ(read.points.size(), wanted.points.size());
        for (std::size_t i = 0; i < read.points.size(); ++i)
          for (std::size_t axis = 0; axis < 3; ++axis)
            ASSERT_NEAR(read.points[i][axis], wanted.points[i][axis],
                        1e-12 * std::abs(wanted.points[i][axis]));
        read.points = wanted.points;
      }
      expect_same(canonical(std::move(read)), canonical(std::move(wanted)));
    }
}

TEST(IoRoundTrip, PartitionsWithGhostCells) {
  for (const std::string& format : io::formats_with_ghost_cells())
    for (const TetMesh& mesh : {partitioned(sample_mesh(2)), partitioned(second_order(sample_mesh(2)))}) {
      SCOPED_TRACE(format);
      const TemporaryFolder folder;
      io::write_tet_mesh(folder.file("a" + format), mesh, {}, GhostCells::one_layer);
      expect_same(canonical(io::read_tet_mesh(folder.file("a" + format))), canonical(mesh));
    }
}

TEST(IoRoundTrip, FormatsSayWhetherTheyHoldPartitions) {
  const std::vector<std::string> partitions = io::formats_with_partitions();
  for (const Format& format : formats)
    EXPECT_EQ(std::count(partitions.begin(), partitions.end(), format.extension), format.partitions ? 1 : 0)
        << format.extension;
}

TEST(IoRoundTrip, CoversEveryFormat) {
  for (const std::string& known : io::read_tet_mesh_formats())
    EXPECT_TRUE(std::any_of(formats.begin(), formats.end(), [&](const Format& f) {
      return f.extension == known;
    })) << known;
}

TEST(IoRoundTrip, FormatOverridesTheExtension) {
  const TemporaryFolder folder;
  const TetMesh mesh = sample_mesh(1);
  for (const std::string& format : io::read_tet_mesh_formats()) {
    if (format == ".ele") continue;  // a mesh of several files
    io::write_tet_mesh(folder.file("mesh.dat"), mesh, format);
    EXPECT_EQ(io::read_tet_mesh(folder.file("mesh.dat"), format).tets.size(), mesh.tets.size()) << format;
  }
}

}  // namespace
}  // namespace collarmesh::io_round_trip_test
