// Adds mid-edge nodes; those of edges on features are on the shape.
#include <algorithm>
#include <array>
#include <cmath>

#include "calls.h"
#include "collarmesh/curved_tet.h"
#include "collarmesh/distributed.h"
#include "collarmesh/second_order.h"
#include "local_mesh.h"
#include "placement.h"
#include "second_order/places_on_features.h"
#include "shared_points.h"

namespace collarmesh::distributed {

namespace {

/// A placement of mid-edge nodes on smooth features that inverts no tet, for a mesh on many ranks.
class DistributedCurving {
 public:
  DistributedCurving(DM dm, const Shape& shape)
      : communicator_(PetscObjectComm(reinterpret_cast<PetscObject>(dm))),
        shape_(shape),
        mesh_(dm, 2),
        shared_(dm, 1) {}

  /// Places the mid-edge nodes. Returns all points: the vertices, then the nodes of the edges.
  const std::vector<Point>& run() {
    agree(communicator_, [&] { find_ways(); });
    share_ways();
    agree(communicator_, [&] { find_curved_tets(); });
    for (;;) {
      std::vector<PetscInt> marks = faulty();
      shared_.combine(marks, MPI_MAX);
      std::int64_t any = 0;
      for (std::size_t e = 0; e < marks.size(); ++e)
        if (marks[e] > 0) {
          ++back_[e];
          place(e);
          any = 1;
        }
      if (all_reduce(communicator_, any, MPI_MAX) == 0) break;
    }
    return mesh_.points;
  }

  OrderReport report() const {
    OrderReport r;
    for (std::size_t e = 0; e < ways_.size(); ++e) {
      if (!shared_.owned(e)) continue;
      ++r.nodes;
      if (squared_norm(ways_[e]) == 0) continue;
      if (shares[back_[e]] > 0) ++r.curved;
      if (back_[e] == 0) continue;
      ++r.straightened;
      r.farthest_off = std::max(r.farthest_off, (1 - shares[back_[e]]) * norm(ways_[e]));
    }
    for (std::int64_t* sum : {&r.nodes, &r.curved, &r.straightened})
      *sum = all_reduce(communicator_, *sum, MPI_SUM);
    r.farthest_off = all_reduce(communicator_, r.farthest_off, MPI_MAX);
    return r;
  }

 private:
  void place(std::size_t edge) {
    mesh_.points[mesh_.vertices + edge] = mesh_.middle(edge) + shares[back_[edge]] * ways_[edge];
  }
  std::array<std::size_t, 6> edges_of(Index tet) const {
    std::array<std::size_t, 6> edges;
    std::ranges::transform(mesh_.tet_mid_nodes[tet], edges.begin(),
                           [this](Index node) { return node - mesh_.vertices; });
    return edges;
  }

  // Finds the displacements of the nodes that this rank owns.
  void find_ways() {
    ways_.assign(mesh_.ends.size(), {});
    back_.assign(mesh_.ends.size(), 0);
    second_order::PlacesOnFeatures on_features(shape_.plc, shape_.exact);
    for (std::size_t e = 0; e < ways_.size(); ++e)
      if (const TetMesh::VertexFeature& feature = mesh_.features[mesh_.vertices + e];
          shared_.owned(e) && on_features.has_places(feature))
        ways_[e] = on_features.place(feature, mesh_.middle(e)) - mesh_.middle(e);
  }

  void share_ways() {
    shared_.take_owners(ways_);
    for (std::size_t e = 0; e < ways_.size(); ++e) {
      const auto& [a, b] = mesh_.ends[e];
      if (!std::isfinite(squared_norm(ways_[e]))) ways_[e] = {};
      if (!second_order::PlacesOnFeatures::belongs(norm(ways_[e]),
                                                   distance(mesh_.points[a], mesh_.points[b])))
        back_[e] = shares.size() - 1;
      place(e);
    }
  }

  void find_curved_tets() {
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      if (std::ranges::any_of(edges_of(t), [&](std::size_t e) { return squared_norm(ways_[e]) > 0; }))
        curved_.push_back(t);
  }

  /// Returns marks by edge: 1 for the edges whose nodes have the longest displacement in an invalid tet, 0
  /// for all others.
  std::vector<PetscInt> faulty() const {
    std::vector<PetscInt> marks(ways_.size(), 0);
    const auto way_of = [&](std::size_t e) { return shares[back_[e]] * norm(ways_[e]); };
    for (const Index tet : curved_)
      if (!jacobian_exceeds(curved_tet(mesh_, tet), SecondOrderOptions().least_jacobian))
        mark_longest(edges_of(tet), way_of, marks);
    return marks;
  }

  MPI_Comm communicator_;
  const Shape& shape_;
  LocalMesh mesh_;
  SharedPoints shared_;
  std::vector<Vector> ways_;        // by edge: displacement of its node from its middle
  std::vector<std::uint8_t> back_;  // by edge: its index in shares
  std::vector<Index> curved_;       // tets with displaced nodes
};

}  // namespace

OrderReport ParallelMesh::raise_order(const Shape& shape) {
  const PetscMessages messages;
  agree(communicator_, [&] {
    if (order_ != 1) throw OptionError("the mesh is of second order already");
  });
  DistributedCurving curving(dm_, shape);
  const std::vector<Point>& points = curving.run();
  call(DMPlexCreateCoordinateSpace(dm_, 2, nullptr));
  agree(communicator_, [&] { set_points(dm_, points); });
  order_ = 2;
  return curving.report();
}

}  // namespace collarmesh::distributed
