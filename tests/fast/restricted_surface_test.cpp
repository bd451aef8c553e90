// The stored data of cells and faces: hierarchy nodes at vertices, regions, restricted triangles. After any
// insertion they equal the results of an exhaustive search.
#include "refine/restricted_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <set>
#include <thread>

#include "support/plc_shapes.h"
#include "support/refinement_parts.h"

namespace collarmesh::restricted_surface_test {
namespace {

using testing::KnownMesh;

bool holds(const Point& min, const Point& max, const Point& p) {
  return p.x > min.x && p.x < max.x && p.y > min.y && p.y < max.y && p.z > min.z && p.z < max.z;
}

/// Two boxes of different sizes that share a part of a facet: regions 1 and 2.
Plc two_boxes() {
  const std::vector<PolygonSoup> soups{testing::polygonal_box({0, 0, 0}, {1, 1, 1}),
                                       testing::polygonal_box({1, 0, 0}, {2, 1, 1})};
  return build_plc(soups);
}

Index region_at(const Point& p) {
  if (holds({0, 0, 0}, {1, 1, 1}, p)) return 1;
  return holds({1, 0, 0}, {2, 1, 1}, p) ? 2 : 0;
}

class RandomPoints {
 public:
  explicit RandomPoints(std::uint64_t seed) : random_(seed) {}
  /// Returns points around the boxes, sometimes on the faces x = 0, 1 and 2.
  Point next(const Box& box) {
    const Vector side = box.max - box.min;
    Point p{box.min.x + side.x * share_(random_), box.min.y + side.y * share_(random_),
            box.min.z + side.z * share_(random_)};
    if (random_() % 3 == 0) p.x = static_cast<double>(random_() % 3);
    return p;
  }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> share_{0.2, 0.8};
};

template <class Visit>
void visit_faces(const RefinedMesh& mesh, const Visit& visit) {
  for (Index cell = 0; cell < mesh.cell_capacity(); ++cell)
    for (unsigned corner = 0; corner < 4 && mesh.alive(cell); ++corner)
      if (mesh.opposite(face_id(cell, corner)) != no_face) visit(face_id(cell, corner));
}

TEST(RestrictedSurface, NodesOfAFaceCoverWhatItsDualEdgeCrosses) {
  const Plc plc = two_boxes();
  KnownMesh known(plc);
  RandomPoints random(1);
  std::vector<TriangleHierarchy::Crossing> found, all;
  for (int k = 0; k < 150; ++k) {
    known.insert(random.next(known.domain.box));
    if (k % 10 != 0) continue;
    visit_faces(known.mesh, [&](FaceId face) {
      known.nodes.crossings_of_dual_edge(face, found);
      known.nodes.crossings(known.mesh.circumcentre(cell_of(face)),
                            known.mesh.circumcentre(cell_of(known.mesh.opposite(face))), all);
      std::set<Index> expected, got;
      for (const auto& crossing : all) expected.insert(crossing.triangle);
      for (const auto& crossing : found) got.insert(crossing.triangle);
      ASSERT_EQ(got, expected);
    });
  }
}

TEST(RestrictedSurface, CellsHaveTheRegionOfTheirCircumcentre) {
  const Plc plc = two_boxes();
  KnownMesh known(plc);
  RandomPoints random(2);
  for (int k = 0; k < 300; ++k) {
    known.insert(random.next(known.domain.box));
    for (const Index cell : known.zone.created)
      ASSERT_EQ(known.surface.region(cell), region_at(known.mesh.circumcentre(cell))) << k;
  }
  for (Index cell = 0; cell < known.mesh.cell_capacity(); ++cell)
    if (known.mesh.alive(cell)) {
      EXPECT_EQ(known.surface.region(cell), region_at(known.mesh.circumcentre(cell)));
    }
}

TEST(RestrictedSurface, AFaceIsMarkedFromBothSidesIfItsDualEdgeCrossesAPatch) {
  const Plc plc = two_boxes();
  KnownMesh known(plc);
  RandomPoints random(3);
  std::vector<TriangleHierarchy::Crossing> crossings;
  for (int k = 0; k < 200; ++k) {
    known.insert(random.next(known.domain.box));
    if (k % 20 != 19) continue;
    std::size_t marked = 0;
    visit_faces(known.mesh, [&](FaceId face) {
      const FaceId other = known.mesh.opposite(face);
      known.nodes.crossings(known.mesh.circumcentre(cell_of(face)), known.mesh.circumcentre(cell_of(other)),
                            crossings);
      ASSERT_EQ(known.surface.is_marked(face), !crossings.empty());
      ASSERT_EQ(known.surface.is_marked(face), known.surface.is_marked(other));
      if (crossings.empty()) return;
      ++marked;
      const RestrictedTriangle& t = known.surface.triangle(face);
      EXPECT_EQ(&t, &known.surface.triangle(other));
      EXPECT_EQ(t.several_sheets, crossings.size() > 1);
      EXPECT_NEAR(t.squared_radius,
                  squared_distance(t.x, known.mesh.point(known.mesh.face_vertices(face)[0])), 1e-9);
    });
    EXPECT_EQ(known.surface.marked_faces().size(), marked / 2);
  }
}

TEST(RestrictedSurface, NotesLastAsLongAsTheirTriangle) {
  const Plc plc = two_boxes();
  KnownMesh known(plc);
  RandomPoints random(4);
  for (int k = 0; k < 60; ++k) known.insert(random.next(known.domain.box));
  for (const FaceId face : known.surface.marked_faces()) {
    known.surface.note_judged(face);
    known.surface.note_given_up(face);
    known.surface.note_needed(face);
    known.surface.note_known_near(face);
  }
  // Inserts into the middle of a marked face's gap ball: that face is no longer marked, other faces stay as
  // they are.
  const FaceId face = known.surface.marked_faces()[0];
  known.insert(known.surface.triangle(face).x, {2, known.surface.patch(face)});
  std::size_t fresh = 0, kept = 0;
  std::vector<bool> made(known.mesh.cell_capacity(), false);
  for (const Index cell : known.zone.created) made[cell] = true;
  for (const FaceId f : known.surface.marked_faces()) {
    const TriangleNotes& notes = known.surface.notes(f);
    if (made[cell_of(f)] && made[cell_of(known.mesh.opposite(f))]) {
      EXPECT_FALSE(notes.given_up || notes.judged || notes.surface_needs_it || notes.known_near);
      ++fresh;
    } else if (!made[cell_of(f)] && !made[cell_of(known.mesh.opposite(f))]) {
      EXPECT_TRUE(notes.given_up && notes.judged && notes.surface_needs_it && notes.known_near);
      ++kept;
    } else {
      EXPECT_FALSE(notes.judged);  // a border face: it belongs to another cell now, and must be queued again
    }
  }
  EXPECT_GT(fresh, 0U);
  EXPECT_GT(kept, 0U);
}

/// Blocks of a KnownMesh on both sides of x = 1. A thread for each inserts points into it.
class KnownBlocks {
 public:
  explicit KnownBlocks(KnownMesh& known) : known_(known) {}

  Index insert(std::uint64_t seed, std::size_t records) {
    Triangulation::Owners owners;
    for (Index v = 0; v < known_.mesh.vertex_count(); ++v)
      owners.push_back(v < 8 ? Triangulation::no_owner : known_.mesh.point(v).x > 1 ? 1 : 0);
    const std::array cells{cells_of(0, owners), cells_of(1, owners)};
    const std::vector<Index> room{200, 200};
    const std::vector<std::size_t> records_of_blocks{records, records};
    auto blocks = known_.mesh.divide(room, owners);
    std::vector<RestrictedSurface::Workspace> surfaces(2);
    std::vector<Index> inserted(2, 0);
    known_.nodes.fit_mesh();
    known_.surface.divide(records_of_blocks, surfaces);
    {
      std::vector<std::jthread> threads;
      for (std::size_t i = 0; i < 2; ++i)
        threads.emplace_back(
            [&, i] { inserted[i] = insert(blocks[i], surfaces[i], workspaces_[i], cells[i], seed + i); });
    }
    known_.nodes.renumber(known_.mesh.join(blocks));
    known_.surface.join(surfaces);
    return inserted[0] + inserted[1];
  }

 private:
  std::vector<Index> cells_of(std::size_t block, const Triangulation::Owners& owners) const {
    std::vector<Index> cells;
    for (Index cell = 0; cell < known_.mesh.cell_capacity(); ++cell) {
      if (!known_.mesh.alive(cell)) continue;
      const auto& v = known_.mesh.corners(cell);
      if (std::all_of(v.begin(), v.end(), [&](Index w) { return owners[w] == block; })) cells.push_back(cell);
    }
    return cells;
  }

  // Inserts near the circumcentres of some cells, sometimes on a facet.
  Index insert(Triangulation::Block& block, RestrictedSurface::Workspace& surface,
               SurfaceNodes::Workspace& nodes, const std::vector<Index>& cells, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    ConflictZone zone;
    Index inserted = 0;
    for (const Index cell : cells) {
      if (!known_.mesh.alive(cell)) continue;
      Point p = known_.mesh.circumcentre(cell);
      if (random() % 3 == 0) p.x = static_cast<double>(2 * (random() % 2));
      if (!known_.mesh.in_conflict(cell, p) || !block.find_conflict_zone(p, cell, zone) ||
          !known_.surface.has_room(zone, surface))
        continue;
      known_.surface.cells_vanish(zone, surface);
      const Index vertex = known_.mesh.insert(block, zone, {3, none});
      known_.nodes.cells_made(zone, vertex, block, nodes);
      known_.surface.cells_made(zone, vertex, surface);
      ++inserted;
    }
    return inserted;
  }

  KnownMesh& known_;
  std::array<SurfaceNodes::Workspace, 2> workspaces_;
};

TEST(RestrictedSurface, IsWhatASearchFindsAfterInsertionsIntoBlocks) {
  const Plc plc = two_boxes();
  KnownMesh known(plc);
  RandomPoints random(6);
  for (int k = 0; k < 400; ++k) known.insert(random.next(known.domain.box));
  KnownBlocks blocks(known);
  std::vector<TriangleHierarchy::Crossing> all, found;
  for (std::uint64_t round = 0; round < 3; ++round) {
    const Index before = known.mesh.vertex_count();
    const Index inserted = blocks.insert(10 * round, 600);
    EXPECT_GT(inserted, 40U);
    ASSERT_EQ(known.mesh.vertex_count(), before + inserted);
    std::size_t marked = 0;
    std::set<const RestrictedTriangle*> records;
    visit_faces(known.mesh, [&](FaceId face) {
      const Index cell = cell_of(face);
      ASSERT_EQ(known.surface.region(cell), region_at(known.mesh.circumcentre(cell)));
      known.nodes.crossings(known.mesh.circumcentre(cell),
                            known.mesh.circumcentre(cell_of(known.mesh.opposite(face))), all);
      known.nodes.crossings_of_dual_edge(face, found);
      ASSERT_EQ(found.size(), all.size());
      ASSERT_EQ(known.surface.is_marked(face), !all.empty());
      if (all.empty()) return;
      ++marked;
      EXPECT_EQ(known.surface.triangle(face).several_sheets, all.size() > 1);
      EXPECT_EQ(&known.surface.triangle(face), &known.surface.triangle(known.mesh.opposite(face)));
      records.insert(&known.surface.triangle(face));
    });
    EXPECT_EQ(known.surface.marked_faces().size(), marked / 2);
    EXPECT_EQ(records.size(), marked / 2);
    known.insert(random.next(known.domain.box));  // afterwards the loop continues
  }
}

TEST(RestrictedSurface, BlocksInsertNothingWithoutRecords) {
  const Plc plc = two_boxes();
  KnownMesh known(plc);
  RandomPoints random(7);
  for (int k = 0; k < 400; ++k) known.insert(random.next(known.domain.box));
  EXPECT_EQ(KnownBlocks(known).insert(1, 0), 0U);
}

TEST(RestrictedSurface, GivingACellOutsideTurnsTheMarksOfItsFaces) {
  const Plc plc = two_boxes();
  KnownMesh known(plc);
  RandomPoints random(5);
  for (int k = 0; k < 80; ++k) known.insert(random.next(known.domain.box));
  const auto faces = known.surface.marked_faces();
  const auto at = std::find_if(faces.begin(), faces.end(),
                               [&](FaceId face) { return known.surface.region(cell_of(face)) == 1; });
  ASSERT_NE(at, faces.end());
  const Index cell = cell_of(*at), patch = known.surface.patch(*at);
  const unsigned before = known.surface.marked(cell);
  known.surface.give_outside(cell);
  EXPECT_EQ(known.surface.region(cell), 0U);
  EXPECT_EQ(known.surface.marked(cell), ~before & 0xfU);
  known.surface.visit_marked(cell, [&](FaceId face) {
    EXPECT_TRUE(known.surface.is_marked(known.mesh.opposite(face)));
    if (std::popcount(before) == 1) {
      EXPECT_EQ(known.surface.patch(face), patch);
    }
  });
}

}  // namespace
}  // namespace collarmesh::restricted_surface_test
