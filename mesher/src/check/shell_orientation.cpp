#include "check/shell_orientation.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "common/distance_tree.h"
#include "common/edge_key.h"

namespace collarmesh::checks {

namespace {

/// Checks that faces of solids point outwards.
void check_outward(const MeshToCheck& to_check, const Plc& plc, Findings& findings) {
  const Grouping by_patch(to_check.match.face_patch, plc.patches.size());
  for (Index p = 0; p < plc.patches.size(); ++p) {
    const auto& [behind, front] = plc.patches[p].regions;
    if ((behind == 0) == (front == 0)) continue;
    double wrong = 0;
    const Plc::Patch& patch = plc.patches[p];
    std::vector<DistanceTree::Triangle> triangles;
    for (Index t = patch.first_triangle; t < patch.first_triangle + patch.triangle_count; ++t)
      triangles.push_back({to_check.plc_corner(plc.triangles[t], 0), to_check.plc_corner(plc.triangles[t], 1),
                           to_check.plc_corner(plc.triangles[t], 2)});
    const DistanceTree tree(triangles);
    Point where{};
    const auto normal = [](const Point& a, const Point& b, const Point& c) { return cross(b - a, c - a); };
    for (const Index* f = by_patch.begin(p); f != by_patch.end(p); ++f) {
      where = to_check.centroid(to_check.mesh.faces[*f]);
      const auto& [a, b, c] = triangles[tree.nearest(where).triangle];
      const auto& [i, j, k] = to_check.mesh.faces[*f];
      const double agreement =
          dot(normal(a, b, c), normal(to_check.point(i), to_check.point(j), to_check.point(k)));
      wrong += agreement < 0 ? 1 : -1;
    }
    if ((wrong > 0) == (behind > 0) && wrong != 0)
      findings.add(guarantee::shell_orientation, where, {p},
                   "The faces of patch {} (tag {}) at {} point into its solid; turn them.", p, patch.tag,
                   At{where});
  }
}

/// Two patches that meet in an edge of two triangles.
struct PatchMeeting {
  std::array<Index, 2> patches;  // the smaller one first
  bool agree;                    // the triangles pass the edge in opposite directions
  std::array<Index, 2> ends;

  friend bool operator<(const PatchMeeting& a, const PatchMeeting& b) {
    return std::tie(a.patches, a.agree, a.ends) < std::tie(b.patches, b.agree, b.ends);
  }
  bool same_relation(const PatchMeeting& other) const {
    return patches == other.patches && agree == other.agree;
  }
};

/// Returns the meetings of patches that bound no region, one for each pair of patches and value of `agree`.
/// Edges of more than two triangles do not count.
std::vector<PatchMeeting> meetings_of(const MeshToCheck& to_check, const Plc& plc) {
  struct Side {
    std::uint64_t edge;
    Index patch;
    std::array<Index, 2> run;  // its ends, in the direction of its triangle
    bool operator<(const Side& other) const { return edge < other.edge; }
  };
  std::vector<Side> sides;
  for (Index f = 0; f < to_check.mesh.faces.size(); ++f)
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = to_check.mesh.faces[f][i], b = to_check.mesh.faces[f][(i + 1) % 3];
      sides.push_back({edge_key(a, b), to_check.match.face_patch[f], {a, b}});
    }
  std::sort(sides.begin(), sides.end());
  const auto is_free = [&](Index patch) {
    return patch != none && plc.patches[patch].regions == std::array<Index, 2>{0, 0};
  };
  std::vector<PatchMeeting> meetings;
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    for (j = i; j < sides.size() && sides[j].edge == sides[i].edge;) ++j;
    if (j - i != 2 || sides[i].patch == sides[i + 1].patch) continue;
    if (!is_free(sides[i].patch) || !is_free(sides[i + 1].patch)) continue;
    meetings.push_back({sorted(sides[i].patch, sides[i + 1].patch), sides[i].run != sides[i + 1].run,
                        sorted(sides[i].run[0], sides[i].run[1])});
  }
  std::sort(meetings.begin(), meetings.end());
  const auto same = [](const PatchMeeting& a, const PatchMeeting& b) { return a.same_relation(b); };
  meetings.erase(std::unique(meetings.begin(), meetings.end(), same), meetings.end());
  return meetings;
}

/// Surfaces of patches that meet, by union-find. Each patch has a mark that tells whether it must be turned
/// to agree with its parent in the union-find tree.
class MetSurfaces {
 public:
  explicit MetSurfaces(std::size_t patches)
      : parent_(patches), turned_(patches, false), orientable_(patches, true) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  void join(const PatchMeeting& meeting) {
    const auto [a, a_turned] = surface_of(meeting.patches[0]);
    const auto [b, b_turned] = surface_of(meeting.patches[1]);
    const bool turn = (a_turned != b_turned) == meeting.agree;
    if (a == b) {
      if (turn) orientable_[a] = false;
      return;
    }
    parent_[b] = a;
    turned_[b] = turn;
    if (!orientable_[b]) orientable_[a] = false;
  }
  bool is_orientable(Index patch) { return orientable_[surface_of(patch).first]; }

 private:
  // Returns the patch that represents the surface of the given patch (the root of the union-find tree), and
  // whether the given patch is turned against it.
  std::pair<Index, bool> surface_of(Index patch) {
    bool turned = false;
    for (; parent_[patch] != patch; patch = parent_[patch]) {
      const Index up = parent_[patch];
      turned_[patch] = turned_[patch] != turned_[up];
      parent_[patch] = parent_[up];
      turned = turned != turned_[patch];
    }
    return {patch, turned};
  }

  std::vector<Index> parent_;
  std::vector<bool> turned_, orientable_;
};

/// Checks that patches of an orientable surface agree where two of them meet.
void check_agreement(const MeshToCheck& to_check, const Plc& plc, Findings& findings) {
  const std::vector<PatchMeeting> meetings = meetings_of(to_check, plc);
  MetSurfaces surfaces(plc.patches.size());
  for (const PatchMeeting& meeting : meetings) surfaces.join(meeting);
  for (const PatchMeeting& meeting : meetings) {
    const Index first = meeting.patches[0], second = meeting.patches[1];
    if (meeting.agree || !surfaces.is_orientable(first)) continue;
    const Point where = to_check.midpoint(meeting.ends);
    findings.add(guarantee::shell_orientation, where, {first, second},
                 "The faces of patches {} (tag {}) and {} (tag {}) are turned against each other at {}; turn "
                 "those of one patch.",
                 first, plc.patches[first].tag, second, plc.patches[second].tag, At{where});
  }
}

}  // namespace

void check_shell_orientation(const MeshToCheck& to_check, const Plc& plc, Findings& findings) {
  assert(to_check.is_matched());
  check_outward(to_check, plc, findings);
  check_agreement(to_check, plc, findings);
}

}  // namespace collarmesh::checks
