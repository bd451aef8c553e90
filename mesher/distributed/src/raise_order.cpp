// Adds mid-edge nodes; those of edges on features are on the shape.
#include <algorithm>
#include <array>
#include <cmath>

#include "calls.h"
#include "collarmesh/curved_tet.h"
#include "collarmesh/distributed.h"
#include "local_mesh.h"
#include "mid_nodes.h"
#include "on_shape.h"
#include "shared_points.h"

namespace collarmesh::distributed {

namespace {

// A node farther from the middle of its edge than this, relative to the edge, belongs to another part of its
// feature. On a half circle it is 0.5.
constexpr double farthest = 0.5;
// The default of SecondOrderOptions::least_jacobian.
constexpr double least_jacobian = 0.1;
// The shares of their displacement that nodes keep when they move back, step by step.
constexpr std::array<double, 4> shares{1, 0.5, 0.25, 0};

class Curving {
 public:
  Curving(DM dm, const Shape& shape)
      : dm_(dm),
        communicator_(PetscObjectComm(reinterpret_cast<PetscObject>(dm))),
        shape_(shape),
        mesh_(dm),
        edges_(dm),
        shared_(dm, 1) {}

  /// Returns the nodes by edge.
  std::vector<Point> run() {
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
          any = 1;
        }
      if (all_reduce(communicator_, any, MPI_MAX) == 0) break;
    }
    std::vector<Point> nodes;
    for (std::size_t e = 0; e < edges_.size(); ++e) nodes.push_back(node(e));
    return nodes;
  }

  OrderReport report() const {
    OrderReport r;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
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
  Point middle(std::size_t edge) const {
    const auto& [a, b] = edges_.ends(edge);
    return 0.5 * (mesh_.points[a] + mesh_.points[b]);
  }
  Point node(std::size_t edge) const { return middle(edge) + shares[back_[edge]] * ways_[edge]; }

  // Finds the displacements of the nodes; the owners do so for all ranks.
  void find_ways() {
    ways_.assign(edges_.size(), {});
    back_.assign(edges_.size(), 0);
    OnShape on_shape(shape_);
    const std::vector<PetscInt> codes = label_values(dm_, feature_label, shared_.first(), edges_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e)
      if (const TetMesh::VertexFeature feature = decoded(codes[e]);
          shared_.owned(e) && on_shape.has_places(feature))
        ways_[e] = on_shape.place(feature, middle(e)) - middle(e);
  }

  void share_ways() {
    std::vector<PetscReal> values;
    for (const std::size_t e : shared_.shared())
      values.insert(values.end(), {ways_[e].x, ways_[e].y, ways_[e].z});
    shared_.combine_shared(values, MPI_REPLACE, 3);
    for (std::size_t k = 0; k < shared_.shared().size(); ++k)
      ways_[shared_.shared()[k]] = {values[3 * k], values[3 * k + 1], values[3 * k + 2]};
    for (std::size_t e = 0; e < ways_.size(); ++e) {
      const auto& [a, b] = edges_.ends(e);
      if (!std::isfinite(squared_norm(ways_[e]))) ways_[e] = {};
      if (norm(ways_[e]) > farthest * distance(mesh_.points[a], mesh_.points[b]))
        back_[e] = shares.size() - 1;
    }
  }

  void find_curved_tets() {
    PetscInt first = 0;
    call(DMPlexGetHeightStratum(dm_, 0, &first, nullptr));
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      const std::array<Index, 6> edges = edges_.of_tet(first + static_cast<PetscInt>(t), mesh_.tets[t]);
      if (std::any_of(edges.begin(), edges.end(), [&](Index e) { return squared_norm(ways_[e]) > 0; }))
        curved_.push_back({static_cast<Index>(t), edges});
    }
  }

  /// Returns the edges of each invalid tet whose nodes have the longest displacement.
  std::vector<PetscInt> faulty() {
    std::vector<PetscInt> marks(edges_.size(), 0);
    const auto way_of = [&](Index e) { return shares[back_[e]] * norm(ways_[e]); };
    for (const auto& [tet, edges] : curved_) {
      CurvedTet nodes;
      const Corners corners = mesh_.corners(tet);
      std::copy(corners.begin(), corners.end(), nodes.begin());
      for (std::size_t k = 0; k < 6; ++k) nodes[4 + k] = node(edges[k]);
      if (jacobian_exceeds(nodes, least_jacobian)) continue;
      double longest = 0;
      for (const Index e : edges) longest = std::max(longest, way_of(e));
      for (const Index e : edges)
        if (longest > 0 && way_of(e) == longest) marks[e] = 1;
    }
    return marks;
  }

  struct CurvedCell {
    Index tet;
    std::array<Index, 6> edges;
  };

  DM dm_;
  MPI_Comm communicator_;
  const Shape& shape_;
  LocalMesh mesh_;
  Edges edges_;
  SharedPoints shared_;
  std::vector<Vector> ways_;        // by edge: displacement of its node from its middle
  std::vector<std::uint8_t> back_;  // by edge: its index in shares
  std::vector<CurvedCell> curved_;
};

}  // namespace

OrderReport ParallelMesh::raise_order(const Shape& shape) {
  const PetscMessages messages;
  agree(communicator_, [&] {
    if (order_ != 1) throw OptionError("the mesh is of second order already");
  });
  Curving curving(dm_, shape);
  const std::vector<Point> nodes = curving.run();
  call(DMPlexCreateCoordinateSpace(dm_, 2, nullptr));
  agree(communicator_, [&] { Edges(dm_).set_nodes(nodes); });
  order_ = 2;
  return curving.report();
}

}  // namespace collarmesh::distributed
