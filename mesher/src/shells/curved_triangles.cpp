#include "shells/curved_triangles.h"

#include <algorithm>
#include <unordered_map>

#include "common/edge_key.h"

namespace collarmesh::shells {

namespace {

/// The placement of a triangle mesh's mid-edge nodes on curves and patches.
class TriangleCurving {
 public:
  TriangleCurving(TetMesh& mesh, const Plc& plc, SurfaceMesher& mesher, const ExactGeometry& exact,
                  double least_jacobian)
      : mesh_(mesh), plc_(plc), mesher_(mesher), exact_(exact), least_jacobian_(least_jacobian) {}

  SecondOrderReport run() {
    add_curve_nodes();
    add_patch_nodes();
    straighten();
    for (const Node& node : nodes_) {
      const bool curved = mesh_.points[node.point] != node.middle;
      if (curved) ++report_.curved;
      if (node.share < 1) add_straightened(node);
    }
    report_.nodes = nodes_.size();
    return report_;
  }

 private:
  struct Node {
    Index point;
    std::array<Index, 2> edge;
    Point middle, wanted;
    double share = 1;  // position between the middle of the edge (0) and the feature (1)
  };

  Index add(const std::array<Index, 2>& edge, const Point& place, const TetMesh::VertexFeature& feature) {
    const Point middle = 0.5 * (mesh_.points[edge[0]] + mesh_.points[edge[1]]);
    const std::optional<Point> exact =
        exact_ ? exact_(feature.dimension, feature.feature, place) : std::nullopt;
    // Ignore an exact place so far away that it may be on another sheet of the feature.
    const double reach = 0.5 * distance(mesh_.points[edge[0]], mesh_.points[edge[1]]);
    const Point wanted = exact && distance(*exact, place) < reach ? *exact : place;
    const auto point = static_cast<Index>(mesh_.points.size());
    mesh_.points.push_back(wanted);
    mesh_.features.push_back(feature);
    node_of_.emplace(edge_key(edge[0], edge[1]), static_cast<Index>(nodes_.size()));
    nodes_.push_back({point, edge, middle, wanted});
    return point;
  }

  void add_curve_nodes() {
    for (std::size_t e = 0; e < mesh_.edges.size(); ++e)
      mesh_.edge_mid_nodes.push_back(
          add(mesh_.edges[e], mesher_.middle_of_curve_edge(e), {1, mesh_.edge_curve[e]}));
  }

  void add_patch_nodes() {
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      const auto& c = mesh_.faces[f];
      std::array<Index, 3> nodes{};
      for (unsigned i = 0; i < 3; ++i) {
        const std::array<Index, 2> edge{c[i], c[(i + 1) % 3]};
        const auto found = node_of_.find(edge_key(edge[0], edge[1]));
        if (found != node_of_.end()) {
          nodes[i] = nodes_[found->second].point;
          continue;
        }
        const Point middle = 0.5 * (mesh_.points[edge[0]] + mesh_.points[edge[1]]);
        const Index patch = mesh_.face_patch[f];
        const bool planar = plc_.patches[patch].planar;
        nodes[i] = add(edge, planar ? middle : mesher_.place_on_patch(patch, middle), {2, patch});
        if (planar) put(nodes_.back(), 0);
      }
      mesh_.face_mid_nodes.push_back(nodes);
    }
    for (Node& node : nodes_)
      if (mesh_.points[node.point] == node.middle) node.share = 1;
  }

  void put(Node& node, double share) {
    node.share = share;
    mesh_.points[node.point] = node.middle + share * (node.wanted - node.middle);
  }

  /// Returns a lower bound on the Jacobian, relative to the straight triangle's: the smallest of its
  /// Bernstein coefficients of degree 2, which enclose its values.
  double least_jacobian_of(std::size_t face) const {
    std::array<Point, 6> p;
    for (unsigned i = 0; i < 3; ++i) {
      p[i] = mesh_.points[mesh_.faces[face][i]];
      p[3 + i] = mesh_.points[mesh_.face_mid_nodes[face][i]];
    }
    const Vector normal = cross(p[1] - p[0], p[2] - p[0]);
    const double scale = squared_norm(normal);
    if (!(scale > 0)) return 0;
    // Control points of the sides, and the derivatives from p[0] towards p[1] and p[2] at the three corners.
    const Point ab = 2 * p[3] - 0.5 * (p[0] + p[1]), bc = 2 * p[4] - 0.5 * (p[1] + p[2]),
                ca = 2 * p[5] - 0.5 * (p[2] + p[0]);
    const std::array<Vector, 3> u{2 * (ab - p[0]), 2 * (p[1] - ab), 2 * (bc - ca)},
        v{2 * (ca - p[0]), 2 * (bc - ab), 2 * (p[2] - ca)};
    double least = INFINITY;
    for (unsigned i = 0; i < 3; ++i)
      for (unsigned j = i; j < 3; ++j) {
        const Vector both = 0.5 * (cross(u[i], v[j]) + cross(u[j], v[i]));
        least = std::min(least, dot(both, normal) / scale);
      }
    return least;
  }

  void straighten() {
    constexpr unsigned rounds = 12;
    for (unsigned round = 0; round < rounds; ++round) {
      bool bad = false;
      for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
        if (least_jacobian_of(f) > least_jacobian_) continue;
        bad = true;
        for (unsigned i = 0; i < 3; ++i) {
          Node& node = nodes_[node_of_.at(edge_key(mesh_.faces[f][i], mesh_.faces[f][(i + 1) % 3]))];
          if (mesh_.points[node.point] == node.middle) continue;
          put(node, round + 1 == rounds ? 0 : 0.6 * node.share);
        }
      }
      if (!bad) return;
    }
  }

  void add_straightened(const Node& node) {
    if (node.wanted == node.middle) return;
    const TetMesh::VertexFeature& feature = mesh_.features[node.point];
    if (feature.dimension == 2 && plc_.patches[feature.feature].planar) return;
    const Tag tag =
        feature.dimension == 1 ? plc_.curves[feature.feature].tag : plc_.patches[feature.feature].tag;
    report_.straightened.push_back({node.point, node.edge, feature, tag, mesh_.points[node.point],
                                    distance(mesh_.points[node.point], node.wanted)});
  }

  TetMesh& mesh_;
  const Plc& plc_;
  SurfaceMesher& mesher_;
  const ExactGeometry& exact_;
  const double least_jacobian_;
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, Index> node_of_;  // index in nodes_, by edge
  SecondOrderReport report_;
};

}  // namespace

SecondOrderReport curve_triangles(TetMesh& mesh, const Plc& plc, SurfaceMesher& mesher,
                                  const ExactGeometry& exact, double least_jacobian) {
  return TriangleCurving(mesh, plc, mesher, exact, least_jacobian).run();
}

}  // namespace collarmesh::shells
