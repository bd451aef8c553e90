#include "improve/operations.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "improve/shape.h"

namespace collarmesh::improvement {

namespace {

// Larger rings are hardly ever improved by removing their edge.
constexpr std::size_t largest_ring = 9;
// Four points are in one plane when their volume is below this share of their longest edge cubed.
constexpr double flat_volume = 1e-13;
// Vertices move by steps from this share of their shortest edge down, halved so often.
constexpr double first_step = 0.4;
constexpr unsigned halvings = 4;
// A move that gains less than this share is not worth it.
constexpr double least_gain = 1e-3;

}  // namespace

double Operations::quality(Index tet) const { return shape_quality(complex_.corners(tet)); }

// Not above `above` means worthless, whatever the value.
double Operations::new_quality(const std::array<Index, 4>& v, double above) const {
  const auto& points = complex_.mesh().points;
  const Corners p{points[v[0]], points[v[1]], points[v[2]], points[v[3]]};
  const double quality = shape_quality(p);
  if (quality <= above) return -1;
  const Circumsphere sphere = circumsphere(p);
  return sphere.squared_radius <= squared_radius_edge_ * sphere.shortest_squared_edge ? quality : -1;
}

// Triangulate the polygon around the edge ab so that the worst of the two tets on each triangle is as
// good as possible (Klincsek 1980). Cost: the polygon's vertices cubed.
double Operations::triangulate(Index a, Index b, const Polygon& polygon, double above) {
  const std::size_t n = polygon.size();
  best_.assign(n * n, INFINITY);
  apex_.assign(n * n, 0);
  for (std::size_t width = 2; width < n; ++width)
    for (std::size_t i = 0; i + width < n; ++i) {
      const std::size_t j = i + width;
      double& best = best_[i * n + j];
      best = -1;
      for (std::size_t k = i + 1; k < j; ++k) {
        double q = std::min(best_[i * n + k], best_[k * n + j]);
        const double bar = std::max(above, best);
        if (q <= bar) continue;
        q = std::min(q, new_quality({a, polygon[i], polygon[k], polygon[j]}, bar));
        if (q <= bar) continue;
        q = std::min(q, new_quality({b, polygon[i], polygon[j], polygon[k]}, bar));
        if (q <= bar) continue;
        best = q;
        apex_[i * n + j] = k;
      }
    }
  return best_[n - 1];
}

void Operations::collect(Index a, Index b, const Polygon& polygon, std::size_t i, std::size_t j, Index like,
                         Change& change) const {
  if (j < i + 2) return;
  const std::size_t k = apex_[i * polygon.size() + j];
  change.created.push_back({{a, polygon[i], polygon[k], polygon[j]}, like});
  change.created.push_back({{b, polygon[i], polygon[j], polygon[k]}, like});
  collect(a, b, polygon, i, k, like, change);
  collect(a, b, polygon, k, j, like, change);
}

bool Operations::flat(Index a, Index b, Index c, Index d) const {
  const auto& p = complex_.mesh().points;
  const double longest = std::max({squared_distance(p[a], p[b]), squared_distance(p[a], p[c]),
                                   squared_distance(p[a], p[d]), squared_distance(p[c], p[d])});
  return std::fabs(six_volume(p[a], p[b], p[c], p[d])) <= flat_volume * longest * std::sqrt(longest);
}

void Operations::remove_edge(Index tet, unsigned i, unsigned j, Change& change) {
  const Index a = complex_[tet].corners[i], b = complex_[tet].corners[j];
  if (complex_.on_curve(a, b)) return;
  complex_.ring(tet, a, b, ring_);
  const std::size_t n = ring_.tets.size(), m = ring_.link.size();
  if (n > largest_ring || (ring_.closed && m < 3)) return;
  // Where among the link vertices do faces that must stay leave the edge?
  std::vector<std::pair<std::size_t, Index>> kept;
  double worst = INFINITY;
  for (std::size_t k = 0; k < n; ++k) {
    const auto& t = complex_[ring_.tets[k]];
    if (t.collar) return;
    worst = std::min(worst, quality(ring_.tets[k]));
    for (unsigned corner = 0; corner < 4; ++corner) {
      const Index opposite = t.corners[corner];
      if (opposite == a || opposite == b || t.faces[corner] == none) continue;
      const bool ahead = opposite == ring_.link[k];  // the face to the next tet
      const std::size_t at = ahead ? (k + 1) % m : k;
      if (kept.empty() ||
          std::none_of(kept.begin(), kept.end(), [&](const auto& x) { return x.first == at; }))
        kept.emplace_back(at, t.faces[corner]);
    }
  }
  const double above = std::max(worst, change.quality);
  Change made;
  std::vector<Polygon> polygons;
  std::vector<Index> like;
  if (kept.empty()) {
    if (!ring_.closed) return;
    polygons.push_back(ring_.link);
    like.push_back(ring_.tets[0]);
  } else {
    if (kept.size() != 2) return;
    std::sort(kept.begin(), kept.end());
    const auto& mesh = complex_.mesh();
    const Index patch = mesh.face_patch[kept[0].second];
    if (patch == none || mesh.face_patch[kept[1].second] != patch) return;
    const std::size_t from = kept[0].first, to = kept[1].first;
    if (!ring_.closed && (from != 0 || to + 1 != m)) return;
    const Index c = ring_.link[from], d = ring_.link[to];
    const bool planar = plc_.patches[patch].planar;
    if (planar && !flat(a, b, c, d)) return;
    for (const auto& [begin, end] : {std::pair{from, to}, std::pair{to, from + m}}) {
      if (!ring_.closed && begin != 0) break;
      Polygon& polygon = polygons.emplace_back();
      for (std::size_t k = begin; k <= end; ++k) polygon.push_back(ring_.link[k % m]);
      like.push_back(ring_.tets[begin % n]);
      if (polygon.size() < 3 && (planar || !may_lose(like.back(), a, b))) return;
    }
    for (const auto& [end, face] : {std::pair{b, kept[0].second}, std::pair{a, kept[1].second}}) {
      auto corners = mesh.faces[face];
      std::replace(corners.begin(), corners.end(), end, end == b ? d : c);
      made.kept.push_back({corners, face});
    }
  }
  made.quality = INFINITY;
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    made.quality = std::min(made.quality, triangulate(a, b, polygons[k], above));
    if (made.quality <= above) return;
    collect(a, b, polygons[k], 0, polygons[k].size() - 1, like[k], made);
  }
  made.old = ring_.tets;
  made.kind = kept.empty() ? Change::Kind::edge_removal : Change::Kind::boundary_flip;
  if (!kept.empty() && !may_turn(made.kept)) return;
  change = std::move(made);
}

// May a sliver with two faces at the edge ab go to their other side, whose tets must be there?
bool Operations::may_lose(Index tet, Index a, Index b) const {
  const auto& t = complex_[tet];
  for (unsigned corner = 0; corner < 4; ++corner) {
    if (t.corners[corner] != a && t.corners[corner] != b) continue;
    if (t.faces[corner] != none || t.neighbours[corner] == none || complex_[t.neighbours[corner]].collar)
      return false;
  }
  return true;
}

// May two faces of a patch become these, which share the edge that neither had? On a planar patch the
// tets' volumes have told.
bool Operations::may_turn(const std::vector<TetComplex::Face>& turned) {
  const auto& mesh = complex_.mesh();
  if (plc_.patches[mesh.face_patch[turned[0].face]].planar) return true;
  faces_.clear();
  triangles_.clear();
  std::array<Index, 2> shared{none, none};
  for (const TetComplex::Face& face : turned) {
    faces_.push_back(face.face);
    triangles_.push_back(
        {mesh.points[face.corners[0]], mesh.points[face.corners[1]], mesh.points[face.corners[2]]});
  }
  unsigned count = 0;
  for (const Index v : turned[0].corners)
    if (count < 2 &&
        std::find(turned[1].corners.begin(), turned[1].corners.end(), v) != turned[1].corners.end())
      shared[count++] = v;
  return !complex_.on_faces(shared[0], shared[1]) && surfaces_.fit(faces_, triangles_);
}

void Operations::made(const Change& change) {
  faces_.clear();
  for (const TetComplex::Face& face : change.kept) faces_.push_back(face.face);
  surfaces_.replaced(faces_);
}

bool Operations::split_edge(Index a, Index b, double least) {
  if (complex_.on_curve(a, b)) return false;
  const Index tet = complex_.tet_at_edge(a, b);
  if (tet == none) return false;
  complex_.ring(tet, a, b, ring_);
  const std::size_t n = ring_.tets.size();
  if (!ring_.closed || n > largest_ring) return false;
  double worst = INFINITY;
  around_.clear();
  for (std::size_t k = 0; k < n; ++k) {
    const auto& t = complex_[ring_.tets[k]];
    if (t.collar) return false;
    for (unsigned corner = 0; corner < 4; ++corner)
      if (t.faces[corner] != none && t.corners[corner] != a && t.corners[corner] != b) return false;
    worst = std::min(worst, quality(ring_.tets[k]));
    const Index p = ring_.link[k], q = ring_.link[(k + 1) % n];
    around_.push_back({a, q, p});
    around_.push_back({b, p, q});
  }
  const auto& points = complex_.mesh().points;
  const Point middle = 0.5 * (points[a] + points[b]);
  faces_.clear();
  const auto [place, quality] = best_place(middle, none, everywhere, -1);
  if (quality <= std::max(worst, least)) return false;
  const Index vertex = complex_.add_vertex(place);
  std::vector<TetComplex::NewTet> made;
  for (std::size_t k = 0; k < around_.size(); ++k)
    made.push_back({{vertex, around_[k][0], around_[k][1], around_[k][2]}, ring_.tets[k / 2]});
  const auto created = complex_.replace(ring_.tets, made, {});
  star_.assign(created.begin(), created.end());
  return true;
}

// Where a vertex may be moved to: anywhere, on its patch, or nowhere.
std::optional<Operations::Freedom> Operations::freedom(Index vertex) {
  const auto& feature = complex_.mesh().features[vertex];
  if (feature.dimension == 3) return everywhere;
  if (feature.dimension < 2 || feature.feature == none) return std::nullopt;
  const Plc::Patch& patch = plc_.patches[feature.feature];
  const Vector n =
      patch.planar ? patch.normal : surfaces_.nearest(feature.feature, complex_.mesh().points[vertex]).normal;
  const double least = std::min({std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)});
  const Vector axis = std::fabs(n.x) == least   ? Vector{1, 0, 0}
                      : std::fabs(n.y) == least ? Vector{0, 1, 0}
                                                : Vector{0, 0, 1};
  const Vector u = cross(n, axis) / norm(cross(n, axis));
  return Freedom{{u, cross(n, u), {}}, 2, feature.feature};
}

Point Operations::back_on_feature(const Point& p, const Point& from, const Freedom& freedom) {
  if (freedom.patch == none) return p;
  const Plc::Patch& patch = plc_.patches[freedom.patch];
  if (!patch.planar) return surfaces_.nearest(freedom.patch, p, 1.0001 * distance(p, from)).point;
  return p - dot(p - patch.origin, patch.normal) * patch.normal;
}

// The worst tet of a vertex at `at` with the faces around it; -1 when that is not above `above` or one
// breaks the radius-edge bound.
double Operations::quality_around(const Point& at, double above) const {
  const auto& points = complex_.mesh().points;
  double worst = INFINITY;
  for (const auto& face : around_) {
    const Corners p{at, points[face[0]], points[face[1]], points[face[2]]};
    worst = std::min(worst, shape_quality(p));
    if (worst <= above) return -1;
    const Circumsphere sphere = circumsphere(p);
    if (sphere.squared_radius > squared_radius_edge_ * sphere.shortest_squared_edge) return -1;
  }
  return worst;
}

// Pattern search from `start`, whose quality is `best`.
std::pair<Point, double> Operations::best_place(const Point& start, Index vertex, const Freedom& freedom,
                                                double best) {
  const auto& points = complex_.mesh().points;
  Vector to_centre{0, 0, 0};
  double shortest = INFINITY;
  for (const auto& face : around_)
    for (const Index v : face) {
      shortest = std::min(shortest, squared_distance(points[v], start));
      to_centre = to_centre + (points[v] - start) / (3.0 * static_cast<double>(around_.size()));
    }
  Point place = start;
  const auto consider = [&](const Point& wish) {
    const Point p = back_on_feature(wish, start, freedom);
    const double quality = quality_around(p, best);
    if (quality <= best || !surfaces_allow(vertex, p)) return false;
    best = quality;
    place = p;
    return true;
  };
  consider(start + to_centre);
  consider(start + 0.5 * to_centre);
  double step = first_step * std::sqrt(shortest);
  for (unsigned h = 0; h < halvings; ++h, step *= 0.5)
    for (unsigned d = 0; d < freedom.count; ++d)
      if (!consider(place + step * freedom.directions[d])) consider(place - step * freedom.directions[d]);
  return {place, best};
}

// The same along the curve of a vertex: how far to slide it.
std::pair<double, double> Operations::best_way(Index vertex, double best) {
  const auto& points = complex_.mesh().points;
  double shortest = INFINITY;
  for (const auto& face : around_)
    for (const Index v : face) shortest = std::min(shortest, squared_distance(points[v], points[vertex]));
  double way = 0;
  const auto consider = [&](double wish) {
    const Point p = curves_.ahead(vertex, wish);
    const double quality = quality_around(p, best);
    if (quality <= best || !curves_.fits(vertex, wish) || !surfaces_allow(vertex, p)) return false;
    best = quality;
    way = wish;
    return true;
  };
  double step = first_step * std::sqrt(shortest);
  for (unsigned h = 0; h < halvings; ++h, step *= 0.5)
    if (!consider(way + step)) consider(way - step);
  return {way, best};
}

// The faces of the star that a move of the vertex changes on smooth patches.
void Operations::find_faces(Index vertex) {
  faces_.clear();
  if (complex_.mesh().features[vertex].dimension == 3) return;
  for (const Index t : star_)
    for (unsigned corner = 0; corner < 4; ++corner) {
      const Index face = complex_[t].faces[corner];
      if (complex_[t].corners[corner] == vertex || face == none) continue;
      if (std::find(faces_.begin(), faces_.end(), face) == faces_.end()) faces_.push_back(face);
    }
}

bool Operations::surfaces_allow(Index vertex, const Point& at) {
  if (faces_.empty()) return true;
  const auto& mesh = complex_.mesh();
  triangles_.clear();
  for (const Index face : faces_) {
    auto& t = triangles_.emplace_back();
    for (unsigned i = 0; i < 3; ++i)
      t[i] = mesh.faces[face][i] == vertex ? at : mesh.points[mesh.faces[face][i]];
  }
  return surfaces_.fit(faces_, triangles_);
}

bool Operations::move_vertex(Index vertex) {
  complex_.star(vertex, star_);
  if (std::any_of(star_.begin(), star_.end(), [&](Index t) { return complex_[t].collar; })) return false;
  const bool on_curve = complex_.mesh().features[vertex].dimension == 1;
  if (on_curve && !curves_.movable(vertex)) return false;
  const auto where = on_curve ? std::optional(everywhere) : freedom(vertex);
  if (!where) return false;
  around_.clear();
  double before = INFINITY;
  for (const Index t : star_) {
    before = std::min(before, quality(t));
    const auto& v = complex_[t].corners;
    around_.push_back(
        face_corners(v, static_cast<unsigned>(std::find(v.begin(), v.end(), vertex) - v.begin())));
  }
  find_faces(vertex);
  Point& p = complex_.mesh().points[vertex];
  const double wanted = before * (1 + least_gain) + 1e-12;
  if (on_curve) {
    const auto [way, after] = best_way(vertex, before);
    if (after <= wanted) return false;
    p = curves_.ahead(vertex, way);
    curves_.moved(vertex, way);
  } else {
    // Most often the best place is one that the surface allows.
    std::vector<Index> faces = std::exchange(faces_, {});
    auto [place, after] = best_place(p, vertex, *where, before);
    faces_ = std::move(faces);
    if (after <= wanted) return false;
    if (!surfaces_allow(vertex, place)) std::tie(place, after) = best_place(p, vertex, *where, before);
    if (after <= wanted) return false;
    p = place;
  }
  surfaces_.replaced(faces_);
  return true;
}

}  // namespace collarmesh::improvement
