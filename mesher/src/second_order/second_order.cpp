// Mid-edge nodes: placed in the middles of edges, moved onto smooth features, moved back where a tet would be
// inverted.
#include "collarmesh/second_order.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <span>

#include "collarmesh/curved_tet.h"
#include "collarmesh/error.h"
#include "collarmesh/mesher.h"
#include "common/stopwatch.h"
#include "common/thread_limit.h"
#include "remesh/replace_tets.h"
#include "remesh/thin_shape.h"
#include "second_order/mid_nodes.h"
#include "second_order/places_on_features.h"
#include "second_order/untangling.h"

namespace collarmesh {

namespace second_order {
namespace {

using remeshing::UnwantedTet;

// Two edges count as having the same tangent if the area between their tangents is at most this share of the
// area between the straight edges.
constexpr double least_turn = 0.15;

// Nodes move back by `step_factor`; below `least_share` of the full distance they go to the middle of their
// edge. Moving forward again stops within `forward_precision` of the largest possible share.
constexpr double step_factor = 0.8, least_share = 0.1, forward_precision = 0.04;
// `make_room` is tried at first and again each time after this many steps back.
constexpr unsigned steps_per_try = 3;

// Relative to the edge: a node on a planar patch or a straight curve moves to the exact geometry if that is
// farther away than `rounding`; a move by at most `slight` on a planar patch is a SlightMove.
constexpr double rounding = 1e-12, slight = 1e-6;

/// The placement of mid-edge nodes of tets on smooth features, such that no tet is inverted.
class TetCurving {
 public:
  TetCurving(TetMesh& mesh, const Plc& plc, const SecondOrderOptions& options, const Execution& execution)
      : mesh_(mesh),
        plc_(plc),
        options_(options),
        execution_(execution),
        edges_(mesh),
        on_features_(plc, options.exact),
        untangling_(mesh, edges_, plc, options.least_jacobian) {}

  /// Finds the places of the nodes on features, the first step. Returns false if cancelled.
  bool find_nodes() {
    find_moves();
    return !execution_.cancelled();
  }

  /// Finds tets that would be flat at a corner, with the edge to split there. If two curved edges have the
  /// same tangent, or three have tangents in one plane, as at a corner inside a smooth patch, the Jacobian
  /// determinant vanishes, however small the edges are. The edges that join the other ends of the curved
  /// edges, inside a region or on a planar patch, have to be split.
  std::vector<UnwantedTet> flat_at_corners() const {
    std::vector<UnwantedTet> found;
    if (moves_.empty()) return found;
    for (Index tet = 0; tet < mesh_.tets.size(); ++tet)
      for (unsigned corner = 0; corner < 4; ++corner)
        if (const auto edge = edge_at_flat_corner(mesh_.tets[tet], corner)) {
          found.push_back({tet, *edge});
          break;
        }
    return found;
  }

  /// Gives the mesh its mid-edge nodes, and moves those that are on no smooth feature if that makes tets
  /// valid. Returns the tets that are still invalid.
  std::vector<UnwantedTet> place_nodes() {
    add_mid_nodes(edges_, mesh_);
    for (const auto& [edge, way] : slight_moves_) mesh_.points[edges_.first_node() + edge] = home(edge);
    for (const Move& move : moves_) place(move);
    find_tets_at_moves();
    std::vector<UnwantedTet> found;
    for (const Index tet : curved_) {
      if (execution_.cancelled()) break;
      if (!is_valid(curved_tet(mesh_, tet)) && !make_room(tet)) found.push_back({tet});
    }
    std::erase_if(found, [this](const UnwantedTet& u) { return is_valid(curved_tet(mesh_, u.tet)); });
    return found;
  }
  /// Removes the nodes. Precondition: the mesh has its nodes.
  void take_nodes_back() {
    assert(mesh_.order() == 2);
    mesh_.points.resize(edges_.first_node());
    mesh_.features.resize(std::min<std::size_t>(mesh_.features.size(), edges_.first_node()));
    mesh_.tet_mid_nodes.clear(), mesh_.face_mid_nodes.clear(), mesh_.edge_mid_nodes.clear();
  }

  /// Moves nodes back where tets are invalid.
  SecondOrderReport finish() {
    SecondOrderReport report;
    draw_back();
    put_forward();
    report.nodes = edges_.size();
    for (Index e = 0; e < edges_.size(); ++e)
      if (untangling_.is_free(e) && mesh_.points[edges_.first_node() + e] != home(e)) ++report.moved_inside;
    for (const Move& move : moves_) {
      if (move.share > 0) ++report.curved;
      if (move.share < 1) report.straightened.push_back(straightened(move));
    }
    return report;
  }

 private:
  /// A node whose place is off the middle of its edge.
  struct Move {
    Index edge;
    Vector way;        ///< from the middle to its intended place
    double share = 1;  ///< share of that way that it moves
  };

  /// A move of a node on a planar patch by little more than rounding. It is always made in full.
  struct SlightMove {
    Index edge;
    Vector way;
  };

  void find_moves() {
    for (Index e = 0; e < edges_.size() && !execution_.cancelled(); ++e) {
      const TetMesh::VertexFeature& feature = edges_.feature(e);
      if (!on_features_.has_places(feature)) continue;
      const auto [a, b] = edges_.ends(e);
      const Point middle = 0.5 * (mesh_.points[a] + mesh_.points[b]);
      const Vector way = on_features_.place(feature, middle) - middle;
      const double length = norm(way), edge_length = length_of(e);
      if (length <= (on_features_.is_smooth(feature) ? 0 : rounding * edge_length)) continue;
      if (untangling_.is_free(e)) {
        if (length <= slight * edge_length) {
          slight_moves_.push_back({e, way});
          continue;
        }
        untangling_.keep(e);
      }
      moves_.push_back({e, way, PlacesOnFeatures::belongs(length, edge_length) ? 1.0 : 0.0});
    }
  }

  // Returns the place of a node that has no Move.
  Point home(Index edge) const {
    const auto [a, b] = edges_.ends(edge);
    const Point middle = 0.5 * (mesh_.points[a] + mesh_.points[b]);
    const SlightMove* const move = found_in(slight_moves_, edge);
    return move != nullptr ? middle + move->way : middle;
  }

  const Move* move_of(Index edge) const { return found_in(moves_, edge); }

  template <class Moves>
  static const typename Moves::value_type* found_in(const Moves& moves, Index edge) {
    const auto at = std::ranges::lower_bound(moves, edge, {}, &Moves::value_type::edge);
    return at != moves.end() && at->edge == edge ? &*at : nullptr;
  }

  std::optional<std::array<Index, 2>> edge_at_flat_corner(const std::array<Index, 4>& tet,
                                                          unsigned corner) const {
    struct Side {
      Index end;
      Vector straight, tangent;
      bool fixed;
    };
    std::array<Side, 3> sides;
    unsigned n = 0, fixed = 0;
    bool curved = false;
    const Index at = tet[corner];
    for (unsigned k = 0; k < 4; ++k) {
      if (k == corner) continue;
      const Index edge = edges_.node(at, tet[k]) - edges_.first_node();
      const Vector straight = mesh_.points[tet[k]] - mesh_.points[at];
      const Move* move = move_of(edge);
      const bool is_fixed = !untangling_.may_move(edge);
      // Uses the tangent, at the corner, of the quadratic curve through the ends and a node this far off the
      // middle.
      sides[n++] = {tet[k], straight,
                    move != nullptr && move->share > 0 ? straight + 4 * move->way : straight, is_fixed};
      fixed += is_fixed ? 1 : 0;
      curved = curved || (is_fixed && move != nullptr);
    }
    if (fixed < 2 || !curved) return std::nullopt;
    for (unsigned i = 0; i < 3; ++i) {
      const Side &a = sides[i], &b = sides[(i + 1) % 3];
      if (!a.fixed || !b.fixed) continue;
      const Vector straight = cross(a.straight, b.straight);
      if (dot(cross(a.tangent, b.tangent), straight) > least_turn * squared_norm(straight)) continue;
      if (may_split(a.end, b.end)) return {{std::min(a.end, b.end), std::max(a.end, b.end)}};
    }
    if (fixed < 3) return std::nullopt;
    const double straight = dot(cross(sides[0].straight, sides[1].straight), sides[2].straight);
    if (dot(cross(sides[0].tangent, sides[1].tangent), sides[2].tangent) / straight > options_.least_jacobian)
      return std::nullopt;
    std::optional<std::array<Index, 2>> found;
    double longest = 0;
    for (unsigned i = 0; i < 3; ++i) {
      const Index a = sides[i].end, b = sides[(i + 1) % 3].end;
      const double length = squared_distance(mesh_.points[a], mesh_.points[b]);
      if (length <= longest || !may_split(a, b)) continue;
      found = {{std::min(a, b), std::max(a, b)}};
      longest = length;
    }
    return found;
  }
  // Returns whether the edge is inside a region or a planar patch, where splitting it changes no surface.
  bool may_split(Index a, Index b) const {
    return untangling_.may_move(edges_.node(a, b) - edges_.first_node());
  }

  Point place_of(const Move& move) const {
    const auto [a, b] = edges_.ends(move.edge);
    return 0.5 * (mesh_.points[a] + mesh_.points[b]) + (move.share > 0 ? move.share * move.way : Vector{});
  }
  void place(const Move& move) { mesh_.points[edges_.first_node() + move.edge] = place_of(move); }

  // Returns the moves of a tet's nodes; none for a node without a move.
  std::array<Index, 6> moves_of(Index tet) const {
    std::array<Index, 6> found;
    for (std::size_t k = 0; k < 6; ++k) {
      const Move* move = move_of(mesh_.tet_mid_nodes[tet][k] - edges_.first_node());
      found[k] = move != nullptr ? static_cast<Index>(move - moves_.data()) : none;
    }
    return found;
  }

  void find_tets_at_moves() {
    tets_at_move_.assign(moves_.size(), {});
    for (Index tet = 0; tet < mesh_.tets.size(); ++tet) {
      bool curved = false;
      for (const Index move : moves_of(tet)) {
        if (move == none) continue;
        tets_at_move_[move].push_back(tet);
        curved = true;
      }
      if (curved) curved_.push_back(tet);
    }
  }

  bool make_room(Index tet, bool farther = false) {
    std::size_t moved = untangling_.untangle(tet);
    if (moved == 0 && farther) moved = untangling_.untangle_farther(tet);
    return moved > 0;
  }

  // Moves nodes back until all tets are valid. Any order ends with valid tets: curved nodes only move nearer
  // to the middle of their edge, and a node inside a region that was moved back stays there.
  void draw_back() {
    std::vector<Index> work = curved_;
    while (!work.empty() && !execution_.cancelled()) {
      const Index tet = work.back();
      work.pop_back();
      for (unsigned steps = 0; !is_valid(curved_tet(mesh_, tet)); ++steps) {
        if (steps % steps_per_try == 0 && make_room(tet, steps == 0)) break;
        const Index move = move_at_fault(tet);
        if (move == none) {
          put_back_inside(tet, work);
          break;
        }
        step_back(moves_[move]);
        place(moves_[move]);
        for (const Index other : tets_at_move_[move])
          if (other != tet) work.push_back(other);
      }
    }
  }

  // Moves nodes forward again, because nodes that moved back later may have made room.
  void put_forward() {
    std::vector<Index> drawn;
    for (Index m = 0; m < moves_.size(); ++m)
      if (moves_[m].share < 1 && norm(moves_[m].way) > 0) drawn.push_back(m);
    const auto left = [this](Index m) { return (1 - moves_[m].share) * norm(moves_[m].way); };
    std::ranges::sort(drawn, {}, [&](Index m) { return std::pair(-left(m), m); });
    for (const Index m : drawn) {
      if (execution_.cancelled()) return;
      if (!PlacesOnFeatures::belongs(norm(moves_[m].way), length_of(moves_[m].edge))) continue;
      double low = moves_[m].share, high = 1;
      for (double share = high; high - low > forward_precision; share = 0.5 * (low + high)) {
        moves_[m].share = share;
        place(moves_[m]);
        const bool valid = std::ranges::all_of(
            tets_at_move_[m], [this](Index tet) { return is_valid(curved_tet(mesh_, tet)); });
        (valid ? low : high) = share;
      }
      moves_[m].share = low;
      place(moves_[m]);
    }
  }

  double length_of(Index edge) const {
    const auto [a, b] = edges_.ends(edge);
    return distance(mesh_.points[a], mesh_.points[b]);
  }

  bool is_valid(const CurvedTet& nodes) const { return jacobian_exceeds(nodes, options_.least_jacobian); }

  // Moves the nodes of a tet that lie on no smooth feature back for good. Precondition: the edges on smooth
  // features are straight.
  void put_back_inside(Index tet, std::vector<Index>& work) {
    for (const Index node : mesh_.tet_mid_nodes[tet]) {
      const Index edge = node - edges_.first_node();
      if (!untangling_.may_move(edge) || mesh_.points[node] == home(edge)) continue;
      mesh_.points[node] = home(edge);
      untangling_.keep(edge);
      for (const Index other : untangling_.tets_at(edge))
        if (other != tet) work.push_back(other);
    }
  }

  static void step_back(Move& move) { move.share = move.share > least_share ? step_factor * move.share : 0; }

  // Returns the move to take back: the shortest one whose next step back makes the tet valid, otherwise the
  // longest one; none if all edges of the tet are straight.
  Index move_at_fault(Index tet) const {
    const CurvedTet nodes = curved_tet(mesh_, tet);
    const std::array<Index, 6> moves = moves_of(tet);
    Index helpful = none, farthest_gone = none;
    double helpful_way = INFINITY, most_way = 0;
    for (std::size_t k = 0; k < 6; ++k) {
      if (moves[k] == none || moves_[moves[k]].share == 0) continue;
      Move move = moves_[moves[k]];
      const double way = move.share * norm(move.way);
      if (way > most_way) {
        most_way = way;
        farthest_gone = moves[k];
      }
      step_back(move);
      CurvedTet changed = nodes;
      changed[4 + k] = place_of(move);
      if (way < helpful_way && is_valid(changed)) {
        helpful_way = way;
        helpful = moves[k];
      }
    }
    return helpful != none ? helpful : farthest_gone;
  }

  SecondOrderReport::Straightened straightened(const Move& move) const {
    SecondOrderReport::Straightened s;
    s.point = edges_.first_node() + move.edge;
    s.edge = edges_.ends(move.edge);
    s.feature = edges_.feature(move.edge);
    s.tag =
        s.feature.dimension == 1 ? plc_.curves[s.feature.feature].tag : plc_.patches[s.feature.feature].tag;
    s.where = mesh_.points[s.point];
    s.distance = (1 - move.share) * norm(move.way);
    return s;
  }

  TetMesh& mesh_;
  const Plc& plc_;
  const SecondOrderOptions& options_;
  const Execution& execution_;
  MeshEdges edges_;
  PlacesOnFeatures on_features_;
  std::vector<Move> moves_;               // sorted by edge
  std::vector<SlightMove> slight_moves_;  // sorted by edge
  std::vector<Index> curved_;             // tets with moves
  std::vector<std::vector<Index>> tets_at_move_;
  Untangling untangling_;
};

// Maximum number of rounds. Tets that replace an unwanted one may be unwanted, too, so another round follows
// as long as the number of unwanted tets falls.
constexpr unsigned most_rounds = 4;

/// Replaces unwanted tets of a mesh of first order. Returns false if none could be replaced.
bool replace_in_mesh(TetMesh& mesh, const Plc& plc, std::span<const UnwantedTet> unwanted,
                     const SecondOrderOptions& options) {
  std::size_t gone = 0;
  ThreadLimit(options.threads).run([&] {
    remeshing::EditableMesh edited(mesh, plc, options.bounds);
    const remeshing::ThinRule rule({remeshing::ThinShape(plc, mesh, options.bounds.thin_angle, 0,
                                                         edited.forced, options.bounds.tets_across()),
                                    remeshing::CellBounds(plc, mesh, options.bounds)});
    gone = remeshing::replace_tets(edited, unwanted, rule, 1);
    edited.store_marked(options.bounds);
  });
  return gone > 0;
}

}  // namespace
}  // namespace second_order

SecondOrderReport make_second_order(TetMesh& mesh, const Plc& plc, const SecondOrderOptions& options,
                                    const Execution& execution) {
  assert(mesh.order() == 1);
  if (!(options.least_jacobian >= 0 && options.least_jacobian < 1))
    throw OptionError("least-jacobian must be at least 0 and below 1");
  const Stopwatch stopwatch;
  const std::size_t tets_before = mesh.tets.size();
  std::size_t flat_before = SIZE_MAX, invalid_before = SIZE_MAX;
  SecondOrderReport report;
  for (unsigned round = 0;; ++round) {
    second_order::TetCurving curving(mesh, plc, options, execution);
    if (!curving.find_nodes()) {
      report.cancelled = true;
      break;
    }
    const bool may_replace = options.bounds.thin_angle > 0 && round < second_order::most_rounds;
    if (may_replace) {
      const auto flat = curving.flat_at_corners();
      const bool fewer = flat.size() < flat_before;
      flat_before = flat.size();
      if (!flat.empty() && fewer && second_order::replace_in_mesh(mesh, plc, flat, options)) continue;
    }
    const auto invalid = curving.place_nodes();
    if (may_replace && !invalid.empty() && invalid.size() < invalid_before) {
      invalid_before = invalid.size();
      curving.take_nodes_back();
      second_order::replace_in_mesh(mesh, plc, invalid, options);
      continue;
    }
    report = curving.finish();
    report.cancelled = execution.cancelled();
    if (report.cancelled) curving.take_nodes_back();
    break;
  }
  report.more_tets = static_cast<std::ptrdiff_t>(mesh.tets.size() - tets_before);
  report.seconds = stopwatch.seconds();
  return report;
}

}  // namespace collarmesh
