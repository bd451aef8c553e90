// The collar surface is looked at in rounds when everything else is done (paper, section 4): what is poorly
// represented is mended, then looked at again. A round judges the triangles around the cells that were
// created since the one before, so that all rounds together cost what was created.
#include <algorithm>

#include "delaunay/predicates.h"
#include "refine/refinement.h"

namespace collarmesh {

namespace {

constexpr unsigned most_rounds = 200;
constexpr std::size_t triangles_between_stops = 64;
constexpr double on_sphere = 1e-6;
// A cell whose volume is below this share of its longest edge cubed is flat.
constexpr double flat_volume = 1e-7;

void sort_and_make_unique(std::vector<Index>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

// The faces around an edge of a cell; all of them unless the edge lies on the hull.
template <class Visit>
void visit_faces_around(const Triangulation& mesh, Index cell, Index a, Index b, const Visit& visit) {
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

bool Refinement::check_collars() {
  if (collars_.empty() || !message_.empty()) return false;
  if (!collar_review_.started) start_review();
  std::vector<Index> cells = touched_cells();
  take_in_flat_cells(cells);
  if (!judge_changed_triangles(cells)) return false;
  find_exposed_centres(cells);
  bool found = surround_centres();
  found |= mend_poor_triangles();
  if (found && ++collar_rounds_ > most_rounds) {
    give_up(mesh_.point(last_vertex()), "the collar surface did not settle; the last vertex is",
            "raise collar-angle, or try a smaller size or another seed");
    return false;
  }
  return found;
}

// Everything is new. Voronoi cells have become smaller: fewer vertices are near collars than when they came.
void Refinement::start_review() {
  collar_review_.started = true;
  collars_.complete();
  for (Index v = 0; v < mesh_.vertex_count(); ++v) {
    if (!vertices_[v].near_collar) continue;
    mesh_.incident_cells(v, cells_scratch_);
    double largest = 0;
    for (const Index cell : cells_scratch_) largest = std::max(largest, mesh_.squared_radius(cell));
    collars_.balls_meeting(mesh_.point(v), std::sqrt(largest), 1, nearby_balls_);
    vertices_[v].near_collar = !nearby_balls_.empty();
  }
  for (Index ball = 0; ball < collars_.balls().size(); ++ball)
    if (ball_vertex(ball) != none) collar_review_.ball_at.emplace(ball_vertex(ball), ball);
  for (Index v = 0; v < mesh_.vertex_count(); ++v)
    if (on_crease(v))
      if (const Index ball = collars_.ball_containing(mesh_.point(v)); ball != none)
        collar_review_.ball_at.emplace(v, ball);
  for (Index cell = 0; cell < mesh_.cell_capacity(); ++cell) {
    if (!mesh_.alive(cell)) continue;
    const auto& v = mesh_.corners(cell);
    if (std::any_of(v.begin(), v.end(), [&](Index i) { return vertices_[i].near_collar; })) touch(cell);
  }
}

void Refinement::touch(Index cell) {
  if (labels_[cell].touched) return;
  labels_[cell].touched = true;
  collar_review_.touched.push_back(cell);
}

// Those that are still there. A cell that takes the place of one is touched itself.
std::vector<Index> Refinement::touched_cells() {
  std::vector<Index> cells;
  cells.swap(collar_review_.touched);
  std::erase_if(cells, [&](Index cell) { return !mesh_.alive(cell) || !labels_[cell].touched; });
  sort_and_make_unique(cells);
  for (const Index cell : cells) labels_[cell].touched = false;
  return cells;
}

// Corner points of neighbouring circles on neighbouring sheets are cocircular: a flat cell of them
// just outside the collar is given to it. Adds what is given to the cells.
void Refinement::take_in_flat_cells(std::vector<Index>& cells) {
  std::vector<Index> candidates = cells;
  const auto add_neighbours = [&](Index cell) {
    for (unsigned corner = 0; corner < 4; ++corner)
      if (const FaceId other = mesh_.opposite(face_id(cell, corner)); other != no_face)
        candidates.push_back(cell_of(other));
  };
  for (const Index cell : cells)
    if (labels_[cell].in_collar) add_neighbours(cell);
  sort_and_make_unique(candidates);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Index cell = candidates[i], ball = ball_to_take_in(cell);
    if (ball == none) continue;
    labels_[cell].in_collar = true;
    taken_in_[cell] = {ball, mesh_.generation(cell)};
    cells.push_back(cell);
    add_neighbours(cell);
  }
  sort_and_make_unique(cells);
}

// The ball that a flat cell is given to, none when it stays outside.
Index Refinement::ball_to_take_in(Index cell) {
  if (labels_[cell].in_collar || labels_[cell].region == 0) return none;
  const auto& v = mesh_.corners(cell);
  if (std::any_of(v.begin(), v.end(),
                  [&](Index i) { return !vertices_[i].near_collar || vertices_[i].dimension == 3; }))
    return none;
  const Point &a = mesh_.point(v[0]), &b = mesh_.point(v[1]), &c = mesh_.point(v[2]), &d = mesh_.point(v[3]);
  const double longest = std::max({squared_distance(a, b), squared_distance(a, c), squared_distance(a, d)});
  if (std::fabs(six_volume(a, b, c, d)) > flat_volume * longest * std::sqrt(longest)) return none;
  for (unsigned corner = 0; corner < 4; ++corner) {
    const FaceId other = mesh_.opposite(face_id(cell, corner));
    if (other == no_face || !labels_[cell_of(other)].in_collar) continue;
    const auto t = collar_triangle(face_id(cell, corner));
    if (!t) continue;
    const CollarBall& ball = collars_.balls()[t->ball];
    if (std::all_of(v.begin(), v.end(), [&](Index i) {
          return std::fabs(distance(mesh_.point(i), ball.centre) - ball.radius) < on_sphere * ball.radius;
        }))
      return t->ball;
  }
  return none;
}

Index Refinement::taken_in_by(Index cell) const {
  const auto taken = taken_in_.find(cell);
  return taken != taken_in_.end() && taken->second.generation == mesh_.generation(cell) ? taken->second.ball
                                                                                        : none;
}

// Judge the triangles of these cells, and those that share an edge with what these cells have replaced.
// False when stopped.
bool Refinement::judge_changed_triangles(const std::vector<Index>& cells) {
  auto& triangles = collar_review_.triangles;
  for (const Index cell : cells) labels_[cell].touched = true;
  std::size_t looked_at = 0;
  std::vector<FaceId> changed, border;
  for (const Index cell : cells)
    for (unsigned corner = 0; corner < 4; ++corner) {
      const FaceId face = face_id(cell, corner), other = mesh_.opposite(face);
      if (other == no_face) continue;
      if (!labels_[cell_of(other)].touched)
        border.push_back(face);
      else if (cell_of(other) < cell)
        continue;
      for (const FaceId outer : {face, other}) {
        auto t = collar_triangle(outer);
        if (!t) continue;  // what was known of this face is not asked for any more
        if (++looked_at % triangles_between_stops == 0 && stopped()) return false;
        t->poor_alone = poorly_represented(*t) || bends(*t);
        triangles.insert_or_assign(*t);
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
  for (const Index cell : cells) labels_[cell].touched = false;
  sort_and_make_unique(changed);
  for (const FaceId face : changed) {
    CollarTriangle& t = *triangles.find(face, mesh_.generation(cell_of(face)));
    const auto v = mesh_.face_vertices(face);
    t.poor = t.poor_alone || poor_edge(t, v[0], v[1]) || poor_edge(t, v[1], v[2]) || poor_edge(t, v[2], v[0]);
    if (t.poor && labels_[cell_of(face)].region != 0) collar_review_.poor.push_back(face);
  }
  return true;
}

// The collar triangle of a face seen from either side, if it is one.
const CollarTriangle* Refinement::known_triangle(FaceId face) const {
  const FaceId other = mesh_.opposite(face);
  if (other == no_face) return nullptr;
  const bool inside = labels_[cell_of(face)].in_collar, beyond = labels_[cell_of(other)].in_collar;
  if (inside && beyond) return nullptr;
  const FaceId outer = inside || (!beyond && cell_of(other) < cell_of(face)) ? other : face;
  if (labels_[cell_of(outer)].off_collars >> corner_of(outer) & 1U) return nullptr;
  return collar_review_.triangles.find(outer, mesh_.generation(cell_of(outer)));
}

// What neighbours decide: every edge has two triangles, of one ball or of consecutive ones, and then
// the book tet between their centres is not inverted and keeps the angle bound.
bool Refinement::poor_edge(const CollarTriangle& t, Index a, Index b) const {
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
    return labels_[cell_of(t.face)].region != labels_[cell_of(neighbour->face)].region &&
           spans_sheets(collars_.balls()[t.ball], a, b);
  return !collars_.consecutive(t.ball, neighbour->ball) ||
         poor_book(t, *neighbour, {std::min(a, b), std::max(a, b)});
}

// A centre, or another point of a crease, must not be a vertex of cells outside: their part of the sphere has
// no points yet.
void Refinement::find_exposed_centres(const std::vector<Index>& cells) {
  for (const Index cell : cells) {
    if (labels_[cell].region == 0 || labels_[cell].in_collar) continue;
    for (const Index v : mesh_.corners(cell)) {
      if (!on_crease(v)) continue;
      const auto ball = collar_review_.ball_at.find(v);
      if (ball != collar_review_.ball_at.end()) collar_review_.exposed.push_back(v);
    }
  }
  sort_and_make_unique(collar_review_.exposed);
}

// False when nothing was inserted.
bool Refinement::surround_centres() {
  bool found = false;
  std::erase_if(collar_review_.exposed, [&](Index vertex) {
    const Index b = collar_review_.ball_at.at(vertex);
    const CollarBall& ball = collars_.balls()[b];
    mesh_.incident_cells(vertex, cells_scratch_);
    const auto outside = std::find_if(cells_scratch_.begin(), cells_scratch_.end(), [&](Index cell) {
      return labels_[cell].region != 0 && !labels_[cell].in_collar;
    });
    if (outside == cells_scratch_.end()) return true;
    const auto& v = mesh_.corners(*outside);
    const auto corner = static_cast<unsigned>(std::find(v.begin(), v.end(), vertex) - v.begin());
    const Vector d = mesh_.circumcentre(*outside) - ball.centre;
    found |= repair({face_id(*outside, corner), mesh_.generation(*outside), b,
                     ball.centre + ball.radius / norm(d) * d, false});
    return false;
  });
  return found;
}

// False when nothing was inserted.
bool Refinement::mend_poor_triangles() {
  bool found = false;
  std::vector<FaceId> poor;
  poor.swap(collar_review_.poor);
  sort_and_make_unique(poor);
  std::size_t looked_at = 0;
  for (const FaceId face : poor) {
    if (++looked_at % triangles_between_stops == 0 && stopped()) return false;
    const CollarTriangle* t = known_triangle(face);
    if (t == nullptr || t->face != face || !t->poor) continue;
    // What an earlier repair has changed is judged anew in the next round.
    if (!labels_[cell_of(face)].touched && !labels_[cell_of(mesh_.opposite(face))].touched)
      found |= repair(CollarTriangle(*t));
    collar_review_.poor.push_back(face);
  }
  return found;
}

}  // namespace collarmesh
