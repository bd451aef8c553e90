// Mid-side nodes: put amid the edges, moved onto smooth features, drawn back where a tet would be inverted.
#include "collarmesh/second_order.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <unordered_set>

#include "collarmesh/curved_tet.h"
#include "collarmesh/error.h"
#include "common/cells_at_vertices.h"
#include "common/flat_features.h"
#include "second_order/mid_nodes.h"
#include "second_order/nearest_on_features.h"

namespace collarmesh {

namespace second_order {
namespace {

// A node that is farther from the middle of its edge than this, relative to the edge, does not belong to it:
// the nearest point lies on another part of the feature. A half circle has 0.5.
constexpr double farthest = 0.5;

// A node on a planar patch or straight curve goes to the exact geometry if that is farther away, relative to
// the edge.
constexpr double rounding = 1e-12;

// How far a node inside goes along with a curved edge beside it.
constexpr std::array<double, 3> parts_of_the_way{0.5, 0.25, 1};

class Curving {
 public:
  Curving(TetMesh& mesh, const Plc& plc, const SecondOrderOptions& options, const Execution& execution)
      : mesh_(mesh),
        plc_(plc),
        options_(options),
        execution_(execution),
        edges_(mesh),
        nearest_(plc),
        flat_(plc),
        exact_(options.exact ? flat_.limit(options.exact) : ExactGeometry{}) {}

  SecondOrderReport run() {
    const auto start = std::chrono::steady_clock::now();
    SecondOrderReport report;
    find_moves();
    if (execution_.cancelled()) {
      report.cancelled = true;
      return report;
    }
    add_mid_nodes(edges_, mesh_);
    for (const Move& move : moves_) place(move);
    draw_back();
    report.nodes = edges_.size();
    report.moved_inside = made_room_;
    for (const Move& move : moves_) {
      if (move.share > 0) ++report.curved;
      if (move.share < 1) report.straightened.push_back(straightened(move));
    }
    report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
  }

 private:
  /// A node that belongs off the middle of its edge.
  struct Move {
    Index edge;
    Vector way;        ///< from the middle to where it belongs
    double share = 1;  ///< of the way that it goes
  };

  static bool on_feature(const TetMesh::VertexFeature& feature) {
    return feature.feature != none && (feature.dimension == 1 || feature.dimension == 2);
  }
  bool is_smooth(const TetMesh::VertexFeature& feature) const {
    if (!on_feature(feature)) return false;
    return feature.dimension == 1 ? !plc_.curves[feature.feature].straight
                                  : !plc_.patches[feature.feature].planar;
  }

  void find_moves() {
    for (Index e = 0; e < edges_.size() && !execution_.cancelled(); ++e) {
      const TetMesh::VertexFeature& feature = edges_.feature(e);
      if (!is_smooth(feature) && !(exact_ && on_feature(feature))) continue;
      const auto [a, b] = edges_.ends(e);
      const Point middle = 0.5 * (mesh_.points[a] + mesh_.points[b]);
      const Vector way = place_on(feature, middle) - middle;
      const double length = norm(way), edge_length = distance(mesh_.points[a], mesh_.points[b]);
      if (length <= (is_smooth(feature) ? 0 : rounding * edge_length)) continue;
      const bool belongs = length <= farthest * edge_length;  // also false for what is not a number
      moves_.push_back({e, way, belongs ? 1.0 : 0.0});
    }
  }

  Point place_on(const TetMesh::VertexFeature& feature, const Point& middle) {
    if (exact_)
      if (const auto place = exact_(feature.dimension, feature.feature, middle)) return *place;
    return is_smooth(feature) ? nearest_.nearest(feature, middle) : middle;
  }

  Point place_of(const Move& move) const {
    const auto [a, b] = edges_.ends(move.edge);
    return 0.5 * (mesh_.points[a] + mesh_.points[b]) + (move.share > 0 ? move.share * move.way : Vector{});
  }
  void place(const Move& move) { mesh_.points[edges_.first_node() + move.edge] = place_of(move); }

  // The moves of a tet's nodes; none where a node has no move.
  std::array<Index, 6> moves_of(Index tet) const {
    std::array<Index, 6> found;
    for (std::size_t k = 0; k < 6; ++k) {
      const Index edge = mesh_.tet_mid_nodes[tet][k] - edges_.first_node();
      const auto at = std::lower_bound(moves_.begin(), moves_.end(), edge,
                                       [](const Move& move, Index e) { return move.edge < e; });
      found[k] = at != moves_.end() && at->edge == edge ? static_cast<Index>(at - moves_.begin()) : none;
    }
    return found;
  }

  // Any order ends in valid tets: curved nodes are only drawn nearer to the middle of their edge, and a node
  // inside that was put back there stays.
  void draw_back() {
    std::vector<std::vector<Index>> tets_at_move(moves_.size());
    std::vector<Index> work;
    for (Index tet = 0; tet < mesh_.tets.size(); ++tet) {
      bool curved = false;
      for (const Index move : moves_of(tet)) {
        if (move == none) continue;
        tets_at_move[move].push_back(tet);
        curved = true;
      }
      if (curved) work.push_back(tet);
    }
    while (!work.empty()) {
      const Index tet = work.back();
      work.pop_back();
      while (!is_valid(curved_tet(mesh_, tet))) {
        if (make_room(tet)) {
          ++made_room_;
          continue;
        }
        const Index move = move_at_fault(tet);
        if (move == none) {
          put_back_inside(tet, work);
          break;
        }
        step_back(moves_[move]);
        place(moves_[move]);
        for (const Index other : tets_at_move[move])
          if (other != tet) work.push_back(other);
      }
    }
  }

  bool is_valid(const CurvedTet& nodes) const { return jacobian_exceeds(nodes, options_.least_jacobian); }

  // A node inside a region goes along with a curved edge beside it, when that makes the tet valid and leaves
  // the others at it so.
  bool make_room(Index tet) {
    const std::array<Index, 6> moves = moves_of(tet);
    for (std::size_t k = 0; k < 6; ++k) {
      const Index node = mesh_.tet_mid_nodes[tet][k];
      const Index edge = node - edges_.first_node();
      if (edges_.feature(edge).dimension != 3 || stays(edge)) continue;
      for (const Index m : moves) {
        if (m == none || moves_[m].share == 0 || !touch(edge, moves_[m].edge)) continue;
        for (const double part : parts_of_the_way) {
          const Point before = mesh_.points[node];
          mesh_.points[node] = before + part * moves_[m].share * moves_[m].way;
          if (is_valid(curved_tet(mesh_, tet)) && harms_none(edge, tet, before)) return true;
          mesh_.points[node] = before;
        }
      }
    }
    return false;
  }

  bool touch(Index edge, Index other) const {
    const auto [a, b] = edges_.ends(edge);
    const auto [c, d] = edges_.ends(other);
    return a == c || a == d || b == c || b == d;
  }

  // Is every tet at the edge but this one as valid as with the node where it was?
  bool harms_none(Index edge, Index tet, const Point& before) {
    const Index node = edges_.first_node() + edge;
    const std::vector<Index> around = tets_at(edge);
    return std::all_of(around.begin(), around.end(), [&](Index other) {
      CurvedTet nodes = curved_tet(mesh_, other);
      if (other == tet || is_valid(nodes)) return true;
      const auto& mids = mesh_.tet_mid_nodes[other];
      nodes[4 + static_cast<std::size_t>(std::find(mids.begin(), mids.end(), node) - mids.begin())] = before;
      return !is_valid(nodes);
    });
  }

  // A tet whose curved edges are straight again: its nodes inside go back, too, and stay there.
  void put_back_inside(Index tet, std::vector<Index>& work) {
    for (const Index node : mesh_.tet_mid_nodes[tet]) {
      const Index edge = node - edges_.first_node();
      const auto [a, b] = edges_.ends(edge);
      const Point middle = 0.5 * (mesh_.points[a] + mesh_.points[b]);
      if (edges_.feature(edge).dimension != 3 || mesh_.points[node] == middle) continue;
      mesh_.points[node] = middle;
      stay_.insert(edge);
      for (const Index other : tets_at(edge))
        if (other != tet) work.push_back(other);
    }
  }
  bool stays(Index edge) const { return stay_.count(edge) > 0; }

  std::vector<Index> tets_at(Index edge) {
    if (tets_at_vertex_.empty()) tets_at_vertex_ = {mesh_.tets, edges_.first_node()};
    const auto [a, end] = edges_.ends(edge);
    std::vector<Index> found;
    for (const Index t : tets_at_vertex_[a])
      if (std::find(mesh_.tets[t].begin(), mesh_.tets[t].end(), end) != mesh_.tets[t].end())
        found.push_back(t);
    return found;
  }

  static void step_back(Move& move) { move.share = move.share > 0.25 ? 0.5 * move.share : 0; }

  // The one with the shortest way whose next step back makes the tet valid, else the one that goes farthest;
  // none when all its edges are straight.
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
  NearestOnFeatures nearest_;
  FlatFeatures flat_;
  ExactGeometry exact_;  // limited; empty when there is none
  std::vector<Move> moves_;         // sorted by edge
  CellsAtVertices tets_at_vertex_;  // empty until it is needed
  std::unordered_set<Index> stay_;  // edges inside whose node has been put back
  std::size_t made_room_ = 0;
};

}  // namespace
}  // namespace second_order

SecondOrderReport make_second_order(TetMesh& mesh, const Plc& plc, const SecondOrderOptions& options,
                                    const Execution& execution) {
  if (!(options.least_jacobian >= 0 && options.least_jacobian < 1))
    throw OptionError("least-jacobian must be at least 0 and below 1");
  return second_order::Curving(mesh, plc, options, execution).run();
}

}  // namespace collarmesh
