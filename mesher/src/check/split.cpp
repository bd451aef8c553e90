// The certificate of a mesh whose internal patches were split.
#include "check/split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "check/findings.h"
#include "common/disjoint_sets.h"
#include "common/sorted.h"
#include "common/tet_sides.h"

namespace collarmesh::checks {

namespace {

using Corners = std::array<Index, 3>;

constexpr double rounding = 1e-10;  // relative tolerance: the same sums are added in another order

/// Returns for each node the node with the smallest index at the same place.
std::vector<Index> places_of(const std::vector<Point>& points) {
  std::vector<Index> order(points.size()), places(points.size());
  std::iota(order.begin(), order.end(), Index{0});
  const auto key = [&](Index i) { return std::tie(points[i].x, points[i].y, points[i].z); };
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  for (std::size_t k = 0; k < order.size(); ++k)
    places[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? places[order[k - 1]] : order[k];
  return places;
}

/// A side of a tet. `place`: for each corner, the smallest node at its place, sorted.
struct PlacedSide {
  Corners place, corners;
  Index tet = none;
};

class SplitCheck {
 public:
  SplitCheck(const TetMesh& mesh, const std::vector<Sides>& sides, Findings& findings)
      : mesh_(mesh),
        findings_(findings),
        places_(places_of(mesh.points)),
        shared_(mesh.points.size(), false) {
    for (Index v = 0; v < places_.size(); ++v)
      if (places_[v] != v) shared_[v] = shared_[places_[v]] = true;
    for (const auto& [minus, plus] : sides) other_side_.insert({{minus, plus}, {plus, minus}});
  }

  void run() {
    find_sides();
    check_nodes();
    check_pairs();
    check_sectors();
  }

 private:
  bool is_side(Index face) const { return other_side_.contains(mesh_.face_tag[face]); }
  Corners placed(const Corners& corners) const {
    return sorted(Corners{places_[corners[0]], places_[corners[1]], places_[corners[2]]});
  }
  const Point& at(Index node) const { return mesh_.points[node]; }

  /// Finds all sides of each tet that has a node at the place of another node. Sorts them by place.
  void find_sides() {
    for (Index t = 0; t < mesh_.tets.size(); ++t) {
      if (std::none_of(mesh_.tets[t].begin(), mesh_.tets[t].end(), [&](Index v) { return shared_[v]; }))
        continue;
      for (unsigned corner = 0; corner < 4; ++corner) {
        const Corners corners = side_corners(mesh_.tets[t], corner);
        sides_.push_back({placed(corners), corners, t});
      }
    }
    std::sort(sides_.begin(), sides_.end(), [](const PlacedSide& a, const PlacedSide& b) {
      return std::tie(a.place, a.tet) < std::tie(b.place, b.tet);
    });
  }

  void check_nodes() {
    std::vector<bool> on_side(mesh_.points.size(), false), in_tet(mesh_.points.size(), false);
    const auto mark = [](const auto& nodes, std::vector<bool>& marks) {
      for (const Index v : nodes) marks[v] = true;
    };
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (!is_side(f)) continue;
      mark(mesh_.faces[f], on_side);
      if (mesh_.order() == 2) mark(mesh_.face_mid_nodes[f], on_side);
    }
    for (const auto& tet : mesh_.tets) mark(tet, in_tet);
    for (const auto& nodes : mesh_.tet_mid_nodes) mark(nodes, in_tet);
    for (Index v = 0; v < shared_.size(); ++v)
      if (shared_[v] && in_tet[v] && !on_side[v])
        findings_.add(guarantee::split_nodes, at(v), {v},
                      "Node {} at {} coincides with another node but is on no triangle of a split patch.", v,
                      At{at(v)});
  }

  void check_pairs() {
    std::map<Corners, std::vector<Index>> faces;  // by place
    for (Index f = 0; f < mesh_.faces.size(); ++f)
      if (is_side(f)) faces[placed(mesh_.faces[f])].push_back(f);
    for (const auto& [place, pair] : faces) {
      if (pair.size() != 2 || !are_opposite(pair[0], pair[1]))
        findings_.add(guarantee::split_pairs, at(place[0]), {pair[0]},
                      "Face {} of a split patch at {} does not coincide with exactly one face of opposite "
                      "orientation on the other side.",
                      pair[0], At{at(place[0])});
    }
    for (std::size_t k = 1; k < sides_.size(); ++k) {
      const PlacedSide &a = sides_[k - 1], &b = sides_[k];
      if (a.place != b.place) continue;
      const bool apart = sorted(a.corners) != sorted(b.corners);
      if (apart != faces.contains(a.place))
        findings_.add(guarantee::split_pairs, at(a.place[0]), {a.tet, b.tet},
                      "Tets {} and {} have a common side at {}, which is {}.", a.tet, b.tet,
                      At{at(a.place[0])},
                      apart ? "cut open but no triangle of a split patch"
                            : "a triangle of a split patch but not cut open");
    }
  }

  /// Returns whether two faces are on the two sides of a split patch and have opposite orientations, mid-edge
  /// nodes included.
  bool are_opposite(Index f, Index g) const {
    if (other_side_.at(mesh_.face_tag[f]) != mesh_.face_tag[g]) return false;
    const Corners &a = mesh_.faces[f], &b = mesh_.faces[g];
    for (unsigned i = 0; i < 3; ++i) {
      if (places_[b[i]] != places_[a[0]]) continue;
      if (places_[b[(i + 1) % 3]] != places_[a[2]] || places_[b[(i + 2) % 3]] != places_[a[1]]) return false;
      if (mesh_.order() == 1) return true;
      const Corners &m = mesh_.face_mid_nodes[f], &n = mesh_.face_mid_nodes[g];
      return places_[m[0]] == places_[n[(i + 2) % 3]] && places_[m[1]] == places_[n[(i + 1) % 3]] &&
             places_[m[2]] == places_[n[i]];
    }
    return false;
  }

  /// Checks that the tets at each node are connected without crossing split triangles: otherwise the node
  /// would hold two sides together.
  void check_sectors() {
    struct AtNode {
      Index node, tet;
    };
    std::vector<AtNode> all;
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      for (const Index v : mesh_.tets[t])
        if (shared_[v]) all.push_back({v, t});
    const auto by_node = [](const AtNode& a, const AtNode& b) {
      return std::tie(a.node, a.tet) < std::tie(b.node, b.tet);
    };
    std::sort(all.begin(), all.end(), by_node);
    const auto number_of = [&](Index node, Index tet) {
      const auto found = std::lower_bound(all.begin(), all.end(), AtNode{node, tet}, by_node);
      return static_cast<Index>(found - all.begin());
    };
    DisjointSets together(all.size()), touching(all.size());
    for (std::size_t k = 1; k < sides_.size(); ++k) {
      const PlacedSide &a = sides_[k - 1], &b = sides_[k];
      if (a.place != b.place) continue;
      for (const Index v : a.corners)
        for (const Index w : b.corners) {
          if (!shared_[v] || places_[v] != places_[w]) continue;
          touching.unite(number_of(v, a.tet), number_of(w, b.tet));
          if (sorted(a.corners) == sorted(b.corners))
            together.unite(number_of(v, a.tet), number_of(w, b.tet));
        }
    }
    for (std::size_t k = 1; k < all.size(); ++k)
      if (const auto i = static_cast<Index>(k - 1), j = static_cast<Index>(k);
          all[i].node == all[j].node && touching.same(i, j) && !together.same(i, j))
        findings_.add(guarantee::split_sectors, at(all[i].node), {all[i].node, all[i].tet, all[j].tet},
                      "Node {} at {} joins tets {} and {}, although patches that separate them are split.",
                      all[i].node, At{at(all[i].node)}, all[i].tet, all[j].tet);
  }

  const TetMesh& mesh_;
  Findings& findings_;
  std::vector<Index> places_;
  std::vector<bool> shared_;  // by node: whether another node is at its place
  std::map<Tag, Tag> other_side_;
  std::vector<PlacedSide> sides_;
};

/// Returns the areas of patches, by index, without the faces that have one of these tags.
std::map<Index, double> areas_of(const TetMesh& mesh, const std::set<Tag>& left_out) {
  std::map<Index, double> areas;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (left_out.contains(mesh.face_tag[f])) continue;
    const auto& [a, b, c] = mesh.faces[f];
    areas[mesh.face_patch[f]] +=
        0.5 * norm(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
  }
  return areas;
}

std::map<Index, double> volumes_of(const TetMesh& mesh) {
  std::map<Index, double> volumes;
  for (Index t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    const Point& p = mesh.points[a];
    volumes[mesh.tet_region[t]] += dot(cross(mesh.points[b] - p, mesh.points[c] - p), mesh.points[d] - p) / 6;
  }
  return volumes;
}

void compare(const std::map<Index, double>& before, const std::map<Index, double>& after, const char* measure,
             const char* of, Findings& findings) {
  for (const auto& [key, value] : before) {
    const auto found = after.find(key);
    const double now = found == after.end() ? 0 : found->second;
    if (!(std::fabs(now - value) <= rounding * std::fabs(value)))
      findings.add(guarantee::split_measures, {}, {},
                   "The {} of {} {} was {:.9g} and is {:.9g} after the split.", measure, of, key, value, now);
  }
}

}  // namespace

SplitMeasures measure_before_split(const TetMesh& mesh) { return {volumes_of(mesh), areas_of(mesh, {})}; }

void check_split(const TetMesh& mesh, const std::vector<Sides>& sides, const SplitMeasures& before,
                 CheckReport& report) {
  constexpr std::size_t listed = 20;
  Findings findings(report, listed);
  SplitCheck(mesh, sides, findings).run();
  compare(before.volumes, volumes_of(mesh), "volume", "region", findings);
  std::set<Tag> minus, plus;
  for (const Sides& each : sides) {
    minus.insert(each.minus);
    plus.insert(each.plus);
  }
  compare(before.areas, areas_of(mesh, plus), "area", "patch", findings);
  compare(before.areas, areas_of(mesh, minus), "area", "patch", findings);
}

}  // namespace collarmesh::checks
