// Pushes the front into the tets in steps: its nodes move by a part of their way, nodes near them follow, and
// the engine of improvement restores the tets. Where that fails, heights are lowered.
#include "layers/core.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/parallel_for.h"
#include "common/sort_uniquely.h"
#include "common/sorted.h"
#include "common/tet_sides.h"
#include "improve/improve_edited.h"
#include "layers/core_mesh.h"

namespace collarmesh::layering {

using remeshing::EditableMesh;

namespace {

constexpr unsigned rings_moved = 5, sweeps = 12;
// A move that would make tets flat is halved at most this many times, then left out.
constexpr unsigned most_halvings = 6;
// A move must leave each tet the share `quality_left` of its quality, or at least the quality `good_quality`.
constexpr double quality_left = 0.2, good_quality = 0.15;
// While the front moves, tets are improved until their angles are this multiple of the bound; at the end, as
// far as the options ask.
constexpr double above_bound = 1.05;
// Slow means of improvement are used if at most this many tets are poor.
constexpr std::size_t most_of_few = 20;
constexpr unsigned most_advances = 6, most_rounds = 4, most_fittings = 40;
constexpr unsigned most_rings = 64;  // rings around poor tets in which the front is searched for
constexpr double fitting = 0.85;     // factor by which heights are lowered to fit tets
// A height counts as reached if it is missed by at most this share of the height asked for.
constexpr double precision = 1e-9;
constexpr std::size_t at_once = 4096;
// Radius-edge ratios larger, and smaller, than that of any tet.
constexpr double any_ratio = 1e12, no_ratio = 0;

}  // namespace

Core::Core(const TetMesh& mesh, const Plc& plc, const Front& front, const Heights& heights,
           const ImproveOptions& improvement, const Execution& execution)
    : given_(mesh),
      plc_(plc),
      front_(front),
      options_(improvement),
      execution_(execution),
      reached_(front.nodes.size(), 0) {
  CoreMesh copy(mesh, front, heights);
  mesh_ = std::move(copy.mesh);
  vertex_of_ = std::move(copy.vertex_of);
  node_of_ = std::move(copy.node_of);
  piece_ = std::make_unique<EditableMesh>(mesh_, plc, options_.bounds);
  thin_ = std::make_unique<remeshing::ThinShape>(plc, mesh_, options_.bounds.thin_angle, 0, piece_->forced,
                                                 options_.bounds.tets_across());
  fix_wall();
  for (const Index t : poor_tets()) poor_at_first_.push_back(sorted(piece_->complex[t].corners));
  std::sort(poor_at_first_.begin(), poor_at_first_.end());
}

void Core::fix_wall() {
  piece_->complex.forget_balls();
  std::vector<Index> fixed;
  for (Index v = 0; v < mesh_.points.size(); ++v)
    if (mesh_.features[v].dimension <= 1 || v >= given_.points.size() || front_.on_wall[v])
      fixed.push_back(v);
  piece_->fix(fixed);
  std::vector<bool> walls(plc_.patches.size(), false);
  for (const WallSide& side : front_.sides) walls[side.patch] = true;
  piece_->keep_triangles_of(walls);
}

bool Core::push(Heights& heights, const std::vector<std::uint8_t>& levels) {
  failed_.clear();
  fit_tets(heights, levels);
  const double enough = above_bound * options_.bounds.thin_angle;
  double share = 0.7;
  bool few = false;  // few poor tets are left
  std::vector<Index> poor;
  for (unsigned round = 0; round < most_rounds; ++round) {
    go(heights, enough, few);
    if (cancelled_) return true;
    bool lowered = false, reached = true;
    for (Index n = 0; n < heights.size(); ++n) {
      if (is_reached(n, heights)) continue;
      reached = false;
      if (reached_[n] > heights[n]) continue;
      heights.lower(n, reached_[n], Cause::core);
      lowered = true;
    }
    poor = poor_tets();
    few = poor.size() <= most_of_few;
    if (!poor.empty()) {
      lowered = lower_at(poor, share, heights) || lowered;
      share = 0.5;
    }
    lowered = heights.settle() || lowered;
    if (poor.size() > most_left(heights)) break;
    if (lowered || !reached) continue;
    if (!poor.empty()) break;
    piece_->leave({});
    improve_by(options_.min_dihedral, false, no_ratio);
    return true;
  }
  for (unsigned rings = 2; failed_.empty() && !poor.empty() && rings <= most_rings; rings *= 2)
    failed_ = nodes_near(poor, rings);
  for (Index n = 0; n < heights.size(); ++n)
    if (!is_reached(n, heights)) failed_.push_back(n);
  sort_uniquely(failed_);
  return false;
}

/// Lowers heights until tets at the front would keep a share of their bounds, or their present margin if that
/// is less, if their nodes moved without any improvement.
void Core::fit_tets(Heights& heights, const std::vector<std::uint8_t>& levels) {
  constexpr std::array<double, strictest + 1> shares{0.4, 1.0};
  const std::vector<Index> near = vertices_near_front(rings_moved);
  find_around(near);
  const auto& complex = piece_->complex;
  std::vector<Index> tets;
  std::vector<double> least;  // margin that each tet must keep
  for (Index t = 0; t < complex.size(); ++t) {
    double wanted = 0;
    for (const Index v : complex[t].corners)
      if (v < node_of_.size() && node_of_[v] != none)
        wanted = std::max(wanted, shares[std::min(strictest, levels[node_of_[v]])]);
    if (wanted == 0) continue;
    tets.push_back(t);
    least.push_back(std::min(wanted, margin(corners(t), t)));
  }
  std::vector<std::uint8_t> spoilt(tets.size(), 0);
  for (unsigned pass = 0; pass < most_fittings; ++pass) {
    const std::vector<Vector> moves = moves_towards(heights, near);
    parallel_for_ranges(tets.size(), at_once, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Index t = tets[i];
        remeshing::Corners p = corners(t);
        for (unsigned k = 0; k < 4; ++k) p[k] = p[k] + moves[complex[t].corners[k]];
        spoilt[i] = margin(p, t) < least[i] ? 1 : 0;
      }
    });
    std::vector<Index> at;
    for (std::size_t i = 0; i < tets.size(); ++i)
      if (spoilt[i] != 0)
        for (const Index v : complex[tets[i]].corners)
          if (v < node_of_.size() && node_of_[v] != none) at.push_back(node_of_[v]);
    if (at.empty()) return;
    sort_uniquely(at);
    for (const Index n : at)
      if (heights[n] > 0) heights.lower(n, fitting * heights[n], Cause::core);
    heights.settle();
  }
}

/// Returns a tet's margin: the sine of its smallest angle divided by the sine of the bound on it, or the same
/// ratio for its largest angle, whichever is less. It is at least 1 if the tet keeps both bounds, and -1 if
/// the tet is flat or inverted.
double Core::margin(const remeshing::Corners& p, Index tet) const {
  const auto [of_smallest, of_largest] =
      thin_->squared_margins(remeshing::extreme_cosines(p), p, piece_->complex[tet].corners);
  return of_largest < 0 ? -1 : std::sqrt(std::min(of_smallest, of_largest));
}

/// Moves the front step by step, and improves tets in between, as long as it advances.
void Core::go(const Heights& heights, double enough, bool thoroughly) {
  std::size_t left = heights.size() + 1;
  for (unsigned k = 0; k < most_advances; ++k) {
    const bool there = advance(heights);
    improve_tets(enough, thoroughly);
    std::size_t missing = 0;
    for (Index n = 0; n < heights.size(); ++n) missing += is_reached(n, heights) ? 0 : 1;
    if (there || cancelled_ || missing >= left) return;
    left = missing;
  }
}

/// Returns the number of poor tets above which a push gives up instead of lowering heights at these tets.
std::size_t Core::most_left(const Heights& heights) const {
  constexpr std::size_t few_nodes = 20, nodes_per_tet = 40;
  return few_nodes + heights.size() / nodes_per_tet;
}

bool Core::is_reached(Index node, const Heights& heights) const {
  return vertex_of_[node] == front_.nodes[node].vertex ||
         std::fabs(reached_[node] - heights[node]) <= precision * heights.asked(node);
}

/// Moves the front and the vertices near it as far as tets stay good enough. Returns whether the front has
/// reached its heights.
bool Core::advance(const Heights& heights) {
  const std::vector<Index> near = vertices_near_front(rings_moved);
  find_around(near);
  const std::vector<Vector> moves = moves_towards(heights, near);
  const std::vector<double> shares = shares_of(moves, near);
  bool all = true;
  for (Index n = 0; n < heights.size(); ++n) {
    const Index v = vertex_of_[n];
    if (v == front_.nodes[n].vertex || reached_[n] == heights[n]) continue;
    const double share = shares[v];
    if (share == 1)
      reached_[n] = heights[n];
    else
      reached_[n] += share * (heights[n] - reached_[n]), all = false;
    piece_->complex.move_vertex(v, heights.place(n, reached_[n]));
  }
  for (const Index v : near)
    if ((v >= node_of_.size() || node_of_[v] == none) && shares[v] > 0 && squared_norm(moves[v]) > 0)
      piece_->complex.move_vertex(v, mesh_.points[v] + shares[v] * moves[v]);
  return all;
}

std::vector<Index> Core::vertices_near_front(unsigned rings) const {
  std::vector<std::uint8_t> ring(mesh_.points.size(), 0);
  for (std::size_t v = given_.points.size(); v < std::min(node_of_.size(), ring.size()); ++v) ring[v] = 1;
  const auto& complex = piece_->complex;
  for (unsigned r = 1; r <= rings; ++r)
    for (Index t = 0; t < complex.size(); ++t) {
      if (!complex[t].alive) continue;
      const auto& c = complex[t].corners;
      if (std::none_of(c.begin(), c.end(), [&](Index v) { return ring[v] == r; })) continue;
      for (const Index v : c)
        if (ring[v] == 0) ring[v] = static_cast<std::uint8_t>(r + 1);
    }
  std::vector<Index> near;
  for (Index v = 0; v < ring.size(); ++v)
    if (ring[v] != 0 && complex.in_use(v)) near.push_back(v);
  return near;
}

std::vector<Vector> Core::moves_towards(const Heights& heights, const std::vector<Index>& near) {
  std::vector<Vector> moves(mesh_.points.size());
  for (Index n = 0; n < heights.size(); ++n)
    if (vertex_of_[n] != front_.nodes[n].vertex)
      moves[vertex_of_[n]] = (heights[n] - reached_[n]) * front_.nodes[n].direction;
  spread(moves, near);
  return moves;
}

/// Finds the neighbours of each vertex that may follow the front; lists a neighbour once for each common tet.
void Core::find_around(const std::vector<Index>& near) {
  const auto& complex = piece_->complex;
  std::vector<Index> slot(mesh_.points.size(), none);
  for (Index i = 0; i < near.size(); ++i)
    if (!piece_->is_fixed(near[i])) slot[near[i]] = i;
  around_.first.assign(near.size() + 1, 0);
  const auto for_all = [&](const auto& visit) {
    for (Index t = 0; t < complex.size(); ++t) {
      if (!complex[t].alive) continue;
      for (const Index v : complex[t].corners)
        if (slot[v] != none) visit(slot[v], v, complex[t].corners);
    }
  };
  for_all([&](Index i, Index, const auto&) { around_.first[i + 1] += 3; });
  for (Index i = 0; i < near.size(); ++i) around_.first[i + 1] += around_.first[i];
  around_.entries.resize(around_.first.back());
  std::vector<Index> next(around_.first.begin(), around_.first.end() - 1);
  for_all([&](Index i, Index v, const auto& corners) {
    for (const Index w : corners)
      if (w != v) around_.entries[next[i]++] = w;
  });
}

/// Finds the moves of vertices near the front, which follow it: each moves by the mean of its neighbours'
/// moves.
void Core::spread(std::vector<Vector>& moves, const std::vector<Index>& near) const {
  std::vector<Vector> next(near.size());
  for (unsigned sweep = 0; sweep < sweeps; ++sweep) {
    parallel_for_ranges(near.size(), at_once, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto around = around_[i];
        next[i] = moves[near[i]];
        if (around.empty()) continue;
        Vector sum{};
        for (const Index v : around) sum = sum + moves[v];
        next[i] = sum / static_cast<double>(around.size());
        constrain(near[i], next[i]);
      }
    });
    for (std::size_t i = 0; i < near.size(); ++i) moves[near[i]] = next[i];
  }
}

/// Restricts a move so that the vertex stays on its planar patch. Vertices on curved patches do not move.
void Core::constrain(Index vertex, Vector& move) const {
  const auto& [dimension, feature] = mesh_.features[vertex];
  if (dimension == 3) return;
  if (dimension == 2 && feature != none && plc_.patches[feature].planar) {
    const Vector& n = plc_.patches[feature].normal;
    move = move - dot(move, n) * n;
    return;
  }
  move = {};
}

/// Returns the share of its move that each vertex may make, so that no tet becomes too poor.
std::vector<double> Core::shares_of(const std::vector<Vector>& moves, const std::vector<Index>& near) const {
  const auto& complex = piece_->complex;
  std::vector<double> shares(mesh_.points.size(), 0);
  for (const Index v : near) shares[v] = 1;
  std::vector<Index> moved;
  for (Index t = 0; t < complex.size(); ++t)
    if (complex[t].alive && std::any_of(complex[t].corners.begin(), complex[t].corners.end(),
                                        [&](Index v) { return shares[v] > 0 && squared_norm(moves[v]) > 0; }))
      moved.push_back(t);
  std::vector<std::uint8_t> spoilt(moved.size(), 0);
  std::vector<double> before(moved.size());
  // Vertices whose share changed in the last pass; tets without such vertices need no second look.
  std::vector<bool> changed(mesh_.points.size(), true);
  for (unsigned pass = 0;; ++pass) {
    parallel_for_ranges(moved.size(), at_once, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto& c = complex[moved[i]].corners;
        if (std::none_of(c.begin(), c.end(), [&](Index v) { return changed[v]; })) continue;
        remeshing::Corners p = corners(moved[i]);
        if (pass == 0) before[i] = remeshing::shape_quality(p);
        for (unsigned k = 0; k < 4; ++k) p[k] = p[k] + shares[c[k]] * moves[c[k]];
        const double after = remeshing::shape_quality(p);
        spoilt[i] = after > 0 && (after >= good_quality || after >= quality_left * before[i]) ? 0 : 1;
      }
    });
    std::vector<Index> at;
    for (std::size_t i = 0; i < moved.size(); ++i)
      if (spoilt[i] != 0)
        for (const Index v : complex[moved[i]].corners)
          if (shares[v] > 0) at.push_back(v);
    if (at.empty()) return shares;
    sort_uniquely(at);
    changed.assign(changed.size(), false);
    for (const Index v : at) {
      shares[v] = pass < most_halvings ? 0.5 * shares[v] : 0;
      changed[v] = true;
    }
  }
}

/// Improves tets with angles below `angle`: first replaces them only by tets within their bounds, then
/// replaces poor tets by any better ones. (A better tet may still miss its bound, because bounds are lower at
/// creases and forced edges than beside them.) `thoroughly`: also by slow means.
void Core::improve_tets(double angle, bool thoroughly) {
  piece_->leave({});
  improve_by(angle, thoroughly, no_ratio);
  const std::vector<Index> poor = poor_tets();
  if (poor.empty()) return;
  const std::vector<std::uint8_t> near = vertices_near(poor, 1);
  std::vector<bool> far(near.size());
  for (std::size_t v = 0; v < near.size(); ++v) far[v] = near[v] == 0;
  piece_->leave(std::move(far));
  improve_by(angle, thoroughly, any_ratio);
}

/// Improves tets once. `ratio`: tets above this radius-edge ratio must keep their bounds on angles.
void Core::improve_by(double angle, bool thoroughly, double ratio) {
  ImproveOptions options = options_;
  options.min_dihedral = std::min(angle, options.min_dihedral);
  options.bounds.radius_edge = ratio;
  options.bounds.thin_in_narrow_places_only = false;
  options.thin_above = any_ratio;
  options.keep_vertices = false;
  cancelled_ = cancelled_ || improve(*piece_, options, execution_, thoroughly).cancelled;
}

/// Returns the tets beyond the bounds on angles, without unchanged tets that were beyond them from the start,
/// because the mesh was certified with these.
std::vector<Index> Core::poor_tets() const {
  const auto& complex = piece_->complex;
  std::vector<std::uint8_t> poor(complex.size(), 0);
  parallel_for_ranges(poor.size(), at_once, [&](std::size_t begin, std::size_t end) {
    for (auto t = static_cast<Index>(begin); t < end; ++t)
      poor[t] =
          complex[t].alive && !thin_->contains(corners(t), complex[t].corners) && !is_as_given(t) ? 1 : 0;
  });
  std::vector<Index> found;
  for (Index t = 0; t < poor.size(); ++t)
    if (poor[t] != 0) found.push_back(t);
  return found;
}

bool Core::is_as_given(Index tet) const {
  const std::array<Index, 4>& corners = piece_->complex[tet].corners;
  return std::binary_search(poor_at_first_.begin(), poor_at_first_.end(), sorted(corners)) &&
         std::all_of(corners.begin(), corners.end(), [&](Index v) {
           const bool copied = v < node_of_.size() && node_of_[v] != none;
           const Index given = copied ? front_.nodes[node_of_[v]].vertex : v;
           return given < given_.points.size() && mesh_.points[v] == given_.points[given];
         });
}

/// Marks the vertices of all tets within this many rings of the given ones.
std::vector<std::uint8_t> Core::vertices_near(const std::vector<Index>& tets, unsigned rings) const {
  const auto& complex = piece_->complex;
  std::vector<std::uint8_t> near(mesh_.points.size(), 0);
  for (const Index t : tets)
    for (const Index v : complex[t].corners) near[v] = 1;
  for (unsigned r = 0; r < rings; ++r) {
    std::vector<std::uint8_t> wider = near;
    for (Index t = 0; t < complex.size(); ++t) {
      if (!complex[t].alive) continue;
      const auto& c = complex[t].corners;
      if (std::any_of(c.begin(), c.end(), [&](Index v) { return near[v] != 0; }))
        for (const Index v : c) wider[v] = 1;
    }
    near = std::move(wider);
  }
  return near;
}

/// Returns the nodes of the front that have copies in tets within this many rings of the given ones.
std::vector<Index> Core::nodes_near(const std::vector<Index>& tets, unsigned rings) const {
  const std::vector<std::uint8_t> near = vertices_near(tets, rings);
  std::vector<Index> nodes;
  for (std::size_t v = given_.points.size(); v < node_of_.size(); ++v)
    if (near[v] != 0) nodes.push_back(node_of_[v]);
  return nodes;
}

/// Lowers the front, by the factor `share`, at these tets or, if no layers are there, in the nearest of a few
/// rings around them where there are some. Returns whether it lowered any height.
bool Core::lower_at(const std::vector<Index>& tets, double share, Heights& heights) const {
  for (unsigned rings = 0; rings < 4; ++rings) {
    bool any = false;
    for (const Index n : nodes_near(tets, rings))
      if (heights[n] > 0) {
        heights.lower(n, share * heights[n], Cause::core);
        any = true;
      }
    if (any) return true;
  }
  return false;
}

}  // namespace collarmesh::layering
