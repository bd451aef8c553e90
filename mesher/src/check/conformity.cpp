// Checks each face of a tet against the other tets at it and against the listed faces.
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "check/mesh_to_check.h"
#include "common/edge_key.h"
#include "common/median.h"
#include "common/simplices_at_vertex.h"

namespace collarmesh::checks {

namespace {

class ConformityCheck {
 public:
  ConformityCheck(const MeshToCheck& to_check, Findings& findings)
      : to_check_(to_check), findings_(findings) {}

  /// Returns whether a triangle needs no closer look: it is a side of two tets of one region, one on either
  /// side, and is no listed face. Most triangles are like this.
  static bool is_plain(const MeshToCheck& to_check, std::span<const TriangleUse> uses) {
    return uses.size() == 2 && !uses[1].listed() && uses[0].odd != uses[1].odd &&
           to_check.mesh.tet_region[uses[0].cell] == to_check.mesh.tet_region[uses[1].cell];
  }

  void triangle(Index smallest, std::span<const TriangleUse> uses) {
    corners_ = {smallest, uses[0].middle(), uses[0].largest()};
    const auto first_listed =
        std::find_if(uses.begin(), uses.end(), [](const TriangleUse& u) { return u.listed(); });
    const auto sides = static_cast<std::size_t>(first_listed - uses.begin());
    listed_ = uses.subspan(sides);
    collect_sides(uses.first(sides));
    check_sides();
    check_listing();
  }

 private:
  // Collects the tets at a triangle. If a tet is listed twice, its side counts once, and the tet is reported.
  void collect_sides(std::span<const TriangleUse> sides) {
    sides_.clear();
    for (const TriangleUse& use : sides) {
      const auto duplicate = std::find_if(sides_.begin(), sides_.end(), [&](const TriangleUse& other) {
        return other.odd == use.odd && opposite(other) == opposite(use);
      });
      if (duplicate == sides_.end())
        sides_.push_back(use);
      else if (opposite(use) > corners_[2])  // report each tet once, not for each of its four sides
        report_duplicates(duplicate->cell, use.cell);
    }
  }

  void check_sides() {
    if (sides_.size() < 2 || (sides_.size() == 2 && sides_[0].odd != sides_[1].odd)) return;
    findings_.add(guarantee::conforming, where(),
                  {corners_[0], corners_[1], corners_[2], sides_[0].cell, sides_[1].cell},
                  "The face of points {}, {}, {} at {} is shared by {} tets, {} {} and {}; tets overlap "
                  "there. If the mesher made this mesh, report it with the input and the options.",
                  corners_[0], corners_[1], corners_[2], At{where()}, sides_.size(),
                  sides_[0].odd == sides_[1].odd ? "two of them on one side of it:"
                                                 : "several of them on one side of it, the first two being",
                  sides_[0].cell, sides_[1].cell);
  }

  void check_listing() {
    if (listed_.size() > 1)
      findings_.add(guarantee::listed_faces, where(), {listed_[0].cell, listed_[1].cell},
                    "Faces {} and {} are the same triangle of points {}, {}, {} at {}; list it once.",
                    listed_[0].cell, listed_[1].cell, corners_[0], corners_[1], corners_[2], At{where()});
    if (sides_.empty())
      findings_.add(
          guarantee::listed_faces, where(), {listed_[0].cell},
          "Face {} of points {}, {}, {} at {} is a side of no tet; its tets are missing or it does not "
          "belong to the mesh.",
          listed_[0].cell, corners_[0], corners_[1], corners_[2], At{where()});
    else if (listed_.empty())
      check_unlisted();
    else
      check_regions(listed_[0]);
  }

  void check_unlisted() {
    if (sides_.size() == 1)
      findings_.add(
          guarantee::listed_faces, where(), {sides_[0].cell},
          "The face of points {}, {}, {} at {} has tet {} on one side and nothing on the other, and is not "
          "among the boundary faces; the mesh has a hole there or the face is missing.",
          corners_[0], corners_[1], corners_[2], At{where()}, sides_[0].cell);
    else if (sides_.size() == 2 && region(sides_[0]) != region(sides_[1]))
      findings_.add(
          guarantee::listed_faces, where(), {sides_[0].cell, sides_[1].cell},
          "The face of points {}, {}, {} at {} separates tet {} in region {} from tet {} in region {} and is "
          "not among the faces; a tet's region is wrong or the face is missing.",
          corners_[0], corners_[1], corners_[2], At{where()}, sides_[0].cell, region(sides_[0]),
          sides_[1].cell, region(sides_[1]));
  }

  // Checks the regions of a listed face. Normals of tets' sides point out of the tets, so the tet behind the
  // face is the one whose side is oriented like the face.
  void check_regions(const TriangleUse& listed) {
    std::array<Index, 2> regions{0, 0};
    for (const TriangleUse& side : sides_) regions[side.odd == listed.odd ? 0 : 1] = region(side);
    const Index face = listed.cell;
    const auto& given = to_check_.mesh.face_regions[face];
    if (given == regions) return;
    findings_.add(guarantee::face_regions, where(), {face},
                  "Face {} of points {}, {}, {} at {} is listed between the regions {} (behind its normal) "
                  "and {}, but its tets are in {} and {}; turn it or correct its regions.",
                  face, corners_[0], corners_[1], corners_[2], At{where()}, given[0], given[1], regions[0],
                  regions[1]);
  }

  void report_duplicates(Index first, Index second) {
    findings_.add(guarantee::distinct_tets, where(), {first, second},
                  "Tets {} and {} at {} have the same four corners; list the tet once.", first, second,
                  At{where()});
  }

  Index opposite(const TriangleUse& side) const { return to_check_.mesh.tets[side.cell][side.corner]; }
  Index region(const TriangleUse& side) const { return to_check_.mesh.tet_region[side.cell]; }
  Point where() const { return to_check_.centroid(corners_); }

  const MeshToCheck& to_check_;
  Findings& findings_;
  std::array<Index, 3> corners_{};
  std::vector<TriangleUse> sides_;
  std::span<const TriangleUse> listed_;
};

struct BoundaryEdge {
  Index region;
  std::array<Index, 2> ends;
  int direction;

  bool same_edge(const BoundaryEdge& other) const { return region == other.region && ends == other.ends; }
  friend bool operator<(const BoundaryEdge& a, const BoundaryEdge& b) {
    return a.region != b.region ? a.region < b.region
                                : edge_key(a.ends[0], a.ends[1]) < edge_key(b.ends[0], b.ends[1]);
  }
};

void add_edges(const std::array<Index, 3>& face, Index region, int direction,
               std::vector<BoundaryEdge>& edges) {
  if (region == 0) return;
  for (unsigned i = 0; i < 3; ++i) {
    const Index a = face[i], b = face[(i + 1) % 3];
    edges.push_back({region, sorted(a, b), a < b ? direction : -direction});
  }
}

}  // namespace

// Scans the vertices with all threads, then judges, in order, the triangles that need a closer look.
void check_conformity(const MeshToCheck& to_check, CheckReport& report, Findings& findings) {
  const TetMesh& mesh = to_check.mesh;
  struct NotPlain {
    Index smallest;
    TriangleUse use;

    auto triangle() const { return std::pair(smallest, use.larger_corners); }
  };
  struct Found {
    FittingTetsAtVertex tets;
    TrianglesAtVertex triangles;
    std::vector<double> lengths;
    std::vector<NotPlain> not_plain;
  };
  tbb::enumerable_thread_specific<Found> of_threads;
  for_each_vertex_with_cells(mesh, [&](std::size_t i, std::span<const Index> cells) {
    const auto vertex = static_cast<Index>(i);
    Found& found = of_threads.local();
    found.tets.find(mesh, vertex, cells);
    for (const Index end : found.tets.ends())
      found.lengths.push_back(distance(mesh.points[vertex], mesh.points[end]));
    if (found.tets.fit()) return;
    found.triangles.find(mesh, vertex, cells);
    found.triangles.for_each([&](std::span<const TriangleUse> uses) {
      if (ConformityCheck::is_plain(to_check, uses)) return;
      for (const TriangleUse& use : uses) found.not_plain.push_back({vertex, use});
    });
  });
  std::vector<double> lengths;
  std::vector<NotPlain> all;
  for (const Found& found : of_threads) {
    lengths.insert(lengths.end(), found.lengths.begin(), found.lengths.end());
    all.insert(all.end(), found.not_plain.begin(), found.not_plain.end());
  }
  report.median_edge = median(lengths);
  std::stable_sort(all.begin(), all.end(),
                   [](const NotPlain& a, const NotPlain& b) { return a.triangle() < b.triangle(); });
  ConformityCheck check(to_check, findings);
  std::vector<TriangleUse> uses;
  for (std::size_t i = 0, end = 0; i < all.size(); i = end) {
    uses.clear();
    for (; end < all.size() && all[end].triangle() == all[i].triangle(); ++end) uses.push_back(all[end].use);
    check.triangle(all[i].smallest, uses);
  }
}

// Checks that the faces of a region, turned outwards, have no boundary: every edge is passed equally often in
// both directions.
void check_watertight(const MeshToCheck& to_check, Findings& findings) {
  const TetMesh& mesh = to_check.mesh;
  std::vector<BoundaryEdge> edges;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (mesh.face_regions[f][0] == mesh.face_regions[f][1]) continue;
    add_edges(mesh.faces[f], mesh.face_regions[f][0], 1, edges);
    add_edges(mesh.faces[f], mesh.face_regions[f][1], -1, edges);
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
    int sum = 0;
    for (j = i; j < edges.size() && edges[j].same_edge(edges[i]); ++j) sum += edges[j].direction;
    if (sum == 0) continue;
    const auto& [a, b] = edges[i].ends;
    const Point where = to_check.midpoint(edges[i].ends);
    findings.add(
        guarantee::watertight, where, {a, b, edges[i].region},
        "The faces around region {} do not close at the edge of points {} and {} at {}: they run "
        "along it {} time{} more often in one direction than in the other; a face is missing, doubled or "
        "turned there.",
        edges[i].region, a, b, At{where}, std::abs(sum), std::abs(sum) == 1 ? "" : "s");
  }
}

}  // namespace collarmesh::checks
