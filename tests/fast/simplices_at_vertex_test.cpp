#include "common/simplices_at_vertex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <numeric>
#include <random>
#include <set>

#include "support/meshes.h"

namespace collarmesh::simplices_at_vertex_test {
namespace {

/// A use of a triangle of points: by a tet, opposite one of its corners, or by a listed face (corner 4).
struct BruteUse {
  Index cell;
  unsigned corner;
  bool odd;

  friend auto operator<=>(const BruteUse&, const BruteUse&) = default;
};
using Triangles = std::map<std::array<Index, 3>, std::vector<BruteUse>>;

bool is_odd(const std::array<Index, 3>& c) {
  return ((c[0] > c[1]) + (c[0] > c[2]) + (c[1] > c[2])) % 2 == 1;
}

Triangles all_triangles(const TetMesh& mesh) {
  Triangles triangles;
  const auto add = [&](std::array<Index, 3> corners, Index cell, unsigned corner) {
    const bool odd = is_odd(corners);
    std::sort(corners.begin(), corners.end());
    triangles[corners].push_back({cell, corner, odd});
  };
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    add({b, c, d}, t, 0), add({a, d, c}, t, 1), add({a, b, d}, t, 2), add({a, c, b}, t, 3);
  }
  for (Index f = 0; f < mesh.faces.size(); ++f) add(mesh.faces[f], f, TriangleUse::listed_face);
  return triangles;
}

/// Makes cubes of six tets each, with points numbered at random and no listed face.
TetMesh grid(unsigned n, std::uint32_t seed) {
  const TetMesh box = testing::meshed_box(n).mesh;
  std::vector<Index> number(box.points.size());
  std::iota(number.begin(), number.end(), Index{0});
  std::shuffle(number.begin(), number.end(), std::mt19937(seed));
  TetMesh mesh;
  mesh.points.resize(box.points.size());
  for (const auto& [a, b, c, d] : box.tets) mesh.tets.push_back({number[a], number[b], number[c], number[d]});
  mesh.tet_region = box.tet_region;
  return mesh;
}

/// Spoils a mesh: exchanges corners of two tets, inverts a tet, repeats one many times, changes its region,
/// lists a face, or removes a tet.
void spoil(TetMesh& mesh, std::mt19937& random) {
  const auto any = [&] { return random() % mesh.tets.size(); };
  switch (random() % 6) {
    case 0: std::swap(mesh.tets[any()][0], mesh.tets[any()][0]); break;
    case 1: {
      auto& tet = mesh.tets[any()];
      std::swap(tet[1], tet[2]);
      break;
    }
    case 2: {
      const std::array<Index, 4> duplicate = mesh.tets[any()];
      for (unsigned times = 0; times < 1 + random() % 3; ++times) {
        mesh.tets.push_back(duplicate);
        mesh.tet_region.push_back(1);
      }
      break;
    }
    case 3: mesh.tet_region[any()] = 2; break;
    case 4: {
      const auto& tet = mesh.tets[any()];
      mesh.faces.push_back({tet[2], tet[0], tet[3]});
      break;
    }
    default:
      mesh.tets.erase(mesh.tets.begin() + static_cast<std::ptrdiff_t>(any())), mesh.tet_region.pop_back();
  }
}

// Returns whether all corners are distinct; repeated corners are found earlier, by `check_arrays`.
bool has_distinct_corners(const TetMesh& mesh) {
  return std::all_of(mesh.tets.begin(), mesh.tets.end(), [](const std::array<Index, 4>& tet) {
    return std::set<Index>(tet.begin(), tet.end()).size() == 4;
  });
}

/// Returns for each vertex whether all triangles with this smallest corner satisfy
/// `FittingTetsAtVertex::fit`.
std::vector<bool> vertices_where_tets_fit(const TetMesh& mesh, const Triangles& triangles) {
  std::vector<bool> fit(mesh.points.size(), true);
  for (const auto& [corners, uses] : triangles) {
    const bool plain = uses.size() == 2 && uses[1].corner != TriangleUse::listed_face &&
                       uses[0].odd != uses[1].odd &&
                       mesh.tet_region[uses[0].cell] == mesh.tet_region[uses[1].cell];
    if (!plain) fit[corners[0]] = false;
  }
  return fit;
}

void expect_simplices(const TetMesh& mesh) {
  const Triangles expected = all_triangles(mesh);
  const std::vector<bool> fit = vertices_where_tets_fit(mesh, expected);
  std::set<std::array<Index, 2>> edges;
  for (const auto& tet : mesh.tets)
    for (const Index a : tet)
      for (const Index b : tet)
        if (a < b) edges.insert({a, b});
  Triangles found;
  std::set<std::array<Index, 2>> found_edges;
  std::mutex mutex;
  for_each_vertex_with_cells(mesh, [&](std::size_t i, std::span<const Index> cells) {
    const std::scoped_lock lock(mutex);
    const auto vertex = static_cast<Index>(i);
    TrianglesAtVertex triangles;
    triangles.find(mesh, vertex, cells);
    triangles.for_each([&](std::span<const TriangleUse> uses) {
      auto& list = found[{vertex, uses[0].middle(), uses[0].largest()}];
      EXPECT_TRUE(list.empty());
      for (const TriangleUse& use : uses) list.push_back({use.cell, use.corner, use.odd});
    });
    FittingTetsAtVertex tets_at;
    EdgesAtVertex edges_at;
    for (unsigned time = 0; time < 2; ++time) {  // the object is reused
      tets_at.find(mesh, vertex, cells);
      edges_at.find(mesh, vertex, cells);
      EXPECT_EQ(std::set<Index>(tets_at.ends().begin(), tets_at.ends().end()),
                std::set<Index>(edges_at.ends().begin(), edges_at.ends().end()));
      // If `fit` returns true, the tets fit. Beside other regions it may return false although they fit.
      EXPECT_TRUE(fit[vertex] || !tets_at.fit());
      const bool one_region = std::all_of(cells.begin(), cells.end(), [&](Index cell) {
        return cell < mesh.tets.size() && mesh.tet_region[cell] == mesh.tet_region[cells[0]];
      });
      if (one_region && edges_at.ends().size() <= 32) {
        EXPECT_EQ(tets_at.fit(), fit[vertex]) << vertex;
      }
    }
    for (const Index end : edges_at.ends()) EXPECT_TRUE(found_edges.insert({vertex, end}).second);
  });
  EXPECT_EQ(found, expected);
  EXPECT_EQ(found_edges, edges);
}

TEST(SimplicesAtVertex, OfAGrid) {
  for (const unsigned n : {1U, 2U, 5U}) expect_simplices(grid(n, n));
}

TEST(SimplicesAtVertex, OfSpoiltGrids) {
  std::mt19937 random(7);
  unsigned spoilt = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    TetMesh mesh = grid(3, seed);
    for (unsigned fault = 0; fault < 1 + seed % 4; ++fault) spoil(mesh, random);
    if (!has_distinct_corners(mesh)) continue;
    ++spoilt;
    expect_simplices(mesh);
  }
  EXPECT_GT(spoilt, 60U);
}

// Vertices with more neighbours than `most_counted`, and with more than a hash table has slots initially.
TEST(SimplicesAtVertex, OfAVertexOfManyTets) {
  for (const Index rim : {20U, 31U, 33U, 300U}) {
    TetMesh mesh;
    mesh.points.resize(rim + 2);
    for (Index i = 0; i < rim; ++i) {
      mesh.tets.push_back({0, 1, 2 + i, 2 + (i + 1) % rim});
      mesh.tet_region.push_back(1);
    }
    expect_simplices(mesh);
  }
}

// A triangle of such a tet has many uses; finding them must not take a quadratic number of steps.
TEST(SimplicesAtVertex, OfATetGivenManyTimes) {
  TetMesh mesh;
  mesh.points.resize(4);
  mesh.tets.assign(200000, {0, 1, 2, 3});
  mesh.tet_region.assign(mesh.tets.size(), 1);
  std::size_t uses_of_all = 0;
  std::mutex mutex;
  for_each_vertex_with_cells(mesh, [&](std::size_t vertex, std::span<const Index> cells) {
    const std::scoped_lock lock(mutex);
    TrianglesAtVertex triangles;
    triangles.find(mesh, static_cast<Index>(vertex), cells);
    triangles.for_each([&](std::span<const TriangleUse> uses) { uses_of_all += uses.size(); });
    FittingTetsAtVertex tets;
    tets.find(mesh, static_cast<Index>(vertex), cells);
    EXPECT_TRUE(!tets.fit() || vertex > 1);  // the two largest vertices are the smallest corner of no
                                             // triangle
  });
  EXPECT_EQ(uses_of_all, 4 * mesh.tets.size());
}

// The command `info` measures unchecked meshes: corners may be repeated, and regions missing.
TEST(MedianEdge, OfAMeshThatNobodyHasChecked) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {9, 9, 9}, {9, 9, 9}};
  mesh.tets = {{3, 1, 0, 1}, {0, 1, 0, 1}, {0, 1, 2, 3}, {2, 2, 2, 2}};
  // 1, 2, 3, sqrt 5, sqrt 10, sqrt 13
  EXPECT_EQ(median_edge(mesh), 3);
}

}  // namespace
}  // namespace collarmesh::simplices_at_vertex_test
