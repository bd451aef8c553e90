// A periodic mesh that is cut open elsewhere: nothing is lost by cutting and restoring it.
#include "periodic/recut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "collarmesh/pipeline.h"
#include "common/tet_sides.h"
#include "periodic/node_map.h"
#include "periodic/pair_choice.h"
#include "support/periodic.h"

namespace collarmesh::periodicity::recut_test {
namespace {

using namespace testing;
using Moved = Recut::Moved;
constexpr std::array all{Moved::beside_first, Moved::beside_second, Moved::first_half};

/// A cell of 27 boxes that its faces cut, with its periodic pairs.
struct Cell {
  Cell() {
    PipelineOptions options;
    options.mesh.size = 0.07;
    options.periodic.pairs = {"x", "y", "z"};
    SoupPipelineResult made = run_pipeline(std::vector{cell_of_boxes({0, 0.2, 0.7, 1})}, options);
    plc = std::move(made.plc);
    mesh = std::move(made.result.mesh);
    map_corners(mesh);
    pairs = choose_pairs(options.periodic, plc);
    for (const PatchPair& pair : pairs) images.push_back(find_images(pair, plc, 1e-9));
  }

  Recut recut(Moved moved) const { return {mesh, plc, SurfaceTolerance(1e-9), pairs, images, moved}; }

  Plc plc;
  TetMesh mesh;
  std::vector<PatchPair> pairs;
  std::vector<FeatureImages> images;
};

using Place = std::array<double, 3>;

Place place_of(const TetMesh& mesh, Index v) {
  const Point& p = mesh.points[v];
  return {p.x, p.y, p.z};
}

/// Returns the simplices with their data, by places, because numbers of vertices may differ.
template <std::size_t n>
std::multiset<std::pair<std::array<Place, n>, Index>> by_places(
    const TetMesh& mesh, const std::vector<std::array<Index, n>>& simplices, const std::vector<Index>& of) {
  std::multiset<std::pair<std::array<Place, n>, Index>> places;
  for (std::size_t i = 0; i < simplices.size(); ++i) {
    std::array<Place, n> corners;
    for (std::size_t k = 0; k < n; ++k) corners[k] = place_of(mesh, simplices[i][k]);
    std::sort(corners.begin(), corners.end());
    places.emplace(corners, of[i]);
  }
  return places;
}

/// Returns faces such that those with another orientation, or with regions on the other side, differ.
auto oriented_faces(const TetMesh& mesh) {
  std::multiset<std::tuple<std::array<Place, 3>, std::array<Index, 2>, Index>> faces;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    std::array<Place, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = place_of(mesh, mesh.faces[f][k]);
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    faces.emplace(corners, mesh.face_regions[f], mesh.face_patch[f]);
  }
  return faces;
}

std::vector<double> volumes(const TetMesh& mesh) {
  std::vector<double> volumes;
  for (const auto& [a, b, c, d] : mesh.tets)
    volumes.push_back(six_volume(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) / 6);
  return volumes;
}

TEST(Recut, AndBackIsTheSameMesh) {
  const Cell cell;
  for (const Moved moved : all) {
    const TetMesh back = cell.recut(moved).back();
    EXPECT_EQ(by_places(back, back.tets, back.tet_region),
              by_places(cell.mesh, cell.mesh.tets, cell.mesh.tet_region));
    EXPECT_GT(std::ranges::min(volumes(back)), 0);
    EXPECT_EQ(oriented_faces(back), oriented_faces(cell.mesh));
    EXPECT_EQ(by_places(back, back.edges, back.edge_curve),
              by_places(cell.mesh, cell.mesh.edges, cell.mesh.edge_curve));
    EXPECT_EQ(back.points.size(), cell.mesh.points.size());
  }
}

// All tets are moved rigidly, and the triangles of the second group have tets on both sides, except where the
// cut of another pair meets them.
TEST(Recut, HasThePairsFacesInside) {
  const Cell cell;
  for (const Moved moved : all) {
    Recut recut = cell.recut(moved);
    const TetMesh& mesh = recut.mesh();
    const std::set<Index> fixed(recut.fixed().begin(), recut.fixed().end());
    const std::vector<double> of_tets = volumes(mesh);
    EXPECT_NEAR(std::accumulate(of_tets.begin(), of_tets.end(), 0.0), 1, 1e-9);
    std::map<std::array<Index, 3>, unsigned> uses;
    for (const auto& tet : mesh.tets)
      for (unsigned i = 0; i < 4; ++i) {
        std::array<Index, 3> side = side_corners(tet, i);
        std::sort(side.begin(), side.end());
        ++uses[side];
      }
    const double place = moved == Moved::beside_second ? 0 : 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double area = 0;
      for (std::array<Index, 3> face : mesh.faces) {
        if (std::ranges::any_of(face,
                                [&](Index v) { return std::fabs(mesh.points[v][axis] - place) > 1e-9; }))
          continue;
        const double twice = norm(
            cross(mesh.points[face[1]] - mesh.points[face[0]], mesh.points[face[2]] - mesh.points[face[0]]));
        std::sort(face.begin(), face.end());
        area += 0.25 * uses[face] * twice;
        EXPECT_TRUE(uses[face] == 2 || std::ranges::all_of(face, [&](Index v) { return fixed.contains(v); }));
      }
      EXPECT_NEAR(area, 1, 1e-9);
    }
  }
}

// The cuts of one pair meet the faces of others, but each vertex there is off the cut for at least one
// choice.
TEST(Recut, LeavesEachVertexOfThePairsFreeOnce) {
  const Cell cell;
  std::map<Place, unsigned> fixed;
  for (const Moved moved : all) {
    Recut recut = cell.recut(moved);
    EXPECT_FALSE(recut.fixed().empty());
    std::set<Place> places;
    for (const Index v : recut.fixed()) {
      Place place = place_of(recut.mesh(), v);
      for (double& x : place) x = std::round(1e9 * (x - std::floor(x + 1e-9)));  // position within the cell
      if (std::ranges::any_of(place, [](double x) { return x == 0; })) places.insert(place);
    }
    for (const Place& place : places) ++fixed[place];
  }
  for (const auto& [place, times] : fixed) EXPECT_LT(times, all.size());
}

}  // namespace
}  // namespace collarmesh::periodicity::recut_test
