#include "refine/rip_and_stitch.h"

#include <algorithm>
#include <iterator>

#include "common/sorted.h"
#include "refine/sagitta.h"

namespace collarmesh {

namespace {

struct FaceUse {
  std::array<Index, 3> key;   // sorted mesh vertices
  std::array<Index, 3> face;  // counterclockwise as seen from outside its tet
  Index region;               // region of the tet
};

}  // namespace

void RipAndStitch::stitch() {
  stitched_ = {};
  if (collars_.empty()) return;
  const std::vector<CollarTriangle> triangles = collar_surface_.triangles();
  for (const CollarTriangle& t : triangles) {
    const Index region = surface_.region(cell_of(t.face));
    if (region == 0 || t.several) continue;
    const auto v = mesh_.face_vertices(t.face);
    add({{v[0], v[1], v[2], creator_.vertex_of(t.ball)}, region, 1, crease_tag(t.ball)});
  }
  stitch_books(triangles);
  stitch_faces(triangles);
  for (const CollarLink& link : collars_.links())
    stitched_.edges.push_back(
        {{creator_.vertex_of(link.balls[0]), creator_.vertex_of(link.balls[1])}, link.curve});
  for (const CurveChains::ClippedEnd& end : curves_.clipped_ends())
    stitched_.edges.push_back({{creator_.vertex_of(end.ball), points_[end.point].vertex}, end.curve});
}

// Adds a tet. If the review has given up, a triangle may have the centre of its own ball as a corner. Makes
// no tet of such a triangle, so the collar stays open there.
void RipAndStitch::add(const Stitched::Tet& tet) {
  const std::array<Index, 4> corners = sorted(tet.corners);
  if (std::ranges::adjacent_find(corners) == corners.end())
    stitched_.tets.push_back(tet);
  else
    stitched_.open.push_back(tet.corners[0]);
}

Tag RipAndStitch::crease_tag(Index ball) const {
  const CollarBall& b = collars_.balls()[ball];
  return b.dimension == 0 ? domain_.plc.vertices[b.feature].tag : domain_.plc.curves[b.feature].tag;
}

void RipAndStitch::stitch_books(const std::vector<CollarTriangle>& triangles) {
  std::vector<std::pair<std::array<Index, 2>, Index>> curve_between;  // two balls, their curve; sorted
  for (const auto& [balls, curve, parameters] : collars_.links())
    curve_between.push_back({sorted(balls[0], balls[1]), curve});
  std::ranges::sort(curve_between);
  const auto tag_between = [&](Index a, Index b) {
    const std::array<Index, 2> balls = sorted(a, b);
    const auto found = std::ranges::lower_bound(curve_between, std::pair{balls, Index{0}});
    // Triangles of balls that are not consecutive meet only if the review has given up.
    if (found == curve_between.end() || found->first != balls) return crease_tag(a);
    return domain_.plc.curves[found->second].tag;
  };
  struct Side {
    std::array<Index, 2> key;   // sorted edge
    std::array<Index, 2> edge;  // in the direction of its triangle
    Index ball, region;
  };
  std::vector<Side> sides;
  for (const CollarTriangle& t : triangles) {
    const Index region = surface_.region(cell_of(t.face));
    if (region == 0 || t.several) continue;
    const auto v = mesh_.face_vertices(t.face);
    for (unsigned k = 0; k < 3; ++k) {
      const Index a = v[k], b = v[(k + 1) % 3];
      sides.push_back({sorted(a, b), {a, b}, t.ball, region});
    }
  }
  std::ranges::stable_sort(sides, {}, &Side::key);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &s = sides[i], &other = sides[i + 1];
    if (s.key != other.key || s.ball == other.ball) continue;
    add({{s.edge[1], s.edge[0], creator_.vertex_of(other.ball), creator_.vertex_of(s.ball)},
         s.region,
         2,
         tag_between(s.ball, other.ball)});
  }
}

// Makes the faces of the new tets that lie on patches: faces between two regions, or on a patch inside one
// region.
void RipAndStitch::stitch_faces(const std::vector<CollarTriangle>& triangles) {
  std::vector<FaceUse> uses;
  const auto add_use = [&](const std::array<Index, 3>& face, Index region) {
    uses.push_back({sorted(face), face, region});
  };
  for (const auto& tet : stitched_.tets)
    for (const auto& f : opposite_places)
      add_use({tet.corners[f[0]], tet.corners[f[1]], tet.corners[f[2]]}, tet.region);
  for (const CollarTriangle& t : triangles) {
    const Index region = surface_.region(cell_of(t.face));
    if (region != 0 && !t.several) add_use(mesh_.face_vertices(t.face), region);
  }
  std::ranges::stable_sort(uses, {}, &FaceUse::key);
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    for (j = i; j < uses.size() && uses[j].key == uses[i].key;) ++j;
    const Index beyond = j - i > 1 ? uses[i + 1].region : 0;
    const Index patch = patch_between(uses[i].key, uses[i].region, beyond);
    if (patch == none) {
      if (uses[i].region != beyond || j - i > 2)
        stitched_.open.insert(stitched_.open.end(), uses[i].key.begin(), uses[i].key.end());
      continue;
    }
    auto face = uses[i].face;
    std::array<Index, 2> regions{uses[i].region, beyond};
    const bool reversed = regions[0] == regions[1]
                              ? against_patch(face, patch)
                              : beyond != 0 && regions[0] != domain_.plc.patches[patch].regions[0];
    if (reversed) {
      std::swap(face[1], face[2]);
      std::swap(regions[0], regions[1]);
    }
    stitched_.faces.push_back({face, regions, patch});
  }
}

Point RipAndStitch::centroid(const std::array<Index, 3>& face) const {
  return (mesh_.point(face[0]) + mesh_.point(face[1]) + mesh_.point(face[2])) / 3;
}

// Returns whether the face's normal points to the back of the patch.
bool RipAndStitch::against_patch(const std::array<Index, 3>& face, Index patch) const {
  double any = INFINITY;
  const Index nearest = nodes_.nearest_triangle(centroid(face), patch, any);
  const auto t = nodes_.hierarchy().corners(nearest);
  const Point& a = mesh_.point(face[0]);
  return dot(cross(mesh_.point(face[1]) - a, mesh_.point(face[2]) - a), cross(t[1] - t[0], t[2] - t[0])) < 0;
}

// Returns the patch that contains all three vertices and separates these regions; none if there is none. Two
// curves that meet at a crease can bound two such patches: then returns the one nearer to the face. If the
// regions are the same, the face must lie on the patch (lies_on).
Index RipAndStitch::patch_between(const std::array<Index, 3>& corners, Index a, Index b) const {
  const auto separates = [&](Index patch) {
    const auto& r = domain_.plc.patches[patch].regions;
    return ((r[0] == a && r[1] == b) || (r[0] == b && r[1] == a)) &&
           std::ranges::all_of(corners, [&](Index v) { return mesh_.on_patch(v, patch); });
  };
  std::vector<Index> possible;
  for (const Index corner : corners) {
    const Feature& v = mesh_.feature(corner);
    if (v.dimension == 3) return none;
    if (v.dimension < 2) continue;
    if (!separates(v.index)) return none;
    if (a != b || domain_.plc.patches[v.index].planar) return v.index;
    possible = {v.index};
  }
  if (possible.empty()) {
    const Feature& v = mesh_.feature(corners[0]);
    const auto& patches =
        v.dimension == 0 ? domain_.plc.vertices[v.index].patches : domain_.plc.curves[v.index].patches;
    std::ranges::copy_if(patches, std::back_inserter(possible), separates);
  }
  if (possible.empty() || (possible.size() == 1 && a != b)) return possible.empty() ? none : possible[0];
  const Point middle = centroid(corners);
  const auto distance_to = [&](Index patch) {
    return squared_distance(middle, collars_.features().nearest_point({2, patch}, middle));
  };
  const Index nearest = *std::ranges::min_element(possible, {}, distance_to);
  return a != b || lies_on(corners, nearest) ? nearest : none;
}

// Returns whether a face inside one region lies on the patch that contains its vertices, and not beside the
// patch or across a fold of it.
bool RipAndStitch::lies_on(const std::array<Index, 3>& face, Index patch) const {
  const auto is_near = [&](const Point& p, double most) {
    return squared_distance(p, collars_.features().nearest_point({2, patch}, p)) <= most * most;
  };
  if (domain_.plc.patches[patch].planar)
    return is_near(centroid(face), std::max(domain_.plc.planar_tolerance, 1e-9 * domain_.diagonal));
  if (!is_near(centroid(face), domain_.tolerance.largest_on_patch(patch))) return false;
  for (unsigned k = 0; k < 3; ++k) {
    const Point &a = mesh_.point(face[k]), &b = mesh_.point(face[(k + 1) % 3]);
    if (!is_near(0.5 * (a + b), largest_sagitta * distance(a, b))) return false;
  }
  return true;
}

}  // namespace collarmesh
