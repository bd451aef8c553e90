#include "layers/front.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/contains.h"
#include "common/edge_key.h"
#include "common/sort_uniquely.h"
#include "common/tet_sides.h"
#include "layers/direction.h"

namespace collarmesh::layering {

namespace {

// Limit on the tets followed around an edge; valid meshes have fewer.
constexpr unsigned most_around = 10'000;

/// Returns whether two triangles with the same corners are oriented alike.
bool is_alike(const std::array<Index, 3>& t, const std::array<Index, 3>& u) {
  for (unsigned i = 0; i < 3; ++i)
    if (u[i] == t[0]) return u[(i + 1) % 3] == t[1];
  return false;
}

}  // namespace

std::vector<Index> within_rings(const Lists& neighbours, std::vector<Index> nodes, unsigned rings) {
  sort_uniquely(nodes);
  std::vector<bool> found(neighbours.size(), false);
  for (const Index n : nodes) found[n] = true;
  std::size_t first = 0;  // index of the last ring's first node
  for (unsigned ring = 0; ring < rings; ++ring) {
    const std::size_t last = nodes.size();
    for (; first < last; ++first)
      for (const Index other : neighbours[nodes[first]])
        if (!found[other]) {
          found[other] = true;
          nodes.push_back(other);
        }
  }
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

Front::Front(const remeshing::TetComplex& complex, const Plc& plc, const WallChoice& walls)
    : complex_(complex), mesh_(complex.mesh()), plc_(plc), walls_(walls) {
  find_sides();
  if (sides.empty()) return;
  find_nodes();
  number_corners();
  link_edges();
  list_sides();
  find_directions();
}

Vector Front::normal(const WallSide& side) const {
  const auto& p = mesh_.points;
  const Vector n = cross(p[side.corners[1]] - p[side.corners[0]], p[side.corners[2]] - p[side.corners[0]]);
  const double length = norm(n);
  return length > 0 ? n / length : n;
}

bool Front::is_wall_edge(Index a, Index b) const {
  return std::binary_search(wall_edges_.begin(), wall_edges_.end(), edge_key(a, b));
}

void Front::find_sides() {
  on_wall.assign(mesh_.points.size(), false);
  side_of_.assign(4 * std::size_t{complex_.size()}, none);
  for (Index t = 0; t < complex_.size(); ++t) {
    const auto& tet = complex_[t];
    for (unsigned corner = 0; corner < 4; ++corner) {
      if (is_wall(tet.faces[corner])) add_side(t, corner);
    }
  }
  for (const WallSide& side : sides)
    for (unsigned i = 0; i < 3; ++i) {
      on_wall[side.corners[i]] = true;
      wall_edges_.push_back(edge_key(side.corners[i], side.corners[(i + 1) % 3]));
    }
  sort_uniquely(wall_edges_);
}

void Front::add_side(Index tet, unsigned corner) {
  const auto& at = complex_[tet];
  const auto [a, b, c] = side_corners(at.corners, corner);
  WallSide side;
  side.face = at.faces[corner];
  side.tet = tet;
  side.corners = {a, c, b};  // a, b, c are counterclockwise from outside
  side.patch = mesh_.face_patch[side.face];
  side.region = at.region;
  if (!walls_.has_layers(side.patch, side.region)) {
    bare_sides.push_back(side);
    return;
  }
  side_of_[4 * std::size_t{tet} + corner] = static_cast<Index>(sides.size());
  sides.push_back(side);
}

/// Returns whether the face opposite a corner is a wall that has layers on its other side only.
bool Front::is_bare(Index tet, unsigned corner) const {
  return is_wall(complex_[tet].faces[corner]) && side_of_[4 * std::size_t{tet} + corner] == none;
}

/// Makes, for each node of a wall, a node of the front in each sector of tets there that has a side of the
/// wall.
void Front::find_nodes() {
  edges_at_ = CellsAtVertices(mesh_.edges, mesh_.points.size());
  node_at.assign(4 * std::size_t{complex_.size()}, none);
  std::vector<Index> sector;
  for (const WallSide& side : sides)
    for (const Index v : side.corners)
      if (node_of(side.tet, place_of(v, complex_[side.tet].corners)) == none)
        find_sector(v, side.tet, sector);
}

/// Finds the tets at a vertex that are connected to this tet without passing a wall, and the faces and edges
/// without layers there.
void Front::find_sector(Index vertex, Index tet, std::vector<Index>& sector) {
  const auto node = static_cast<Index>(nodes.size());
  nodes.emplace_back().vertex = vertex;
  sector.assign(1, tet);
  node_at[4 * std::size_t{tet} + place_of(vertex, complex_[tet].corners)] = node;
  std::vector<Index> faces, corners;
  for (std::size_t i = 0; i < sector.size(); ++i) {
    const auto& at = complex_[sector[i]];
    corners.insert(corners.end(), at.corners.begin(), at.corners.end());
    for (unsigned corner = 0; corner < 4; ++corner) {
      if (at.corners[corner] == vertex) continue;
      // Triangles with layers on the other side only must not move.
      if (is_bare(sector[i], corner)) nodes[node].blocked = true;
      if (is_wall(at.faces[corner])) continue;
      if (at.faces[corner] != none) faces.push_back(at.faces[corner]);
      const Index next = at.neighbours[corner];
      if (next == none) continue;
      Index& number = node_at[4 * std::size_t{next} + place_of(vertex, complex_[next].corners)];
      if (number != none) continue;
      number = node;
      sector.push_back(next);
    }
  }
  sort_uniquely(faces);
  faces_at_.entries.insert(faces_at_.entries.end(), faces.begin(), faces.end());
  faces_at_.end_group();
  for (const Index e : edges_at_[vertex]) {
    const auto [a, b] = mesh_.edges[e];
    if (!is_wall_edge(a, b) && contains(corners, a == vertex ? b : a)) edges_of.entries.push_back(e);
  }
  edges_of.end_group();
}

void Front::number_corners() {
  for (WallSide& side : sides)
    for (unsigned i = 0; i < 3; ++i)
      side.nodes[i] = node_of(side.tet, place_of(side.corners[i], complex_[side.tet].corners));
}

void Front::link_edges() {
  for (WallSide& side : sides)
    for (unsigned i = 0; i < 3; ++i) {
      side.edges[i] = follow(side, i);
      if (!side.edges[i].blocked) continue;
      nodes[side.nodes[i]].blocked = nodes[side.nodes[(i + 1) % 3]].blocked = true;
    }
}

/// Goes around an edge of a side, through the tets beside it, up to another side of a wall or to the end of
/// the mesh.
WallSide::Edge Front::follow(const WallSide& side, unsigned corner) const {
  const Index a = side.corners[corner], b = side.corners[(corner + 1) % 3];
  Index behind = side.corners[(corner + 2) % 3], tet = side.tet;
  WallSide::Edge edge;
  unsigned met = 0;
  for (unsigned step = 0; step < most_around; ++step) {
    const auto& at = complex_[tet];
    const unsigned across = place_of(behind, at.corners);
    if (const Index other = side_of_[4 * std::size_t{tet} + across]; other != none) {
      edge.beyond = other;
      edge.blocked = met > 1;
      return edge;
    }
    if (is_bare(tet, across)) {
      edge.blocked = true;
      return edge;
    }
    if (at.faces[across] != none) {
      edge.across = at.faces[across];
      edge.outwards = is_alike(side_corners(at.corners, across), mesh_.faces[edge.across]);
      ++met;
    }
    if (at.neighbours[across] == none) {
      edge.blocked = met != 1 || at.faces[across] == none;
      return edge;
    }
    for (const Index v : at.corners)
      if (v != a && v != b && v != behind) {
        behind = v;
        break;
      }
    // `behind` is now the corner on the face that was crossed.
    const Index next = at.neighbours[across];
    tet = next;
  }
  edge.blocked = true;
  return edge;
}

void Front::list_sides() {
  std::vector<Index> count(nodes.size(), 0);
  for (const WallSide& side : sides)
    for (const Index node : side.nodes) ++count[node];
  sides_at.first.resize(nodes.size() + 1);
  for (std::size_t n = 0; n < nodes.size(); ++n) sides_at.first[n + 1] = sides_at.first[n] + count[n];
  sides_at.entries.resize(sides_at.first.back());
  std::vector<Index> next(sides_at.first.begin(), sides_at.first.end() - 1);
  for (Index s = 0; s < sides.size(); ++s)
    for (const Index node : sides[s].nodes) sides_at.entries[next[node]++] = s;
  std::vector<Index> around;
  for (Index n = 0; n < nodes.size(); ++n) {
    around.clear();
    for (const Index s : sides_at[n])
      for (const Index other : sides[s].nodes)
        if (other != n) around.push_back(other);
    sort_uniquely(around);
    neighbours.entries.insert(neighbours.entries.end(), around.begin(), around.end());
    neighbours.end_group();
  }
}

void Front::find_directions() {
  for (Index n = 0; n < nodes.size(); ++n) {
    std::vector<Index> faces;
    for (const Index s : sides_at[n]) faces.push_back(sides[s].face);
    std::sort(faces.begin(), faces.end());
    // A facet that ends at the node has both of its sides in the sector.
    if (std::adjacent_find(faces.begin(), faces.end()) != faces.end()) nodes[n].blocked = true;
    if (!nodes[n].blocked) find_direction(n, faces_at_[n], edges_of[n]);
  }
}

void Front::find_direction(Index node, std::span<const Index> sector_faces,
                           std::span<const Index> sector_edges) {
  FrontNode& at = nodes[node];
  DirectionSearch search;
  for (const Index s : sides_at[node]) search.add_wall(normal(sides[s]));
  const std::vector<PatchNormal> normals = normals_of_patches(node);
  for (const PatchNormal& of : normals)
    if (const double length = norm(of.mean); length > 0) search.add_mean(of.mean / length);
  const Point& p = mesh_.points[at.vertex];
  std::vector<std::pair<Index, Vector>> patches;  // with the sum of the normals of their faces
  for (const Index f : sector_faces) {
    const Index patch = mesh_.face_patch[f];
    if (patch == none) {
      at.blocked = true;
      return;
    }
    const auto& [a, b, c] = mesh_.faces[f];
    const Vector n = cross(mesh_.points[b] - mesh_.points[a], mesh_.points[c] - mesh_.points[a]);
    auto known =
        std::find_if(patches.begin(), patches.end(), [&](const auto& each) { return each.first == patch; });
    if (known == patches.end()) known = patches.insert(known, {patch, Vector{}});
    known->second = known->second + n;
  }
  for (const auto& [patch, sum] : patches) {
    const Plc::Patch& of = plc_.patches[patch];
    search.stay_in_plane(of.planar ? of.normal : sum / std::max(norm(sum), 1e-300));
    at.slides_on = {2, patch};
  }
  for (const Index e : sector_edges) {
    const Index curve = mesh_.edge_curve[e];
    if (curve == none || !plc_.curves[curve].straight || at.slides_on.dimension == 1) {
      at.blocked = true;
      return;
    }
    const auto [a, b] = mesh_.edges[e];
    const Vector way = mesh_.points[a == at.vertex ? b : a] - p;
    search.stay_on_line(way / norm(way));
    at.slides_on = {1, curve};
  }
  const std::optional<Direction> found = search.best();
  if (!found) {
    at.blocked = true;
    return;
  }
  at.direction = found->direction;
  at.least_cosine = found->least_cosine;
  // Triangles deviate from a curved wall to both sides, so use the mean of their normals for each patch.
  at.cosine = 1;
  for (const PatchNormal& of : normals) at.cosine = std::min(at.cosine, dot(of.mean, at.direction));
}

std::vector<Front::PatchNormal> Front::normals_of_patches(Index node) const {
  std::vector<PatchNormal> normals;
  for (const Index s : sides_at[node]) {
    const WallSide& side = sides[s];
    const auto i =
        static_cast<std::size_t>(std::find(side.nodes.begin(), side.nodes.end(), node) - side.nodes.begin());
    const Point& p = mesh_.points[side.corners[i]];
    const Vector u = mesh_.points[side.corners[(i + 1) % 3]] - p;
    const Vector v = mesh_.points[side.corners[(i + 2) % 3]] - p;
    const double angle = std::atan2(norm(cross(u, v)), dot(u, v));
    auto found = std::find_if(normals.begin(), normals.end(),
                              [&](const PatchNormal& of) { return of.patch == side.patch; });
    if (found == normals.end()) found = normals.insert(found, {side.patch, 0, {}});
    found->angle += angle;
    found->mean = found->mean + angle * normal(side);
  }
  for (PatchNormal& of : normals)
    if (of.angle > 0) of.mean = of.mean / of.angle;
  return normals;
}

}  // namespace collarmesh::layering
