// Operations that replace the tets around an edge.
#include <algorithm>

#include "common/cell_shapes.h"
#include "remesh/operations.h"
#include "remesh/shape.h"

namespace collarmesh::remeshing {

namespace {

// Four points count as coplanar if six times their volume is at most this share of their longest edge cubed.
constexpr double flat_volume = 1e-13;

}  // namespace

// Returns the quality of a new tet; -1 if it is not above `above` or the rule forbids the tet.
double Operations::new_quality(const std::array<Index, 4>& v, double above) const {
  const auto& points = mesh_.points;
  const Corners p{points[v[0]], points[v[1]], points[v[2]], points[v[3]]};
  return rule_.quality_if_allowed(p, v, above);
}

// Triangulates the polygon around the edge ab. Each triangle makes two tets, with a and with b; the worst of
// all these tets is as good as possible (Klincsek 1980). Returns its quality, or -1 if no triangulation makes
// only tets better than `above`. Cost: the polygon's number of vertices cubed.
double Operations::triangulate(Index a, Index b, const Polygon& polygon, bool closed, double above) {
  const std::size_t n = polygon.size();
  const auto& points = mesh_.points;
  const Vector removed = points[b] - points[a];
  best_.assign(n * n, INFINITY);
  apex_.assign(n * n, 0);
  for (std::size_t width = 2; width < n; ++width)
    for (std::size_t i = 0; i + width < n; ++i) {
      const std::size_t j = i + width;
      double& best = best_[i * n + j];
      best = -1;
      const bool is_new = width + 1 < n || !closed;
      if (is_new &&
          !rule_.allows_edge(polygon[i], polygon[j], complex_.edge(polygon[i], polygon[j]), removed))
        continue;
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
  auto& created = change.replacement.created;
  created.push_back({{a, polygon[i], polygon[k], polygon[j]}, like});
  created.push_back({{b, polygon[i], polygon[j], polygon[k]}, like});
  collect(a, b, polygon, i, k, like, change);
  collect(a, b, polygon, k, j, like, change);
}

bool Operations::flat(Index a, Index b, Index c, Index d) const {
  const auto& p = mesh_.points;
  const double longest = std::max({squared_distance(p[a], p[b]), squared_distance(p[a], p[c]),
                                   squared_distance(p[a], p[d]), squared_distance(p[c], p[d])});
  return std::fabs(six_volume(p[a], p[b], p[c], p[d])) <= flat_volume * longest * std::sqrt(longest);
}

void Operations::remove_best_edge(Index tet, Change& change) {
  for (const auto& [i, j] : cell_shapes::corner_pairs) remove_edge(tet, i, j, change);
}

void Operations::remove_edge(Index tet, unsigned i, unsigned j, Change& change,
                             std::optional<double> anyhow_above) {
  const Index a = complex_[tet].corners[i], b = complex_[tet].corners[j];
  if (complex_.on_curve(a, b)) return;
  complex_.ring(tet, a, b, ring_);
  const std::size_t n = ring_.tets.size(), m = ring_.link.size();
  if (n > largest_ring || (ring_.closed && m < 3)) return;
  // The mesh faces at the edge, which must be preserved, each with the place of its third corner in the link.
  std::vector<std::pair<std::size_t, Index>> kept;
  // If `change` is at least as good as this tet, it is at least as good as the worst tet at the edge. The new
  // tets need only be better than `change` then, so the quality of the worst tet is not computed.
  const bool known = anyhow_above || (!change.is_none() && change.quality >= quality(tet));
  double worst = known ? -INFINITY : INFINITY;
  for (std::size_t k = 0; k < n; ++k) {
    const auto& t = complex_[ring_.tets[k]];
    if (untouchable(t)) return;
    if (!known) worst = std::min(worst, quality(ring_.tets[k]));
    for (unsigned corner = 0; corner < 4; ++corner) {
      const Index opposite = t.corners[corner];
      if (opposite == a || opposite == b || t.faces[corner] == none) continue;
      const bool ahead = opposite == ring_.link[k];  // the face shared with the next tet of the ring
      const std::size_t at = ahead ? (k + 1) % m : k;
      if (kept.empty() || std::ranges::none_of(kept, [&](const auto& x) { return x.first == at; }))
        kept.emplace_back(at, t.faces[corner]);
    }
  }
  const double above = anyhow_above.value_or(std::max(worst, change.quality));
  Change made;
  std::vector<Polygon> polygons;
  std::vector<Index> like;
  if (kept.empty()) {
    if (!ring_.closed) return;
    polygons.push_back(ring_.link);
    like.push_back(ring_.tets[0]);
  } else {
    if (kept.size() != 2) return;
    std::ranges::sort(kept);
    const Index patch = mesh_.face_patch[kept[0].second];
    if (patch == none || mesh_.face_patch[kept[1].second] != patch || edited_.keeps(patch)) return;
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
      auto corners = mesh_.faces[face];
      std::ranges::replace(corners, end, end == b ? d : c);
      made.replacement.old_faces.push_back(face);
      made.replacement.created_faces.push_back({corners, face});
    }
  }
  made.quality = INFINITY;
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    made.quality = std::min(made.quality, triangulate(a, b, polygons[k], kept.empty(), above));
    if (made.quality <= above) return;
    collect(a, b, polygons[k], 0, polygons[k].size() - 1, like[k], made);
  }
  made.replacement.old = ring_.tets;
  made.kind = kept.empty() ? Change::Kind::edge_removal : Change::Kind::boundary_flip;
  made.read = std::move(change.read);  // a refusal depends on the tets that were read, too
  if (kept.empty() || may_turn(made))
    change = std::move(made);
  else
    change.read = std::move(made.read);
}

// Returns whether this boundary sliver may be given to the region across its two mesh faces at ab. Its other
// two faces then become mesh faces, so they must not be mesh faces already and must have tets behind them.
bool Operations::may_lose(Index tet, Index a, Index b) const {
  const auto& t = complex_[tet];
  for (const Index v : t.corners)
    if (complex_.pinched(v)) return false;
  for (unsigned corner = 0; corner < 4; ++corner) {
    if (t.corners[corner] != a && t.corners[corner] != b) continue;
    if (t.faces[corner] != none || t.neighbours[corner] == none ||
        untouchable(complex_[t.neighbours[corner]]))
      return false;
  }
  return true;
}

// Returns whether the two faces that the change creates, which share a new edge, may replace its old faces.
// Returns false if the mesh has faces at the new edge already, because a face could then occur twice.
bool Operations::may_turn(Change& change) {
  const auto& turned = change.replacement.created_faces;
  std::array<Index, 2> shared{none, none};
  unsigned count = 0;
  for (const Index v : turned[0].corners)
    if (count < 2 && std::ranges::find(turned[1].corners, v) != turned[1].corners.end()) shared[count++] = v;
  complex_.star(shared[0], star_);
  change.read.insert(change.read.end(), star_.begin(), star_.end());
  if (complex_.on_faces(shared[0], shared[1])) return false;
  const Index patch = mesh_.face_patch[turned[0].like];
  if (plc_.patches[patch].planar) return true;  // positive volumes of the new tets suffice on a plane
  faces_.clear();
  for (const TetComplex::NewFace& face : turned)
    faces_.push_back(
        {{mesh_.points[face.corners[0]], mesh_.points[face.corners[1]], mesh_.points[face.corners[2]]},
         patch});
  return surfaces_.fit(change.replacement.old_faces, faces_);
}

}  // namespace collarmesh::remeshing
