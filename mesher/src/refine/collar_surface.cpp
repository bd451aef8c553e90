#include "refine/collar_surface.h"

#include <algorithm>
#include <cmath>

#include "common/shared_bounds.h"
#include "delaunay/predicates.h"
#include "refine/sagitta.h"

namespace collarmesh {

namespace {

// Patches meet the spheres of balls in arcs. A representation point this close to an arc, relative to the
// radius of its ball, is moved onto the arc: inserting points of lower dimension first keeps collars small.
constexpr double arc_reach = 0.7;
// The point is not moved if a mesh vertex is already this close to its new place on the arc, relative to the
// distance between the representation point and the nearest mesh vertex.
constexpr double arc_clearance = 0.5;
// Where a smooth patch bends: least distance of a new point on an arc from mesh vertices, in distance
// tolerances.
constexpr double bent_clearance = 0.1;
// Least distance of all other new points on the collar surface from mesh vertices, in radii of their ball.
constexpr double clearance_in_radii = 1e-3;
// Edges from a patch to a ball's centre that leave the patch are divided only if they are longer than this,
// in radii of the ball.
constexpr double divisible_spoke = 1.05;

double radians(double degrees) { return degrees * 3.14159265358979323846 / 180; }

}  // namespace

std::span<const Index> CollarSurface::patches_through(const CollarBall& ball) const {
  return ball.dimension == 0 ? domain_.plc.vertices[ball.feature].patches
                             : domain_.plc.curves[ball.feature].patches;
}

bool CollarSurface::on_crease(Index vertex) const {
  const Feature& f = mesh_.feature(vertex);
  return (f.dimension == 0 && collars_.ball_at_vertex(f.index) != none) ||
         (f.dimension == 1 && collars_.is_crease_curve(f.index));
}

// Returns whether a corner lies on a curve inside a smooth patch, where the patch may fold. A tet with
// corners on both sides of a fold is not flat.
bool CollarSurface::at_fold(std::span<const Index> corners) const {
  return std::ranges::any_of(corners, [&](Index v) {
    if (mesh_.feature(v).dimension != 1) return false;
    const auto& patches = domain_.plc.curves[mesh_.feature(v).index].patches;
    return patches.size() == 1 && !domain_.plc.patches[patches[0]].planar;
  });
}

std::vector<CollarTriangle> CollarSurface::triangles() {
  std::vector<CollarTriangle> triangles;
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    if (!mesh_.alive(cell) || cells_.inside(cell)) continue;
    const auto& v = mesh_.corners(cell);
    if (std::ranges::none_of(v, [&](Index i) { return cells_.near(i); })) continue;
    for (unsigned corner = 0; corner < 4; ++corner)
      if (const auto t = triangle(face_id(cell, corner))) triangles.push_back(*t);
  }
  return triangles;
}

std::optional<CollarTriangle> CollarSurface::triangle(FaceId outer) {
  const FaceId inner = mesh_.opposite(outer);
  if (inner == no_face || cells_.inside(cell_of(outer))) return std::nullopt;
  const bool inside = cells_.inside(cell_of(inner));
  if (!inside && cell_of(inner) < cell_of(outer)) return std::nullopt;
  const std::uint32_t generation = mesh_.generation(cell_of(outer));
  if (const Index taker = cells_.taken_in_by(cell_of(inner)); taker != none) {
    const CollarBall& ball = collars_.balls()[taker];
    const Vector d = surface_.circumcentre(outer) - ball.centre;
    return CollarTriangle{outer, generation, taker, ball.centre + ball.radius / norm(d) * d, false};
  }
  if (is_off(outer)) return std::nullopt;
  // A dual edge lies in the Voronoi cells of the triangle's vertices.
  const auto v = mesh_.face_vertices(outer);
  const Point p = mesh_.circumcentre(cell_of(outer)), q = mesh_.circumcentre(cell_of(inner));
  balls_.clear();
  if (std::ranges::all_of(v, [&](Index i) { return cells_.near(i); }))
    collars_.balls_on_segment(p, q, balls_);
  if (balls_.empty()) {
    off_.resize(mesh_.cell_capacity(), 0);
    off_[cell_of(outer)] |= static_cast<std::uint8_t>(1U << corner_of(outer));
    return std::nullopt;
  }
  // The part of the dual edge inside a ball, in parameters that go from 0 at p to 1 at q.
  struct Part {
    double from, to;
    Index ball;
  };
  std::vector<Part> parts;
  const Vector d = q - p;
  const double length = squared_norm(d);
  for (const Index index : balls_) {
    const CollarBall& ball = collars_.balls()[index];
    const double middle = dot(ball.centre - p, d) / length;
    const double off = squared_distance(ball.centre, p + middle * d);
    const double half = std::sqrt(std::max(0.0, (ball.radius * ball.radius - off) / length));
    parts.push_back({middle - half, middle + half, index});
  }
  std::ranges::sort(parts, {}, &Part::from);
  double covered = parts[0].to;
  bool several = !inside;
  for (const Part& part : parts) {
    if (part.from > covered) several = true;
    covered = std::max(covered, part.to);
  }
  return CollarTriangle{outer, generation, parts[0].ball, p + parts[0].from * d, several};
}

// Returns whether a triangle is poor for reasons other than its neighbours and bends.
bool CollarSurface::poorly_represented(const CollarTriangle& t) {
  const Index outer = cell_of(t.face);
  const FaceId inner = mesh_.opposite(t.face);
  if (surface_.region(outer) == 0 && (t.several ? surface_.region(cell_of(inner)) == 0 : true)) return false;
  if (t.several) return true;
  const auto v = mesh_.face_vertices(t.face);
  for (const Index vertex : v)
    if (on_crease(vertex)) return true;
  // A patch separates the outer cell from the sphere, so the star tet would lie on the other side of the
  // patch.
  if (surface_.is_marked(t.face) && !surface_.triangle(t.face).in_collar) return true;
  const CollarBall& ball = collars_.balls()[t.ball];
  const Index centre_vertex = creator_.vertex_of(t.ball);
  if (centre_vertex == none) return true;
  if (mesh_.on_one_patch(std::array{v[0], v[1], v[2], centre_vertex}) && !at_fold(v)) return true;
  const Point &a = mesh_.point(v[0]), &b = mesh_.point(v[1]), &c = mesh_.point(v[2]);
  if (predicates::orientation(a, b, c, ball.centre) <= 0) return true;
  const TetQuality quality = measure(a, b, c, ball.centre);
  if (quality.max_dihedral > domain_.options.bounds.collar_angle) return true;
  if (cells_.taken_in_by(cell_of(inner)) == none) {
    const Vector along = mesh_.circumcentre(cell_of(inner)) - mesh_.circumcentre(outer);
    const Vector normal = ball.centre - t.representation;
    if (dot(along, normal) <
        std::cos(radians(domain_.options.representation_angle)) * norm(along) * norm(normal))
      return true;
  }
  return crosses_patch(ball, v[0], v[1]) || crosses_patch(ball, v[1], v[2]) ||
         crosses_patch(ball, v[2], v[0]);
}

bool CollarSurface::far_from_patch(Index patch, const Point& p) const {
  Index nearest = none;
  collars_.features().distance_within({2, patch}, p, domain_.tolerance.least_on_patch(patch), nearest,
                                      [](Index) { return true; });
  return nearest == none;
}

// Returns whether a face between the ball's centre and an edge on a smooth patch, or an edge from the centre
// to a vertex on the patch, leaves the patch by more than the tolerance. Records the patch and the place in
// the triangle.
bool CollarSurface::bends(CollarTriangle& t) const {
  if (surface_.region(cell_of(t.face)) == 0) return false;
  const CollarBall& ball = collars_.balls()[t.ball];
  const auto v = mesh_.face_vertices(t.face);
  for (const Index patch : patches_through(ball)) {
    if (domain_.plc.patches[patch].planar) continue;
    for (unsigned k = 0; k < 3; ++k) {
      const Index i = v[k], j = v[(k + 1) % 3];
      if (mesh_.on_patch(i, patch)) {
        // The edge to the centre. A point on the sphere divides this edge only if the edge is longer than the
        // radius. Otherwise the new point would be right beside i.
        const Vector spoke = mesh_.point(i) - ball.centre;
        const bool divisible = norm(spoke) > divisible_spoke * ball.radius;
        for (const double share : {0.4, 0.65}) {
          if (!divisible || !far_from_patch(patch, ball.centre + share * spoke)) continue;
          t.bent_on = patch;
          t.bent_at = ball.centre + share * spoke;
          return true;
        }
      }
      if (!mesh_.on_patch(i, patch) || !mesh_.on_patch(j, patch)) continue;
      const Point &a = mesh_.point(i), &b = mesh_.point(j);
      const Point middle = 0.5 * (a + b);
      if (distance(a, b) < domain_.tolerance.least_on_patch(patch)) continue;
      if (!far_from_patch(patch, middle) && !far_from_patch(patch, (a + b + ball.centre) / 3)) continue;
      t.bent_on = patch;
      t.bent_at = middle;
      return true;
    }
  }
  return false;
}

bool CollarSurface::spans_sheets(const CollarBall& ball, Index a, Index b) const {
  const Point middle = 0.5 * (mesh_.point(a) + mesh_.point(b));
  const double most = largest_sagitta * distance(mesh_.point(a), mesh_.point(b));
  if (most >= domain_.tolerance.largest()) return false;
  bool found = false;
  for (const Index patch : patches_through(ball)) {
    if (!mesh_.on_patch(a, patch) || !mesh_.on_patch(b, patch)) continue;
    if (domain_.plc.patches[patch].planar ||
        squared_distance(middle, collars_.features().nearest_point({2, patch}, middle)) <= most * most)
      return false;
    found = true;
  }
  return found;
}

// Returns a point near a given one where a patch through the ball's centre meets the ball's sphere.
std::optional<Point> CollarSurface::arc_point(const CollarBall& ball, Index patch, const Point& near) const {
  const auto on_sphere_towards = [&](const Point& p) {
    const Vector d = p - ball.centre;
    return ball.centre + ball.radius / norm(d) * d;
  };
  constexpr int most_projections = 40;
  constexpr double close = 1e-9;
  Point p = near;
  for (int k = 0; k < most_projections; ++k) {
    const Point q = collars_.features().nearest_point({2, patch}, p);
    if (squared_distance(q, ball.centre) < 1e-6 * ball.radius * ball.radius) return std::nullopt;
    p = on_sphere_towards(q);
    if (distance(p, q) < close * ball.radius)
      return domain_.plc.patches[patch].planar ? domain_.on_plane(patch, p) : p;
  }
  return std::nullopt;
}

// Returns whether an edge of a star crosses a patch. An edge near the ball can only cross patches through the
// ball's centre; others are three radii away.
bool CollarSurface::crosses_patch(const CollarBall& ball, Index a, Index b) {
  const Point &p = mesh_.point(a), &q = mesh_.point(b);
  const double reach = gap_per_radius * ball.radius;
  const bool near =
      squared_distance(p, ball.centre) < reach * reach && squared_distance(q, ball.centre) < reach * reach;
  const auto on_one_side = [&](Index patch) {
    const Plc::Patch& plane = domain_.plc.patches[patch];
    if (mesh_.on_patch(a, patch) || mesh_.on_patch(b, patch))
      return plane.planar || (mesh_.on_patch(a, patch) && mesh_.on_patch(b, patch));
    if (!plane.planar) return false;
    const Point origin = domain_.frame.inside(plane.origin);
    return dot(plane.normal, p - origin) * dot(plane.normal, q - origin) > 0;
  };
  const auto patches = patches_through(ball);
  if (near && std::ranges::all_of(patches, on_one_side)) return false;
  nodes_.crossings(p, q, crossings_);
  return std::ranges::any_of(crossings_, [&](const auto& crossing) {
    const Index patch = domain_.plc.triangles[crossing.triangle].patch;
    const bool a_on = mesh_.on_patch(a, patch), b_on = mesh_.on_patch(b, patch);
    if (a_on == b_on) return !a_on;
    return !domain_.plc.patches[patch].planar &&
           on_another_sheet(ball, mesh_.point(a_on ? a : b), crossing.triangle);
  });
}

// Returns whether p lies on another sheet of a patch than a triangle does. A smooth patch may pass through a
// ball's centre in several sheets, so an edge may begin on one and cross another. Balls are made so small
// that a sheet deviates from chords as long as the radius r by at most h (collar/flatness.cpp), and its
// triangles are tilted by about 4 h / r. So a point of the same sheet is off the triangle's plane by less
// than 8 h, where h is at most half the distance tolerance, and by less than r / 2.
bool CollarSurface::on_another_sheet(const CollarBall& ball, const Point& p, Index triangle) const {
  const auto [a, b, c] = nodes_.hierarchy().corners(triangle);
  const Index patch = domain_.plc.triangles[triangle].patch;
  const Vector normal = cross(b - a, c - a);
  return std::fabs(dot(p - a, normal)) >
         std::min(4 * domain_.tolerance.largest_on_patch(patch), 0.5 * ball.radius) * norm(normal);
}

bool CollarSurface::poor_book(const CollarTriangle& t, const CollarTriangle& u,
                              const std::array<Index, 2>& edge) const {
  if (surface_.region(cell_of(t.face)) == 0 && surface_.region(cell_of(u.face)) == 0) return false;
  if (surface_.region(cell_of(t.face)) != surface_.region(cell_of(u.face))) return true;
  const auto v = mesh_.face_vertices(t.face);
  unsigned first = 0;
  while (!(v[first] == edge[0] && v[(first + 1) % 3] == edge[1]) &&
         !(v[first] == edge[1] && v[(first + 1) % 3] == edge[0]))
    ++first;
  const Point &a = mesh_.point(v[first]), &b = mesh_.point(v[(first + 1) % 3]);
  const Point &p = collars_.balls()[t.ball].centre, &q = collars_.balls()[u.ball].centre;
  return predicates::orientation(b, a, q, p) <= 0 ||
         measure(b, a, q, p).max_dihedral > domain_.options.bounds.collar_angle;
}

std::optional<Candidate> CollarSurface::repair(const CollarTriangle& t) const {
  const CollarBall& ball = collars_.balls()[t.ball];
  const auto v = mesh_.face_vertices(t.face);
  const double radius = distance(t.representation, mesh_.point(mesh_.nearest_vertex(t.representation, v[0])));
  const double clearance = arc_clearance * radius;
  Point best = t.representation;
  Index patch = none;
  double nearest = arc_reach * ball.radius;
  for (const Index p : patches_through(ball)) {
    const bool bent = t.bent_on == p;
    const auto found = arc_point(ball, p, bent ? t.bent_at : t.representation);
    if (!found) continue;
    const Point arc = domain_.frame.rounded(*found);
    const double off = bent ? 0 : distance(arc, t.representation);
    if (off >= nearest) continue;
    const Index other = collars_.ball_containing(ball.centre + (1 + 1e-9) * (arc - ball.centre));
    if (other != none) continue;
    const double gap = distance(arc, mesh_.point(mesh_.nearest_vertex(arc, v[0])));
    if (gap < (bent ? bent_clearance * domain_.tolerance.least_on_patch(p) : clearance)) continue;
    nearest = off;
    best = arc;
    patch = p;
  }
  if (t.bent_on != none && patch == none) return std::nullopt;
  best = domain_.frame.rounded(best);
  const Index vertex = mesh_.nearest_vertex(best, v[0]);
  const Index start = mesh_.conflicting_cell_around(vertex, best);
  const bool mends_bend = patch != none && patch == t.bent_on;
  const double away = distance(best, mesh_.point(vertex)),
               least = mends_bend ? 0 : clearance_in_radii * ball.radius;
  if (start == none || away < least || domain_.at_floor(best, std::min(away * away, radius * radius)))
    return std::nullopt;
  const Feature feature{static_cast<std::uint8_t>(patch == none ? 3 : 2), patch};
  return Candidate{best, radius * radius, t.representation, feature, start};
}

// Clears the flags of faces whose cells have changed.
void CollarSurface::cells_made(const ConflictZone& zone) {
  if (off_.size() == 0) return;
  off_.resize(mesh_.cell_capacity(), 0);
  for (const Index cell : zone.created) off_[cell] = 0;
  for (const FaceId outer : zone.outer)
    if (outer != no_face) off_[cell_of(outer)] &= static_cast<std::uint8_t>(~(1U << corner_of(outer)));
}

}  // namespace collarmesh
