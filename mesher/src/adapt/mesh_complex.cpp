#include "adapt/mesh_complex.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "collarmesh/error.h"
#include "common/cell_shapes.h"
#include "common/disjoint_sets.h"
#include "common/sorted.h"
#include "common/tet_sides.h"

namespace collarmesh::remeshing::adapting {

namespace {

// If six times the volume of an inverted tet is below this share of the cube of its box's diagonal, the
// inversion may be due to rounding of coordinates in files.
constexpr double rounded_volume = 1e-6;

std::string text(const Point& p) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", p.x, p.y, p.z); }

[[noreturn]] void refuse(PlcFault::Kind kind, const std::string& message, std::vector<Index> points,
                         const Point& at) {
  throw PlcError(message, {{kind, message, std::move(points), at}});
}

/// Throws PlcError with the message "The `what` of the nodes ... at ...", followed by `wrong`. `given`: by
/// node, its number in the whole mesh, which the message uses.
template <std::size_t n>
[[noreturn]] void refuse(std::string_view what, std::array<Index, n> cell, const std::vector<Index>& given,
                         const Point& at, std::string_view wrong,
                         PlcFault::Kind kind = PlcFault::Kind::intersection) {
  std::string nodes;
  for (std::size_t i = 0; i < n; ++i) {
    cell[i] = given[cell[i]];
    nodes += fmt::format("{}{}", i == 0 ? "" : i + 1 == n ? " and " : ", ", cell[i]);
  }
  refuse(kind, fmt::format("The {} of the nodes {} at {}{}", what, nodes, text(at), wrong),
         {cell.begin(), cell.end()}, at);
}

using Ends = std::array<Index, 2>;

using Triangle = std::array<Index, 3>;

/// A triangle that separates a region from another one or from the outside, or that the mesh lists as a face.
struct MeshSide {
  Triangle corners;     ///< corners; the tet `behind` is on the triangle's back side
  Index behind, front;  ///< tets; none: the outside
  Index face;           ///< index of the mesh's face; none if it is not listed
};

/// The mesh sides in the order of their tets, and which tets are connected across faces that are no mesh
/// sides. If the mesh lists every side of its tets, listed faces inside a region count only if they have a
/// tag other than 0. The constructor throws PlcError for sides that more than two tets share, and for listed
/// faces that are no side of a tet; messages name points by `given`. Cost: O(n log n).
struct MeshSides {
  MeshSides(const TetMesh& mesh, const std::vector<Index>& given);

  std::vector<MeshSide> sides;
  std::vector<Index> component;  ///< by tet: the first tet connected to it
};

/// A side of a tet, or a listed face.
struct Use {
  Triangle key;  // sorted corners
  Index tet;     // none: a listed face
  Index place;   // the opposite corner, or the number of the face
};

std::vector<Use> uses_of(const TetMesh& mesh) {
  std::vector<Use> uses;
  uses.reserve(4 * mesh.tets.size() + mesh.faces.size());
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (unsigned corner = 0; corner < 4; ++corner)
      uses.push_back({sorted(side_corners(mesh.tets[t], corner)), t, corner});
  for (Index f = 0; f < mesh.faces.size(); ++f) uses.push_back({sorted(mesh.faces[f]), none, f});
  std::ranges::sort(uses, {}, [](const Use& use) { return std::tuple(use.key, use.tet, use.place); });
  return uses;
}

/// Returns whether the mesh lists every side of its tets as a face, as some programs do. Then being listed
/// says nothing about a face inside a region.
bool lists_every_side(const std::vector<Use>& uses) {
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    for (j = i; j < uses.size() && uses[j].key == uses[i].key;) ++j;
    if (uses[j - 1].tet != none) return false;
  }
  return true;
}

MeshSides::MeshSides(const TetMesh& mesh, const std::vector<Index>& given) {
  const std::vector<Use> uses = uses_of(mesh);
  const bool every_side = lists_every_side(uses);
  DisjointSets connected(mesh.tets.size());
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    for (j = i; j < uses.size() && uses[j].key == uses[i].key;) ++j;
    const auto tets = static_cast<std::size_t>(std::find_if(uses.begin() + static_cast<std::ptrdiff_t>(i),
                                                            uses.begin() + static_cast<std::ptrdiff_t>(j),
                                                            [](const Use& use) { return use.tet == none; }) -
                                               (uses.begin() + static_cast<std::ptrdiff_t>(i)));
    const auto centre = [&] {
      const auto& key = uses[i].key;
      return (mesh.points[key[0]] + mesh.points[key[1]] + mesh.points[key[2]]) / 3;
    };
    if (tets == 0)
      refuse("triangle", uses[i].key, given, centre(),
             " is listed as a face but is no side of a tetrahedron; remove it from the file.");
    if (tets > 2)
      refuse("triangle", uses[i].key, given, centre(),
             fmt::format(" is a side of {} tetrahedra; remove those that overlap others.", tets));
    const bool listed = i + tets < j;
    const bool counts = listed && !(every_side && mesh.face_tag[uses[i + tets].place] == 0);
    const Index first = uses[i].tet, second = tets == 2 ? uses[i + 1].tet : none;
    if (!counts && second != none && mesh.tet_region[first] == mesh.tet_region[second])
      connected.unite(first, second);
    else
      sides.push_back({side_corners(mesh.tets[first], uses[i].place), first, second,
                       listed ? uses[i + tets].place : none});
  }
  std::ranges::sort(sides, [](const MeshSide& a, const MeshSide& b) {
    return a.behind != b.behind ? a.behind < b.behind : sorted(a.corners) < sorted(b.corners);
  });
  component.resize(mesh.tets.size());
  for (Index t = 0; t < mesh.tets.size(); ++t) component[t] = connected.find(t);
}

std::array<double, 3> coordinates(const Point& p) { return {p.x, p.y, p.z}; }

/// An index of points by their coordinates.
class Places {
 public:
  /// Keeps the points by reference. Throws PlcError, with points named by `given`, if two are at one place.
  Places(const std::vector<Point>& points, const std::vector<Index>& given)
      : points_(points), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), Index{0});
    std::ranges::stable_sort(order_, {}, [&](Index i) { return coordinates(points_[i]); });
    for (std::size_t i = 1; i < order_.size(); ++i)
      if (const Index a = order_[i - 1], b = order_[i]; points_[a] == points_[b])
        refuse(PlcFault::Kind::duplicate_points,
               fmt::format("The mesh has two nodes, {} and {}, at {}; merge such nodes first, also where the "
                           "mesh is cut open on purpose.",
                           given[a], given[b], text(points_[a])),
               {given[a], given[b]}, points_[a]);
  }
  Index find(const Point& p) const {
    const auto found = std::ranges::lower_bound(order_, coordinates(p), {},
                                                [&](Index i) { return coordinates(points_[i]); });
    return found != order_.end() && points_[*found] == p ? *found : none;
  }

 private:
  const std::vector<Point>& points_;
  std::vector<Index> order_;
};

class ComplexBuilder {
 public:
  ComplexBuilder(const TetMesh& mesh, const PlcOptions& options)
      : ComplexBuilder(corners_of(mesh), options) {}

  MeshComplex run() {
    require_edges();
    require_positive_sides();
    build();
    for (const Point& p : plc_.points) point_of_.push_back(places_.find(p));
    find_triangles();
    number_regions();
    require_positive_regions();
    set_regions_of_patches();
    label();
    return {std::move(plc_), std::move(mesh_)};
  }

 private:
  ComplexBuilder(CornerMesh corners, const PlcOptions& options)
      : mesh_(std::move(corners.mesh)),
        given_(std::move(corners.given)),
        options_(options),
        places_(mesh_.points, given_),
        found_(mesh_, given_) {}

  Tag tag_of(const MeshSide& side) const { return side.face == none ? 0 : mesh_.face_tag[side.face]; }

  /// Throws PlcError for edges between nodes that no tet joins, because remeshing could not keep them.
  void require_edges() const {
    if (mesh_.edges.empty()) return;
    std::vector<Ends> joined;
    for (const auto& tet : mesh_.tets)
      for (const auto& [i, j] : cell_shapes::corner_pairs) joined.push_back(sorted(tet[i], tet[j]));
    std::ranges::sort(joined);
    for (const auto& [a, b] : mesh_.edges)
      if (!std::ranges::binary_search(joined, sorted(a, b)))
        refuse("line", Ends{a, b}, given_, mesh_.points[a],
               " is listed but is no edge of a tetrahedron; remove it from the file.");
  }

  double six_volume_of(Index tet) const {
    const auto& [a, b, c, d] = mesh_.tets[tet];
    return six_volume(mesh_.points[a], mesh_.points[b], mesh_.points[c], mesh_.points[d]);
  }

  /// Throws PlcError for clearly inverted tets with a side on a boundary or an interface: these sides would
  /// be kept, turned over. Improvement mends flat tets, and inverted ones inside.
  void require_positive_sides() const {
    for (const MeshSide& side : found_.sides)
      for (const Index tet : {side.behind, side.front}) {
        if (tet == none) continue;
        Box box;
        for (const Index v : mesh_.tets[tet]) box.add(mesh_.points[v]);
        const double length = box.diagonal();
        if (six_volume_of(tet) >= -rounded_volume * length * length * length) continue;
        refuse("tetrahedron", mesh_.tets[tet], given_, mesh_.points[mesh_.tets[tet][0]],
               " is inverted and has a side on a boundary; exchange two of its nodes, or move them until its "
               "volume is positive.");
      }
  }

  /// Throws PlcError for regions whose tets have no positive volume in total.
  void require_positive_regions() const {
    for (Index t = 0; t < mesh_.tets.size(); ++t) {
      const Plc::Region& region = plc_.regions[mesh_.tet_region[t]];
      if (region.volume > 0) continue;
      const Point& at = mesh_.points[mesh_.tets[t][0]];
      refuse(PlcFault::Kind::intersection,
             fmt::format("The tetrahedra of {} at {} have a total volume of {:.9g}, which must be positive; "
                         "remove them, or turn those that are inverted.",
                         region.name, text(at), region.volume),
             {given_[mesh_.tets[t][0]]}, at);
    }
  }

  void build() {
    PolygonSoup soup;
    soup.name = "the mesh";
    soup.points = mesh_.points;
    for (const MeshSide& side : found_.sides) soup.add_facet(side.corners, tag_of(side));
    for (Index e = 0; e < mesh_.edges.size(); ++e)
      soup.segments.push_back({mesh_.edges[e][0], mesh_.edges[e][1], mesh_.edge_tag[e]});
    for (Index v = 0; v < mesh_.points.size(); ++v)
      if (mesh_.features[v].dimension == 0) soup.vertices.push_back(v);
    soup.given_features = edges_are_complete();
    soup.tag_names = mesh_.names;
    PlcOptions options = options_;
    options.weld = 0;
    options.require_solid = false;
    plc_ = build_plc({&soup, 1}, options);
  }

  /// Returns whether the mesh lists all edges at which one side ends, more than two sides meet, or two sides
  /// with different tags.
  bool edges_are_complete() const {
    if (mesh_.edges.empty()) return false;
    struct EdgeUse {
      Ends ends;
      Tag tag;
    };
    std::vector<Ends> listed;
    for (const auto& [a, b] : mesh_.edges) listed.push_back(sorted(a, b));
    std::ranges::sort(listed);
    std::vector<EdgeUse> uses;
    for (const MeshSide& side : found_.sides)
      for (unsigned i = 0; i < 3; ++i)
        uses.push_back({sorted(side.corners[i], side.corners[(i + 1) % 3]), tag_of(side)});
    std::ranges::sort(uses, {}, [](const EdgeUse& use) { return std::pair(use.ends, use.tag); });
    for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
      for (j = i; j < uses.size() && uses[j].ends == uses[i].ends;) ++j;
      if ((j - i != 2 || uses[i].tag != uses[j - 1].tag) && !std::ranges::binary_search(listed, uses[i].ends))
        return false;
    }
    return true;
  }

  /// Finds for each triangle of the complex the mesh side that it was made from. Throws PlcError if a side
  /// has no triangle.
  void find_triangles() {
    std::vector<std::pair<Triangle, Index>> sides;
    for (Index s = 0; s < found_.sides.size(); ++s) sides.emplace_back(sorted(found_.sides[s].corners), s);
    std::ranges::sort(sides);
    std::vector<bool> used(sides.size(), false);
    for (const Plc::Triangle& t : plc_.triangles) {
      const Triangle key = sorted(in_mesh(t));
      const auto at = std::ranges::lower_bound(sides, std::pair(key, Index{0}));
      if (at == sides.end() || at->first != key) continue;
      side_of_.push_back(at->second);
      used[at->second] = true;
    }
    const auto missing = std::ranges::find(used, false);
    if (missing == used.end() && side_of_.size() == plc_.triangles.size()) return;
    const Triangle& corners =
        found_.sides[missing == used.end() ? 0 : static_cast<std::size_t>(missing - used.begin())].corners;
    refuse("side of a tetrahedron on a boundary,", corners, given_, mesh_.points[corners[0]],
           ", has no area; move one of its nodes.", PlcFault::Kind::degenerate_facet);
  }

  Triangle in_mesh(const Plc::Triangle& t) const {
    return {point_of_[t.points[0]], point_of_[t.points[1]], point_of_[t.points[2]]};
  }

  /// Numbers the connected parts of the mesh's regions, in the order of the regions.
  void number_regions() {
    std::vector<Index> firsts;
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      if (found_.component[t] == t) firsts.push_back(t);
    std::ranges::stable_sort(firsts, {}, [&](Index tet) { return mesh_.tet_region[tet]; });
    std::vector<Index> number(mesh_.tets.size(), 0);
    plc_.regions.resize(1);
    plc_.regions[0].name = "outside";
    for (const Index first : firsts) {
      number[first] = static_cast<Index>(plc_.regions.size());
      Plc::Region region;
      region.tag = mesh_.tet_tag[first];
      region.name = fmt::format("region {}", number[first]);
      plc_.regions.push_back(region);
    }
    for (Index t = 0; t < mesh_.tets.size(); ++t) {
      mesh_.tet_region[t] = number[found_.component[t]];
      plc_.regions[mesh_.tet_region[t]].volume += six_volume_of(t) / 6;
    }
  }

  /// Sets the regions of patches. If one side of a patch is outside, that side is its front.
  void set_regions_of_patches() {
    for (Plc::Patch& patch : plc_.patches) {
      const Index first = patch.first_triangle, last = first + patch.triangle_count;
      patch.regions = regions_at(first);
      for (Index t = first; t < last; ++t)
        if (regions_at(t) != patch.regions) {
          const Point& at = plc_.points[plc_.triangles[t].points[0]];
          refuse(PlcFault::Kind::not_orientable,
                 fmt::format("The faces around {} form a one-sided surface, so they separate no regions; "
                             "remove those inside a region.",
                             text(at)),
                 {}, at);
        }
      if (patch.regions[0] != 0 || patch.regions[1] == 0) continue;
      std::swap(patch.regions[0], patch.regions[1]);
      if (patch.planar) patch.normal = -1.0 * patch.normal;
      for (Index t = first; t < last; ++t)
        std::swap(plc_.triangles[t].points[1], plc_.triangles[t].points[2]);
    }
  }

  /// Returns the regions behind and in front of a triangle of the complex.
  std::array<Index, 2> regions_at(Index triangle) const {
    const MeshSide& side = found_.sides[side_of_[triangle]];
    const Triangle here = in_mesh(plc_.triangles[triangle]);
    const auto i = static_cast<unsigned>(std::ranges::find(here, side.corners[0]) - here.begin());
    const auto region_of = [&](Index tet) { return tet == none ? 0 : mesh_.tet_region[tet]; };
    std::array<Index, 2> regions{region_of(side.behind), region_of(side.front)};
    if (here[(i + 1) % 3] != side.corners[1]) std::swap(regions[0], regions[1]);
    return regions;
  }

  void label() {
    const std::size_t tets = mesh_.tets.size();
    for (std::size_t t = 0; t < tets; ++t) mesh_.tet_tag[t] = plc_.regions[mesh_.tet_region[t]].tag;
    mesh_.tet_collar.assign(tets, 0);
    mesh_.tet_crease.assign(tets, 0);
    mesh_.tet_thin.assign(tets, 0);
    mesh_.features.assign(mesh_.points.size(), {});
    mesh_.names = plc_.names;
    label_faces();
    label_edges();
    for (Index v = 0; v < plc_.vertices.size(); ++v)
      mesh_.features[point_of_[plc_.vertices[v].point]] = {0, v};
  }

  void label_faces() {
    mesh_.faces.clear();
    mesh_.face_tag.clear();
    for (const Plc::Triangle& t : plc_.triangles) {
      const Plc::Patch& patch = plc_.patches[t.patch];
      mesh_.faces.push_back(in_mesh(t));
      mesh_.face_patch.push_back(t.patch);
      mesh_.face_tag.push_back(patch.tag);
      mesh_.face_regions.push_back(patch.regions);
      for (const Index v : mesh_.faces.back()) mesh_.features[v] = {2, t.patch};
    }
  }

  void label_edges() {
    mesh_.edges.clear();
    mesh_.edge_tag.clear();
    for (Index c = 0; c < plc_.curves.size(); ++c) {
      const auto& points = plc_.curves[c].points;
      for (std::size_t i = plc_.curves[c].closed ? 0 : 1; i < points.size(); ++i) {
        const Index a = point_of_[points[i == 0 ? points.size() - 1 : i - 1]], b = point_of_[points[i]];
        mesh_.edges.push_back({a, b});
        mesh_.edge_curve.push_back(c);
        mesh_.edge_tag.push_back(plc_.curves[c].tag);
        mesh_.features[a] = mesh_.features[b] = {1, c};
      }
    }
  }

  TetMesh mesh_;
  const std::vector<Index> given_;  // by point: its index in the mesh that was given
  const PlcOptions& options_;
  const Places places_;
  const MeshSides found_;
  Plc plc_;
  std::vector<Index> point_of_;  // by point of the complex: the mesh's point
  std::vector<Index> side_of_;   // by triangle of the complex: index among the sides
};

}  // namespace

CornerMesh corners_of(const TetMesh& mesh) {
  if (mesh.tets.empty())
    refuse(PlcFault::Kind::empty, "The mesh has no tetrahedra; name a file that has some.", {}, {});
  CornerMesh corners;
  TetMesh& kept = corners.mesh;
  std::vector<Index> number(mesh.points.size(), none);
  kept.tets = mesh.tets;
  for (const auto& tet : mesh.tets)
    for (const Index v : tet) number[v] = 0;
  for (Index v = 0; v < mesh.points.size(); ++v) {
    if (number[v] == none) continue;
    number[v] = static_cast<Index>(kept.points.size());
    corners.given.push_back(v);
    kept.points.push_back(mesh.points[v]);
    kept.features.push_back(v < mesh.features.size() ? mesh.features[v] : TetMesh::VertexFeature{});
  }
  for (auto& tet : kept.tets)
    for (Index& v : tet) v = number[v];
  kept.tet_region = mesh.tet_region;
  kept.tet_tag = mesh.tet_tag;
  const auto require_kept = [&](const auto& cell, std::string_view kind) {
    for (const Index v : cell)
      if (number[v] == none)
        refuse(PlcFault::Kind::intersection,
               fmt::format(
                   "A {} is listed whose node {} at {} belongs to no tetrahedron; remove it from the file.",
                   kind, v, text(mesh.points[v])),
               {v}, mesh.points[v]);
  };
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    require_kept(mesh.faces[f], "face");
    const auto& [a, b, c] = mesh.faces[f];
    kept.faces.push_back({number[a], number[b], number[c]});
    kept.face_tag.push_back(mesh.face_tag[f]);
  }
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    require_kept(mesh.edges[e], "line");
    kept.edges.push_back({number[mesh.edges[e][0]], number[mesh.edges[e][1]]});
    kept.edge_tag.push_back(mesh.edge_tag[e]);
  }
  kept.group_names = mesh.group_names;
  kept.names = mesh.names;
  return corners;
}

MeshComplex complex_of(const TetMesh& mesh, const PlcOptions& options) {
  return ComplexBuilder(mesh, options).run();
}

}  // namespace collarmesh::remeshing::adapting
