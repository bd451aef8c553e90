#include "adapt/edge_division.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>

#include "common/cell_shapes.h"
#include "common/contains.h"
#include "common/found_in_ranges.h"
#include "common/sort_uniquely.h"
#include "common/sorted.h"
#include "common/tet_sides.h"

namespace collarmesh::remeshing::adapting {

namespace {

// If all tets at an edge are better than this, `least_share_` is relative to this quality.
constexpr double good_enough = 1;
constexpr std::size_t edges_between_reports = 4096;
// Edges are divided at a place that faces another edge or a vertex only if this place lies in their middle
// part. An edge on a curve can only be divided in its middle, so its middle part is smaller.
constexpr double middle_part = 0.4, middle_part_of_curve = 0.1;  // from the middle, relative to the edge
// Limit of trials before the first division that helps, and the increase of this limit with each such
// division.
constexpr std::size_t first_trials = 60, trials_per_division = 8;
constexpr unsigned most_steps = 20;  // improvement steps in a trial

bool is_inside(double share) { return std::fabs(share - 0.5) < middle_part; }

/// Returns the shares of the lengths of two edges at which their lines are nearest to each other; nothing if
/// they are parallel.
std::optional<std::pair<double, double>> shares_of_crossing(const Point& a, const Point& b, const Point& c,
                                                            const Point& d) {
  const Vector u = b - a, v = d - c, w = a - c;
  const double uu = squared_norm(u), uv = dot(u, v), vv = squared_norm(v), uw = dot(u, w), vw = dot(v, w);
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 0)) return std::nullopt;
  return std::pair((uv * vw - vv * uw) / determinant, (uu * vw - uv * uw) / determinant);
}

}  // namespace

EdgeDivision::EdgeDivision(EditableMesh& edited, const MeshOptions& options, std::vector<double> sizes)
    : edited_(edited),
      options_(options),
      sizing_(edited.plc, options, Frame()),
      metric_(std::move(sizes)),
      rule_({ThinShape(edited.plc, mesh(), options.bounds.thin_angle, options.bounds.reserve, edited.forced),
             CellBounds(edited.plc, mesh(), options.bounds)}),
      operations_(edited, rule_) {
  edited_.prepare();
}

// Gives sizes to vertices without one, which improvement has inserted.
void EdgeDivision::add_missing_sizes() {
  std::vector<Index> region(mesh().points.size(), none);
  for (Index t = 0; t < complex().size(); ++t)
    if (complex()[t].alive)
      for (const Index v : complex()[t].corners) region[v] = complex()[t].region;
  metric_.resize(region.size(), INFINITY);
  for (Index v = 0; v < region.size(); ++v)
    if (region[v] != none && !std::isfinite(metric_.target(v)))
      metric_.set(v, size_at(mesh().features[v], region[v], mesh().points[v]));
}

std::size_t EdgeDivision::divide_all(double longest, std::size_t most_vertices, const Execution& execution) {
  add_missing_sizes();
  return divide_each(long_edges(longest), most_vertices, execution);
}

std::size_t EdgeDivision::divide_distant(std::size_t most_vertices, const Execution& execution) {
  add_missing_sizes();
  return divide_each(distant_edges(), most_vertices, execution);
}

std::size_t EdgeDivision::divide_each(const std::vector<LongEdge>& edges, std::size_t most_vertices,
                                      const Execution& execution) {
  std::size_t count = 0, step = 0;
  for (const LongEdge& edge : edges) {
    if (most_vertices > 0 && mesh().points.size() >= most_vertices) break;
    if (execution.cancelled()) break;
    if (++step % edges_between_reports == 0 && execution.progress &&
        !execution.progress({"remesh", 0, mesh().points.size(), complex().size()}))
      break;
    if (divide(edge.a, edge.b)) ++count;
  }
  return count;
}

// Returns the length of an edge in target lengths: by the targets at its ends or, if it is longer so, by the
// size field at its middle.
double EdgeDivision::length_by_field(const LongEdge& edge) const {
  const Point &a = mesh().points[edge.a], &b = mesh().points[edge.b];
  return std::max(edge.length, distance(a, b) / sizing_.default_size(0.5 * (a + b)));
}

// Finds long edges. Queries the size field with one thread: it may belong to a caller who expects one call at
// a time.
std::vector<EdgeDivision::LongEdge> EdgeDivision::long_edges(double longest) const {
  const bool all = sizing_.has_field();
  std::vector<LongEdge> edges =
      found_in_ranges<LongEdge>(complex().size(), [&](std::size_t i, std::vector<LongEdge>& found) {
        const auto& tet = complex()[static_cast<Index>(i)];
        if (!tet.alive) return;
        for (const auto& [k, l] : cell_shapes::corner_pairs) {
          const auto [a, b] = sorted(tet.corners[k], tet.corners[l]);
          if (const double here = length(a, b); all || here > longest) found.push_back({here, a, b});
        }
      });
  sort_uniquely(edges, [](const LongEdge& edge) { return std::pair(edge.a, edge.b); });
  if (all) {
    for (LongEdge& edge : edges)
      if (edge.length <= longest) edge.length = length_by_field(edge);
    std::erase_if(edges, [longest](const LongEdge& edge) { return edge.length <= longest; });
  }
  std::ranges::stable_sort(edges, std::greater<>(), &LongEdge::length);
  return edges;
}

// Adds the edges of a face on a smooth patch, each with the patch; and the longest one again, without a
// patch, if the centre of the face is too far from the patch.
void EdgeDivision::add_edges_of_face(const std::array<Index, 3>& face, Index patch,
                                     std::vector<EdgeOfPatch>& found) const {
  const auto& p = mesh().points;
  std::array<EdgeOfPatch, 3> edges;
  for (unsigned k = 0; k < 3; ++k) {
    const auto [a, b] = std::minmax(face[k], face[(k + 1) % 3]);
    edges[k] = {a, b, patch};
    found.push_back(edges[k]);
  }
  if (edited_.surfaces.centre_is_near(patch, {p[face[0]], p[face[1]], p[face[2]]})) return;
  const auto longest = std::ranges::max_element(
      edges, {}, [&](const EdgeOfPatch& e) { return squared_distance(p[e.a], p[e.b]); });
  found.push_back({longest->a, longest->b, none});
}

bool EdgeDivision::is_near(const EdgeOfPatch& edge) const {
  if (edge.patch == none) return false;
  if (!complex().on_curve(edge.a, edge.b))
    return edited_.surfaces.edge_is_near(edge.patch, mesh().points[edge.a], mesh().points[edge.b]);
  const Index curve = mesh().edge_curve[complex().curve_edge(edge.a, edge.b)];
  return curve == none || edited_.curves.edge_is_near(curve, edge.a, edge.b);
}

std::vector<EdgeDivision::LongEdge> EdgeDivision::distant_edges() const {
  auto candidates =
      found_in_ranges<EdgeOfPatch>(complex().size(), [&](std::size_t i, std::vector<EdgeOfPatch>& found) {
        const auto& tet = complex()[static_cast<Index>(i)];
        for (unsigned corner = 0; tet.alive && corner < 4; ++corner) {
          const Index patch = tet.faces[corner] == none ? none : mesh().face_patch[tet.faces[corner]];
          if (patch != none && !edited_.plc.patches[patch].planar)
            add_edges_of_face(side_corners(tet.corners, corner), patch, found);
        }
      });
  sort_uniquely(candidates, [](const EdgeOfPatch& e) { return std::tuple(e.a, e.b, e.patch); });
  std::vector<LongEdge> edges =
      found_in_ranges<LongEdge>(candidates.size(), [&](std::size_t i, std::vector<LongEdge>& found) {
        const EdgeOfPatch& e = candidates[i];
        if (!is_near(e)) found.push_back({length(e.a, e.b), e.a, e.b});
      });
  std::ranges::stable_sort(edges, std::greater<>(), &LongEdge::length);
  return edges;
}

bool EdgeDivision::divide(Index a, Index b) {
  if (!complex().in_use(a) || !complex().in_use(b)) return false;
  const Index at = complex().tet_at_edge(a, b);
  if (at == none) return false;
  TetComplex::Ring ring;
  complex().ring(at, a, b, ring);
  double worst = good_enough;
  for (const Index t : ring.tets) worst = std::min(worst, quality(t));
  Change change;
  operations_.divide_edge(a, b, facing_ ? share_facing(a, b, ring) : 0.5, std::max(0.0, least_share_ * worst),
                          change);
  if (change.is_none() || !edited_.stays_oriented(change)) return false;
  add_vertex(a, b, complex()[at].region, change);
  edited_.apply(std::move(change));
  return true;
}

// Adds the target of the vertex that the change will insert into the edge ab.
void EdgeDivision::add_vertex(Index a, Index b, Index region, const Change& change) {
  metric_.add(std::min(metric_.target(a, b), size_at(change.feature, region, change.place)));
}

std::size_t EdgeDivision::divide_crossing(const Execution& execution) {
  add_missing_sizes();
  std::vector<std::pair<double, Index>> poor;
  for (Index t = 0; t < complex().size(); ++t)
    if (complex()[t].alive)
      if (const double q = quality(t); q < good_enough) poor.emplace_back(q, t);
  std::ranges::sort(poor);
  std::size_t count = 0;
  for (const auto& [q, t] : poor) {
    if (execution.cancelled() || trials_ > first_trials + trials_per_division * count) break;
    if (complex()[t].alive && quality(t) == q && divide_facing_at(t)) ++count;
  }
  return count;
}

/// Divides edges of a tet at places that face each other or a corner, if that helps.
bool EdgeDivision::divide_facing_at(Index tet) {
  const auto corners = complex()[tet].corners;
  const auto point = [&](unsigned corner) { return mesh().points[corners[corner]]; };
  for (const auto& [i, j, k, l] : {std::array<unsigned, 4>{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}}) {
    const auto shares = shares_of_crossing(point(i), point(j), point(k), point(l));
    if (shares && is_inside(shares->first) && is_inside(shares->second) &&
        try_to_divide({{corners[i], corners[j], shares->first}, {corners[k], corners[l], shares->second}}))
      return true;
  }
  for (const auto& [i, j] : cell_shapes::corner_pairs)
    for (unsigned k = 0; k < 4; ++k) {
      if (k == i || k == j) continue;
      const Vector along = point(j) - point(i);
      const double share = dot(point(k) - point(i), along) / squared_norm(along);
      if (is_inside(share) && try_to_divide({{corners[i], corners[j], share}})) return true;
    }
  return false;
}

/// Divides edges and improves the tets there. Keeps the result only if fewer tets miss their bounds then, or
/// as many as before but the worst are better.
bool EdgeDivision::try_to_divide(const std::vector<Division>& divisions) {
  ++trials_;
  before_.clear();
  Trial trial(edited_);
  const auto try_one = [&](const Division& division) {
    const auto& [a, b, share] = division;
    if (complex().on_curve(a, b) && std::fabs(share - 0.5) > middle_part_of_curve) return false;
    Change change;
    operations_.divide_edge(a, b, share, 0, change);
    if (change.is_none() || !edited_.stays_oriented(change)) return false;
    add_vertex(a, b, complex()[change.replacement.old.front()].region, change);
    apply(trial, std::move(change));
    return true;
  };
  if (std::ranges::all_of(divisions, try_one)) {
    improve_changed(trial);
    if (is_better(trial)) {
      trial.keep();
      return true;
    }
  }
  trial.undo();
  metric_.resize(mesh().points.size());
  return false;
}

void EdgeDivision::apply(Trial& trial, Change change) {
  trial.apply(std::move(change), [&](Index t) { before_.push_back(std::min(good_enough, quality(t))); });
}

void EdgeDivision::improve_changed(Trial& trial) {
  std::vector<Index> given_up;  // tets that nothing has improved since the last change
  for (unsigned step = 0; step < most_steps; ++step) {
    double worst = good_enough;
    Index poor = none;
    for (const Index t : trial.changed())
      if (complex()[t].alive && !contains(given_up, t))
        if (const double q = quality(t); q < worst) worst = q, poor = t;
    if (poor == none) break;
    Change change = improvement_of(poor);
    if (change.is_none() || !edited_.stays_oriented(change) ||
        (change.kind == Change::Kind::collapse && !edited_.curve_can_spare(change))) {
      given_up.push_back(poor);
      continue;
    }
    apply(trial, std::move(change));
    given_up.clear();
  }
}

Change EdgeDivision::improvement_of(Index tet) {
  const auto corners = complex()[tet].corners;
  Change change;
  operations_.remove_best_edge(tet, change);
  const auto found = [&] { return !change.is_none(); };
  for (const Index v : corners)
    if (!found()) operations_.move_to_face(v, change);
  for (const Index v : corners)
    if (!found()) operations_.move_vertex(v, change);
  for (const Index v : corners)
    for (const Index w : corners)
      if (v != w && !found()) operations_.collapse_edge(v, w, change);
  return change;
}

/// Returns whether fewer tets miss their bounds than before the trial, or as many as before but the worst are
/// better.
bool EdgeDivision::is_better(const Trial& trial) {
  std::vector<double> now;
  for (const Index t : trial.changed())
    if (complex()[t].alive)
      if (const double q = quality(t); q < good_enough) now.push_back(q);
  std::erase_if(before_, [](double q) { return q >= good_enough; });
  if (now.size() != before_.size()) return now.size() < before_.size();
  constexpr double gain = 1.01;
  std::ranges::sort(now);
  std::ranges::sort(before_);
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] > gain * before_[i]) return true;
    if (now[i] < before_[i]) return false;
  }
  return false;
}

/// Returns where to divide an edge, as a share of its length: at the place nearest to the middle that faces a
/// near vertex of the tets around; in the middle if no near vertex faces the middle part.
double EdgeDivision::share_facing(Index a, Index b, const TetComplex::Ring& ring) const {
  constexpr double middle_part = 0.3, near = 0.1;  // relative to the edge
  const Point& from = mesh().points[a];
  const Vector along = mesh().points[b] - from;
  const double squared = squared_norm(along);
  double share = 0.5, off = middle_part;
  for (const Index t : ring.tets)
    for (const Index v : complex()[t].corners) {
      if (v == a || v == b) continue;
      const Vector way = mesh().points[v] - from;
      const double at = dot(way, along) / squared;
      if (std::fabs(at - 0.5) >= off || squared_norm(way - at * along) > near * near * squared) continue;
      off = std::fabs(at - 0.5);
      share = at;
    }
  return share;
}

double EdgeDivision::size_at(const TetMesh::VertexFeature& feature, Index region, const Point& p) const {
  if (feature.dimension == 0 || feature.feature == none) return sizing_.default_size(p);
  return feature.dimension == 3 ? sizing_.region_size(region, p)
                                : sizing_.feature_size(feature.dimension, feature.feature, p);
}

}  // namespace collarmesh::remeshing::adapting
