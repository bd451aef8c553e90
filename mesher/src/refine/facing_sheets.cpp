#include "refine/facing_sheets.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/edge_key.h"
#include "tolerance/forced_edges.h"

namespace collarmesh {

namespace {

// Bytes per entry of a hash set: a node and its slot in the table.
constexpr std::size_t bytes_per_pair = 32;
// Largest width of a gap, relative to the radius of the ball of the triangle or subsegment that is split. In
// wider gaps the distance between samples is already about the width of the gap.
constexpr double widest_gap_per_radius = 0.9;
// Least distance of a new vertex from all others except the vertex across the gap, relative to the same
// radius.
constexpr double least_spacing_per_radius = 0.35;
// Least cosine between the direction across the gap and the normals of sheets that face each other.
constexpr double least_facing = 0.97;
// In cells that span a gap, the ratio of height to longest edge is below this.
constexpr double largest_narrowness = 0.5;
// A curve is split opposite a vertex across the gap only if that place is at least this share of the
// subsegment's length away from both ends of the subsegment.
constexpr double least_part = 0.25;

using Corners = std::array<Point, 4>;

double longest_edge(const Corners& p) {
  double longest = 0;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = 0; j < i; ++j) longest = std::max(longest, squared_distance(p[i], p[j]));
  return std::sqrt(longest);
}

}  // namespace

std::optional<Candidate> FacingSheets::candidate_across(FaceId face) {
  if (domain_.is_papers()) return std::nullopt;
  const RestrictedTriangle& t = surface_.triangle(face);
  if (t.resolved_vertices) return std::nullopt;
  const Index patch = surface_.patch(face);
  double squared_gap = widest_gap_per_radius * widest_gap_per_radius * t.squared_radius;
  Index across = none;
  Point beneath;
  for (const Index v : mesh_.face_vertices(face)) {
    if (mesh_.feature(v).dimension == 3 || mesh_.on_patch(v, patch)) continue;
    const Point& p = mesh_.point(v);
    double squared = squared_gap;
    const Index triangle = nodes_.nearest_triangle(p, patch, squared);
    if (triangle == none) continue;
    const auto corners = nodes_.hierarchy().corners(triangle);
    const Point q = nearest_point_on_triangle(p, corners[0], corners[1], corners[2]);
    const Vector n = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const Vector normal = n / norm(n);
    if (!(std::fabs(dot(p - q, normal)) > least_facing * std::sqrt(squared)) || !faces(v, patch, normal) ||
        collars_.ball_containing(q) != none)
      continue;
    squared_gap = squared;
    across = v;
    beneath = domain_.frame.rounded(domain_.plc.patches[patch].planar ? domain_.on_plane(patch, q) : q);
  }
  if (across == none) return std::nullopt;
  const Index start = mesh_.conflicting_cell_around(across, beneath);
  if (start == none) return std::nullopt;
  mesh_.find_conflict_zone(beneath, start, zone_);
  const double spacing = least_spacing_per_radius * least_spacing_per_radius * t.squared_radius;
  for (const Index v : zone_.vertices)
    if (v != across && squared_distance(beneath, mesh_.point(v)) < spacing) return std::nullopt;
  return Candidate{beneath, t.squared_radius, beneath, {2, patch}, start, across};
}

std::optional<double> FacingSheets::parameter_across(const Subsegment& s, const Vector& along,
                                                     Index vertex) const {
  assert(vertex != s.ends[0] && vertex != s.ends[1]);
  if (domain_.is_papers() || !are_apart(mesh_.feature(vertex), {1, s.curve})) return std::nullopt;
  const Point& p = mesh_.point(vertex);
  if (squared_distance(p, s.centre) > s.squared_radius) return std::nullopt;
  const double length = s.parameters[1] - s.parameters[0];
  double low = s.parameters[0] + least_part * length, high = s.parameters[1] - least_part * length;
  const auto before = [&](double parameter) {
    return dot(domain_.paths.point(s.curve, parameter) - p, along) < 0;
  };
  if (!before(low) || before(high)) return std::nullopt;
  for (int step = 0; step < 50; ++step) {
    const double middle = 0.5 * (low + high);
    (before(middle) ? low : high) = middle;
  }
  const double widest = widest_gap_per_radius * widest_gap_per_radius * s.squared_radius;
  if (squared_distance(domain_.paths.point(s.curve, low), p) > widest) return std::nullopt;
  return low;
}

// Returns whether a patch faces a vertex. If the vertex lies on another patch, the two must be parallel
// there; if it lies on a curve, no end of the curve may lie on the patch that faces it. Without these
// conditions, the samples of features that meet would approach their common point ever more closely.
bool FacingSheets::faces(Index vertex, Index patch, const Vector& normal) const {
  const Feature& v = mesh_.feature(vertex);
  if (v.dimension == 0) return true;
  if (v.dimension == 1) {
    const auto& ends = domain_.plc.curves[v.index].ends;
    return std::ranges::none_of(
        ends, [&](Index end) { return end != none && domain_.plc.vertex_on_patch(end, patch); });
  }
  const Plc::Patch& other = domain_.plc.patches[v.index];
  if (other.planar) return std::fabs(dot(normal, other.normal)) > least_facing;
  double any = INFINITY;
  const auto corners = nodes_.hierarchy().corners(nodes_.nearest_triangle(mesh_.point(vertex), v.index, any));
  const Vector n = cross(corners[1] - corners[0], corners[2] - corners[0]);
  return std::fabs(dot(normal, n)) > least_facing * norm(n);
}

bool FacingSheets::are_apart(const Feature& a, const Feature& b) const {
  return std::max(a.dimension, b.dimension) < 3 &&
         !contacts_.touch(a.dimension, a.index, b.dimension, b.index);
}

bool FacingSheets::is_pair(Index a, Index b) const { return pairs_.contains(edge_key(a, b)); }

void FacingSheets::note_pair(Index a, Index b) { pairs_.insert(edge_key(a, b)); }

std::size_t FacingSheets::bytes() const { return pairs_.size() * bytes_per_pair; }

bool FacingSheets::is_within(Index cell, double bound) const {
  if (pairs_.empty()) return false;
  const auto& v = mesh_.corners(cell);
  double shortest = INFINITY;
  for (unsigned i = 0; i < 4; ++i)
    for (unsigned j = 0; j < i; ++j)
      if (!is_pair(v[i], v[j]))
        shortest = std::min(shortest, squared_distance(mesh_.point(v[i]), mesh_.point(v[j])));
  return mesh_.squared_radius(cell) <= bound * bound * shortest;
}

double FacingSheets::gap_across(Index cell) const {
  const auto& v = mesh_.corners(cell);
  for (const Index corner : v)
    if (mesh_.feature(corner).dimension == 3) return INFINITY;
  const Corners p{mesh_.point(v[0]), mesh_.point(v[1]), mesh_.point(v[2]), mesh_.point(v[3])};
  const double narrowness = narrowness_of(p, [&](unsigned i, unsigned j) {
    return are_apart(mesh_.feature(v[i]), mesh_.feature(v[j])) || is_pair(v[i], v[j]);
  });
  return narrowness < largest_narrowness ? narrowness * longest_edge(p) : INFINITY;
}

}  // namespace collarmesh
