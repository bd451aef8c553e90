#include "constrained/tetrahedra.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "common/spatial_order.h"
#include "delaunay/predicates.h"
#include "delaunay/triangulation.h"

namespace collarmesh::constrained {

namespace {

// The box extends beyond the points' bounding box by this factor times the latter's diagonal, so that its
// corners are far from the points.
constexpr double box_margin = 1;
constexpr Index box_corners = 8;

Box box_around(const std::vector<Point>& points) {
  Box box;
  for (const Point& p : points) box.add(p);
  const double margin = box_margin * std::max(box.diagonal(), 1e-300);
  box.min = box.min - Vector{margin, margin, margin};
  box.max = box.max + Vector{margin, margin, margin};
  return box;
}

/// Walks from a cell to one that contains a point, across faces that separate the cell from the point.
Index cell_with(const Triangulation& mesh, const Point& p, Index start) {
  Index cell = start, from = none;
  unsigned turn = 0;
  for (;;) {
    Index next = none;
    for (unsigned i = 0; i < 4 && next == none; ++i) {
      const unsigned corner = (i + turn) % 4;
      const FaceId beyond = mesh.opposite(face_id(cell, corner));
      if (beyond == no_face || cell_of(beyond) == from) continue;
      const auto [a, b, c] = mesh.face_vertices(face_id(cell, corner));
      if (predicates::orientation(mesh.point(a), mesh.point(b), mesh.point(c), p) > 0) next = cell_of(beyond);
    }
    if (next == none) return cell;
    ++turn;
    from = cell;
    cell = next;
  }
}

}  // namespace

Tetrahedra::Tetrahedra(const std::vector<Point>& points) : points_(points) {
  Triangulation mesh(box_around(points));
  std::vector<Index> number(points.size() + box_corners);  // number of the point, by the mesh's vertex
  for (Index i = 0; i < box_corners; ++i) {
    number[i] = static_cast<Index>(points.size()) + i;
    points_.push_back(mesh.point(i));
  }
  ConflictZone zone;
  Index cell = mesh.incident_cell(0);
  for (const SpatialKey& key : spatial_order(points)) {
    const Point& p = points[key.item];
    mesh.find_conflict_zone(p, cell_with(mesh, p, cell), zone);
    const Index vertex = mesh.insert(zone);
    number[vertex] = key.item;
    cell = mesh.incident_cell(vertex);
  }
  std::vector<Index> tet_of(mesh.cell_capacity(), none);
  tet_at_.assign(points_.size(), none);
  for (Index c = 0; c < mesh.cell_capacity(); ++c) {
    if (!mesh.alive(c)) continue;
    const auto& v = mesh.corners(c);
    tet_of[c] = new_tet({number[v[0]], number[v[1]], number[v[2]], number[v[3]]});
    attach(tet_of[c]);
  }
  for (Index c = 0; c < mesh.cell_capacity(); ++c)
    for (unsigned k = 0; tet_of[c] != none && k < 4; ++k)
      if (const FaceId beyond = mesh.opposite(face_id(c, k)); beyond != no_face)
        tets_[tet_of[c]].neighbours[k] = {tet_of[cell_of(beyond)], corner_of(beyond)};
  assert(consistent(all()));
}

std::vector<Index> Tetrahedra::all() const {
  std::vector<Index> tets;
  for (Index t = 0; t < size(); ++t)
    if (alive(t)) tets.push_back(t);
  return tets;
}

bool Tetrahedra::consistent(std::span<const Index> tets) const {
  const auto side = [this](const Face& face) {
    auto corners_of_side = side_corners(corners(face.tet), face.corner);
    std::ranges::sort(corners_of_side);
    return corners_of_side;
  };
  const auto agrees = [&](const Face& face) {
    const Face other = opposite(face);
    if (other.tet == none) return true;
    const Face back = opposite(other);
    return alive(other.tet) && back.tet == face.tet && back.corner == face.corner &&
           side(other) == side(face) && facet(other) == facet(face);
  };
  return std::ranges::all_of(tets, [&](Index t) {
    const auto& [a, b, c, d] = corners(t);
    return alive(t) && orientation(a, b, c, d) > 0 && agrees({t, 0}) && agrees({t, 1}) && agrees({t, 2}) &&
           agrees({t, 3});
  });
}

int Tetrahedra::orientation(Index a, Index b, Index c, Index d) const {
  return predicates::orientation(points_[a], points_[b], points_[c], points_[d]);
}

void Tetrahedra::set_facet(const Face& face, Index facet) {
  tets_[face.tet].facets[face.corner] = facet;
  if (const Face other = opposite(face); other.tet != none) tets_[other.tet].facets[other.corner] = facet;
}

Index Tetrahedra::tet_at(Index a, Index b) const {
  Index found = none;
  find_star(a, star_, [&](Index t) {
    if (has(t, b)) found = t;
    return found != none;
  });
  return found;
}

Tetrahedra::Face Tetrahedra::face_of(Index a, Index b, Index c) const {
  Face found;
  find_star(a, star_, [&](Index t) {
    if (!has(t, b) || !has(t, c)) return false;
    found.tet = t;
    while (corners(t)[found.corner] == a || corners(t)[found.corner] == b || corners(t)[found.corner] == c)
      ++found.corner;
    return true;
  });
  return found;
}

bool Tetrahedra::ring(Index tet, Index a, Index b, Ring& ring) const {
  ring.tets.clear();
  ring.link.clear();
  // Returns the tetrahedron's other two corners in the order for which (a, b, first, second) is positive.
  const auto ordered = [&](Index t) {
    const Corners& v = corners(t);
    const unsigned i = place_of(a, v);
    const auto side = side_corners(v, i);
    const auto j = static_cast<unsigned>(std::ranges::find(side, b) - side.begin());
    return std::array<Index, 2>{side[(j + 1) % 3], side[(j + 2) % 3]};
  };
  Index t = tet;
  do {
    const auto [first, second] = ordered(t);
    ring.tets.push_back(t);
    ring.link.push_back(first);
    t = beyond({t, place_of(first, corners(t))});
    if (t == none) return false;
  } while (t != tet);
  return true;
}

Index Tetrahedra::add_point(const Point& p) {
  points_.push_back(p);
  tet_at_.push_back(none);
  return static_cast<Index>(points_.size() - 1);
}

void Tetrahedra::replace(std::span<const Index> old, std::span<const Corners> created) {
  const auto sorted = [](std::array<Index, 3> v) {
    std::ranges::sort(v);
    return v;
  };
  assert(std::ranges::all_of(old, [this](Index t) { return alive(t); }));
  sides_.clear();
  for (const Index t : old) tets_[t].alive = false;
  for (const Index t : old)
    for (unsigned k = 0; k < 4; ++k) {
      const Face next = tets_[t].neighbours[k];
      if (next.tet == none || tets_[next.tet].alive)
        sides_.push_back({sorted(side_corners(corners(t), k)), next, tets_[t].facets[k], true});
    }
  Step step{{old.begin(), old.end()}, {}};
  step.created.reserve(created.size());
  for (const Corners& v : created) {
    const Index t = new_tet(v);
    step.created.push_back(t);
    for (unsigned k = 0; k < 4; ++k) sides_.push_back({sorted(side_corners(v, k)), {t, k}, none, false});
  }
  std::ranges::sort(sides_, [](const Side& x, const Side& y) {
    return x.corners != y.corners ? x.corners < y.corners : x.border < y.border;
  });
  for (std::size_t i = 0; i + 1 < sides_.size(); i += 2) {
    const Side &x = sides_[i], &y = sides_[i + 1];
    assert(x.corners == y.corners && !x.border);
    tets_[x.face.tet].neighbours[x.face.corner] = y.face;
    tets_[x.face.tet].facets[x.face.corner] = y.facet;
    if (y.face.tet != none) tets_[y.face.tet].neighbours[y.face.corner] = x.face;
  }
  for (const Index t : step.created) attach(t);
  assert(consistent(step.created));
  journal_.push_back(std::move(step));
}

void Tetrahedra::undo_to(std::size_t mark) {
  assert(mark <= journal_.size());
  while (journal_.size() > mark) {
    const Step& step = journal_.back();
    for (const Index t : step.created) tets_[t].alive = false;
    for (const Index t : step.old) {
      tets_[t].alive = true;
      attach(t);
      for (unsigned k = 0; k < 4; ++k)
        if (const Face next = tets_[t].neighbours[k]; next.tet != none)
          tets_[next.tet].neighbours[next.corner] = {t, k};
    }
    assert(consistent(step.old));
    free_.insert(free_.end(), step.created.begin(), step.created.end());
    journal_.pop_back();
  }
}

void Tetrahedra::keep() {
  for (const Step& step : journal_) free_.insert(free_.end(), step.old.begin(), step.old.end());
  journal_.clear();
}

Index Tetrahedra::new_tet(const Corners& corners) {
  Index t = static_cast<Index>(tets_.size());
  if (free_.empty()) {
    tets_.emplace_back();
  } else {
    t = free_.back();
    free_.pop_back();
  }
  tets_[t] = Tet();
  tets_[t].corners = corners;
  return t;
}

void Tetrahedra::attach(Index tet) {
  for (const Index v : corners(tet)) tet_at_[v] = tet;
}

}  // namespace collarmesh::constrained
