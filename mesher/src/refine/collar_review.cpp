#include "refine/collar_review.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "common/sort_uniquely.h"

namespace collarmesh {

namespace {

constexpr std::size_t triangles_between_stops = 64;
constexpr double on_sphere = 1e-6;
// A cell is flat if six times its volume is below this share of the cube of the longest edge at its first
// corner.
constexpr double flat_volume = 1e-7;

// Visits the faces around the edge ab, from a given cell at the edge on. If the edge lies on the hull, stops
// after the first face on the hull.
template <class Visit>
void visit_faces_around(const RefinedMesh& mesh, Index cell, Index a, Index b, const Visit& visit) {
  const auto other_corner = [&](Index at, unsigned but) {
    const auto& v = mesh.corners(at);
    unsigned corner = 0;
    while (corner == but || v[corner] == a || v[corner] == b) ++corner;
    return face_id(at, corner);
  };
  const FaceId first = other_corner(cell, 4);
  for (FaceId face = first;;) {
    visit(face);
    const FaceId beyond = mesh.opposite(face);
    if (beyond == no_face) return;
    face = other_corner(cell_of(beyond), corner_of(beyond));
    if (face == first) return;
  }
}

}  // namespace

void CollarReview::cells_made(const ConflictZone& zone) {
  changed_ = true;
  if (!started_) return;
  touched_.resize(mesh_.cell_capacity(), 0);
  for (const Index cell : zone.created) touched_[cell] = 0;
  if (!cells_.any_near(zone)) return;
  for (const Index cell : zone.created) touch(cell);
}

void CollarReview::vertex_joined_feature(Index vertex) {
  changed_ = true;
  if (!started_ || !cells_.near(vertex)) return;
  mesh_.incident_cells(vertex, scratch_);
  for (const Index cell : scratch_) touch(cell);
}

bool CollarReview::check() {
  if (collars_.empty()) return false;
  assert(queue_.first_priority() == WorkQueue::priority_count);
  if (!started_) start();
  if (!std::exchange(changed_, false)) return false;
  std::vector<Index> cells = take_touched();
  take_in_flat_cells(cells);
  if (!judge_changed_triangles(cells)) return false;
  find_exposed_vertices(cells);
  const std::size_t before = queue_.pushed();
  queue_exposed_vertices();
  queue_poor_triangles();
  return queue_.pushed() > before;
}

// Starts the reviews: touches all cells near collars. Voronoi cells have become smaller since the collars
// were created, so fewer vertices are near collars now.
void CollarReview::start() {
  started_ = true;
  collars_.complete();
  cells_.forget_far_vertices();
  for (Index ball = 0; ball < collars_.balls().size(); ++ball)
    if (creator_.vertex_of(ball) != none) ball_at_.emplace(creator_.vertex_of(ball), ball);
  for (Index v = 0; v < mesh_.vertex_count(); ++v)
    if (collar_surface_.on_crease(v))
      if (const Index ball = collars_.ball_containing(mesh_.point(v)); ball != none)
        ball_at_.emplace(v, ball);
  touched_.resize(mesh_.cell_capacity(), 0);
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    if (!mesh_.alive(cell)) continue;
    const auto& v = mesh_.corners(cell);
    if (std::ranges::any_of(v, [&](Index i) { return cells_.near(i); })) touch(cell);
  }
}

void CollarReview::touch(Index cell) {
  if (std::exchange(touched_[cell], 1) == 0) touched_cells_.push_back(cell);
}

// Returns the touched cells that still exist. A cell that replaced a touched one is itself touched.
std::vector<Index> CollarReview::take_touched() {
  std::vector<Index> cells;
  cells.swap(touched_cells_);
  std::erase_if(cells, [&](Index cell) { return !mesh_.alive(cell) || touched_[cell] == 0; });
  sort_uniquely(cells);
  for (const Index cell : cells) touched_[cell] = 0;
  return cells;
}

// Adds flat cells just outside a collar to the collar. They arise where the spheres of consecutive balls meet
// in circles: the points in which two neighbouring circles cross two neighbouring sheets of the surface lie
// on one circle, so these four points may form a flat cell. Appends these cells to `cells`.
void CollarReview::take_in_flat_cells(std::vector<Index>& cells) {
  std::vector<Index> candidates = cells;
  const auto add_neighbours = [&](Index cell) {
    for (unsigned corner = 0; corner < 4; ++corner)
      if (const FaceId other = mesh_.opposite(face_id(cell, corner)); other != no_face)
        candidates.push_back(cell_of(other));
  };
  for (const Index cell : cells)
    if (cells_.inside(cell)) add_neighbours(cell);
  sort_uniquely(candidates);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Index cell = candidates[i], ball = ball_to_take_in(cell);
    if (ball == none) continue;
    cells_.take_in(cell, ball);
    cells.push_back(cell);
    add_neighbours(cell);
  }
  sort_uniquely(cells);
}

// Returns the ball whose collar a cell joins; none if it stays outside. A cell joins if it is flat, its
// corners lie on features and on the ball's sphere, and it shares a triangle with the collar.
Index CollarReview::ball_to_take_in(Index cell) {
  if (cells_.inside(cell) || surface_.region(cell) == 0) return none;
  const auto& v = mesh_.corners(cell);
  if (std::ranges::any_of(v, [&](Index i) { return !cells_.near(i) || mesh_.feature(i).dimension == 3; }))
    return none;
  const Point &a = mesh_.point(v[0]), &b = mesh_.point(v[1]), &c = mesh_.point(v[2]), &d = mesh_.point(v[3]);
  const double longest = std::max({squared_distance(a, b), squared_distance(a, c), squared_distance(a, d)});
  if (std::fabs(six_volume(a, b, c, d)) > flat_volume * longest * std::sqrt(longest)) return none;
  for (unsigned corner = 0; corner < 4; ++corner) {
    const FaceId other = mesh_.opposite(face_id(cell, corner));
    if (other == no_face || !cells_.inside(cell_of(other))) continue;
    const auto t = collar_surface_.triangle(face_id(cell, corner));
    if (!t) continue;
    const CollarBall& ball = collars_.balls()[t->ball];
    if (std::ranges::all_of(v, [&](Index i) {
          return std::fabs(distance(mesh_.point(i), ball.centre) - ball.radius) < on_sphere * ball.radius;
        }))
      return t->ball;
  }
  return none;
}

// Judges the triangles of these cells, and triangles from earlier reviews that share an edge with the border
// of these cells. Returns false when stopped.
bool CollarReview::judge_changed_triangles(const std::vector<Index>& cells) {
  for (const Index cell : cells) touched_[cell] = 1;
  std::size_t looked_at = 0;
  std::vector<FaceId> changed, border;
  for (const Index cell : cells)
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId face = face_id(cell, corner), other = mesh_.opposite(face);
      if (other == no_face) continue;
      if (touched_[cell_of(other)] == 0)
        border.push_back(face);
      else if (cell_of(other) < cell)
        continue;
      for (const FaceId outer : {face, other}) {
        auto t = collar_surface_.triangle(outer);
        if (!t) continue;  // a record of this face, if there is one, is obsolete
        if (++looked_at % triangles_between_stops == 0 && stopped_()) return false;
        t->poor_alone = collar_surface_.poor_alone(*t);
        triangles_.insert_or_assign(*t);
        changed.push_back(outer);
      }
    }
  for (const FaceId face : border) {
    const auto v = mesh_.face_vertices(face);
    for (unsigned k = 0; k < 3; ++k)
      visit_faces_around(mesh_, cell_of(face), v[k], v[(k + 1) % 3], [&](FaceId around) {
        if (const CollarTriangle* t = known_triangle(around)) changed.push_back(t->face);
      });
  }
  for (const Index cell : cells) touched_[cell] = 0;
  sort_uniquely(changed);
  for (const FaceId face : changed) {
    CollarTriangle& t = *triangles_.find(face, mesh_.generation(cell_of(face)));
    const auto v = mesh_.face_vertices(face);
    t.poor = t.poor_alone || poor_edge(t, v[0], v[1]) || poor_edge(t, v[1], v[2]) || poor_edge(t, v[2], v[0]);
    if (t.poor && surface_.region(cell_of(face)) != 0) poor_.push_back(face);
  }
  return true;
}

// Returns the record of a face that is a collar triangle, seen from either side; null if there is none.
const CollarTriangle* CollarReview::known_triangle(FaceId face) const {
  const FaceId other = mesh_.opposite(face);
  if (other == no_face) return nullptr;
  const bool inside = cells_.inside(cell_of(face)), beyond = cells_.inside(cell_of(other));
  if (inside && beyond) return nullptr;
  const FaceId outer = inside || (!beyond && cell_of(other) < cell_of(face)) ? other : face;
  if (collar_surface_.is_off(outer)) return nullptr;
  return triangles_.find(outer, mesh_.generation(cell_of(outer)));
}

// Returns whether an edge is poor. It must have exactly two collar triangles, of one ball or of consecutive
// balls. If they are of one ball, an edge between two regions must not lead from one sheet of a patch to
// another. If they are of two balls, the book tet on the edge and the two centres must not be inverted and
// must keep the angle bound.
bool CollarReview::poor_edge(const CollarTriangle& t, Index a, Index b) const {
  const CollarTriangle* neighbour = nullptr;
  std::size_t count = 0;
  visit_faces_around(mesh_, cell_of(t.face), a, b, [&](FaceId face) {
    const CollarTriangle* found = known_triangle(face);
    if (found == nullptr) return;
    ++count;
    if (found->face != t.face) neighbour = found;
  });
  if (count != 2) return true;
  if (t.ball == neighbour->ball)
    return surface_.region(cell_of(t.face)) != surface_.region(cell_of(neighbour->face)) &&
           collar_surface_.spans_sheets(collars_.balls()[t.ball], a, b);
  return !collars_.consecutive(t.ball, neighbour->ball) ||
         collar_surface_.poor_book(t, *neighbour, {std::min(a, b), std::max(a, b)});
}

// Finds mesh vertices on creases (usually centres of balls) that are corners of cells outside the collars:
// the spheres around them have too few mesh vertices as yet.
void CollarReview::find_exposed_vertices(const std::vector<Index>& cells) {
  for (const Index cell : cells) {
    if (surface_.region(cell) == 0 || cells_.inside(cell)) continue;
    for (const Index v : mesh_.corners(cell)) {
      if (!collar_surface_.on_crease(v)) continue;
      const auto ball = ball_at_.find(v);
      if (ball != ball_at_.end()) exposed_.push_back(v);
    }
  }
  sort_uniquely(exposed_);
}

// Returns the cells at a vertex that lie in a region and outside the collars.
const std::vector<Index>& CollarReview::cells_outside(Index vertex) {
  mesh_.incident_cells(vertex, scratch_);
  std::erase_if(scratch_, [&](Index cell) { return surface_.region(cell) == 0 || cells_.inside(cell); });
  return scratch_;
}

void CollarReview::queue_exposed_vertices() {
  for (const Index vertex : std::exchange(exposed_, {})) {
    if (cells_outside(vertex).empty()) continue;
    const double radius = collars_.balls()[ball_at_.at(vertex)].radius;
    queue_.push(WorkQueue::exposed_crease_vertices, radius * radius, {vertex, 0});
  }
}

void CollarReview::queue_poor_triangles() {
  sort_uniquely(poor_);
  for (const FaceId face : std::exchange(poor_, {})) {
    const CollarTriangle* t = known_triangle(face);
    if (t == nullptr || t->face != face || !t->poor) continue;
    const double squared_radius =
        squared_distance(t->representation, mesh_.point(mesh_.face_vertices(face)[0]));
    queue_.push(WorkQueue::poor_collar_triangles, squared_radius, {face, mesh_.generation(cell_of(face))});
  }
}

std::optional<Candidate> CollarReview::candidate(const WorkQueue::Item& item) {
  return item.priority == WorkQueue::exposed_crease_vertices ? candidate_at_vertex(item.entry.id)
                                                             : candidate_on_triangle(item.entry);
}

// Returns a point on the sphere of the vertex's ball, in the direction of the circumcentre of a cell outside
// the collars.
std::optional<Candidate> CollarReview::candidate_at_vertex(Index vertex) {
  for (const Index outside : cells_outside(vertex))
    if (auto found = candidate_towards(outside, vertex)) {
      exposed_.push_back(vertex);  // the candidate may yield: review the vertex again
      return found;
    }
  return std::nullopt;
}

std::optional<Candidate> CollarReview::candidate_towards(Index outside, Index vertex) const {
  const Index b = ball_at_.at(vertex);
  const CollarBall& ball = collars_.balls()[b];
  const auto& v = mesh_.corners(outside);
  const auto corner = static_cast<unsigned>(std::ranges::find(v, vertex) - v.begin());
  const Vector d = mesh_.circumcentre(outside) - ball.centre;
  return collar_surface_.repair({face_id(outside, corner), mesh_.generation(outside), b,
                                 ball.centre + ball.radius / norm(d) * d, false});
}

std::optional<Candidate> CollarReview::candidate_on_triangle(const WorkQueue::Entry& entry) {
  const FaceId face = entry.id;
  if (!mesh_.alive(cell_of(face), entry.stamp)) return std::nullopt;
  const CollarTriangle* t = known_triangle(face);
  if (t == nullptr || t->face != face || !t->poor || touched_[cell_of(face)] != 0 ||
      touched_[cell_of(mesh_.opposite(face))] != 0)
    return std::nullopt;
  auto found = collar_surface_.repair(*t);
  if (found) poor_.push_back(face);  // the candidate may yield: review the triangle again
  return found;
}

}  // namespace collarmesh
