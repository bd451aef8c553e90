#include "refine/memory_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

namespace collarmesh {
namespace {

using Place = std::tuple<double, double, double>;

Place place(const TetMesh& mesh, Index point) {
  const Point& p = mesh.points[point];
  return {p.x, p.y, p.z};
}

template <std::size_t corners>
std::array<Place, corners> places(const TetMesh& mesh, const std::array<Index, corners>& cell) {
  std::array<Place, corners> all;
  std::transform(cell.begin(), cell.end(), all.begin(), [&](Index p) { return place(mesh, p); });
  return all;
}

/// Everything that a mesh tells, whatever its numbers.
auto told_by(const TetMesh& mesh) {
  std::multiset<std::tuple<Place, unsigned, Index>> points;
  for (Index p = 0; p < mesh.points.size(); ++p)
    points.emplace(place(mesh, p), mesh.features[p].dimension, mesh.features[p].feature);
  std::multiset<std::tuple<std::array<Place, 4>, Index, Tag, unsigned, unsigned, Tag>> tets;
  for (Index t = 0; t < mesh.tets.size(); ++t)
    tets.emplace(places(mesh, mesh.tets[t]), mesh.tet_region[t], mesh.tet_tag[t], mesh.tet_collar[t],
                 mesh.tet_thin[t], mesh.tet_crease[t]);
  std::multiset<std::tuple<std::array<Place, 3>, std::array<Index, 2>, Index, Tag>> faces;
  for (Index f = 0; f < mesh.faces.size(); ++f)
    faces.emplace(places(mesh, mesh.faces[f]), mesh.face_regions[f], mesh.face_patch[f], mesh.face_tag[f]);
  std::multiset<std::tuple<std::array<Place, 2>, Index, Tag>> edges;
  for (Index e = 0; e < mesh.edges.size(); ++e)
    edges.emplace(places(mesh, mesh.edges[e]), mesh.edge_curve[e], mesh.edge_tag[e]);
  std::multiset<std::pair<Place, double>> balls;
  for (const TetMesh::CollarBall& ball : mesh.collar_balls)
    balls.emplace(place(mesh, ball.point), ball.radius);
  return std::tuple(points, tets, faces, edges, balls);
}

/// How far apart the numbers of a tet's corners are on average.
double spread(const TetMesh& mesh) {
  double sum = 0;
  for (const auto& tet : mesh.tets) {
    const auto [least, greatest] = std::minmax_element(tet.begin(), tet.end());
    sum += *greatest - *least;
  }
  return sum / static_cast<double>(mesh.tets.size());
}

TetMesh grid(unsigned n) {
  TetMesh mesh;
  const auto number = [n](unsigned x, unsigned y, unsigned z) { return x + (n + 1) * (y + (n + 1) * z); };
  for (unsigned z = 0; z <= n; ++z)
    for (unsigned y = 0; y <= n; ++y)
      for (unsigned x = 0; x <= n; ++x) {
        mesh.points.push_back({double(x), double(y), double(z)});
        mesh.features.push_back({static_cast<std::uint8_t>(x == 0 ? 2 : 3), x == 0 ? number(x, y, z) : none});
      }
  std::vector<Index> shuffled(mesh.points.size());
  for (Index i = 0; i < shuffled.size(); ++i) shuffled[i] = i;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(1));  // the new number of each
  std::vector<Point> points(mesh.points.size());
  std::vector<TetMesh::VertexFeature> features(mesh.points.size());
  for (Index i = 0; i < shuffled.size(); ++i) {
    points[shuffled[i]] = mesh.points[i];
    features[shuffled[i]] = mesh.features[i];
  }
  mesh.points = points;
  mesh.features = features;
  for (unsigned z = 0; z < n; ++z)
    for (unsigned y = 0; y < n; ++y)
      for (unsigned x = 0; x < n; ++x) {
        const Index t = static_cast<Index>(mesh.tets.size());
        const Index o = shuffled[number(x, y, z)], a = shuffled[number(x + 1, y, z)],
                    b = shuffled[number(x, y + 1, z)], c = shuffled[number(x, y, z + 1)];
        mesh.tets.push_back({o, a, b, c});
        mesh.tet_region.push_back(t), mesh.tet_tag.push_back(2 * t), mesh.tet_collar.push_back(t % 3);
        mesh.tet_thin.push_back(t % 2), mesh.tet_crease.push_back(5 * t);
        mesh.faces.push_back({o, a, b});
        mesh.face_regions.push_back({t, 0}), mesh.face_patch.push_back(3 * t), mesh.face_tag.push_back(7 * t);
        mesh.edges.push_back({o, c});
        mesh.edge_curve.push_back(t), mesh.edge_tag.push_back(9 * t);
        mesh.collar_balls.push_back({o, 0.1 * t, {}});
      }
  std::shuffle(mesh.edges.begin(), mesh.edges.end(), std::mt19937(2));
  return mesh;
}

TEST(MemoryOrder, TellsTheSameAndPutsTogetherWhatIsNear) {
  constexpr unsigned n = 16;
  TetMesh mesh = grid(n);
  const auto before = told_by(mesh);
  const double spread_before = spread(mesh);
  order_in_memory(mesh);
  EXPECT_EQ(told_by(mesh), before);
  EXPECT_GT(spread_before, 2000);
  EXPECT_LT(spread(mesh), 600);  // of 4913 points
  std::vector<Index> least;
  for (const auto& tet : mesh.tets) least.push_back(*std::min_element(tet.begin(), tet.end()));
  EXPECT_TRUE(std::is_sorted(least.begin(), least.end()));
}

TEST(MemoryOrder, AnEmptyMeshStaysEmpty) {
  TetMesh mesh;
  order_in_memory(mesh);
  EXPECT_TRUE(mesh.points.empty());
  EXPECT_TRUE(mesh.tets.empty());
}

}  // namespace
}  // namespace collarmesh
