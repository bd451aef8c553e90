// Blocks of a triangulation's vertices, refined by several threads at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <thread>

#include "delaunay/predicates.h"
#include "delaunay/triangulation.h"

namespace collarmesh::delaunay_blocks_test {
namespace {

constexpr std::uint16_t block_count = 8;

// Returns the block of a point: its octant of the unit cube.
std::uint16_t octant(const Point& p) {
  return static_cast<std::uint16_t>((p.x > 0.5 ? 1 : 0) + (p.y > 0.5 ? 2 : 0) + (p.z > 0.5 ? 4 : 0));
}

bool in_unit_cube(const Point& p) { return std::min({p.x, p.y, p.z}) > 0 && std::max({p.x, p.y, p.z}) < 1; }

class DelaunayBlocks : public ::testing::Test {
 protected:
  DelaunayBlocks() : mesh_(surrounding_box()) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    ConflictZone zone;
    for (int i = 0; i < 3000; ++i) {
      const Point p{unit(random), unit(random), unit(random)};
      Index cell = 0;
      while (!mesh_.alive(cell) || !mesh_.in_conflict(cell, p)) ++cell;
      mesh_.find_conflict_zone(p, cell, zone);
      mesh_.insert(zone);
    }
    own_vertices();
  }

  static Box surrounding_box() {
    Box box;
    box.add(Point{-2, -2.1, -2.2});
    box.add(Point{3, 3.1, 3.2});
    return box;
  }

  void own_vertices() {
    owners_.assign(mesh_.vertex_count(), Triangulation::no_owner);
    for (Index v = 8; v < mesh_.vertex_count(); ++v) owners_[v] = octant(mesh_.point(v));
  }

  // Inserts the circumcentres of all cells that lie in one block, as long as the block may take more
  // vertices.
  static Index refine(const Triangulation& mesh, Triangulation::Block& block,
                      const std::vector<Index>& cells) {
    ConflictZone zone;
    Index inserted = 0;
    for (const Index cell : cells) {
      if (!mesh.alive(cell)) continue;
      const Point p = mesh.circumcentre(cell);
      if (!in_unit_cube(p) || !mesh.in_conflict(cell, p) || !block.find_conflict_zone(p, cell, zone))
        continue;
      block.insert(zone);
      ++inserted;
    }
    return inserted;
  }

  std::vector<std::vector<Index>> cells_of_blocks() const {
    std::vector<std::vector<Index>> cells(block_count);
    for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
      if (!mesh_.alive(cell)) continue;
      const auto& v = mesh_.corners(cell);
      const std::uint16_t owner = owners_[v[0]];
      if (owner != Triangulation::no_owner &&
          std::all_of(v.begin(), v.end(), [&](Index w) { return owners_[w] == owner; }))
        cells[owner].push_back(cell);
    }
    return cells;
  }

  // Uses a thread for each block, or handles the blocks one after the other, the last one first.
  Index refine_blocks(Index room, bool together) {
    const auto cells = cells_of_blocks();
    const std::vector<Index> rooms(block_count, room);
    auto blocks = mesh_.divide(rooms, owners_);
    std::vector<Index> inserted(block_count, 0);
    if (together) {
      std::vector<std::jthread> threads;
      for (std::size_t i = 0; i < block_count; ++i)
        threads.emplace_back([&, i] { inserted[i] = refine(mesh_, blocks[i], cells[i]); });
    } else {
      for (std::size_t i = block_count; i-- > 0;) inserted[i] = refine(mesh_, blocks[i], cells[i]);
    }
    mesh_.join(blocks);
    Index sum = 0;
    for (const Index n : inserted) sum += n;
    return sum;
  }

  void expect_delaunay() const {
    Index alive = 0;
    for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
      if (!mesh_.alive(cell)) continue;
      ++alive;
      const auto& v = mesh_.corners(cell);
      for (const Index w : v) ASSERT_LT(w, mesh_.vertex_count());
      ASSERT_GT(predicates::orientation_exact(mesh_.point(v[0]), mesh_.point(v[1]), mesh_.point(v[2]),
                                              mesh_.point(v[3])),
                0);
      for (unsigned corner = 0; corner < 4; ++corner) {
        const FaceId face = face_id(cell, corner), other = mesh_.opposite(face);
        if (other == no_face) continue;
        ASSERT_TRUE(mesh_.alive(cell_of(other)));
        ASSERT_EQ(mesh_.opposite(other), face);
        const Point& apex = mesh_.point(mesh_.corners(cell_of(other))[corner_of(other)]);
        ASSERT_FALSE(predicates::in_sphere_exact(mesh_.point(v[0]), mesh_.point(v[1]), mesh_.point(v[2]),
                                                 mesh_.point(v[3]), apex));
      }
    }
    EXPECT_EQ(alive, mesh_.cell_count());
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      const Index cell = mesh_.incident_cell(v);
      ASSERT_TRUE(mesh_.alive(cell));
      const auto& corners = mesh_.corners(cell);
      ASSERT_NE(std::find(corners.begin(), corners.end(), v), corners.end());
    }
  }

  Triangulation mesh_;
  Triangulation::Owners owners_;
};

TEST_F(DelaunayBlocks, RefinedByThreadsAreDelaunayWhenJoined) {
  Index vertices = mesh_.vertex_count();
  for (int round = 0; round < 3; ++round) {
    const Index inserted = refine_blocks(400, true);
    EXPECT_GT(inserted, 500U);
    vertices += inserted;
    ASSERT_EQ(mesh_.vertex_count(), vertices);
    expect_delaunay();
    own_vertices();
  }
}

TEST_F(DelaunayBlocks, BecomeTheSameWhateverTheOrderOfThreads) {
  struct Other : DelaunayBlocks {
    void TestBody() override {}
    using DelaunayBlocks::mesh_;
    using DelaunayBlocks::own_vertices;
    using DelaunayBlocks::refine_blocks;
  } other;
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(refine_blocks(300, true), other.refine_blocks(300, false));
    own_vertices();
    other.own_vertices();
  }
  ASSERT_EQ(mesh_.vertex_count(), other.mesh_.vertex_count());
  ASSERT_EQ(mesh_.cell_capacity(), other.mesh_.cell_capacity());
  for (Index v = 0; v < mesh_.vertex_count(); ++v) ASSERT_EQ(mesh_.point(v), other.mesh_.point(v));
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    ASSERT_EQ(mesh_.alive(cell), other.mesh_.alive(cell));
    if (mesh_.alive(cell)) {
      ASSERT_EQ(mesh_.corners(cell), other.mesh_.corners(cell));
    }
  }
}

TEST_F(DelaunayBlocks, FindTheCellsOfTheirVertices) {
  std::vector<std::vector<Index>> expected(mesh_.vertex_count());
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell)
    if (mesh_.alive(cell))
      for (const Index v : mesh_.corners(cell)) expected[v].push_back(cell);
  const std::vector<Index> rooms(block_count, 1);
  std::vector<Triangulation::Block> blocks = mesh_.divide(rooms, owners_);
  std::vector<Index> found;
  for (Index v = 8; v < expected.size(); ++v) {
    blocks[owners_[v]].incident_cells(v, found);
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, expected[v]);
  }
  mesh_.join(blocks);
}

TEST_F(DelaunayBlocks, TellHowTheirVerticesAreNumberedWhenJoined) {
  const std::vector<Index> rooms(block_count, 20);
  const auto cells = cells_of_blocks();
  auto blocks = mesh_.divide(rooms, owners_);
  for (std::size_t i = 0; i < block_count; ++i)
    refine(mesh_, blocks[i], {cells[i].begin(), cells[i].begin() + static_cast<std::ptrdiff_t>(3 + i)});
  GrowingArray<double> x;
  for (Index v = 0; v < mesh_.vertex_count(); ++v) x.push_back(mesh_.point(v).x);
  const Renumbering renumbering = mesh_.join(blocks);
  renumbering.apply(x);
  EXPECT_EQ(renumbering.count, mesh_.vertex_count());
  ASSERT_EQ(x.size(), mesh_.vertex_count());
  for (Index v = 0; v < mesh_.vertex_count(); ++v) EXPECT_EQ(x[v], mesh_.point(v).x);
}

TEST_F(DelaunayBlocks, TakeNoMoreThanThereIsRoomFor) {
  const Index before = mesh_.vertex_count();
  EXPECT_EQ(refine_blocks(5, true), 5U * block_count);
  EXPECT_EQ(mesh_.vertex_count(), before + 5U * block_count);
  expect_delaunay();
}

TEST_F(DelaunayBlocks, RefuseZonesWithVerticesOfOthers) {
  std::vector<Index> mixed;
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    if (!mesh_.alive(cell) || !in_unit_cube(mesh_.circumcentre(cell))) continue;
    const auto& v = mesh_.corners(cell);
    if (std::any_of(v.begin(), v.end(), [&](Index w) { return owners_[w] != owners_[v[0]]; }))
      mixed.push_back(cell);
  }
  ASSERT_FALSE(mixed.empty());
  const std::vector<Index> rooms(block_count, 10);
  auto blocks = mesh_.divide(rooms, owners_);
  ConflictZone zone;
  for (const Index cell : mixed)
    for (auto& block : blocks)
      if (mesh_.in_conflict(cell, mesh_.circumcentre(cell))) {
        EXPECT_FALSE(block.find_conflict_zone(mesh_.circumcentre(cell), cell, zone));
      }
  mesh_.join(blocks);
  expect_delaunay();
}

}  // namespace
}  // namespace collarmesh::delaunay_blocks_test
