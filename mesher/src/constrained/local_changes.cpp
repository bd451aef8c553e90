#include "constrained/local_changes.h"

#include <algorithm>
#include <limits>

#include "common/edge_key.h"

namespace collarmesh::constrained {

namespace {
constexpr int impossible = std::numeric_limits<int>::max() / 4;
}

std::optional<int> LocalChanges::remove_face(const Tetrahedra::Face& face, const Obstacles& obstacles) {
  const Tetrahedra::Face other = mesh_.opposite(face);
  if (other.tet == none || mesh_.facet(face) != none) return {};
  const auto [p, q, r] = side_corners(mesh_.corners(face.tet), face.corner);
  const Index d = mesh_.corners(face.tet)[face.corner], e = mesh_.corners(other.tet)[other.corner];
  const std::array<Tetrahedra::Corners, 3> created{{{d, p, q, e}, {d, q, r, e}, {d, r, p, e}}};
  for (const auto& v : created)
    if (mesh_.orientation(v[0], v[1], v[2], v[3]) <= 0) return {};
  const std::array<Index, 2> old{face.tet, other.tet};
  const int gain = obstacles.edge(d, e) + obstacles.face(d, e, p) + obstacles.face(d, e, q) +
                   obstacles.face(d, e, r) - obstacles.face(p, q, r);
  mesh_.replace(old, created);
  return gain;
}

bool LocalChanges::may_remove(Index a, Index b, const Tetrahedra::Ring& ring) const {
  if (required_.contains(edge_key(a, b)) || ring.link.size() < 3 || ring.link.size() > largest_ring)
    return false;
  return std::ranges::all_of(ring.tets, [&](Index t) {
    const auto& v = mesh_.corners(t);
    for (unsigned k = 0; k < 4; ++k)
      if (v[k] != a && v[k] != b && mesh_.facet({t, k}) != none) return false;
    return true;
  });
}

std::optional<int> LocalChanges::remove_edge(Index a, Index b, unsigned depth, const Obstacles& obstacles,
                                             int most) {
  Index at = mesh_.tet_at(a, b);
  Tetrahedra::Ring ring;
  if (at == none || !mesh_.ring(at, a, b, ring) || !may_remove(a, b, ring)) return {};
  const std::size_t before = mesh_.mark();
  if (const auto gain = triangulate_ring(a, b, ring, obstacles, most)) return gain;
  if (depth == 0 || budget_ == 0) return {};
  int sum = 0;
  // Removing an edge between an end of ab and the ring may make the ring smaller.
  const std::vector<Index> link = ring.link;
  for (const Index p : link)
    for (const Index end : {a, b}) {
      const std::size_t mark = mesh_.mark();
      const auto gain = remove_edge(end, p, depth - 1, obstacles, any_number);
      if (!gain) continue;
      at = mesh_.tet_at(a, b);
      if (at == none && sum + *gain <= most) return sum + *gain;
      Tetrahedra::Ring now;
      if (at == none || !mesh_.ring(at, a, b, now) || now.link.size() >= ring.link.size()) {
        mesh_.undo_to(mark);
        continue;
      }
      sum += *gain;
      ring = now;
      if (const auto last = triangulate_ring(a, b, ring, obstacles, most - sum)) return sum + *last;
      break;
    }
  mesh_.undo_to(before);
  return {};
}

int LocalChanges::cost_of_diagonal(Index a, Index b, Index p, Index q, const Obstacles& obstacles) const {
  return obstacles.edge(p, q) + obstacles.face(a, p, q) + obstacles.face(b, p, q);
}

// Triangulates the ring by Klincsek's dynamic program (Minimal triangulations of polygonal domains, 1980).
std::optional<int> LocalChanges::triangulate_ring(Index a, Index b, const Tetrahedra::Ring& ring,
                                                  const Obstacles& obstacles, int most) {
  if (budget_ > 0) --budget_;
  const std::vector<Index>& link = ring.link;
  const std::size_t n = link.size();
  least_.assign(n * n, impossible);
  third_.assign(n * n, 0);
  for (std::size_t i = 0; i + 1 < n; ++i) least_[i * n + i + 1] = 0;
  for (std::size_t length = 2; length < n; ++length)
    for (std::size_t i = 0; i + length < n; ++i) {
      const std::size_t j = i + length;
      int& best = least_[i * n + j];
      for (std::size_t k = i + 1; k < j; ++k) {
        const int parts = least_[i * n + k] + least_[k * n + j];
        if (parts >= best) continue;
        const Index p = link[i], q = link[k], r = link[j];
        if (mesh_.orientation(p, q, r, b) <= 0 || mesh_.orientation(q, p, r, a) <= 0) continue;
        const int sum = parts + obstacles.face(p, q, r);
        if (sum >= best) continue;
        best = sum;
        third_[i * n + j] = k;
      }
      if (best < impossible && length + 1 < n) best += cost_of_diagonal(a, b, link[i], link[j], obstacles);
    }
  if (least_[n - 1] >= impossible) return {};
  int before = obstacles.edge(a, b);
  for (const Index p : link) before += obstacles.face(a, b, p);
  const int gain = least_[n - 1] - before;
  if (gain > most) return {};
  std::vector<Tetrahedra::Corners> created;
  created.reserve(2 * n);
  collect(a, b, link, 0, n - 1, created);
  mesh_.replace(ring.tets, created);
  return gain;
}

void LocalChanges::collect(Index a, Index b, const std::vector<Index>& link, std::size_t i, std::size_t j,
                           std::vector<Tetrahedra::Corners>& created) const {
  if (j - i < 2) return;
  const std::size_t k = third_[i * link.size() + j];
  created.push_back({link[i], link[k], link[j], b});
  created.push_back({link[k], link[i], link[j], a});
  collect(a, b, link, i, k, created);
  collect(a, b, link, k, j, created);
}

Index LocalChanges::insert(const Point& p, std::vector<Index> cavity) {
  const Index x = mesh_.add_point(p);
  std::vector<Tetrahedra::Corners> created;
  if (grow(x, cavity)) {
    for (const Index t : cavity)
      for (unsigned k = 0; k < 4; ++k) {
        if (std::ranges::find(cavity, mesh_.beyond({t, k})) != cavity.end()) continue;
        created.push_back(mesh_.corners(t));
        created.back()[k] = x;
      }
    if (keeps_features(cavity, created)) {
      mesh_.replace(cavity, created);
      return x;
    }
  }
  mesh_.drop_point();
  return none;
}

/// Adds tetrahedra to the cavity until all its sides are visible from the point x inside it. Returns false if
/// that is not possible.
bool LocalChanges::grow(Index x, std::vector<Index>& cavity) const {
  for (std::size_t i = 0; i < cavity.size(); ++i)
    for (unsigned k = 0; k < 4; ++k) {
      const Tetrahedra::Face side{cavity[i], k};
      const Index next = mesh_.beyond(side);
      if (std::ranges::find(cavity, next) != cavity.end()) continue;
      const auto [a, b, c] = side_corners(mesh_.corners(side.tet), k);
      if (mesh_.orientation(a, b, c, x) < 0) continue;
      if (next == none || mesh_.facet(side) != none || cavity.size() >= largest_cavity) return false;
      cavity.push_back(next);
    }
  return true;
}

/// Returns whether all vertices, facets and required edges of the cavity are among those of the new
/// tetrahedra.
bool LocalChanges::keeps_features(const std::vector<Index>& cavity,
                                  const std::vector<Tetrahedra::Corners>& created) const {
  std::unordered_set<std::uint64_t> edges;
  std::unordered_set<Index> vertices;
  for (const auto& v : created)
    for (unsigned i = 0; i < 4; ++i) {
      vertices.insert(v[i]);
      for (unsigned j = i + 1; j < 4; ++j) edges.insert(edge_key(v[i], v[j]));
    }
  return std::ranges::all_of(cavity, [&](Index t) {
    const auto& v = mesh_.corners(t);
    for (unsigned i = 0; i < 4; ++i) {
      if (!vertices.contains(v[i])) return false;
      if (mesh_.facet({t, i}) != none && std::ranges::find(cavity, mesh_.beyond({t, i})) != cavity.end())
        return false;
      for (unsigned j = i + 1; j < 4; ++j) {
        const std::uint64_t key = edge_key(v[i], v[j]);
        if (required_.contains(key) && !edges.contains(key)) return false;
      }
    }
    return true;
  });
}

}  // namespace collarmesh::constrained
