// The collar surface as a restricted Delaunay triangulation (paper, section 4):
// which cells lie inside the collars, whether the triangles between inside and outside represent
// the surface well enough to be stitched to the balls' centres, and the insertion of points on the
// surface, lower dimension first, where they do not. When that is asked is in collar_review.cpp.
#include <algorithm>

#include "delaunay/predicates.h"
#include "refine/refinement.h"

namespace collarmesh {

namespace {

// A representation point this close to an arc, in radii of its ball, is moved onto the arc: lower
// dimension first is what keeps collars small.
constexpr double arc_reach = 0.7;
// ... unless a mesh vertex is this close to the arc's point already, in radii of the empty ball.
constexpr double arc_clearance = 0.5;
// The radius of a ball is at most a third of the gap size.
constexpr double gap_per_radius = 3;

// So many balls near a vertex are tested one by one, more are looked up in their hierarchy.
constexpr std::size_t most_nearby_balls = 24;

double radians(double degrees) { return degrees * 3.14159265358979323846 / 180; }

}  // namespace

void Refinement::prepare_collars() {
  CollarOptions options;
  options.size = [this](const Feature& feature, const Point& p) { return collar_size(feature, p); };
  options.distance = distance_;
  options.seed = options_.seed;
  options.stopped = [this](std::size_t balls) {
    planned_balls_ = balls;
    const bool stop = stopped();
    planned_balls_ = 0;
    return stop;
  };
  options.smallest_radius = floor_;
  options.outside = [this](const Point& p) { return frame_.outside(p); };
  const std::vector<Crease> creases = find_creases(plc_, options_.crease_angle);
  if (creases.empty()) return;
  if (options_.collar_creation == CollarCreation::in_pass) {
    collars_ = CollarSystem(plc_, points_, creases);
    placement_ = std::make_unique<CollarPlacement>(plc_, points_, gap_size(), options, collars_);
    return;
  }
  collars_ = CollarSystem(plc_, points_, creases, options);
  if (collars_.empty()) return;
  for (MeshVertex& v : vertices_) v.near_collar = true;
  take_up_balls(none, {none, none});
}

// The smallest target edge length of what is at this place of a vertex or curve.
double Refinement::collar_size(const Feature& feature, const Point& p) const {
  if (feature.dimension == 1) return sizing_.feature_size(1, feature.index, p);
  double size = sizing_.default_size(p);
  for (const Index curve : plc_.vertices[feature.index].curves)
    size = std::min(size, sizing_.feature_size(1, curve, p));
  for (const Index patch : plc_.vertices[feature.index].patches)
    size = std::min(size, sizing_.feature_size(2, patch, p));
  return size;
}

bool Refinement::zone_is_near_collar() const {
  return !collars_.empty() && std::any_of(zone_.vertices.begin(), zone_.vertices.end(),
                                          [&](Index v) { return vertices_[v].near_collar; });
}

// Replaces nearby_balls_ by the balls that meet B(v, R_v), which holds the centres of all cells around v.
bool Refinement::meets_collar(Index vertex) {
  if (!zone_is_near_collar()) return false;
  double largest = 0;
  for (const Index cell : zone_.created) largest = std::max(largest, mesh_.squared_radius(cell));
  collars_.balls_meeting(mesh_.point(vertex), std::sqrt(largest), most_nearby_balls, nearby_balls_);
  return !nearby_balls_.empty();
}

void Refinement::find_collar_cells(Index vertex) {
  if (vertices_[vertex].near_collar) {
    const bool all_known = nearby_balls_.size() < most_nearby_balls;
    for (const Index cell : zone_.created) {
      const Point& centre = mesh_.circumcentre(cell);
      const auto holds_centre = [&](Index ball) { return collars_.contains(ball, centre); };
      labels_[cell].in_collar = all_known
                                    ? std::any_of(nearby_balls_.begin(), nearby_balls_.end(), holds_centre)
                                    : collars_.ball_containing(centre) != none;
    }
  }
  if (collar_review_.started && zone_is_near_collar())
    for (const Index cell : zone_.created) touch(cell);
}

std::span<const Index> Refinement::patches_through(const CollarBall& ball) const {
  return ball.dimension == 0 ? plc_.vertices[ball.feature].patches : plc_.curves[ball.feature].patches;
}

bool Refinement::on_crease(Index vertex) const {
  const MeshVertex& v = vertices_[vertex];
  return (v.dimension == 0 && collars_.ball_at_vertex(v.feature) != none) ||
         (v.dimension == 1 && collars_.is_crease_curve(v.feature));
}

bool Refinement::spans_patch(std::span<const Index> corners) const {
  for (const Index v : corners) {
    const MeshVertex& m = vertices_[v];
    if (m.dimension == 3) return false;
  }
  const MeshVertex& m = vertices_[corners[0]];
  const auto contains_all = [&](Index patch) {
    return std::all_of(corners.begin(), corners.end(), [&](Index v) { return on_patch(v, patch); });
  };
  if (m.dimension == 2) return contains_all(m.feature);
  const auto& patches = m.dimension == 0 ? plc_.vertices[m.feature].patches : plc_.curves[m.feature].patches;
  return std::any_of(patches.begin(), patches.end(), contains_all);
}

// A smooth patch may fold at a curve inside it: a tet between its two sides is not flat.
bool Refinement::at_fold(std::span<const Index> corners) const {
  return std::any_of(corners.begin(), corners.end(), [&](Index v) {
    if (vertices_[v].dimension != 1) return false;
    const auto& patches = plc_.curves[vertices_[v].feature].patches;
    return patches.size() == 1 && !plc_.patches[patches[0]].planar;
  });
}

std::vector<CollarTriangle> Refinement::collar_triangles() {
  std::vector<CollarTriangle> triangles;
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    if (!mesh_.alive(cell) || labels_[cell].in_collar) continue;
    const auto& v = mesh_.corners(cell);
    if (std::none_of(v.begin(), v.end(), [&](Index i) { return vertices_[i].near_collar; })) continue;
    for (unsigned corner = 0; corner < 4; ++corner)
      if (const auto t = collar_triangle(face_id(cell, corner))) triangles.push_back(*t);
  }
  return triangles;
}

// The face seen from a cell outside, if its dual edge meets the collar surface.
std::optional<CollarTriangle> Refinement::collar_triangle(FaceId outer) {
  const FaceId inner = mesh_.opposite(outer);
  if (inner == no_face || labels_[cell_of(outer)].in_collar) return std::nullopt;
  const bool inside = labels_[cell_of(inner)].in_collar;
  if (!inside && cell_of(inner) < cell_of(outer)) return std::nullopt;
  const std::uint32_t generation = mesh_.generation(cell_of(outer));
  if (const Index taker = taken_in_by(cell_of(inner)); taker != none) {
    const CollarBall& ball = collars_.balls()[taker];
    const Vector d = triangle_circumcentre(outer) - ball.centre;
    return CollarTriangle{outer, generation, taker, ball.centre + ball.radius / norm(d) * d, false};
  }
  if (labels_[cell_of(outer)].off_collars >> corner_of(outer) & 1U) return std::nullopt;
  // A dual edge lies in the Voronoi cells of the triangle's vertices.
  const auto v = mesh_.face_vertices(outer);
  const Point p = mesh_.circumcentre(cell_of(outer)), q = mesh_.circumcentre(cell_of(inner));
  nodes_scratch_.clear();
  if (std::all_of(v.begin(), v.end(), [&](Index i) { return vertices_[i].near_collar; }))
    collars_.balls_on_segment(p, q, nodes_scratch_);
  if (nodes_scratch_.empty()) {
    labels_[cell_of(outer)].off_collars |= static_cast<std::uint8_t>(1U << corner_of(outer));
    return std::nullopt;
  }
  // The parts of the dual edge inside each ball, as parameters from p to q.
  struct Part {
    double from, to;
    Index ball;
  };
  std::vector<Part> parts;
  const Vector d = q - p;
  const double length = squared_norm(d);
  for (const Index index : nodes_scratch_) {
    const CollarBall& ball = collars_.balls()[index];
    const double middle = dot(ball.centre - p, d) / length;
    const double off = squared_distance(ball.centre, p + middle * d);
    const double half = std::sqrt(std::max(0.0, (ball.radius * ball.radius - off) / length));
    parts.push_back({middle - half, middle + half, index});
  }
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.from < b.from; });
  double covered = parts[0].to;
  bool several = !inside;
  for (const Part& part : parts) {
    if (part.from > covered) several = true;
    covered = std::max(covered, part.to);
  }
  return CollarTriangle{outer, generation, parts[0].ball, p + parts[0].from * d, several};
}

// The triangle alone: everything but what its neighbours decide.
bool Refinement::poorly_represented(const CollarTriangle& t) {
  const Index outer = cell_of(t.face);
  const FaceId inner = mesh_.opposite(t.face);
  if (labels_[outer].region == 0 && (t.several ? labels_[cell_of(inner)].region == 0 : true)) return false;
  if (t.several) return true;
  const auto v = mesh_.face_vertices(t.face);
  for (const Index vertex : v)
    if (on_crease(vertex)) return true;
  // A patch between the outer cell and the sphere: the star tet would lie on its other side.
  if (labels_[outer].marked >> corner_of(t.face) & 1U && !restricted(t.face).in_collar) return true;
  const CollarBall& ball = collars_.balls()[t.ball];
  const Index centre_vertex = unresolved_[ball_points_[t.ball]].vertex;
  if (centre_vertex == none) return true;
  if (spans_patch(std::array{v[0], v[1], v[2], centre_vertex}) && !at_fold(v)) return true;
  const Point &a = mesh_.point(v[0]), &b = mesh_.point(v[1]), &c = mesh_.point(v[2]);
  if (predicates::orientation(a, b, c, ball.centre) <= 0) return true;
  const TetQuality quality = measure(a, b, c, ball.centre);
  if (quality.max_dihedral > options_.collar_angle) return true;
  if (taken_in_by(cell_of(inner)) == none) {
    const Vector along = mesh_.circumcentre(cell_of(inner)) - mesh_.circumcentre(outer);
    const Vector normal = ball.centre - t.representation;
    if (dot(along, normal) < std::cos(radians(options_.representation_angle)) * norm(along) * norm(normal))
      return true;
  }
  return crosses_patch(ball, v[0], v[1]) || crosses_patch(ball, v[1], v[2]) ||
         crosses_patch(ball, v[2], v[0]);
}

bool Refinement::far_from_patch(Index patch, const Point& p) const {
  Index nearest = none;
  collars_.features().distance_within({2, patch}, p, distance_, nearest, [](Index) { return true; });
  return nearest == none;
}

// An edge on a smooth patch makes a face with the ball's centre there: does it leave the patch by
// more than the tolerance?
bool Refinement::bends(CollarTriangle& t) const {
  if (labels_[cell_of(t.face)].region == 0) return false;
  const CollarBall& ball = collars_.balls()[t.ball];
  const auto v = mesh_.face_vertices(t.face);
  for (const Index patch : patches_through(ball)) {
    if (plc_.patches[patch].planar) continue;
    for (unsigned k = 0; k < 3; ++k) {
      const Index i = v[k], j = v[(k + 1) % 3];
      if (on_patch(i, patch)) {
        // The edge to the centre, which is longer than the radius where i is not on the sphere.
        const Vector spoke = mesh_.point(i) - ball.centre;
        for (const double share : {0.4, 0.65}) {
          if (!far_from_patch(patch, ball.centre + share * spoke)) continue;
          t.bent_on = patch;
          t.bent_at = ball.centre + share * spoke;
          return true;
        }
      }
      if (!on_patch(i, patch) || !on_patch(j, patch)) continue;
      const Point &a = mesh_.point(i), &b = mesh_.point(j);
      const Point middle = 0.5 * (a + b);
      if (squared_distance(a, b) < distance_ * distance_) continue;
      if (!far_from_patch(patch, middle) && !far_from_patch(patch, (a + b + ball.centre) / 3)) continue;
      t.bent_on = patch;
      t.bent_at = middle;
      return true;
    }
  }
  return false;
}

// The edge and the ball's centre make a face between two regions. Does it lead from one sheet of a smooth
// patch to another? In balls smaller than the distance tolerance that does not tell.
bool Refinement::spans_sheets(const CollarBall& ball, Index a, Index b) const {
  constexpr double largest_sagitta = 0.15;  // a turn of 30 degrees makes 0.13
  const Point middle = 0.5 * (mesh_.point(a) + mesh_.point(b));
  const double most = largest_sagitta * distance(mesh_.point(a), mesh_.point(b));
  if (most >= distance_) return false;
  bool found = false;
  for (const Index patch : patches_through(ball)) {
    if (!on_patch(a, patch) || !on_patch(b, patch)) continue;
    if (plc_.patches[patch].planar ||
        squared_distance(middle, collars_.features().nearest_point({2, patch}, middle)) <= most * most)
      return false;
    found = true;
  }
  return found;
}

// A point near a given one where a patch through the ball's centre meets its sphere.
std::optional<Point> Refinement::arc_point(const CollarBall& ball, Index patch, const Point& near) const {
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
    if (distance(p, q) < close * ball.radius) return plc_.patches[patch].planar ? on_plane(patch, p) : p;
  }
  return std::nullopt;
}

// Does an edge of a star cross a patch? Only those through the ball's centre come so near to it, the
// others are three radii away.
bool Refinement::crosses_patch(const CollarBall& ball, Index a, Index b) {
  const Point &p = mesh_.point(a), &q = mesh_.point(b);
  const double reach = gap_per_radius * ball.radius;
  const bool near =
      squared_distance(p, ball.centre) < reach * reach && squared_distance(q, ball.centre) < reach * reach;
  const auto on_one_side = [&](Index patch) {
    const Plc::Patch& plane = plc_.patches[patch];
    if (on_patch(a, patch) || on_patch(b, patch))
      return plane.planar || (on_patch(a, patch) && on_patch(b, patch));
    if (!plane.planar) return false;
    const Point origin = frame_.inside(plane.origin);
    return dot(plane.normal, p - origin) * dot(plane.normal, q - origin) > 0;
  };
  const auto patches = patches_through(ball);
  if (near && std::all_of(patches.begin(), patches.end(), on_one_side)) return false;
  const Index root = hierarchy_.root();
  hierarchy_.crossings(p, q, {&root, 1}, crossings_);
  return std::any_of(crossings_.begin(), crossings_.end(), [&](const auto& crossing) {
    const Index patch = plc_.triangles[crossing.triangle].patch;
    const bool a_on = on_patch(a, patch), b_on = on_patch(b, patch);
    if (a_on == b_on) return !a_on;
    return !plc_.patches[patch].planar &&
           on_another_sheet(ball, mesh_.point(a_on ? a : b), crossing.triangle);
  });
}

// A smooth patch may pass through a ball's centre in several sheets, of which an edge may begin on one and
// cross another. A sheet leaves its chords by the shares that the balls are made for (collar/flatness.cpp):
// by h over a radius r, with a triangle tilted by about 4 h / r; so a point of it is off the triangle's plane
// by less than 8 h, where h is half the distance tolerance at most, and less than r / 2.
bool Refinement::on_another_sheet(const CollarBall& ball, const Point& p, Index triangle) const {
  const auto [a, b, c] = hierarchy_.corners(triangle);
  const Vector normal = cross(b - a, c - a);
  return std::fabs(dot(p - a, normal)) > std::min(4 * distance_, 0.5 * ball.radius) * norm(normal);
}

bool Refinement::poor_book(const CollarTriangle& t, const CollarTriangle& u,
                           const std::array<Index, 2>& edge) const {
  if (labels_[cell_of(t.face)].region == 0 && labels_[cell_of(u.face)].region == 0) return false;
  if (labels_[cell_of(t.face)].region != labels_[cell_of(u.face)].region) return true;
  const auto v = mesh_.face_vertices(t.face);
  unsigned first = 0;
  while (!(v[first] == edge[0] && v[(first + 1) % 3] == edge[1]) &&
         !(v[first] == edge[1] && v[(first + 1) % 3] == edge[0]))
    ++first;
  const Point &a = mesh_.point(v[first]), &b = mesh_.point(v[(first + 1) % 3]);
  const Point &p = collars_.balls()[t.ball].centre, &q = collars_.balls()[u.ball].centre;
  return predicates::orientation(b, a, q, p) <= 0 || measure(b, a, q, p).max_dihedral > options_.collar_angle;
}

// Insert the representation point, or the nearest point of an arc where a patch through the ball's
// centre meets the sphere.
bool Refinement::repair(const CollarTriangle& t) {
  const CollarBall& ball = collars_.balls()[t.ball];
  const auto v = mesh_.face_vertices(t.face);
  const double clearance = arc_clearance * distance(t.representation, mesh_.point(v[0]));
  Point best = t.representation;
  Index patch = none;
  double nearest = arc_reach * ball.radius;
  for (const Index p : patches_through(ball)) {
    const bool bent = t.bent_on == p;
    const auto found = arc_point(ball, p, bent ? t.bent_at : t.representation);
    if (!found) continue;
    const Point arc = frame_.rounded(*found);
    const double off = bent ? 0 : distance(arc, t.representation);
    if (off >= nearest) continue;
    const Index other = collars_.ball_containing(ball.centre + (1 + 1e-9) * (arc - ball.centre));
    if (other != none) continue;
    const double gap = distance(arc, mesh_.point(walk_.nearest(arc, v[0])));
    if (gap < (bent ? 0.1 * distance_ : clearance)) continue;
    nearest = off;
    best = arc;
    patch = p;
  }
  if (t.bent_on != none && patch == none) return false;
  return insert_on_collar(best, patch == none ? 3 : 2, patch, v[0]);
}

bool Refinement::insert_on_collar(const Point& p, std::uint8_t dimension, Index feature, Index nearby) {
  const Point rounded = frame_.rounded(p);
  const Index nearest = walk_.nearest(rounded, nearby);
  const Index cell = mesh_.conflicting_cell_around(nearest, rounded);
  const double gap = distance(rounded, mesh_.point(nearest));
  if (cell == none || gap < floor_) return false;  // what stays poor is for the certificate to tell
  mesh_.find_conflict_zone(rounded, cell, zone_);
  force_insert(dimension, feature);
  return true;
}

}  // namespace collarmesh
