// Each face of a tet against the other tets at it and against the listed faces.
#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>

#include "check/subject.h"
#include "common/large_pages.h"

namespace collarmesh::checks {

namespace {

// The corners of the face opposite corner i, with the normal away from the tet.
constexpr std::array<std::array<unsigned, 3>, 4> outward{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// A triangle of the mesh that uses three points: a side of a tet or a listed face. Kept with the
// smallest of the points, so that only the other two need storing.
struct Use {
  Index middle, largest;
  std::uint32_t code;  // listed faces have the top bit; then index and, in the lowest bit, the parity

  static constexpr std::uint32_t listed_bit = 0x80000000U;

  bool listed() const { return (code & listed_bit) != 0; }
  bool odd() const { return (code & 1U) != 0; }
  Index face() const { return (code & ~listed_bit) >> 1U; }
  Index tet() const { return code >> 3U; }
  unsigned corner() const { return code >> 1U & 3U; }
  friend bool operator<(const Use& a, const Use& b) {
    if (a.middle != b.middle) return a.middle < b.middle;
    if (a.largest != b.largest) return a.largest < b.largest;
    return a.code < b.code;
  }
};

struct SortedTriangle {
  std::array<Index, 3> corners;
  bool odd;  // an odd permutation of the given order

  explicit SortedTriangle(Index a, Index b, Index c) : corners{a, b, c}, odd(false) {
    sort_pair(0, 1);
    sort_pair(1, 2);
    sort_pair(0, 1);
  }

 private:
  void sort_pair(unsigned i, unsigned j) {
    if (corners[i] <= corners[j]) return;
    std::swap(corners[i], corners[j]);
    odd = !odd;
  }
};

// All uses, in groups by their smallest point. Twelve bytes for each.
class UseTable {
 public:
  explicit UseTable(const TetMesh& mesh) : first_(mesh.points.size() + 1, 0) {
    assert(mesh.tets.size() < (std::size_t{1} << 28U) && mesh.faces.size() < (std::size_t{1} << 30U));
    for_each_use(mesh, [&](Index smallest, const Use&) { ++first_[smallest + 1]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    uses_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for_each_use(mesh, [&](Index smallest, const Use& use) { uses_[next[smallest]++] = use; });
    for (std::size_t i = 0; i + 1 < first_.size(); ++i)
      std::sort(uses_.begin() + static_cast<std::ptrdiff_t>(first_[i]),
                uses_.begin() + static_cast<std::ptrdiff_t>(first_[i + 1]));
  }

  /// Calls visit(corners, uses) for each triangle of points: sides of tets first, listed faces last.
  template <class Visit>
  void for_each_triangle(const Visit& visit) const {
    for (Index smallest = 0; smallest + 1 < first_.size(); ++smallest)
      for (std::size_t i = first_[smallest], j = i; i < first_[smallest + 1]; i = j) {
        while (j < first_[smallest + 1] && uses_[j].middle == uses_[i].middle &&
               uses_[j].largest == uses_[i].largest)
          ++j;
        visit(std::array{smallest, uses_[i].middle, uses_[i].largest}, std::span(uses_).subspan(i, j - i));
      }
  }

 private:
  template <class Visit>
  static void for_each_use(const TetMesh& mesh, const Visit& visit) {
    for (Index tet = 0; tet < mesh.tets.size(); ++tet)
      for (unsigned corner = 0; corner < 4; ++corner) {
        const auto& t = mesh.tets[tet];
        const auto& [a, b, c] = outward[corner];
        const SortedTriangle s(t[a], t[b], t[c]);
        visit(s.corners[0], Use{s.corners[1], s.corners[2], tet << 3U | corner << 1U | unsigned{s.odd}});
      }
    for (Index face = 0; face < mesh.faces.size(); ++face) {
      const auto& f = mesh.faces[face];
      const SortedTriangle s(f[0], f[1], f[2]);
      visit(s.corners[0], Use{s.corners[1], s.corners[2], Use::listed_bit | face << 1U | unsigned{s.odd}});
    }
  }

  std::vector<std::size_t> first_;
  LargeVector<Use> uses_;
};

class ConformityCheck {
 public:
  ConformityCheck(const Subject& subject, Findings& findings) : subject_(subject), findings_(findings) {}

  void triangle(const std::array<Index, 3>& corners, std::span<const Use> uses) {
    corners_ = corners;
    const auto first_listed = std::find_if(uses.begin(), uses.end(), [](const Use& u) { return u.listed(); });
    const auto sides = static_cast<std::size_t>(first_listed - uses.begin());
    listed_ = uses.subspan(sides);
    collect_sides(uses.first(sides));
    check_sides();
    check_listing();
  }

 private:
  // Sides of the same tet given twice count once.
  void collect_sides(std::span<const Use> sides) {
    sides_.clear();
    for (const Use& use : sides) {
      const auto twin = std::find_if(sides_.begin(), sides_.end(), [&](const Use& other) {
        return other.odd() == use.odd() && opposite(other) == opposite(use);
      });
      if (twin == sides_.end())
        sides_.push_back(use);
      else if (opposite(use) > corners_[2])  // once, not for each of its four sides
        report_twins(twin->tet(), use.tet());
    }
  }

  void check_sides() {
    if (sides_.size() < 2 || (sides_.size() == 2 && sides_[0].odd() != sides_[1].odd())) return;
    findings_.add(
        guarantee::conforming, where(),
        {corners_[0], corners_[1], corners_[2], sides_[0].tet(), sides_[1].tet()},
        "The face of points {}, {}, {} at {} is a side of {} tets, {} of them {} and {} on one side of it; "
        "tets overlap there. If the mesher made this mesh, report it with the input and the options.",
        corners_[0], corners_[1], corners_[2], At{where()}, sides_.size(),
        sides_[0].odd() == sides_[1].odd() ? "the first two" : "more than one", sides_[0].tet(),
        sides_[1].tet());
  }

  void check_listing() {
    if (listed_.size() > 1)
      findings_.add(guarantee::listed_faces, where(), {listed_[0].face(), listed_[1].face()},
                    "Faces {} and {} are the same triangle of points {}, {}, {} at {}; list it once.",
                    listed_[0].face(), listed_[1].face(), corners_[0], corners_[1], corners_[2], At{where()});
    if (sides_.empty())
      findings_.add(
          guarantee::listed_faces, where(), {listed_[0].face()},
          "Face {} of points {}, {}, {} at {} is a side of no tet; its tets are missing or it does not "
          "belong to the mesh.",
          listed_[0].face(), corners_[0], corners_[1], corners_[2], At{where()});
    else if (listed_.empty())
      check_unlisted();
    else
      check_regions(listed_[0]);
  }

  void check_unlisted() {
    if (sides_.size() == 1)
      findings_.add(
          guarantee::listed_faces, where(), {sides_[0].tet()},
          "The face of points {}, {}, {} at {} has tet {} on one side and nothing on the other, and is not "
          "among the boundary faces; the mesh has a hole there or the face is missing.",
          corners_[0], corners_[1], corners_[2], At{where()}, sides_[0].tet());
    else if (sides_.size() == 2 && region(sides_[0]) != region(sides_[1]))
      findings_.add(
          guarantee::listed_faces, where(), {sides_[0].tet(), sides_[1].tet()},
          "The face of points {}, {}, {} at {} separates tet {} in region {} from tet {} in region {} and is "
          "not among the faces; a tet's region is wrong or the face is missing.",
          corners_[0], corners_[1], corners_[2], At{where()}, sides_[0].tet(), region(sides_[0]),
          sides_[1].tet(), region(sides_[1]));
  }

  // The normal of a tet's side leaves the tet: the tet on a face's first side has it turned alike.
  void check_regions(const Use& listed) {
    std::array<Index, 2> regions{0, 0};
    for (const Use& side : sides_) regions[side.odd() == listed.odd() ? 0 : 1] = region(side);
    const Index face = listed.face();
    const auto& given = subject_.mesh.face_regions[face];
    if (given == regions) return;
    findings_.add(
        guarantee::face_regions, where(), {face},
        "Face {} of points {}, {}, {} at {} is listed between the regions {} (behind its normal) and {}, its "
        "tets are in {} and {}; turn it or correct its regions.",
        face, corners_[0], corners_[1], corners_[2], At{where()}, given[0], given[1], regions[0], regions[1]);
  }

  void report_twins(Index first, Index second) {
    findings_.add(guarantee::distinct_tets, where(), {first, second},
                  "Tets {} and {} at {} have the same four corners; list the tet once.", first, second,
                  At{where()});
  }

  Index opposite(const Use& side) const { return subject_.mesh.tets[side.tet()][side.corner()]; }
  Index region(const Use& side) const { return subject_.mesh.tet_region[side.tet()]; }
  Point where() const { return subject_.centroid(corners_); }

  const Subject& subject_;
  Findings& findings_;
  std::array<Index, 3> corners_{};
  std::vector<Use> sides_;
  std::span<const Use> listed_;
};

struct BoundaryEdge {
  Index region;
  std::array<Index, 2> ends;
  int direction;

  bool same_edge(const BoundaryEdge& other) const { return region == other.region && ends == other.ends; }
  friend bool operator<(const BoundaryEdge& a, const BoundaryEdge& b) {
    return a.region != b.region ? a.region < b.region : number_of(a.ends) < number_of(b.ends);
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

void check_conformity(const Subject& subject, Findings& findings) {
  ConformityCheck check(subject, findings);
  UseTable(subject.mesh).for_each_triangle([&](const auto& corners, auto uses) {
    check.triangle(corners, uses);
  });
}

// The faces of a region, turned outward, have no boundary: every edge is passed as often one way as
// the other.
void check_watertight(const Subject& subject, Findings& findings) {
  const TetMesh& mesh = subject.mesh;
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
    const Point where = subject.midpoint(edges[i].ends);
    findings.add(guarantee::watertight, where, {a, b, edges[i].region},
                 "The faces around region {} do not close at the edge of points {} and {} at {}: it is "
                 "passed {} time{} "
                 "more often one way than the other; a face is missing, doubled or turned there.",
                 edges[i].region, a, b, At{where}, std::abs(sum), std::abs(sum) == 1 ? "" : "s");
  }
}

}  // namespace collarmesh::checks
