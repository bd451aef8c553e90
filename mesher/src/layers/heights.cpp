#include "layers/heights.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "common/box_tree.h"
#include "common/layer_jacobians.h"
#include "common/parallel_for.h"
#include "common/sort_uniquely.h"

namespace collarmesh::layering {

namespace {

// Height of the first layer if none is given, relative to the mean length of the wall's edges at a node.
constexpr double share_of_edges = 0.1;
// Cosines between a direction and a wall's normal. Below `flattest` there are no layers. A node moves by the
// height divided by the cosine or, if the cosine is below `flat`, divided by `flat`.
constexpr double flattest = 0.1, flat = 0.4;
// The share of a gap that a stack (the layers above a place of the wall) may take: `of_shared_gap` if there
// is another stack on the opposite side of the gap, else `of_gap`.
constexpr double of_shared_gap = 0.3, of_gap = 0.5;
// The least Jacobian in a stack, relative to the largest one.
constexpr double least_jacobian_share = 0.15;
constexpr double largest_step_of_neighbours = 2, rounding = 1e-9;
// Stacks lower than this share of the height that is asked for, or of the height that gaps allow if that is
// less, are left out.
constexpr double least_share = 0.01;
// Edges of the wall may bulge to at most this share of the layers' height.
constexpr double most_bulging = 0.4;
constexpr double lowering = 0.8;
constexpr unsigned most_lowerings = 24;
constexpr std::size_t nodes_at_once = 64;

/// Returns the distance at which a ray meets a triangle; infinite if it does not.
double distance_along(const Point& from, const Vector& way, const std::array<Point, 3>& t) {
  const Vector u = t[1] - t[0], v = t[2] - t[0], h = cross(way, v);
  const double det = dot(u, h);
  if (det == 0) return INFINITY;
  const Vector s = from - t[0], q = cross(s, u);
  const double a = dot(s, h) / det, b = dot(way, q) / det;
  constexpr double slack = 1e-9;
  if (a < -slack || b < -slack || a + b > 1 + slack) return INFINITY;
  const double along = dot(v, q) / det;
  return along > 0 ? along : INFINITY;
}

}  // namespace

std::string text_of(Cause cause) {
  switch (cause) {
    case Cause::ends: return "layers end there, at faces without layers or at facets inside";
    case Cause::direction:
      return "the faces there meet so sharply that no direction leads steeply away from all of them";
    case Cause::patch: return "nodes would move off a curved face that has no layers";
    case Cause::gap: return "the gap to the opposite face is narrow";
    case Cause::fold: return "cells would fold, at a sharp edge or a curved wall";
    case Cause::core: return "tetrahedra beside the layers would miss their bounds";
    case Cause::step: return "the layers at neighbouring nodes are lower";
    default: return "";
  }
}

Heights::Heights(const Front& front, const TetMesh& mesh, const Plc& plc, const WallChoice& walls)
    : front_(front), mesh_(mesh), plc_(plc), walls_(walls) {
  const std::size_t n = front.nodes.size();
  length_.assign(n, 0);
  asked_.assign(n, 0);
  possible_.assign(n, 0);
  asked_height_.assign(n, 0);
  cause_.assign(n, Cause::none);
  walls_at_.assign(n, nullptr);
  ask();
}

void Heights::ask() {
  for (Index n = 0; n < size(); ++n) {
    const FrontNode& node = front_.nodes[n];
    double height = INFINITY, edges = 0;
    bool alike = true;
    for (const Index s : front_.sides_at[n]) {
      const WallLayers& wall = walls_[front_.sides[s].patch];
      if (walls_at_[n] == nullptr) walls_at_[n] = &wall;
      alike = alike && wall.count == walls_at_[n]->count && wall.growth == walls_at_[n]->growth;
    }
    const auto around = front_.neighbours[n];
    for (const Index other : around)
      edges += distance(mesh_.points[node.vertex], mesh_.points[front_.nodes[other].vertex]) /
               static_cast<double>(around.size());
    for (const Index s : front_.sides_at[n]) {
      const WallLayers& wall = walls_[front_.sides[s].patch];
      const double first = wall.first > 0 ? wall.first : share_of_edges * edges;
      height = std::min(height, wall.thickness > 0 ? wall.thickness : first * relative_thickness(wall));
    }
    asked_height_[n] = height;
    if (node.blocked || !alike) {
      asked_[n] = possible_[n] = height;
      lower(n, 0, Cause::ends);
      continue;
    }
    asked_[n] = possible_[n] = length_[n] = height / std::max(node.cosine, flat);
    if (node.cosine < flat) cause_[n] = Cause::direction;
    if (node.least_cosine < flattest) lower(n, 0, Cause::direction);
  }
}

double Heights::height(Index node) const {
  return asked_[node] > 0 ? length_[node] * front_.nodes[node].cosine : 0;
}

bool Heights::is_lower(Index node) const {
  constexpr double all = 0.999;
  return height(node) < all * asked_height_[node];
}

Point Heights::place(Index node, double distance) const {
  return mesh_.points[front_.nodes[node].vertex] + distance * front_.nodes[node].direction;
}

void Heights::lower(Index node, double to, Cause cause) {
  if (to < least_share * possible_[node]) to = 0;
  if (to >= length_[node] && to > 0) return;
  if (cause_[node] != Cause::none && length_[node] == 0) return;
  length_[node] = to;
  cause_[node] = cause;
}

void Heights::fit_gaps() {
  std::vector<Box> boxes(mesh_.faces.size());
  for (std::size_t f = 0; f < boxes.size(); ++f)
    for (const Index v : mesh_.faces[f]) boxes[f].add(mesh_.points[v]);
  const BoxTree tree(boxes);
  Box all;
  for (const Box& box : boxes) all.add(box);
  const double farthest = all.diagonal() * (1 + rounding);
  std::vector<double> room(size(), INFINITY);
  parallel_for_ranges(size(), nodes_at_once, [&](std::size_t first, std::size_t last) {
    for (auto n = static_cast<Index>(first); n < last; ++n) {
      if (length_[n] == 0) continue;
      const Index vertex = front_.nodes[n].vertex;
      const Point& from = mesh_.points[vertex];
      const double reach = std::min(length_[n] / of_shared_gap, farthest);
      tree.for_each_near_segment(from, place(n, reach), [&](Index f) {
        const auto& [a, b, c] = mesh_.faces[f];
        if (a == vertex || b == vertex || c == vertex) return;
        const double gap = distance_along(from, front_.nodes[n].direction,
                                          {mesh_.points[a], mesh_.points[b], mesh_.points[c]});
        const double share = walls_.is_wall(mesh_.face_patch[f]) ? of_shared_gap : of_gap;
        room[n] = std::min(room[n], share * gap);
      });
    }
  });
  for (Index n = 0; n < size(); ++n)
    if (room[n] < length_[n]) {
      possible_[n] = room[n];
      lower(n, room[n], Cause::gap);
    }
}

void Heights::fit_patches(const remeshing::SmoothSurfaces& surfaces, const SurfaceTolerance& tolerance) {
  constexpr unsigned most_halvings = 3;
  for (Index n = 0; n < size(); ++n) {
    const TetMesh::VertexFeature& slides_on = front_.nodes[n].slides_on;
    const Index patch = slides_on.feature;
    if (slides_on.dimension != 2 || plc_.patches[patch].planar || length_[n] == 0) continue;
    const double most = tolerance.least_on_patch(patch);
    double to = length_[n];
    const auto is_near = [&](double along) {
      const Point p = place(n, along);
      return distance(surfaces.nearest(patch, p).point, p) <= most;
    };
    for (unsigned k = 0; k < most_halvings && !(is_near(to) && is_near(0.5 * to)); ++k) to *= 0.5;
    if (!(is_near(to) && is_near(0.5 * to))) to = 0;
    if (to < length_[n]) lower(n, to, Cause::patch);
  }
}

void Heights::fit_bulges(const Bulges& bulges) {
  if (bulges.empty()) return;
  for (const WallSide& side : front_.sides)
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = side.nodes[i], b = side.nodes[(i + 1) % 3];
      const Vector bulge = bulges(side.corners[i], side.corners[(i + 1) % 3]);
      for (const Index n : {a, b})
        if (dot(bulge, front_.nodes[n].direction) > most_bulging * std::max(length_[a], length_[b]))
          lower(n, 0, Cause::fold);
    }
}

/// Returns the least Jacobian in the stack on a side, relative to the largest one; 1 if there is no stack.
/// For a stack of tets returns only the sign, 1 or -1.
double Heights::relative_jacobian(const WallSide& side) const {
  std::array<Point, 3> below, above;
  unsigned raised = 0, first_raised = 0, first_low = 0;
  for (unsigned i = 0; i < 3; ++i) {
    below[i] = mesh_.points[side.corners[i]];
    above[i] = place(side.nodes[i]);
    const bool is_raised = length_[side.nodes[i]] > 0;
    if (is_raised && raised++ == 0) first_raised = i;
    if (!is_raised) first_low = i;
  }
  if (raised == 0) return 1;
  double least = INFINITY, largest = 0;
  const auto see = [&](double jacobian) {
    least = std::min(least, jacobian);
    largest = std::max(largest, jacobian);
  };
  if (raised == 3) {
    const PrismCorners p{below[0], below[1], below[2], above[0], above[1], above[2]};
    for (unsigned i = 0; i < 3; ++i) {
      const auto along = jacobian_along_edge(p, i);
      for (const double b : {along[0], along[2], least_along_edge(along)}) see(b);
      // The tets into which the prism may be divided.
      see(six_volume(below[0], below[1], below[2], above[i]));
      see(six_volume(above[0], above[1], above[2], below[i]) * -1.0);
    }
  } else if (raised == 2) {
    const unsigned z = first_low, i = (z + 1) % 3, j = (z + 2) % 3;
    for (const double b : jacobians_at_base({below[j], below[i], above[i], above[j], below[z]})) see(b);
  } else {
    return six_volume(below[0], below[1], below[2], above[first_raised]) > 0 ? 1 : -1;
  }
  return least / largest;
}

/// Lowers the stacks with cells that fold or nearly fold; leaves them out if `strictly`. Returns whether
/// there were such cells.
bool Heights::unfold(bool strictly) {
  std::vector<std::uint8_t> folded(front_.sides.size(), 0);
  parallel_for_ranges(folded.size(), nodes_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t s = first; s < last; ++s)
      folded[s] = relative_jacobian(front_.sides[s]) < least_jacobian_share ? 1 : 0;
  });
  std::vector<Index> at;
  for (std::size_t s = 0; s < folded.size(); ++s)
    if (folded[s] != 0) at.insert(at.end(), front_.sides[s].nodes.begin(), front_.sides[s].nodes.end());
  sort_uniquely(at);
  for (const Index n : at)
    if (length_[n] > 0) lower(n, strictly ? 0 : lowering * length_[n], Cause::fold);
  return !at.empty();
}

/// Lowers stacks to at most twice the heights of neighbouring stacks, starting from the lowest. Returns
/// whether it lowered any.
bool Heights::limit_steps() {
  using Item = std::pair<double, Index>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
  for (Index n = 0; n < size(); ++n)
    if (length_[n] > 0) queue.emplace(height(n), n);
  bool any = false;
  while (!queue.empty()) {
    const auto [low, n] = queue.top();
    queue.pop();
    if (low != height(n)) continue;
    const double most = largest_step_of_neighbours * low * (1 - rounding);
    for (const Index other : front_.neighbours[n]) {
      if (height(other) <= most * (1 + 0.5 * rounding)) continue;
      lower(other, most / front_.nodes[other].cosine, Cause::step);
      any = true;
      if (length_[other] > 0) queue.emplace(height(other), other);
    }
  }
  return any;
}

bool Heights::settle() {
  bool any = limit_steps();
  for (unsigned pass = 0; unfold(pass >= most_lowerings); ++pass) {
    any = true;
    limit_steps();
  }
  return any;
}

double Heights::largest_step() const {
  double largest = 1;
  for (Index n = 0; n < size(); ++n)
    for (const Index other : front_.neighbours[n])
      if (length_[n] > 0 && length_[other] > 0) largest = std::max(largest, height(n) / height(other));
  return largest;
}

}  // namespace collarmesh::layering
