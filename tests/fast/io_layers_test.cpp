// Prisms, pyramids and quadrangles in files: formats that can store them give them back, other formats say
// that they cannot.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "collarmesh/error.h"
#include "collarmesh/io/mesh_surface_io.h"
#include "collarmesh/io/tet_mesh_io.h"
#include "io/cell_orientation.h"
#include "io/complete_mesh.h"
#include "support/layer_mesh.h"
#include "support/second_order.h"
#include "support/temporary_file.h"
#include "support/tet_mesh_comparison.h"

namespace collarmesh::io_layers_test {
namespace {

using testing::expect_same;
using testing::layer_mesh;
using testing::second_order;
using testing::TemporaryFolder;

constexpr std::array volumes{CellKind::tet, CellKind::prism, CellKind::pyramid};

/// The data that a format can store besides points, cells and the tags of faces.
struct Format {
  const char* extension;
  bool all_digits = true, regions = true, cell_tags = true, edges = true, layers = false, features = false;
};
const std::vector<Format> formats{{.extension = ".vtu", .layers = true, .features = true},
                                  {.extension = ".vtk", .layers = true, .features = true},
                                  {.extension = ".msh", .regions = false, .layers = true},
                                  {.extension = ".msh2", .regions = false},
                                  {.extension = ".mesh", .cell_tags = false},
                                  {.extension = ".inp", .all_digits = false, .edges = false},
                                  {.extension = ".unv"},
                                  {.extension = ".med", .regions = false}};

/// Numbers regions by ascending tag: region 2 has the tag -4, region 1 the tag 20.
void number_regions_by_tag(TetMesh& mesh) {
  const auto swap = [](Index& region) { region = region == 0 ? 0 : 3 - region; };
  for (const CellKind kind : volumes)
    for (Index& region : io::features_of(mesh, kind)) swap(region);
  for (const CellKind kind : {CellKind::triangle, CellKind::quadrangle})
    for (auto& regions : io::regions_beside(mesh, kind))
      for (Index& region : regions) swap(region);
}

TetMesh as_kept(TetMesh mesh, const Format& format) {
  if (!format.cell_tags)
    for (const CellKind kind : volumes)
      io::tags_of(mesh, kind).assign(io::features_of(mesh, kind).begin(), io::features_of(mesh, kind).end());
  if (!format.regions) number_regions_by_tag(mesh);
  if (!format.features)
    for (const CellKind kind : {CellKind::triangle, CellKind::quadrangle, CellKind::edge})
      std::fill(io::features_of(mesh, kind).begin(), io::features_of(mesh, kind).end(), none);
  if (!format.layers) {
    mesh.layers.tet_layer.clear();
    std::fill(mesh.layers.prism_layer.begin(), mesh.layers.prism_layer.end(), 0);
    std::fill(mesh.layers.pyramid_layer.begin(), mesh.layers.pyramid_layer.end(), 0);
  }
  if (!format.edges) {
    mesh.edges.clear();
    mesh.edge_tag.clear();
    mesh.edge_curve.clear();
    mesh.edge_mid_nodes.clear();
  }
  return mesh;
}

template <class Cells, class MidNodes>
void sort_faces(Cells& cells, MidNodes& middle, std::vector<Tag>& tags,
                std::vector<std::array<Index, 2>>& regions, std::vector<Index>& patches) {
  struct Face {
    typename Cells::value_type corners;
    typename MidNodes::value_type middle;
    Tag tag;
    std::array<Index, 2> regions;
    Index patch;
  };
  std::vector<Face> faces;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Face face{cells[i], {}, tags[i], regions[i], patches[i]};
    if (!middle.empty()) face.middle = middle[i];
    const auto turn = std::min_element(face.corners.begin(), face.corners.end()) - face.corners.begin();
    std::rotate(face.corners.begin(), face.corners.begin() + turn, face.corners.end());
    std::rotate(face.middle.begin(), face.middle.begin() + turn, face.middle.end());
    faces.push_back(face);
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.corners < b.corners; });
  for (std::size_t i = 0; i < faces.size(); ++i) {
    cells[i] = faces[i].corners;
    if (!middle.empty()) middle[i] = faces[i].middle;
    tags[i] = faces[i].tag;
    regions[i] = faces[i].regions;
    patches[i] = faces[i].patch;
  }
}

/// Returns the mesh with faces sorted, each beginning with its smallest corner, because .inp sorts faces by
/// tag. Pyramids begin with their smallest corner, as .inp in second order stores them.
TetMesh canonical(TetMesh mesh) {
  sort_faces(mesh.faces, mesh.face_mid_nodes, mesh.face_tag, mesh.face_regions, mesh.face_patch);
  LayerCells& layers = mesh.layers;
  sort_faces(layers.quads, layers.quad_mid_nodes, layers.quad_tag, layers.quad_regions, layers.quad_patch);
  for (std::size_t i = 0; i < layers.pyramids.size(); ++i) {
    auto& pyramid = layers.pyramids[i];
    const auto turn = std::min_element(pyramid.begin(), pyramid.begin() + 4) - pyramid.begin();
    std::rotate(pyramid.begin(), pyramid.begin() + turn, pyramid.begin() + 4);
    if (layers.pyramid_mid_nodes.empty()) continue;
    auto& middle = layers.pyramid_mid_nodes[i];
    std::rotate(middle.begin(), middle.begin() + turn, middle.begin() + 4);
    std::rotate(middle.begin() + 4, middle.begin() + 4 + turn, middle.end());
  }
  return mesh;
}

TEST(IoLayers, TheSampleIsRight) {
  const TetMesh mesh = layer_mesh();
  std::array<double, 3> volume{};
  for (const CellKind kind : volumes)
    for (std::size_t i = 0; i < io::count_of(mesh, kind); ++i) {
      EXPECT_GT(io::six_volume_of(mesh, kind, i), 0);
      volume[io::features_of(mesh, kind)[i]] += io::six_volume_of(mesh, kind, i) / 6;
    }
  EXPECT_NEAR(volume[1], testing::LayerMesh::volume_below, 0.05);  // some quadrangles are not planar
  EXPECT_NEAR(volume[2], testing::LayerMesh::volume_above, 1e-12);
  EXPECT_EQ(mesh.layers.prisms.size(), 6);
  EXPECT_EQ(mesh.layers.pyramids.size(), 5);
}

/// Returns the sample in both orders, as far as the format can store it.
std::vector<TetMesh> samples_of(const std::string& extension) {
  std::vector<TetMesh> meshes{layer_mesh()};
  const std::vector<std::string> second = io::formats_with_layers(2);
  const bool keeps = std::find(second.begin(), second.end(), extension) != second.end();
  if (keeps) meshes.push_back(second_order(layer_mesh()));
  return meshes;
}

TEST(IoLayers, WhatIsWrittenIsRead) {
  for (const Format& format : formats) {
    const std::string extension = format.extension;
    if (!io::is_tet_mesh_format("a" + extension)) continue;
    for (const TetMesh& mesh : samples_of(extension)) {
      SCOPED_TRACE(extension + " of order " + std::to_string(mesh.order()));
      const TemporaryFolder folder;
      io::write_tet_mesh(folder.file("a" + extension), mesh);
      TetMesh read = io::read_tet_mesh(folder.file("a" + extension));
      io::write_tet_mesh(folder.file("b" + extension), read);
      if (!format.all_digits) {
        ASSERT_EQ(read.points.size(), mesh.points.size());
        for (std::size_t i = 0; i < read.points.size(); ++i)
          ASSERT_LT(distance(read.points[i], mesh.points[i]), 1e-12);
        read.points = mesh.points;
      }
      expect_same(canonical(read), canonical(as_kept(mesh, format)));
      const TetMesh again = io::read_tet_mesh(folder.file("b" + extension));
      io::write_tet_mesh(folder.file("c" + extension), again);
      if (extension != ".med") {
        EXPECT_EQ(folder.read("b" + extension), folder.read("c" + extension));
      }
    }
  }
}

TEST(IoLayers, PrismsThatTurnTheOtherWayAreReversed) {
  for (const int order : {1, 2}) {
    const TetMesh right = order == 1 ? layer_mesh() : second_order(layer_mesh());
    TetMesh mesh = right;
    for (std::size_t i = 0; i < mesh.layers.prisms.size(); ++i) {
      const io::CellNodes nodes = io::turned(CellKind::prism, io::nodes_of(CellKind::prism)(mesh, i));
      std::copy_n(nodes.begin(), 6, mesh.layers.prisms[i].begin());
      if (order == 2) std::copy_n(nodes.begin() + 6, 9, mesh.layers.prism_mid_nodes[i].begin());
    }
    const TemporaryFolder folder;
    io::write_tet_mesh(folder.file("a.vtk"), mesh);
    expect_same(io::read_tet_mesh(folder.file("a.vtk")), right);
  }
}

TEST(IoLayers, QuadranglesFindTheirRegionsAndMidNodes) {
  const TetMesh right = second_order(layer_mesh());
  TetMesh mesh = right;
  mesh.layers.quad_regions.clear();
  mesh.face_regions.clear();
  mesh.layers.quad_mid_nodes.clear();
  for (auto& quad : mesh.layers.quads) std::reverse(quad.begin(), quad.end());
  io::complete_mesh("mesh", mesh);
  // Interfaces that were turned over have the other region behind them.
  for (std::size_t f = 0; f < mesh.layers.quads.size(); ++f) {
    const auto& [back, front] = right.layers.quad_regions[f];
    const auto& regions = mesh.layers.quad_regions[f];
    EXPECT_EQ(regions, front == 0 ? (std::array{back, front}) : (std::array{front, back}));
    const auto& [a, b, c, d] = mesh.layers.quads[f];
    const Point middle = 0.5 * (mesh.points[a] + mesh.points[b]);
    EXPECT_LT(distance(mesh.points[mesh.layers.quad_mid_nodes[f][0]], middle), 1e-12);
  }
  EXPECT_EQ(mesh.face_regions, right.face_regions);
}

TEST(IoLayers, CellsOfBothOrdersAreRefused) {
  TetMesh mesh = second_order(layer_mesh());
  mesh.layers.prism_mid_nodes.clear();
  EXPECT_THROW(io::complete_mesh("mesh", mesh), ReadError);
}

TEST(IoLayers, FormatsWithoutAPlaceSaySo) {
  for (const int order : {1, 2}) {
    const TemporaryFolder folder;
    const TetMesh mesh = order == 1 ? layer_mesh() : second_order(layer_mesh());
    const std::vector<std::string> kept = io::formats_with_layers(order);
    for (const std::string& format : io::written_tet_mesh_formats()) {
      SCOPED_TRACE(format + " of order " + std::to_string(order));
      const bool polymesh = format == ".polymesh";
      const std::string path = folder.file(polymesh ? "boundary" : "a" + format);
      if (std::find(kept.begin(), kept.end(), format) != kept.end()) {
        EXPECT_NO_THROW(io::write_tet_mesh(path, mesh, format));
        continue;
      }
      try {
        io::write_tet_mesh(path, mesh, format);
        ADD_FAILURE() << "written";
      } catch (const WriteError& error) {
        EXPECT_NE(std::string(error.what()).find("pyramids"), std::string::npos) << error.what();
      }
      EXPECT_FALSE(std::filesystem::exists(path));
    }
  }
}

TEST(IoLayers, PartitionsAreRefused) {
  TetMesh mesh = layer_mesh();
  mesh.tet_partition.assign(mesh.tets.size(), 0);
  const TemporaryFolder folder;
  EXPECT_THROW(io::write_tet_mesh(folder.file("a.msh"), mesh), WriteError);
}

TEST(IoLayers, HexahedraAreNoPyramids) {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("a.inp",
                   "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
                   "*ELEMENT, TYPE=C3D8\n1,1,2,3,4,5,6,7,8\n");
  try {
    io::read_tet_mesh(path);
    ADD_FAILURE() << "read";
  } catch (const ReadError& error) {
    EXPECT_NE(std::string(error.what()).find("element 1 is a hexahedron"), std::string::npos) << error.what();
  }
}

TEST(IoLayers, QuadranglesOfSurfacesAreFacets) {
  const TemporaryFolder folder;
  TetMesh mesh = layer_mesh();
  io::write_tet_mesh(folder.file("a.vtu"), mesh);
  const PolygonSoup soup = io::read_mesh_surface(folder.file("a.vtu"));
  EXPECT_EQ(soup.facet_count(), mesh.faces.size() + mesh.layers.quads.size());
}

}  // namespace
}  // namespace collarmesh::io_layers_test
