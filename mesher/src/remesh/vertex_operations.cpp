// Operations on cones of tets: their apex is moved, inserted, or moved onto another vertex.
#include <algorithm>
#include <initializer_list>
#include <tuple>

#include "common/contains.h"
#include "common/index_set.h"
#include "common/sort_uniquely.h"
#include "remesh/operations.h"
#include "remesh/shape.h"

namespace collarmesh::remeshing {

namespace {

// The first step by which a vertex is moved, relative to its shortest edge. Later steps are shorter.
constexpr double first_step = 0.4;

}  // namespace

// Finds the tets and the mesh's faces at a vertex. Returns false if the vertex is fixed, if a tet or a face
// at it has to stay, or if the tets are not connected by faces.
bool Operations::find_cone_of_vertex(Index vertex) {
  cone_.clear();
  if (complex_.pinched(vertex) || edited_.is_fixed(vertex)) return false;
  complex_.star(vertex, cone_.tets);
  return make_cone_of_vertex(vertex);
}

// Completes the cone of a vertex from `cone_.tets`. Returns false if a tet or a face at it has to stay.
bool Operations::make_cone_of_vertex(Index vertex) {
  const bool on_feature = mesh_.features[vertex].dimension < 3;
  for (const Index t : cone_.tets) {
    const auto& tet = complex_[t];
    if (untouchable(tet)) return false;
    for (unsigned corner = 0; corner < 4; ++corner) {
      if (tet.corners[corner] == vertex) {
        cone_.hull.push_back(side_corners(tet.corners, corner));
        cone_.hull_tet.push_back(t);
      } else if (on_feature && tet.faces[corner] != none && !contains(cone_.faces, tet.faces[corner])) {
        if (stays(tet.faces[corner])) return false;
        add_to_rim(tet.faces[corner], vertex);
      }
    }
  }
  return true;
}

// Finds the tets at an edge inside a region or a patch, and the two faces there. Returns false if no vertex
// may be inserted.
bool Operations::find_cone_of_edge(Index a, Index b) {
  if (complex_.on_curve(a, b)) return false;
  const Index at = complex_.tet_at_edge(a, b);
  if (at == none) return false;
  complex_.ring(at, a, b, ring_);
  if (!ring_.closed && edited_.is_fixed(a) && edited_.is_fixed(b)) return false;
  return ring_.tets.size() <= largest_ring && make_cone_of_edge(a, b) && faces_are_of_one_patch();
}

// Makes the cone from the edge's ring. Returns false if a tet or a face at the edge has to stay.
bool Operations::make_cone_of_edge(Index a, Index b) {
  const std::size_t n = ring_.tets.size(), m = ring_.link.size();
  cone_.clear();
  cone_.tets = ring_.tets;
  for (std::size_t k = 0; k < n; ++k) {
    const auto& tet = complex_[ring_.tets[k]];
    if (untouchable(tet)) return false;
    const Index p = ring_.link[k], q = ring_.link[(k + 1) % m];
    cone_.hull.push_back({a, q, p});
    cone_.hull.push_back({b, p, q});
    cone_.hull_tet.insert(cone_.hull_tet.end(), 2, ring_.tets[k]);
    for (unsigned corner = 0; corner < 4; ++corner) {
      const Index face = tet.faces[corner];
      if (face == none || tet.corners[corner] == a || tet.corners[corner] == b) continue;
      if (contains(cone_.faces, face)) continue;
      if (stays(face)) return false;
      add_to_rim(face, a);
      add_to_rim(face, b);
      cone_.faces.pop_back();
    }
  }
  return true;
}

// Returns whether the faces of the cone are two faces of one patch or, if it has no faces, whether the ring
// is closed.
bool Operations::faces_are_of_one_patch() const {
  if (cone_.faces.empty()) return ring_.closed;
  const auto& patches = mesh_.face_patch;
  return cone_.faces.size() == 2 && patches[cone_.faces[0]] != none &&
         patches[cone_.faces[0]] == patches[cone_.faces[1]];
}

// Adds a face to the cone, and to the rim the edge of the face opposite this corner, oriented like the face.
void Operations::add_to_rim(Index face, Index opposite) {
  const auto& v = mesh_.faces[face];
  const auto i = static_cast<unsigned>(std::ranges::find(v, opposite) - v.begin());
  cone_.faces.push_back(face);
  cone_.rim.push_back({v[(i + 1) % 3], v[(i + 2) % 3]});
  cone_.rim_face.push_back(face);
}

// Calls `passes(i, cosines)` for each face i of the hull, with the angles of its tet with the apex. Measures
// a pair of faces at a time, cyclically from `first_pair` on. Stops at the first call that returns false and
// returns its pair; returns `all_passed` if none does.
template <class Passes>
std::size_t Operations::for_each_shape(const Point& apex, std::size_t first_pair, const Passes& passes) {
  if (cone_.shapes.empty()) cone_.shapes.assign(cone_.hull, mesh_.points);
  const std::size_t pairs = cone_.shapes.pairs();
  for (std::size_t k = 0, pair = first_pair; k < pairs; ++k, pair = pair + 1 < pairs ? pair + 1 : 0) {
    const auto cosines = cone_.shapes.extreme_cosines(pair, apex);
    const std::size_t first = HullShapes::at_once * pair,
                      count = std::min(HullShapes::at_once, cone_.hull.size() - first);
    for (std::size_t lane = 0; lane < count; ++lane)
      if (!passes(first + lane, cosines[lane])) return pair;
  }
  return all_passed;
}

double Operations::worst_of_cone() {
  if (std::isinf(cone_.worst))
    for (const Index t : cone_.tets) cone_.worst = std::min(cone_.worst, quality(t));
  return cone_.worst;
}

// Returns the worst quality of the current tets: those of the cone with the vertex as their apex.
double Operations::worst_at_vertex(Index vertex) {
  const AngleRule* rule = rule_.by_angles();
  if (rule == nullptr || !std::isinf(cone_.worst)) return worst_of_cone();
  for_each_shape(mesh_.points[vertex], 0, [&](std::size_t i, const ExtremeCosines& cosines) {
    const auto& [b, c, d] = cone_.hull[i];
    const std::array<Index, 4> corners{vertex, b, c, d};
    cone_.worst =
        std::min(cone_.worst, rule->quality_of(cosines, with_apex(mesh_.points[vertex], corners), corners));
    return true;
  });
  return cone_.worst;
}

// Returns the quality of the worst tet between this apex and a face of the hull; -1 if it is not above
// `above` or if the rule forbids a tet. Leaves out faces that have the apex as a corner.
double Operations::quality_around(const Point& apex, Index id, double above) {
  const AngleRule* rule = rule_.by_angles();
  return rule != nullptr ? quality_by_angles(*rule, apex, id, above) : quality_by_tets(apex, id, above);
}

double Operations::quality_by_angles(const AngleRule& rule, const Point& apex, Index id, double above) {
  double worst = INFINITY;
  const auto failed = for_each_shape(apex, cone_.decisive, [&](std::size_t i, const ExtremeCosines& cosines) {
    const auto& face = cone_.hull[i];
    if (contains(face, id)) return true;
    const std::array<Index, 4> corners{id, face[0], face[1], face[2]};
    const double quality = rule.quality_of(cosines, with_apex(apex, corners), corners);
    worst = std::min(worst, quality);
    return worst > above && may_be_made(apex, corners, quality);
  });
  if (failed == all_passed) return worst;
  cone_.decisive = failed;  // this pair is likely to fail for the next place, too
  return -1;
}

double Operations::quality_by_tets(const Point& apex, Index id, double above) {
  double worst = INFINITY;
  for (std::size_t i = 0; i < cone_.hull.size(); ++i) {
    const auto& face = cone_.hull[i];
    if (contains(face, id)) continue;
    const std::array<Index, 4> corners{id, face[0], face[1], face[2]};
    worst = std::min(worst, rule_.quality_if_allowed(with_apex(apex, corners), corners, above));
    if (worst > above) continue;
    std::swap(cone_.hull[0], cone_.hull[i]);  // this face is likely to decide for the next place, too
    std::swap(cone_.hull_tet[0], cone_.hull_tet[i]);
    return -1;
  }
  return worst;
}

Corners Operations::with_apex(const Point& apex, const std::array<Index, 4>& corners) const {
  const auto& points = mesh_.points;
  return {apex, points[corners[1]], points[corners[2]], points[corners[3]]};
}

bool Operations::may_be_made(const Point& apex, const std::array<Index, 4>& corners, double quality) const {
  return rule_.allows(with_apex(apex, corners), corners, quality);
}

// Returns whether the rule allows all edges at a vertex of the current cone after its move.
bool Operations::edges_allowed(Index vertex, const Point& from, const Point& to) const {
  const auto& points = mesh_.points;
  for (const auto& face : cone_.hull)
    for (const Index v : face)
      if (!rule_.allows_edge(vertex, v, points[v] - to, points[v] - from)) return false;
  return true;
}

bool Operations::surfaces_allow(const Point& apex, Index id) {
  if (cone_.faces.empty()) return true;
  faces_.clear();
  for (std::size_t i = 0; i < cone_.rim.size(); ++i)
    if (!contains(cone_.rim[i], id))
      faces_.push_back({{apex, mesh_.points[cone_.rim[i][0]], mesh_.points[cone_.rim[i][1]]},
                        mesh_.face_patch[cone_.rim_face[i]]});
  return surfaces_.fit(cone_.faces, faces_, cone_.agreement);
}

// Makes the change replace the cone's tets and faces by those that join `apex` to the hull and the rim.
void Operations::fill(Index apex, Change& change) const {
  auto& [old, created, old_faces, created_faces] = change.replacement;
  old = cone_.tets;
  old_faces = cone_.faces;
  created.clear();
  created_faces.clear();
  for (std::size_t i = 0; i < cone_.hull.size(); ++i)
    if (const auto& [b, c, d] = cone_.hull[i]; !contains(cone_.hull[i], apex))
      created.push_back({{apex, b, c, d}, cone_.hull_tet[i]});
  for (std::size_t i = 0; i < cone_.rim.size(); ++i)
    if (const auto& [a, b] = cone_.rim[i]; !contains(cone_.rim[i], apex))
      created_faces.push_back({{apex, a, b}, cone_.rim_face[i]});
}

// Proposes a vertex at a place in the current cone.
void Operations::fill_insertion(const Point& place, double quality, const TetMesh::VertexFeature& feature,
                                Change& change) const {
  change = {};
  change.kind = Change::Kind::insertion;
  change.quality = quality;
  change.place = place;
  change.feature = feature;
  fill(Change::inserted, change);
}

// Proposes the collapse of the vertex of the current cone onto another one.
void Operations::fill_collapse(Index vertex, Index onto, double quality, Change& change) const {
  change = {};
  change.kind = Change::Kind::collapse;
  change.quality = quality;
  change.vertex = vertex;
  fill(onto, change);
}

Operations::Freedom Operations::on_patch(Index patch, const Point& p) {
  const Plc::Patch& of = plc_.patches[patch];
  const Vector n = of.planar ? of.normal : surfaces_.nearest(patch, p).normal;
  const double least = std::min({std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)});
  const Vector axis = std::fabs(n.x) == least   ? Vector{1, 0, 0}
                      : std::fabs(n.y) == least ? Vector{0, 1, 0}
                                                : Vector{0, 0, 1};
  const Vector u = cross(n, axis) / norm(cross(n, axis));
  return {{u, cross(n, u), {}}, 2, patch};
}

// Returns where a vertex may be moved: anywhere or on its patch; nothing if it must stay or lies on a curve.
std::optional<Operations::Freedom> Operations::freedom(Index vertex) {
  const auto& feature = mesh_.features[vertex];
  if (feature.dimension == 3) return everywhere;
  if (feature.dimension < 2 || feature.feature == none) return std::nullopt;
  return on_patch(feature.feature, mesh_.points[vertex]);
}

Point Operations::back_on_feature(const Point& p, const Point& from, const Freedom& freedom) {
  if (freedom.patch == none) return p;
  const Plc::Patch& patch = plc_.patches[freedom.patch];
  if (!patch.planar) return surfaces_.nearest(freedom.patch, p, 1.0001 * distance(p, from)).point;
  return p - dot(p - patch.origin, patch.normal) * patch.normal;
}

// Searches for the best place of the apex by pattern search from `start`; its quality must be above `best`.
// Returns this place and its quality; if none is found, returns `start` and `best`.
std::pair<Point, double> Operations::best_place(const Point& start, Index id, const Freedom& freedom,
                                                double best) {
  const auto& points = mesh_.points;
  Vector to_centre{0, 0, 0};
  double shortest = INFINITY;
  for (const auto& face : cone_.hull)
    for (const Index v : face) {
      shortest = std::min(shortest, squared_distance(points[v], start));
      to_centre = to_centre + (points[v] - start) / (3.0 * static_cast<double>(cone_.hull.size()));
    }
  Point place = start;
  const auto consider = [&](const Point& wish) {
    const Point p = back_on_feature(wish, start, freedom);
    const double quality = quality_around(p, id, best);
    if (quality <= best || (is_there(id) && !edges_allowed(id, start, p)) ||
        (ask_surfaces_ && !surfaces_allow(p, id)))
      return false;
    best = quality;
    place = p;
    return true;
  };
  consider(start + to_centre);
  consider(start + 0.5 * to_centre);
  double step = first_step * std::sqrt(shortest);
  for (unsigned k = 0; k < rule_.step_lengths(); ++k, step *= 0.5)
    for (unsigned d = 0; d < freedom.count; ++d)
      if (!consider(place + step * freedom.directions[d])) consider(place - step * freedom.directions[d]);
  return {place, best};
}

// Searches along the curve of a vertex, like `best_place`, for the best arc length to slide by.
std::pair<double, double> Operations::best_way(Index vertex, double best) {
  const auto& points = mesh_.points;
  double shortest = INFINITY;
  for (const auto& face : cone_.hull)
    for (const Index v : face) shortest = std::min(shortest, squared_distance(points[v], points[vertex]));
  double way = 0;
  const auto consider = [&](double wish) {
    const Point p = curves_.ahead(vertex, wish);
    const double quality = quality_around(p, vertex, best);
    if (quality <= best || !edges_allowed(vertex, points[vertex], p) ||
        (ask_surfaces_ && !(curves_.fits(vertex, wish) && surfaces_allow(p, vertex))))
      return false;
    best = quality;
    way = wish;
    return true;
  };
  double step = first_step * std::sqrt(shortest);
  for (unsigned k = 0; k < rule_.step_lengths(); ++k, step *= 0.5)
    if (!consider(way + step)) consider(way - step);
  return {way, best};
}

void Operations::move_vertex(Index vertex, Change& change) {
  const bool on_curve = mesh_.features[vertex].dimension == 1;
  if (on_curve && !curves_.movable(vertex)) return;
  const auto where = on_curve ? std::optional(everywhere) : freedom(vertex);
  if (!where || !find_cone_of_vertex(vertex)) return;
  const Point& p = mesh_.points[vertex];
  worst_at_vertex(vertex);
  const double wanted = std::max(cone_.worst * (1 + rule_.least_gain()) + 1e-12, change.quality);
  Point place = p;
  double way = 0, after = 0;
  const auto search = [&] {
    if (on_curve) {
      std::tie(way, after) = best_way(vertex, cone_.worst);
      place = curves_.ahead(vertex, way);
    } else {
      std::tie(place, after) = best_place(p, vertex, *where, cone_.worst);
    }
  };
  // In most cases surface and curve allow the best place, so ask them only about it.
  ask_surfaces_ = false;
  search();
  ask_surfaces_ = true;
  if (after > wanted && !((!on_curve || curves_.fits(vertex, way)) && surfaces_allow(place, vertex)))
    search();
  if (after <= wanted) return;
  fill_move(vertex, place, after, change);
  change.way = way;
}

// Proposes the move of the vertex of the current cone.
void Operations::fill_move(Index vertex, const Point& place, double quality, Change& change) {
  std::vector<Index> read = std::move(change.read);
  read.insert(read.end(), cone_.tets.begin(), cone_.tets.end());
  change = {};
  change.kind = Change::Kind::move;
  change.quality = quality;
  change.vertex = vertex;
  change.place = place;
  change.replacement.old_faces = cone_.faces;
  change.read = std::move(read);
}

void Operations::move_to_face(Index vertex, Change& change) {
  const auto& feature = mesh_.features[vertex];
  if (feature.dimension != 2 || feature.feature == none || !find_cone_of_vertex(vertex)) return;
  const Freedom where{{}, 0, feature.feature};
  worst_at_vertex(vertex);
  double best = std::max(cone_.worst * (1 + rule_.least_gain()) + 1e-12, change.quality);
  std::optional<Point> place;
  for (const Point& p : facing_places(vertex, where)) {
    const double quality = quality_around(p, vertex, best);
    if (quality <= best || !edges_allowed(vertex, mesh_.points[vertex], p) || !surfaces_allow(p, vertex))
      continue;
    best = quality;
    place = p;
  }
  if (place) fill_move(vertex, *place, best, change);
}

// Returns places on the patch of `vertex`. For each other vertex of the current cone they are: the place
// nearest to that vertex, if it lies on a feature; and the place nearest to its projection onto the line of
// the longest edge at `vertex`.
std::vector<Point> Operations::facing_places(Index vertex, const Freedom& where) {
  const Point& p = mesh_.points[vertex];
  std::vector<Index> others;
  for (const auto& face : cone_.hull) others.insert(others.end(), face.begin(), face.end());
  sort_uniquely(others);
  Vector longest{0, 0, 0};
  for (const Index v : others)
    if (const Vector way = mesh_.points[v] - p; squared_norm(way) > squared_norm(longest)) longest = way;
  std::vector<Point> places;
  for (const Index v : others) {
    const Vector way = mesh_.points[v] - p;
    const double along = dot(way, longest) / squared_norm(longest);
    if (mesh_.features[v].dimension < 3) places.push_back(back_on_feature(mesh_.points[v], p, where));
    places.push_back(back_on_feature(p + along * longest, p, where));
  }
  return places;
}

void Operations::split_edge(Index a, Index b, double least, Change& change) {
  if (find_cone_of_edge(a, b))
    insert_in_cone(a, b, std::max({worst_of_cone(), least, change.quality}), change);
}

void Operations::split_edge_anyhow(Index a, Index b, double least, Change& change) {
  if (find_cone_of_edge(a, b)) insert_in_cone(a, b, least, change);
}

void Operations::insert_in_cone(Index a, Index b, double least, Change& change) {
  const Index patch = patch_of_cone();
  const Point middle = 0.5 * (mesh_.points[a] + mesh_.points[b]);
  const Freedom where = patch == none ? everywhere : on_patch(patch, middle);
  const auto [place, quality] =
      best_place(back_on_feature(middle, mesh_.points[a], where), inserted_in(patch), where, -1);
  if (quality > least) fill_insertion(place, quality, inside(patch), change);
}

void Operations::divide_edge(Index a, Index b, double share, double least, Change& change) {
  if (!find_whole_ring(a, b) || !make_cone_of_edge(a, b)) return;
  if (complex_.on_curve(a, b)) return divide_curve_edge(a, b, least, change);
  if (!faces_are_of_one_patch()) return;
  const Index patch = patch_of_cone();
  const Freedom where = patch == none ? everywhere : Freedom{{}, 0, patch};
  const Point on_edge = (1 - share) * mesh_.points[a] + share * mesh_.points[b];
  const Point place = back_on_feature(on_edge, mesh_.points[a], where);
  const double quality = quality_around(place, inserted_in(patch), least);
  if (quality < 0 || !surfaces_allow(place, none)) return insert_in_cone(a, b, least, change);
  fill_insertion(place, quality, inside(patch), change);
}

// Finds the tets at an edge. Returns false if they do not form one ring, as where bodies touch.
bool Operations::find_whole_ring(Index a, Index b) {
  const Index from = complex_.pinched(a) ? b : a, to = from == a ? b : a;
  if (complex_.pinched(from)) return false;
  complex_.star(from, star_);
  std::erase_if(star_, [&](Index t) { return !contains(complex_[t].corners, to); });
  if (star_.empty()) return false;
  complex_.ring(star_.front(), a, b, ring_);
  return ring_.tets.size() == star_.size();
}

void Operations::divide_curve_edge(Index a, Index b, double least, Change& change) {
  const Index curve = mesh_.edge_curve[complex_.curve_edge(a, b)];
  if (curve == none) return;
  const auto middle = curves_.middle(curve, a, b);
  if (!middle) return;
  const Point place = curves_.place(curve, *middle);
  const double quality = quality_around(place, cone_.faces.empty() ? none : inserted_on_surface, least);
  if (quality < 0 || !surfaces_allow(place, none)) return;
  fill_insertion(place, quality, {1, curve}, change);
  change.middle = *middle;
}

void Operations::collapse_edge(Index vertex, Index onto, Change& change, std::optional<double> anyhow_above,
                               Lengths lengths) {
  if (mesh_.features[vertex].dimension == 0) return;
  if (!find_cone_of_vertex(vertex) || !may_collapse(vertex, onto)) return;
  if ((lengths != Lengths::any && !keeps_lengths(vertex, onto)) || !keeps_topology(vertex, onto)) return;
  worst_at_vertex(vertex);
  const Point& place = mesh_.points[onto];
  const double above = anyhow_above.value_or(std::max(cone_.worst, change.quality));
  const double quality = quality_around(place, onto, above);
  if (quality < 0 || !surfaces_allow(place, onto)) return;
  fill_collapse(vertex, onto, quality, change);
  if (mesh_.features[vertex].dimension < 3) change.read = star_;  // the star of the other end
}

void Operations::collapse_best_edge(Index tet, Change& change, Lengths lengths) {
  for (const Index v : complex_[tet].corners)
    for (const Index w : complex_[tet].corners)
      if (v != w) collapse_edge(v, w, change, {}, lengths);
}

bool Operations::begin_collapses(Index vertex, std::span<const Index> star) {
  vertex_ = vertex;
  cone_.clear();
  if (mesh_.features[vertex].dimension == 0 || complex_.pinched(vertex) || edited_.is_fixed(vertex))
    return false;
  cone_.tets.assign(star.begin(), star.end());
  return make_cone_of_vertex(vertex);
}

void Operations::collapse_onto(Index onto, double least, double enough, Change& change) {
  if (!may_collapse(vertex_, onto)) return;
  const Point& place = mesh_.points[onto];
  const double quality = quality_around(place, onto, least);
  if (quality < 0 || (quality < enough && quality < worst_at_vertex(vertex_)) ||
      !keeps_topology(vertex_, onto) || !surfaces_allow(place, onto))
    return;
  fill_collapse(vertex_, onto, quality, change);
}

// Returns whether the edge to `onto` lies in the vertex's feature. On a curve, a single edge must also be
// able to replace both edges at the vertex.
bool Operations::may_collapse(Index vertex, Index onto) {
  const auto& feature = mesh_.features[vertex];
  if (feature.dimension == 3) return true;
  if (feature.feature == none) return false;
  if (feature.dimension == 1) {
    if (!curves_.movable(vertex)) return false;
    const auto [before, after] = curves_.neighbours(vertex);
    return (onto == before || onto == after) && !complex_.on_curve(before, after) && curves_.may_skip(vertex);
  }
  unsigned shared = 0;
  for (std::size_t i = 0; i < cone_.faces.size(); ++i) {
    if (mesh_.face_patch[cone_.faces[i]] != feature.feature) return false;
    shared += contains(cone_.rim[i], onto) ? 1 : 0;
  }
  return shared == 2;
}

// Returns whether the collapse keeps the link condition, in the mesh and on its faces: vertices and edges
// that are joined to both ends of the edge must be joined to the edge, too, because otherwise cells would
// coincide. For a vertex inside a region, positive volumes imply this condition.
bool Operations::keeps_topology(Index vertex, Index onto) {
  if (mesh_.features[vertex].dimension == 3) return true;
  if (complex_.pinched(onto)) return false;
  // The other vertices joined to `vertex`, and those joined to the edge.
  IndexSet joined, joined_to_edge;
  for (const auto& face : cone_.hull) {
    const bool at_edge = contains(face, onto);
    for (const Index v : face) {
      joined.insert(v);
      if (at_edge) joined_to_edge.insert(v);
    }
  }
  const auto have = [](const auto& cells, std::initializer_list<Index> vertices) {
    return std::ranges::any_of(cells, [&](const auto& cell) {
      return std::ranges::all_of(vertices, [&](Index v) { return contains(cell, v); });
    });
  };
  complex_.star(onto, star_);
  for (const Index t : star_) {
    const auto& tet = complex_[t];
    for (unsigned corner = 0; corner < 4; ++corner) {
      if (tet.faces[corner] == none || tet.corners[corner] == onto) continue;
      const auto face = side_corners(tet.corners, corner);
      if (contains(face, vertex)) continue;
      const auto i = static_cast<unsigned>(std::ranges::find(face, onto) - face.begin());
      const Index w = face[(i + 1) % 3], x = face[(i + 2) % 3];
      if (have(cone_.rim, {w, x})) return false;
      for (const Index v : {w, x})
        if (have(cone_.rim, {v}) && !have(cone_.rim, {v, onto})) return false;
    }
    if (contains(tet.corners, vertex)) continue;
    std::array<Index, 3> shared;
    unsigned count = 0;
    for (const Index w : tet.corners) {
      if (w == onto || !joined.contains(w)) continue;
      if (!joined_to_edge.contains(w)) return false;
      shared[count++] = w;
    }
    for (unsigned i = 1; i < count; ++i)
      for (unsigned j = 0; j < i; ++j)
        if (have(cone_.hull, {shared[i], shared[j]}) && !have(cone_.hull, {shared[i], shared[j], onto}))
          return false;
  }
  return true;
}

bool Operations::keeps_lengths(Index vertex, Index onto) const {
  const auto& points = mesh_.points;
  double longest = 0, created = 0;
  for (const auto& face : cone_.hull) {
    for (unsigned i = 0; i < 3; ++i) {
      const Point& p = points[face[i]];
      longest = std::max(
          {longest, squared_distance(p, points[vertex]), squared_distance(p, points[face[(i + 1) % 3]])});
      if (!contains(face, onto)) created = std::max(created, squared_distance(p, points[onto]));
    }
  }
  return created <= longest;
}

}  // namespace collarmesh::remeshing
