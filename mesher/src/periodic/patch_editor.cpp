#include "periodic/patch_editor.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>

#include "common/contains.h"
#include "common/spatial_order.h"
#include "delaunay/predicates.h"

namespace collarmesh::periodicity {

namespace {

// A node this near to a place is moved there. The distance is relative to the shortest edge of the patch at
// the node.
constexpr double near_in_patch = 0.25;
constexpr double good_patch_removal = 0.3;    // quality that a removal must leave; otherwise the node is kept
                                              // and inserted on the pair's other patch
constexpr double good_enough_in_patch = 0.1;  // quality that a move must leave unless tets are poorer
                                              // already
constexpr double fair_flip = 0.02;            // quality that an edge flip must leave if it is optional

}  // namespace

PatchEditor::PatchEditor(CavityEditor& editor, const Plc& plc, Index patch, std::span<const Index> faces)
    : editor_(editor), patch_(patch) {
  const Plc::Patch& of = plc.patches[patch];
  normal_ = of.regions[1] == 0 ? of.normal : -1 * of.normal;
  viewpoint_ = of.origin + plc.bounds.diagonal() * normal_;
  for (const Index face : faces) {
    add_face(face);
    for (const Index v : editor.mesh().faces[face])
      if (is_inside(v)) stays_.emplace(v, false);
  }
}

bool PatchEditor::is_inside(Index node) const { return editor_.mesh().features[node].dimension == 2; }

int PatchEditor::side(Index a, Index b, const Point& p) const {
  return predicates::orientation(editor_.at(a), editor_.at(b), p, viewpoint_);
}

// Returns the third corner of the face to the left of ab; none at a border.
Index PatchEditor::opposite(Index a, Index b) const {
  const auto found = faces_at_.find(edge_key(a, b));
  if (found == faces_at_.end()) return none;
  for (const Index face : found->second) {
    if (face == none) continue;
    const auto& corners = editor_.mesh().faces[face];
    for (unsigned i = 0; i < 3; ++i)
      if (corners[i] == a && corners[(i + 1) % 3] == b) return corners[(i + 2) % 3];
  }
  return none;
}

void PatchEditor::add_face(Index face) {
  const auto& corners = editor_.mesh().faces[face];
  for (unsigned i = 0; i < 3; ++i) {
    auto& at = faces_at_.try_emplace(edge_key(corners[i], corners[(i + 1) % 3]), std::array{none, none})
                   .first->second;
    at[at[0] == none ? 0 : 1] = face;
  }
  last_ = face;
}

void PatchEditor::drop_face(Index face) {
  const auto& corners = editor_.mesh().faces[face];
  for (unsigned i = 0; i < 3; ++i) {
    const auto found = faces_at_.find(edge_key(corners[i], corners[(i + 1) % 3]));
    for (Index& at : found->second)
      if (at == face) at = none;
    if (found->second[0] == none && found->second[1] == none) faces_at_.erase(found);
  }
}

void PatchEditor::drop_faces(const Cavity& cavity) {
  for (const Index face : cavity.faces) drop_face(face);
}

void PatchEditor::add_created_faces() {
  for (const Index face : editor_.created_faces()) add_face(face);
}

void PatchEditor::replace(const Cavity& cavity, Index apex) {
  drop_faces(cavity);
  editor_.fill(cavity, apex);
  add_created_faces();
}

Index PatchEditor::replace_by_new(const Cavity& cavity, const Point& apex,
                                  const TetMesh::VertexFeature& feature) {
  drop_faces(cavity);
  const Index vertex = editor_.insert(cavity, apex, feature);
  add_created_faces();
  return vertex;
}

std::vector<PatchEditor::Edge> PatchEditor::edges_of_created_faces() const {
  std::vector<Edge> edges;
  for (const Index face : editor_.created_faces()) {
    const auto& corners = editor_.mesh().faces[face];
    for (unsigned i = 0; i < 3; ++i) edges.push_back({corners[i], corners[(i + 1) % 3]});
  }
  return edges;
}

std::vector<Index> PatchEditor::add_nodes(std::span<const Point> places) {
  std::vector<Index> nodes(places.size(), none);
  const std::vector<SpatialKey> order = spatial_order(places);
  for (const auto& [place, i] : order) nodes[i] = move_one_to(places[i]);
  for (const auto& [place, i] : order)
    if (nodes[i] == none) nodes[i] = insert(places[i]);
  return nodes;
}

std::vector<Index> PatchEditor::put_nodes(std::span<const Point> places) {
  std::vector<Index> nodes = add_nodes(places);
  for (const Index node : others()) remove(node);
  return nodes;
}

std::vector<Index> PatchEditor::others() const {
  std::vector<Index> others;
  for (const auto& [node, stays] : stays_)
    if (!stays) others.push_back(node);
  std::sort(others.begin(), others.end());
  return others;
}

// Finds the face at a place. Walks there from the last face; if a hole is in the way, searches all faces.
Index PatchEditor::find_face(const Point& place) {
  const auto& faces = editor_.mesh().faces;
  const auto edge_before = [&](Index face) {
    for (unsigned i = 0; i < 3; ++i)
      if (side(faces[face][i], faces[face][(i + 1) % 3], place) < 0) return i;
    return 3U;
  };
  Index face = last_;
  for (std::size_t step = 0; step < faces_at_.size(); ++step) {
    const unsigned i = edge_before(face);
    if (i == 3) return last_ = face;
    const auto& sides = faces_at_.at(edge_key(faces[face][i], faces[face][(i + 1) % 3]));
    const Index next = sides[0] == face ? sides[1] : sides[0];
    if (next == none) break;
    face = next;
  }
  for (const auto& [key, at] : faces_at_)
    for (const Index f : at)
      if (f != none && edge_before(f) == 3) return last_ = f;
  return none;
}

// Moves the nearest corner of the face at a place to that place, if it is near enough and the tets stay good
// enough. Returns the corner, or none.
Index PatchEditor::move_one_to(const Point& place) {
  const Index face = find_face(place);
  if (face == none) return none;
  const auto corners = editor_.mesh().faces[face];
  const auto off = [&](Index v) { return distance(editor_.at(v), place); };
  const Index node =
      *std::min_element(corners.begin(), corners.end(), [&](Index a, Index b) { return off(a) < off(b); });
  const auto stays = stays_.find(node);
  if (stays == stays_.end() || stays->second) return none;
  const Cavity cavity = editor_.around_vertex(node);
  double shortest = INFINITY;
  for (const auto& [ends, like] : cavity.rim)
    shortest = std::min(shortest, distance(editor_.at(ends[0]), editor_.at(node)));
  if (off(node) > near_in_patch * shortest) return none;
  if (editor_.worst(cavity, place, node) <
      std::min(good_enough_in_patch, editor_.worst(cavity, editor_.at(node), node)))
    return none;
  editor_.move(node, place);
  stays->second = true;
  return node;
}

// Inserts a node at a place, in a face or on one of its edges.
Index PatchEditor::insert(const Point& place) {
  const Index face = find_face(place);
  if (face == none) return none;
  const auto corners = editor_.mesh().faces[face];
  Cavity best = editor_.around_face(face);
  double quality = editor_.worst(best, place, none);
  for (unsigned i = 0; i < 3; ++i) {
    const Index a = corners[i], b = corners[(i + 1) % 3];
    if (editor_.on_curve(a, b)) continue;
    Cavity cavity = editor_.around_edge(a, b);
    if (const double q = editor_.worst(cavity, place, none); q > quality)
      quality = q, best = std::move(cavity);
  }
  if (quality < 0) return none;
  const Index node = replace_by_new(best, place, {2, patch_});
  stays_[node] = true;
  ++change_.inserted;
  make_delaunay(edges_of_created_faces());
  return node;
}

// Removes a node by collapsing an edge onto the best neighbour, if that leaves good tets.
void PatchEditor::remove(Index node) {
  Cavity cavity = editor_.around_vertex(node);
  Index onto = none;
  double quality = -1;
  for (const auto& [ends, like] : cavity.rim)
    if (const double q = editor_.worst(cavity, editor_.at(ends[0]), ends[0]); q > quality)
      quality = q, onto = ends[0];
  if (quality < good_patch_removal) return;
  replace(cavity, onto);
  ++change_.removed;
  stays_.erase(node);
  make_delaunay(edges_of_created_faces());
}

// Finds the place below `start` at which an apex makes the best tets. Returns the quality of the worst of
// these tets, and the place.
std::pair<double, Point> PatchEditor::best_below(const Cavity& cavity, const Point& start) const {
  double size = 0;
  Vector sum{0, 0, 0};
  for (const Cavity::Side& each : cavity.hull)
    for (const Index v : each.corners) {
      size = std::max(size, distance(editor_.at(v), start));
      sum = sum + (editor_.at(v) - start);
    }
  const Vector to_middle = sum / (3.0 * static_cast<double>(cavity.hull.size()));
  std::pair<double, Point> best{-1, start};
  const auto consider = [&](const Point& place) {
    if (const double q = editor_.worst(cavity, place, none); q > best.first) best = {q, place};
  };
  for (double depth = 0.5; depth > 1e-4; depth *= 0.5) {
    consider(start - depth * size * normal_);
    consider(start + depth * 2 * to_middle);
  }
  for (double step = 0.1 * size; best.first > 0 && step > 0.01 * size; step *= 0.5)
    for (const Vector& by : {Vector{step, 0, 0}, Vector{0, step, 0}, Vector{0, 0, step}}) {
      const Point from = best.second;
      consider(from + by);
      consider(from - by);
    }
  return best;
}

void PatchEditor::make_delaunay(std::vector<Edge> edges) {
  for (std::size_t turned = 0; !edges.empty() && turned < 1000;) {
    const auto [a, b] = edges.back();
    edges.pop_back();
    if (!has(a, b) || editor_.on_curve(a, b)) continue;
    const Index c = opposite(a, b), d = opposite(b, a);
    if (c == none || d == none || is_delaunay(a, b, c, d) || !turn(a, b, fair_flip, false)) continue;
    ++turned;
    for (const Edge& edge : {Edge{a, d}, Edge{d, b}, Edge{b, c}, Edge{c, a}}) edges.push_back(edge);
  }
}

// Returns whether the angles opposite the edge sum up to at most two right angles.
bool PatchEditor::is_delaunay(Index a, Index b, Index c, Index d) const {
  constexpr double tolerance = 1e-9;
  const Point &p = editor_.at(a), &q = editor_.at(b), &r = editor_.at(c), &s = editor_.at(d);
  const double cosine_r = dot(p - r, q - r), sine_r = norm(cross(p - r, q - r)), cosine_s = dot(p - s, q - s),
               sine_s = norm(cross(p - s, q - s));
  const double scale = std::hypot(cosine_r, sine_r) * std::hypot(cosine_s, sine_s);
  return sine_r * cosine_s + cosine_r * sine_s >= -tolerance * scale;
}

// Flips the edge ab: replaces it by the edge between the opposite corners of its two faces.
bool PatchEditor::turn(Index a, Index b, double least, bool with_new_vertex) {
  const Index c = opposite(a, b), d = opposite(b, a);
  if (c == none || d == none || side(d, c, a) * side(d, c, b) >= 0) return false;
  Cavity cavity = editor_.around_edge(a, b);
  if (cavity.faces.size() != 2) return false;
  const Index like = cavity.faces[0];
  cavity.floor = {{{a, d, c}, like}, {{b, c, d}, like}};
  cavity.rim.clear();
  Index apex = none;
  double quality = least;
  for (const Cavity::Side& each : cavity.hull)
    for (const Index v : each.corners) {
      if (v == a || v == b || v == c || v == d || v == apex) continue;
      if (const double q = editor_.worst(cavity, editor_.at(v), v); q > quality) quality = q, apex = v;
    }
  if (apex != none) {
    replace(cavity, apex);
  } else {
    if (!with_new_vertex) return false;
    const auto [q, place] = best_below(cavity, 0.5 * (editor_.at(a) + editor_.at(b)));
    if (q < 0) return false;
    replace_by_new(cavity, place, {3, none});
    ++change_.inserted;
  }
  ++change_.turned;
  return true;
}

std::size_t PatchEditor::make_edges(std::span<const Edge> edges, double least, bool must) {
  return static_cast<std::size_t>(std::ranges::count_if(edges, [&](const Edge& edge) {
    return !has(edge[0], edge[1]) && !make_edge(edge[0], edge[1], least, must);
  }));
}

std::vector<PatchEditor::Edge> PatchEditor::edges() const {
  std::vector<Edge> edges;
  for (const auto& [key, at] : faces_at_)
    edges.push_back({static_cast<Index>(key >> 32U), static_cast<Index>(key)});
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::vector<Point> PatchEditor::places_of_others() const {
  std::vector<Point> places;
  std::ranges::transform(others(), std::back_inserter(places),
                         [this](Index node) { return editor_.at(node); });
  return places;
}

// Makes an edge by flipping the edges that cross it, first those whose faces form a convex quadrilateral
// (Sloan 1993).
bool PatchEditor::make_edge(Index a, Index b, double least, bool must) {
  const std::vector<Edge> all = crossed(a, b);
  std::deque<Edge> edges(all.begin(), all.end());
  if (edges.empty()) return false;
  const std::size_t most = 20 + 10 * edges.size() * edges.size();
  for (std::size_t steps = 0; !edges.empty() && steps < most; ++steps) {
    const auto [u, v] = edges.front();
    edges.pop_front();
    const Index c = opposite(u, v), d = opposite(v, u);
    if (!turn(u, v, least, false) && !(must && turn(u, v, CavityEditor::least_quality, true))) {
      edges.push_back({u, v});
      continue;
    }
    if (c != a && c != b && d != a && d != b && side(a, b, c) * side(a, b, d) < 0) edges.push_back({c, d});
  }
  return has(a, b);
}

// Returns the edges that cross the line from a to b, in order; none if a node is in the way.
std::vector<PatchEditor::Edge> PatchEditor::crossed(Index a, Index b) const {
  const auto& patches = editor_.mesh().face_patch;
  std::vector<Edge> edges;
  Edge edge{none, none};  // to the right and to the left of ab
  for (const auto& [ends, like] : editor_.around_vertex(a).rim)
    if (patches[like] == patch_ && side(a, ends[0], b) > 0 && side(a, ends[1], b) < 0) edge = ends;
  while (edge[0] != none) {
    edges.push_back(edge);
    const Index next = opposite(edge[1], edge[0]);
    if (next == b) return edges;
    const int at = next == none ? 0 : side(a, b, next);
    if (at == 0) return {};
    edge = at > 0 ? Edge{edge[0], next} : Edge{next, edge[1]};
  }
  return {};
}

}  // namespace collarmesh::periodicity
