#include "shells/surface_editor.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "common/sort_uniquely.h"
#include "shells/curve_division.h"
#include "shells/vertex_fan.h"

namespace collarmesh::shells {

namespace {

// Least cosine of the angle between a new triangle and its patch; and the least one at a new vertex, whose
// triangles may be flipped afterwards.
constexpr double least_agreement = 0.6, least_agreement_at_first = 0.2;

/// Returns whether the lists of triangles and edges at the corners of new triangles are consistent.
[[maybe_unused]] bool lists_are_consistent(const SurfaceComplex& complex,
                                           std::span<const SurfaceEditor::Created> created) {
  return std::ranges::all_of(created, [&](const SurfaceEditor::Created& n) {
    return std::ranges::all_of(n.corners, [&](Index v) { return complex.consistent(v); });
  });
}

}  // namespace

SurfaceEditor::SurfaceEditor(SurfaceComplex& complex, const Plc& plc, const CurvePaths& paths,
                             const PatchSurfaces& surfaces, const SurfaceSizes& sizes,
                             SurfaceTolerance tolerance, double most_excess)
    : complex_(complex),
      plc_(plc),
      paths_(paths),
      surfaces_(surfaces),
      sizes_(sizes),
      tolerance_(std::move(tolerance)),
      most_excess_(most_excess) {}

double SurfaceEditor::least_shape_at(Index vertex, double bound) const {
  double least = INFINITY;
  for (const Index t : complex_.vertices[vertex].triangles)
    if ((least = std::min(least, shape(t))) < bound) break;
  return least;
}

unsigned SurfaceEditor::side_too_far(Index triangle) const {
  constexpr unsigned no_side = 3;
  const std::array<Index, 3>& c = complex_.triangles[triangle].corners;
  const Index patch = complex_.triangles[triangle].patch;
  if (surfaces_.planar(patch)) return no_side;
  unsigned worst = no_side, longest = 0;
  double most = most_excess_, most_length = 0;
  for (unsigned i = 0; i < 3; ++i) {
    const Index a = c[i], b = c[(i + 1) % 3];
    if (const double long_side = length(a, b); long_side > most_length) {
      most_length = long_side;
      longest = i;
    }
    if (complex_.edge_at(a, b) != none) continue;
    const double excess =
        surfaces_.excess_between(patch, complex_.vertices[a].point, complex_.vertices[b].point, most_excess_);
    if (excess <= most) continue;
    most = excess;
    worst = i;
  }
  if (worst != no_side) return worst;
  return surfaces_.fit(complex_.corners(triangle), patch, most_excess_).excess > most_excess_ ? longest
                                                                                              : no_side;
}

std::vector<std::pair<Index, Point>> SurfaceEditor::far_points() const {
  std::vector<std::vector<Index>> of_patch(plc_.patches.size());
  for (Index t = 0; t < complex_.triangles.size(); ++t)
    if (complex_.triangles[t].alive() && !surfaces_.planar(complex_.triangles[t].patch))
      of_patch[complex_.triangles[t].patch].push_back(t);
  std::vector<std::pair<Index, Point>> found;
  for (Index patch = 0; patch < of_patch.size(); ++patch) {
    std::vector<Corners> corners;
    corners.reserve(of_patch[patch].size());
    for (const Index t : of_patch[patch]) corners.push_back(complex_.corners(t));
    for (const auto& [i, point] : surfaces_.far_points(patch, corners, most_excess_))
      found.emplace_back(of_patch[patch][i], point);
  }
  return found;
}

PatchSurfaces::Fit SurfaceEditor::worst_fit(std::span<const Index> triangles) const {
  PatchSurfaces::Fit worst;
  for (const Index t : triangles) {
    const PatchSurfaces::Fit fit =
        surfaces_.fit(complex_.corners(t), complex_.triangles[t].patch, most_excess_);
    worst = {std::min(worst.agreement, fit.agreement), std::max(worst.excess, fit.excess)};
  }
  return worst;
}

/// Returns whether created triangles fit their patches, or at least as well as the worst of the removed ones:
/// at their centres and, unless `centre` is none, along their sides at that vertex.
bool SurfaceEditor::fit(std::span<const Created> created, std::span<const Index> removed,
                        Index centre) const {
  std::optional<PatchSurfaces::Fit> before;
  const auto old = [&] { return before ? *before : *(before = worst_fit(removed)); };
  for (const Created& t : created) {
    const PatchSurfaces::Fit fit = surfaces_.fit(complex_.corners(t.corners), t.patch, most_excess_);
    if (!(fit.agreement > 0)) return false;
    if (fit.agreement < least_agreement && fit.agreement < old().agreement) return false;
    if (fit.excess > most_excess_ && fit.excess > old().excess) return false;
    if (centre == none || surfaces_.planar(t.patch)) continue;
    for (unsigned i = 0; i < 3; ++i) {
      if (t.corners[i] != centre) continue;
      const double excess =
          surfaces_.excess_between(t.patch, complex_.vertices[centre].point,
                                   complex_.vertices[t.corners[(i + 1) % 3]].point, most_excess_);
      if (excess > most_excess_ && excess > old().excess) return false;
    }
  }
  return true;
}

bool SurfaceEditor::flip(Index a, Index b) {
  if (complex_.edge_at(a, b) != none) return false;
  const auto both = complex_.two_triangles_at(a, b);
  if (!both) return false;
  const std::array<Index, 2> two = *both;
  const auto& s = complex_.triangles[two[0]];
  const auto& t = complex_.triangles[two[1]];
  if (s.patch != t.patch) return false;
  // Orients ab as in the first triangle.
  const auto place =
      static_cast<unsigned>(std::find(s.corners.begin(), s.corners.end(), a) - s.corners.begin());
  if (s.corners[(place + 1) % 3] != b) std::swap(a, b);
  const Index c = s.third(a, b), d = t.third(a, b), patch = s.patch;
  if (c == d) return false;
  const std::array<Created, 2> created{{{{a, d, c}, patch}, {{d, b, c}, patch}}};
  const double before = std::min(shape(two[0]), shape(two[1]));
  constexpr double least_gain = 1e-6;  // relative gain, because angles of needles between curves are tiny
  for (const Created& n : created)
    if (!(shape_of(complex_.corners(n.corners)) > (1 + least_gain) * before)) return false;
  if (complex_.edge_at(c, d) != none || complex_.have_triangle(c, d)) return false;
  if (!fit(created, two, c)) return false;
  for (const Index old : two) complex_.remove_triangle(old);
  for (const Created& n : created) complex_.add_triangle(n.corners, n.patch);
  assert(lists_are_consistent(complex_, created));
  return true;
}

/// Returns whether collapsing an edge keeps the topology (link condition): the links of its ends may share
/// only the link of the edge.
bool SurfaceEditor::can_collapse(Index from, Index to) const {
  const std::vector<Index> around = complex_.neighbours(from), around_to = complex_.neighbours(to);
  std::vector<Index> common, thirds;
  std::set_intersection(around.begin(), around.end(), around_to.begin(), around_to.end(),
                        std::back_inserter(common));
  for (const Index t : complex_.triangles_at(from, to))
    thirds.push_back(complex_.triangles[t].third(from, to));
  sort_uniquely(thirds);
  if (common != thirds) return false;
  for (const Index t : complex_.vertices[from].triangles) {
    const auto& corners = complex_.triangles[t];
    if (corners.has(to)) continue;
    for (const Index other : complex_.vertices[to].triangles) {
      const bool same = std::all_of(corners.corners.begin(), corners.corners.end(),
                                    [&](Index c) { return c == from || complex_.triangles[other].has(c); });
      if (same) return false;
    }
  }
  return true;
}

bool SurfaceEditor::shapes_permit(Index from, Index to, const CollapseRule& rule) const {
  const double before = least_shape_at(from);
  const double least = std::min(before, rule.least_shape);
  bool any = false;
  for (const Index t : complex_.vertices[from].triangles) {
    auto corners = complex_.triangles[t].corners;
    if (complex_.triangles[t].has(to)) continue;
    std::replace(corners.begin(), corners.end(), from, to);
    const double after = shape_of(complex_.corners(corners));
    if (after < least || (rule.better && after <= before)) return false;
    any = true;
  }
  return any;
}

bool SurfaceEditor::lengths_permit(Index from, Index to, const CollapseRule& rule) const {
  double longest = 0, longest_before = 0;  // longest edge after and before, relative to the sizes
  const auto look_at = [&](Index n) {
    if (n == to || n == from) return;
    longest = std::max(longest, length(n, to) / size_of_edge(n, to));
    longest_before = std::max(longest_before, length(n, from) / size_of_edge(n, from));
  };
  for (const Index t : complex_.vertices[from].triangles)
    for (const Index n : complex_.triangles[t].corners) look_at(n);
  return longest <= std::max(rule.longest, longest_before);
}

std::optional<std::array<Index, 2>> SurfaceEditor::edges_around(Index vertex) const {
  const auto& edges = complex_.vertices[vertex].edges;
  if (edges.size() != 2 || complex_.vertices[vertex].feature.dimension != 1) return std::nullopt;
  const bool in_order = complex_.edges[edges[0]].ends[1] == vertex;
  return in_order ? std::array{edges[0], edges[1]} : std::array{edges[1], edges[0]};
}

/// Returns the largest distance, divided by the tolerance, between a curve and the chord that would replace
/// two of its edges.
double SurfaceEditor::sag_across(const std::array<Index, 2>& two) const {
  const auto& before = complex_.edges[two[0]];
  const auto& behind = complex_.edges[two[1]];
  return sag_between(plc_, paths_, tolerance_, before.curve, before.at[0],
                     before.at[1] + (behind.at[1] - behind.at[0]));
}

bool SurfaceEditor::curve_permits(Index from, Index to, const CollapseRule& rule) const {
  const auto around = edges_around(from);
  const Index edge = complex_.edge_at(from, to);
  if (!around || edge == none) return false;
  const auto& before = complex_.edges[(*around)[0]];
  const auto& behind = complex_.edges[(*around)[1]];
  const Index other = edge == (*around)[0] ? behind.ends[1] : before.ends[0];
  if (other == to || complex_.edge_at(to, other) != none) return false;
  return length(to, other) <= rule.longest * size_of_edge(to, other) && sag_across(*around) <= most_excess_;
}

void SurfaceEditor::merge_edges(Index middle) {
  const auto [first, second] = *edges_around(middle);
  const auto before = complex_.edges[first], behind = complex_.edges[second];
  complex_.remove_edge(first);
  complex_.remove_edge(second);
  complex_.add_edge({before.ends[0], behind.ends[1]}, before.curve,
                    {before.at[0], before.at[1] + (behind.at[1] - behind.at[0])});
}

/// Removes a vertex with its triangles and puts new triangles there.
void SurfaceEditor::replace_vertex(Index vertex, std::span<const Created> created) {
  for (const Index t : std::vector<Index>(complex_.vertices[vertex].triangles)) complex_.remove_triangle(t);
  if (complex_.vertices[vertex].feature.dimension == 1) merge_edges(vertex);
  for (const Created& n : created) complex_.add_triangle(n.corners, n.patch);
  assert(complex_.vertices[vertex].triangles.empty() && complex_.vertices[vertex].edges.empty());
  assert(lists_are_consistent(complex_, created));
}

bool SurfaceEditor::collapse(Index from, Index to, const CollapseRule& rule) {
  const unsigned dimension = complex_.vertices[from].feature.dimension;
  if (dimension == 0 || ends_tip(from)) return false;
  if (dimension == 1 && complex_.edge_at(from, to) == none) return false;
  if (!shapes_permit(from, to, rule) || !lengths_permit(from, to, rule)) return false;
  if (dimension == 1 && !curve_permits(from, to, rule)) return false;
  if (!can_collapse(from, to)) return false;
  const std::vector<Index> all = complex_.vertices[from].triangles;
  std::vector<Created> created;
  for (const Index t : all) {
    if (complex_.triangles[t].has(to)) continue;
    created.push_back({complex_.triangles[t].corners, complex_.triangles[t].patch});
    std::replace(created.back().corners.begin(), created.back().corners.end(), from, to);
  }
  if (!fit(created, all, to)) return false;
  replace_vertex(from, created);
  return true;
}

/// Adds a vertex whose sizes keep the gradation. `asked`: the size that the options ask for there; `size`:
/// the same, considering lengths of curves.
Index SurfaceEditor::add_vertex(const Point& p, const TetMesh::VertexFeature& feature,
                                std::span<const Index> around, double size, double asked) {
  for (const Index n : around) {
    const auto& other = complex_.vertices[n];
    const double growth = sizes_.gradation() * distance(p, other.point);
    size = std::min(size, other.size + growth);
    asked = std::min(asked, other.asked + growth);
  }
  return complex_.add_vertex(p, feature, size, asked);
}

Index SurfaceEditor::new_vertex(const Point& p, Index patch, std::span<const Index> around) {
  Point place;
  Index triangle = plc_.patches[patch].first_triangle;
  if (surfaces_.planar(patch)) {
    place = surfaces_.onto_plane(patch, p);
  } else {
    const PatchSurfaces::Foot foot = surfaces_.nearest(patch, p);
    place = foot.point;
    triangle = foot.triangle;
  }
  const double size = sizes_.on_patch(patch, triangle, place);
  return add_vertex(place, {2, patch}, around, size, size);
}

Index SurfaceEditor::divide_at(Index a, Index b, std::span<const Index> triangles, const Point& p) {
  const Index patch = complex_.triangles[triangles[0]].patch;
  std::vector<Index> around{a, b};
  for (const Index t : triangles) around.push_back(complex_.triangles[t].third(a, b));
  const Index v = new_vertex(p, patch, around);
  std::vector<Created> created;
  for (const Index t : triangles)
    for (const Index end : {a, b}) {
      Created n{complex_.triangles[t].corners, patch};
      std::replace(n.corners.begin(), n.corners.end(), end, v);
      const double agreement = surfaces_.agreement(complex_.corners(n.corners), patch);
      if (agreement < least_agreement_at_first &&
          agreement <= surfaces_.agreement(complex_.corners(t), patch)) {
        complex_.vertices.pop_back();
        return none;
      }
      created.push_back(n);
    }
  for (const Index t : triangles) complex_.remove_triangle(t);
  for (const Created& n : created) complex_.add_triangle(n.corners, n.patch);
  assert(lists_are_consistent(complex_, created));
  return v;
}

Index SurfaceEditor::divide(Index a, Index b) {
  if (complex_.edge_at(a, b) != none) return none;
  const std::vector<Index> two = complex_.triangles_at(a, b);
  if (two.empty()) return none;
  return divide_at(a, b, two, 0.5 * (complex_.vertices[a].point + complex_.vertices[b].point));
}

Index SurfaceEditor::divide_curve_edge(Index edge, double at) {
  const SurfaceComplex::Edge old = complex_.edges[edge];
  const auto [a, b] = old.ends;
  const std::vector<Index> triangles = complex_.triangles_at(a, b);
  const Point p = paths_.point(old.curve, at);
  const Index v = add_vertex(p, {1, old.curve}, old.ends, sizes_.on_curve(old.curve, at),
                             sizes_.asked_on_curve(old.curve, at));
  std::vector<Created> created;
  for (const Index t : triangles)
    for (const Index end : {a, b}) {
      Created n{complex_.triangles[t].corners, complex_.triangles[t].patch};
      std::replace(n.corners.begin(), n.corners.end(), end, v);
      const double agreement = surfaces_.agreement(complex_.corners(n.corners), n.patch);
      if (!(agreement > least_agreement_at_first) &&
          agreement <= surfaces_.agreement(complex_.corners(t), n.patch)) {
        complex_.vertices.pop_back();
        return none;
      }
      created.push_back(n);
    }
  for (const Index t : triangles) complex_.remove_triangle(t);
  complex_.remove_edge(edge);
  for (const Index e : {complex_.add_edge({a, v}, old.curve, {old.at[0], at}),
                        complex_.add_edge({v, b}, old.curve, {at, old.at[1]})}) {
    complex_.edges[e].tip = complex_.edges[e].other(v) == old.tip ? old.tip : none;
  }
  for (const Created& n : created) complex_.add_triangle(n.corners, n.patch);
  assert(complex_.consistent(a) && complex_.consistent(b) && complex_.consistent(v));
  assert(lists_are_consistent(complex_, created));
  return v;
}

Index SurfaceEditor::insert(Index triangle, const Point& p) {
  constexpr double on_side = 0.1;
  const SurfaceComplex::Triangle old = complex_.triangles[triangle];
  const auto shares = barycentric(complex_.corners(triangle), p);
  const auto least = static_cast<unsigned>(std::min_element(shares.begin(), shares.end()) - shares.begin());
  if (shares[least] < on_side) {
    const Index a = old.corners[(least + 1) % 3], b = old.corners[(least + 2) % 3];
    if (const Index edge = complex_.edge_at(a, b); edge != none)
      return complex_.edges[edge].tip != none ? none : divide_curve_edge(edge);
    return divide_at(a, b, complex_.triangles_at(a, b), p);
  }
  const Index v = new_vertex(p, old.patch, old.corners);
  std::array<Created, 3> created;
  for (unsigned i = 0; i < 3; ++i) {
    created[i] = {old.corners, old.patch};
    created[i].corners[i] = v;
    if (surfaces_.agreement(complex_.corners(created[i].corners), old.patch) < least_agreement_at_first) {
      complex_.vertices.pop_back();
      return none;
    }
  }
  complex_.remove_triangle(triangle);
  for (const Created& n : created) complex_.add_triangle(n.corners, n.patch);
  assert(lists_are_consistent(complex_, created));
  return v;
}

void SurfaceEditor::flip_around(Index vertex) {
  constexpr unsigned most = 200;
  std::vector<std::array<Index, 2>> sides;
  const auto add = [&](Index v) {
    for (const Index t : complex_.vertices[v].triangles) {
      const auto& c = complex_.triangles[t].corners;
      for (unsigned i = 0; i < 3; ++i)
        if (c[i] == v) sides.push_back({c[(i + 1) % 3], c[(i + 2) % 3]});
    }
  };
  add(vertex);
  for (unsigned i = 0; i < most && !sides.empty(); ++i) {
    const auto [a, b] = sides.back();
    sides.pop_back();
    if (flip(a, b)) add(vertex);
  }
}

/// Returns the fit of the triangles around a vertex, at their centres and along their sides at the vertex:
/// the least agreement, and the sum of the excesses above the allowed one.
PatchSurfaces::Fit SurfaceEditor::misfit_around(Index vertex) const {
  PatchSurfaces::Fit all;
  const auto add = [&](double excess) { all.excess += std::max(0.0, excess - most_excess_); };
  for (const Index t : complex_.vertices[vertex].triangles) {
    const std::array<Index, 3>& c = complex_.triangles[t].corners;
    const Index patch = complex_.triangles[t].patch;
    const PatchSurfaces::Fit fit = surfaces_.fit(complex_.corners(c), patch, most_excess_);
    all.agreement = std::min(all.agreement, fit.agreement);
    if (!(all.agreement > 0)) return all;
    if (surfaces_.planar(patch)) continue;
    add(fit.excess);
    const auto i = static_cast<unsigned>(std::find(c.begin(), c.end(), vertex) - c.begin());
    add(surfaces_.excess_between(patch, complex_.vertices[vertex].point,
                                 complex_.vertices[c[(i + 1) % 3]].point, most_excess_));
  }
  return all;
}

bool SurfaceEditor::put(Index vertex, const Point& p, double least) {
  const Point before = complex_.vertices[vertex].point;
  if (VertexFan(complex_, vertex).least_shape(p, least) < least) return false;
  complex_.move_vertex(vertex, p);
  const PatchSurfaces::Fit after = misfit_around(vertex);
  bool good = after.agreement > 0;
  if (good && (after.agreement < least_agreement || after.excess > 0)) {
    complex_.move_vertex(vertex, before);
    const PatchSurfaces::Fit old = misfit_around(vertex);
    good = after.agreement >= std::min(old.agreement, least_agreement) && after.excess <= old.excess;
    if (good) complex_.move_vertex(vertex, p);
  } else if (!good) {
    complex_.move_vertex(vertex, before);
  }
  if (good)
    for (const Index t : complex_.vertices[vertex].triangles)
      for (const Index c : complex_.triangles[t].corners) ++complex_.vertices[c].changes;
  return good;
}

bool SurfaceEditor::move(Index vertex, const Point& p, double least) {
  const Index patch = complex_.vertices[vertex].feature.feature;
  return put(vertex,
             surfaces_.planar(patch) ? surfaces_.onto_plane(patch, p) : surfaces_.nearest(patch, p).point,
             least);
}

bool SurfaceEditor::slide(Index vertex, double at, double least) {
  const auto around = edges_around(vertex);
  if (!around || ends_tip(vertex)) return false;
  auto& before = complex_.edges[(*around)[0]];
  auto& behind = complex_.edges[(*around)[1]];
  const double shift = behind.at[0] - before.at[1];  // the length of a closed curve, if the vertex is where
                                                     // its parameter wraps around
  const Index curve = before.curve;
  if (!(at > before.at[0]) || !(at < behind.at[1] - shift)) return false;
  if (sag_between(plc_, paths_, tolerance_, curve, before.at[0], at) > most_excess_ ||
      sag_between(plc_, paths_, tolerance_, curve, at + shift, behind.at[1]) > most_excess_)
    return false;
  if (!put(vertex, paths_.point(curve, at), least)) return false;
  before.at[1] = at;
  behind.at[0] = at + shift;
  assert(before.at[0] < before.at[1] && behind.at[0] <= behind.at[1]);
  return true;
}

}  // namespace collarmesh::shells
