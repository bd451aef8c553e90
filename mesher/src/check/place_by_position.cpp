// Finds labels by position for a mesh from a file without labels, or with labels that the complex does not
// have.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "check/border_edges.h"
#include "check/mesh_to_check.h"
#include "common/disjoint_sets.h"
#include "common/distance_tree.h"
#include "common/segments.h"
#include "common/sort_uniquely.h"
#include "common/tet_sides.h"

namespace collarmesh::checks {

namespace {

using Triangle = std::array<Index, 3>;

template <class Features>
std::vector<Tag> sorted_tags(const Features& features) {
  std::vector<Tag> tags;
  tags.reserve(features.size());
  for (const auto& feature : features) tags.push_back(feature.tag);
  std::sort(tags.begin(), tags.end());
  return tags;
}

// Returns whether at least half of the entities' tags are tags of features.
template <class Features>
bool are_known(const std::vector<Tag>& tags, const Features& features) {
  const std::vector<Tag> known = sorted_tags(features);
  const auto count = std::count_if(
      tags.begin(), tags.end(), [&](Tag tag) { return std::binary_search(known.begin(), known.end(), tag); });
  return 2 * static_cast<std::size_t>(count) >= tags.size();
}

// Returns whether the features have different tags. If not, a tag says only that an entity lies on a feature.
template <class Features>
bool tell_apart(const Features& features) {
  return std::any_of(features.begin(), features.end(),
                     [&](const auto& feature) { return feature.tag != features.front().tag; });
}

// A side of a tet or a listed face.
struct ListedSide {
  Triangle corners;  // sorted
  Index tet;         // none: a listed face
  Index place;       // number of the opposite corner, or of the face

  friend bool operator<(const ListedSide& a, const ListedSide& b) {
    return a.corners != b.corners ? a.corners < b.corners : a.tet < b.tet;
  }
};

// The patches with a region on both sides.
class InnerPatches {
 public:
  explicit InnerPatches(const MeshToCheck& to_check)
      : to_check_(to_check),
        triangles_(triangles_of(to_check.plc, numbers_)),
        near_(to_check.mesh.points.size(), -1) {}

  enum class Kind { planar, any };
  /// Returns whether the triangle lies on patches of this kind.
  bool hold(const Triangle& corners, Kind kind) {
    if (numbers_.empty()) return false;
    if (!std::all_of(corners.begin(), corners.end(), [&](Index p) { return is_near(p); })) return false;
    const auto [distance, number] = triangles_.nearest(to_check_.centroid(corners));
    const Index patch = to_check_.plc.triangles[numbers_[number]].patch;
    return distance <= to_check_.patch_allowance[patch] &&
           (kind == Kind::any || to_check_.plc.patches[patch].planar);
  }
  /// Returns a normal, of any length, of the patch nearest to the triangle, at the nearest place.
  Vector normal(const Triangle& corners) const {
    const Plc::Triangle& t =
        to_check_.plc.triangles[numbers_[triangles_.nearest(to_check_.centroid(corners)).triangle]];
    const Point& a = to_check_.plc_corner(t, 0);
    return cross(to_check_.plc_corner(t, 1) - a, to_check_.plc_corner(t, 2) - a);
  }

 private:
  static DistanceTree triangles_of(const Plc& plc, std::vector<Index>& numbers) {
    std::vector<DistanceTree::Triangle> triangles;
    for (Index i = 0; i < plc.triangles.size(); ++i) {
      const auto& [corners, patch] = plc.triangles[i];
      const auto& regions = plc.patches[patch].regions;
      if (regions[0] == 0 || regions[1] == 0) continue;
      numbers.push_back(i);
      triangles.push_back({plc.points[corners[0]], plc.points[corners[1]], plc.points[corners[2]]});
    }
    return DistanceTree(std::move(triangles));
  }

  bool is_near(Index point) {
    if (near_[point] < 0) {
      const auto [distance, number] = triangles_.nearest(to_check_.point(point), to_check_.rounding);
      near_[point] =
          distance <= to_check_.patch_allowance[to_check_.plc.triangles[numbers_[number]].patch] ? 1 : 0;
    }
    return near_[point] != 0;
  }

  const MeshToCheck& to_check_;
  std::vector<Index> numbers_;  // numbers of the complex's triangles
  DistanceTree triangles_;
  std::vector<std::int8_t> near_;  // by mesh point: 1 if it is on one of these patches, 0 if on none, -1 if
                                   // not computed yet
};

// The segments of all curves, as degenerate triangles, with their positions on the curves.
struct CurveSegments {
  explicit CurveSegments(const Plc& plc) : lengths(plc.curves.size(), 0) {
    for (Index c = 0; c < plc.curves.size(); ++c)
      visit_segments(plc.curves[c], [&](Index from, Index to) {
        const Point &a = plc.points[from], &b = plc.points[to];
        segments.push_back({a, b, b});
        curve.push_back(c);
        arc.push_back(lengths[c]);
        lengths[c] += distance(a, b);
      });
  }

  std::vector<DistanceTree::Triangle> segments;
  std::vector<Index> curve;     // by segment
  std::vector<double> arc;      // by segment: length of the curve up to it
  std::vector<double> lengths;  // by curve
};

// A test whether the tags of a mesh fit, if tags are only numbers that the builder of the complex gives in
// the order of the facets. They fit if at least half of the faces or edges in a sample have the tag of the
// feature nearest to their middle.
class Numbers {
 public:
  explicit Numbers(const MeshToCheck& to_check) : to_check_(to_check) {}

  bool fit_faces() const {
    const Plc& plc = to_check_.plc;
    if (!plc.numbered_patches) return true;
    std::vector<DistanceTree::Triangle> triangles;
    for (const Plc::Triangle& t : plc.triangles)
      triangles.push_back(
          {to_check_.plc_corner(t, 0), to_check_.plc_corner(t, 1), to_check_.plc_corner(t, 2)});
    const DistanceTree tree(std::move(triangles));
    return most(to_check_.mesh.faces.size(), [&](std::size_t f) {
      const Index nearest = tree.nearest(to_check_.centroid(to_check_.mesh.faces[f])).triangle;
      return nearest != none && plc.patches[plc.triangles[nearest].patch].tag == to_check_.mesh.face_tag[f];
    });
  }

  bool fit_edges() const {
    const Plc& plc = to_check_.plc;
    if (!plc.numbered_curves || plc.curves.empty()) return true;
    const CurveSegments curves(plc);
    const DistanceTree tree(curves.segments);
    return most(to_check_.mesh.edges.size(), [&](std::size_t e) {
      const Index nearest = tree.nearest(to_check_.midpoint(to_check_.mesh.edges[e])).triangle;
      return nearest != none && plc.curves[curves.curve[nearest]].tag == to_check_.mesh.edge_tag[e];
    });
  }

 private:
  template <class Fits>
  static bool most(std::size_t count, const Fits& fits) {
    constexpr std::size_t looked_at = 500;
    const std::size_t step = std::max<std::size_t>(1, count / looked_at);
    std::size_t asked = 0, fitting = 0;
    for (std::size_t i = 0; i < count; i += step, ++asked) fitting += fits(i) ? 1 : 0;
    return 2 * fitting >= asked;
  }

  const MeshToCheck& to_check_;
};

class Placement {
 public:
  Placement(const MeshToCheck& to_check, CheckReport& report, Findings& findings)
      : to_check_(to_check), plc_(to_check.plc), report_(report), findings_(findings), inner_(to_check) {
    const TetMesh& mesh = to_check.mesh;
    std::size_t in_regions = 0;
    for (Index t = 0; t < mesh.tets.size(); ++t) in_regions += has_region(t) ? 1 : 0;
    lost_tets_ = in_regions < mesh.tets.size();
    const std::span regions(plc_.regions);
    tets_known_ = 2 * in_regions >= mesh.tets.size() ||
                  are_known(mesh.tet_tag, regions.subspan(std::min<std::size_t>(1, regions.size())));
    const Numbers numbers(to_check);
    new_faces_ = mesh.faces.empty() || !are_known(mesh.face_tag, plc_.patches) || !numbers.fit_faces();
    new_edges_ = !plc_.curves.empty() &&
                 (mesh.edges.empty() || !are_known(mesh.edge_tag, plc_.curves) || !numbers.fit_edges());
  }

  std::optional<TetMesh> run() {
    const std::vector<bool> stray = new_edges_ ? std::vector<bool>{} : stray_edges();
    if (!lost_tets_ && !new_faces_ && !new_edges_ && stray.empty()) return std::nullopt;
    mesh_ = to_check_.mesh;
    if (!stray.empty()) drop_edges(stray);
    if (lost_tets_ || new_faces_) {
      collect_sides();
      if (lost_tets_) place_tets();
      if (new_faces_)
        make_faces();
      else
        renew_face_regions();
    }
    if (new_edges_) make_edges();
    if (new_faces_) place_faces();
    if (mesh_.order() == 2) take_mid_nodes_of_tets(mesh_);
    return std::move(mesh_);
  }

 private:
  // Marks the listed edges that are edges of tets but lie on no curve and have no tag that identifies a
  // curve: other programs list the edges along which they divide faces, and the seams of round faces. Returns
  // an empty list if there are no such edges.
  std::vector<bool> stray_edges() const {
    const TetMesh& mesh = to_check_.mesh;
    if (mesh.edges.empty()) return {};
    const bool told = !plc_.numbered_curves && tell_apart(plc_.curves);
    const std::vector<Tag> known = told ? sorted_tags(plc_.curves) : std::vector<Tag>{};
    const CurveSegments curves(plc_);
    const DistanceTree tree(curves.segments);
    std::vector<std::array<Index, 2>> off;
    std::vector<bool> is_end(mesh.points.size(), false);
    for (Index e = 0; e < mesh.edges.size(); ++e) {
      if (std::binary_search(known.begin(), known.end(), mesh.edge_tag[e])) continue;
      const auto& [a, b] = mesh.edges[e];
      const auto [distance, number] = tree.nearest(to_check_.midpoint({a, b}));
      if (number != none && distance <= to_check_.curve_allowance[curves.curve[number]]) continue;
      off.push_back(sorted(a, b));
      is_end[a] = is_end[b] = true;
    }
    if (off.empty()) return {};
    std::vector<std::array<Index, 2>> of_tets;
    for (const auto& tet : mesh.tets)
      for (unsigned i = 0; i < 4; ++i)
        for (unsigned j = 0; j < i; ++j)
          if (is_end[tet[i]] && is_end[tet[j]]) of_tets.push_back(sorted(tet[i], tet[j]));
    std::sort(of_tets.begin(), of_tets.end());
    std::sort(off.begin(), off.end());
    std::vector<bool> stray(mesh.edges.size(), false);
    bool any = false;
    for (Index e = 0; e < mesh.edges.size(); ++e) {
      const auto edge = sorted(mesh.edges[e][0], mesh.edges[e][1]);
      stray[e] = std::binary_search(off.begin(), off.end(), edge) &&
                 std::binary_search(of_tets.begin(), of_tets.end(), edge);
      any = any || stray[e];
    }
    return any ? stray : std::vector<bool>{};
  }

  void drop_edges(const std::vector<bool>& dropped) {
    report_.notes.push_back(fmt::format("{} listed edges lie on no edge of the input and were left out.",
                                        std::count(dropped.begin(), dropped.end(), true)));
    const auto keep = [&](auto& values) {
      if (values.empty()) return;
      std::size_t kept = 0;
      for (std::size_t e = 0; e < dropped.size(); ++e)
        if (!dropped[e]) values[kept++] = values[e];
      values.resize(kept);
    };
    keep(mesh_.edges);
    keep(mesh_.edge_curve);
    keep(mesh_.edge_tag);
    keep(mesh_.edge_mid_nodes);
  }

  // Returns whether the tet has a region of the complex. Its tag must be that of the region or, because some
  // formats store only one number, the region's number.
  bool has_region(Index tet) const {
    const Index region = to_check_.mesh.tet_region[tet];
    const Tag tag = to_check_.mesh.tet_tag[tet];
    return region >= 1 && region < plc_.regions.size() &&
           (tag == plc_.regions[region].tag || tag == static_cast<Tag>(region));
  }

  void collect_sides() {
    const TetMesh& mesh = to_check_.mesh;
    sides_.reserve(4 * mesh.tets.size() + mesh.faces.size());
    for (Index t = 0; t < mesh.tets.size(); ++t)
      for (Index i = 0; i < 4; ++i) sides_.push_back({outward_face(t, i), t, i});
    for (Index f = 0; f < mesh.faces.size(); ++f) sides_.push_back({mesh.faces[f], none, f});
    for (ListedSide& side : sides_) std::sort(side.corners.begin(), side.corners.end());
    std::sort(sides_.begin(), sides_.end());
  }

  /// Calls visit(sides, number, face) for each triangle: the sides of tets there, how many there are, and the
  /// listed face there (or none).
  template <class Visit>
  void for_each_triangle(const Visit& visit) const {
    for (std::size_t i = 0, j = 0; i < sides_.size(); i = j) {
      for (j = i; j < sides_.size() && sides_[j].corners == sides_[i].corners;) ++j;
      std::size_t tets = 0;
      while (i + tets < j && sides_[i + tets].tet != none) ++tets;
      visit(&sides_[i], tets, i + tets < j ? sides_[i + tets].place : none);
    }
  }

  Triangle outward_face(Index tet, Index opposite) const {
    return side_corners(to_check_.mesh.tets[tet], opposite);
  }

  // Finds the region of each connected part by the place of its largest tet.
  void place_tets() {
    const TetMesh& mesh = to_check_.mesh;
    DisjointSets parts(mesh.tets.size());
    for_each_triangle([&](const ListedSide* side, std::size_t count, Index face) {
      if (count != 2 || face != none) return;
      const Index t = side[0].tet, u = side[1].tet;
      if (mesh.tet_tag[t] != mesh.tet_tag[u] || mesh.tet_region[t] != mesh.tet_region[u]) return;
      if (!inner_.hold(side->corners, InnerPatches::Kind::planar)) parts.unite(t, u);
    });
    std::vector<Index> largest(mesh.tets.size(), none);
    for (Index t = 0; t < mesh.tets.size(); ++t) {
      Index& best = largest[parts.find(t)];
      if (best == none || volume(t) > volume(best)) best = t;
    }
    std::vector<Index> region(mesh.tets.size(), none);
    for (Index t = 0; t < mesh.tets.size(); ++t) {
      if (has_region(t)) continue;
      const Index part = parts.find(t);
      if (region[part] == none) region[part] = region_of(largest[part]);
      mesh_.tet_region[t] = region[part];
      if (!tets_known_) mesh_.tet_tag[t] = plc_.regions[region[part]].tag;
    }
    if (!tets_known_)
      report_.notes.emplace_back(
          "The input has none of the tags of the tets: their regions were found by position.");
  }

  double volume(Index t) const {
    const auto& [a, b, c, d] = to_check_.mesh.tets[t];
    return six_volume(to_check_.point(a), to_check_.point(b), to_check_.point(c), to_check_.point(d));
  }

  Index region_of(Index t) {
    const auto& [a, b, c, d] = to_check_.mesh.tets[t];
    const Point centre =
        0.25 * ((to_check_.point(a) + to_check_.point(b)) + (to_check_.point(c) + to_check_.point(d)));
    const Index region = to_check_.regions->region_at(centre);
    if (region == 0)
      findings_.add(guarantee::region_volume, centre, {t},
                    "Tet {} at {} and those it is connected with lie outside all regions of the input; check "
                    "the mesh against the input that it was made from, in the same units.",
                    t, At{centre});
    return region;
  }

  void renew_face_regions() {
    mesh_.face_regions.assign(mesh_.faces.size(), {0, 0});
    for_each_triangle([&](const ListedSide* side, std::size_t count, Index face) {
      if (face == none) return;
      for (std::size_t i = 0; i < count; ++i) {
        const Triangle own = outward_face(side[i].tet, side[i].place);
        mesh_.face_regions[face][alike(mesh_.faces[face], own) ? 0 : 1] = mesh_.tet_region[side[i].tet];
      }
    });
  }

  // Returns whether two triangles with the same corners have the same orientation.
  static bool alike(const Triangle& a, const Triangle& b) {
    const auto at = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
    return b[(at + 1) % 3] == a[1];
  }

  // Makes faces at the border of the mesh, between regions, and on facets inside regions.
  void make_faces() {
    report_.notes.emplace_back(
        mesh_.faces.empty()
            ? "The mesh lists no triangles: triangles on the boundary and on facets were found by position."
            : "The input has none of the tags of the triangles: triangles on the boundary and on facets were "
              "found by position.");
    mesh_.faces.clear();
    mesh_.face_regions.clear();
    mesh_.face_mid_nodes.clear();
    for_each_triangle([&](const ListedSide* side, std::size_t count, Index face) {
      if (count != 1 && count != 2) return;
      const Index region = mesh_.tet_region[side[0].tet],
                  other = count == 2 ? mesh_.tet_region[side[1].tet] : 0;
      Triangle corners = outward_face(side[0].tet, side[0].place);
      if (region == other) {
        const auto kind = face == none ? InnerPatches::Kind::planar : InnerPatches::Kind::any;
        if (!inner_.hold(corners, kind)) return;
        const Point& a = to_check_.point(corners[0]);
        const Vector normal = cross(to_check_.point(corners[1]) - a, to_check_.point(corners[2]) - a);
        if (dot(normal, inner_.normal(corners)) < 0) std::swap(corners[1], corners[2]);
      }
      mesh_.faces.push_back(corners);
      mesh_.face_regions.push_back({region, other});
    });
    mesh_.face_patch.assign(mesh_.faces.size(), none);
    mesh_.face_tag.assign(mesh_.faces.size(), 0);
  }

  void place_faces() {
    mesh_.face_patch = match_faces(mesh_, plc_, false);
    for (Index f = 0; f < mesh_.faces.size(); ++f)
      if (mesh_.face_patch[f] != none) mesh_.face_tag[f] = plc_.patches[mesh_.face_patch[f]].tag;
  }

  struct PlaceOnCurve {
    double arc;
    Index point;
    friend bool operator<(const PlaceOnCurve& a, const PlaceOnCurve& b) { return a.arc < b.arc; }
  };

  // Makes edges on curves: those that `border_edges` finds on a bent curve, if the mesh's own faces are kept;
  // if there are none, the edges of tets between consecutive points on the curve.
  void make_edges() {
    report_.notes.emplace_back(
        mesh_.edges.empty()
            ? "The mesh lists no edges: edges on curves were found by position."
            : "The input has none of the tags of the edges: edges on curves were found by position.");
    mesh_.edges.clear();
    mesh_.edge_mid_nodes.clear();
    mesh_.edge_curve.clear();
    mesh_.edge_tag.clear();
    auto chains = points_on_curves();
    const auto edges = edges_between(chains);
    const auto borders =
        new_faces_ ? std::vector<std::vector<std::array<Index, 2>>>(chains.size()) : border_edges(to_check_);
    const auto add = [&](Index curve, const std::array<Index, 2>& edge) {
      mesh_.edges.push_back(edge);
      mesh_.edge_curve.push_back(curve);
      mesh_.edge_tag.push_back(plc_.curves[curve].tag);
    };
    for (Index c = 0; c < chains.size(); ++c) {
      for (const auto& edge : borders[c]) add(c, edge);
      if (!borders[c].empty()) continue;
      auto& chain = chains[c];
      std::sort(chain.begin(), chain.end());
      if (plc_.curves[c].closed && chain.size() > 2) chain.push_back(chain.front());
      for (std::size_t i = 1; i < chain.size(); ++i) {
        const Index a = chain[i - 1].point, b = chain[i].point;
        if (std::binary_search(edges.begin(), edges.end(), sorted(a, b))) add(c, {a, b});
      }
    }
  }

  std::vector<std::vector<PlaceOnCurve>> points_on_curves() const {
    const CurveSegments curves(plc_);
    const DistanceTree tree(curves.segments);
    std::vector<std::vector<PlaceOnCurve>> chains(plc_.curves.size());
    const auto vertex_point = match_vertices(mesh_, plc_, to_check_.rounding);
    std::vector<bool> is_vertex(mesh_.points.size(), false);
    for (const Index p : vertex_point)
      if (p != none) is_vertex[p] = true;
    for (const Index p : candidates()) {
      if (is_vertex[p]) continue;
      const auto [distance_to, number] = tree.nearest(to_check_.point(p));
      const Index c = curves.curve[number];
      const double allowed = plc_.curves[c].straight ? to_check_.curve_allowance[c] : to_check_.rounding;
      if (distance_to <= allowed)
        chains[c].push_back(
            {curves.arc[number] + distance(curves.segments[number][0], to_check_.point(p)), p});
    }
    for (Index c = 0; c < chains.size(); ++c) {
      const auto& ends = plc_.curves[c].ends;
      for (const unsigned end : {0U, 1U})
        if (ends[end] != none && vertex_point[ends[end]] != none)
          chains[c].push_back({end == 0 ? -1 : 2 * curves.lengths[c] + 1, vertex_point[ends[end]]});
    }
    return chains;
  }

  // Returns the points that may be on curves, without mid-edge nodes: the corners of faces or, if a curve is
  // on no patch, all points.
  std::vector<Index> candidates() const {
    std::vector<bool> is_candidate(
        mesh_.points.size(),
        std::any_of(plc_.curves.begin(), plc_.curves.end(), [](const auto& c) { return c.patches.empty(); }));
    for (const Triangle& face : mesh_.faces)
      for (const Index p : face) is_candidate[p] = true;
    std::vector<Index> points;
    for (const auto& nodes : mesh_.tet_mid_nodes)
      for (const Index p : nodes) is_candidate[p] = false;
    for (Index p = 0; p < mesh_.points.size(); ++p)
      if (is_candidate[p]) points.push_back(p);
    return points;
  }

  // Returns the edges of tets between points on curves, sorted.
  std::vector<std::array<Index, 2>> edges_between(
      const std::vector<std::vector<PlaceOnCurve>>& chains) const {
    std::vector<bool> on_curve(mesh_.points.size(), false);
    for (const auto& chain : chains)
      for (const PlaceOnCurve& place : chain) on_curve[place.point] = true;
    std::vector<std::array<Index, 2>> edges;
    for (const auto& tet : mesh_.tets)
      for (unsigned i = 0; i < 4; ++i)
        for (unsigned j = 0; j < i; ++j)
          if (on_curve[tet[i]] && on_curve[tet[j]]) edges.push_back(sorted(tet[i], tet[j]));
    sort_uniquely(edges);
    return edges;
  }

  const MeshToCheck& to_check_;
  const Plc& plc_;
  CheckReport& report_;
  Findings& findings_;
  InnerPatches inner_;
  bool tets_known_, lost_tets_, new_faces_, new_edges_;
  std::vector<ListedSide> sides_;
  TetMesh mesh_;
};

}  // namespace

std::optional<TetMesh> place_by_position(const MeshToCheck& to_check, CheckReport& report,
                                         Findings& findings) {
  assert(to_check.mesh.tet_region.size() == to_check.mesh.tets.size() &&
         to_check.mesh.face_tag.size() == to_check.mesh.faces.size() &&
         to_check.mesh.edge_tag.size() == to_check.mesh.edges.size());
  if (to_check.mesh.features.empty()) return Placement(to_check, report, findings).run();
  const Numbers numbers(to_check);
  if (numbers.fit_faces() && numbers.fit_edges()) return std::nullopt;
  TetMesh unplaced = to_check.mesh;  // will lose its labels: they follow another numbering
  unplaced.features.clear();
  std::fill(unplaced.face_patch.begin(), unplaced.face_patch.end(), none);
  std::fill(unplaced.edge_curve.begin(), unplaced.edge_curve.end(), none);
  std::optional<TetMesh> placed =
      Placement({unplaced, to_check.plc, to_check.options, to_check.tolerance, to_check.rounding,
                 to_check.curve_allowance, to_check.patch_allowance, to_check.regions, to_check.match,
                 to_check.collar, to_check.coarsened},
                report, findings)
          .run();
  return placed ? std::move(placed) : std::optional(std::move(unplaced));
}

}  // namespace collarmesh::checks
