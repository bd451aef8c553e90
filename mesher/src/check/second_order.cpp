// Checks of cells of second order: mid-edge nodes and the Jacobian.
#include <algorithm>

#include "check/nodes_on_feature.h"
#include "check/predicates.h"
#include "collarmesh/curved_tet.h"
#include "common/cell_shapes.h"

namespace collarmesh::checks {

using cell_shapes::tet_edges;

namespace {

/// A mid-edge node, as given by one of the cells at its edge: a tet, face or edge.
struct MidNode {
  std::array<Index, 2> edge;
  Index node;
  Index cell;
  int dimension;
};

std::vector<MidNode> mid_nodes_of_tets(const TetMesh& mesh) {
  std::vector<MidNode> nodes;
  nodes.reserve(6 * mesh.tets.size() + 3 * mesh.faces.size() + mesh.edges.size());
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t k = 0; k < 6; ++k)
      nodes.push_back({sorted(mesh.tets[t][tet_edges[k][0]], mesh.tets[t][tet_edges[k][1]]),
                       mesh.tet_mid_nodes[t][k], t, 3});
  return nodes;
}

std::vector<MidNode> mid_nodes(const TetMesh& mesh) {
  std::vector<MidNode> nodes = mid_nodes_of_tets(mesh);
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      nodes.push_back({sorted(mesh.faces[f][tet_edges[k][0]], mesh.faces[f][tet_edges[k][1]]),
                       mesh.face_mid_nodes[f][k], f, 2});
  for (Index e = 0; e < mesh.edges.size(); ++e)
    nodes.push_back({sorted(mesh.edges[e][0], mesh.edges[e][1]), mesh.edge_mid_nodes[e], e, 1});
  return nodes;
}

const char* name_of_cell(int dimension) { return dimension == 3 ? "tet" : dimension == 2 ? "face" : "edge"; }

void check_not_corners(const MeshToCheck& to_check, Findings& findings) {
  const TetMesh& mesh = to_check.mesh;
  std::vector<bool> is_corner(mesh.points.size(), false);
  for (const auto& tet : mesh.tets)
    for (const Index corner : tet) is_corner[corner] = true;
  for (Index t = 0; t < mesh.tets.size(); ++t)
    for (const Index node : mesh.tet_mid_nodes[t])
      if (is_corner[node])
        findings.add(
            guarantee::mid_nodes, to_check.point(node), {t, node},
            "Point {} at {} is a mid-edge node of tet {} and a corner of a tet; give the edge a node "
            "of its own.",
            node, At{to_check.point(node)}, t);
}

// Checks that each edge has one mid-edge node, and each of these nodes one edge.
void check_shared(const MeshToCheck& to_check, Findings& findings) {
  std::vector<MidNode> nodes = mid_nodes(to_check.mesh);
  const auto report = [&](const MidNode& first, const MidNode& second, const char* what) {
    findings.add(guarantee::mid_nodes, to_check.midpoint(second.edge), {first.node, second.node},
                 "{} {} has the mid-edge node {} between points {} and {} at {}, {} {} has the mid-edge node "
                 "{} between {} and {}: {}.",
                 name_of_cell(first.dimension), first.cell, first.node, first.edge[0], first.edge[1],
                 At{to_check.midpoint(first.edge)}, name_of_cell(second.dimension), second.cell, second.node,
                 second.edge[0], second.edge[1], what);
  };
  // Sorts tets first, so that findings name the faces and edges whose nodes differ from those of tets.
  const auto before = [](const MidNode& a, const MidNode& b) {
    return a.dimension != b.dimension ? a.dimension > b.dimension : a.cell < b.cell;
  };
  std::sort(nodes.begin(), nodes.end(), [&](const MidNode& a, const MidNode& b) {
    return a.edge != b.edge ? a.edge < b.edge : before(a, b);
  });
  for (std::size_t i = 1, first = 0; i < nodes.size(); ++i) {
    if (nodes[i].edge != nodes[first].edge)
      first = i;
    else if (nodes[i].node != nodes[first].node)
      report(nodes[first], nodes[i], "cells that share an edge must share its node");
  }
  std::sort(nodes.begin(), nodes.end(), [&](const MidNode& a, const MidNode& b) {
    return a.node != b.node ? a.node < b.node : before(a, b);
  });
  for (std::size_t i = 1, first = 0; i < nodes.size(); ++i) {
    if (nodes[i].node != nodes[first].node)
      first = i;
    else if (nodes[i].edge != nodes[first].edge)
      report(nodes[first], nodes[i], "every edge must have a node of its own");
  }
}

void check_jacobians(const MeshToCheck& to_check, Findings& findings) {
  const TetMesh& mesh = to_check.mesh;
  for (Index t = 0; t < std::min<std::size_t>(mesh.tets.size(), to_check.first_part); ++t)
    check_jacobian({"Tet", t}, curved_tet(mesh, t), mesh.tet_tag[t], findings);
}

void check_on_features(const MeshToCheck& to_check, CheckReport& report, Findings& findings) {
  const auto check = [&](const NodesOnFeature& on, Index node) {
    on.check(guarantee::mid_node_distance, {"The mid-edge node", node}, to_check.point(node),
             report.max_surface_distance, findings);
  };
  const Grouping by_curve(to_check.match.edge_curve, to_check.plc.curves.size()),
      by_patch(to_check.match.face_patch, to_check.plc.patches.size());
  for (Index c = 0; c < to_check.plc.curves.size(); ++c) {
    if (by_curve.size(c) == 0) continue;
    const NodesOnFeature on(to_check, {1, c});
    for (const Index* e = by_curve.begin(c); e != by_curve.end(c); ++e)
      check(on, to_check.mesh.edge_mid_nodes[*e]);
  }
  for (Index p = 0; p < to_check.plc.patches.size(); ++p) {
    if (by_patch.size(p) == 0) continue;
    const NodesOnFeature on(to_check, {2, p});
    for (const Index* f = by_patch.begin(p); f != by_patch.end(p); ++f)
      for (const Index node : to_check.mesh.face_mid_nodes[*f]) check(on, node);
  }
}

}  // namespace

void take_mid_nodes_of_tets(TetMesh& mesh) {
  std::vector<MidNode> nodes = mid_nodes_of_tets(mesh);
  const auto before = [](const MidNode& n, const std::array<Index, 2>& edge) { return n.edge < edge; };
  std::sort(nodes.begin(), nodes.end(), [](const MidNode& a, const MidNode& b) { return a.edge < b.edge; });
  const auto amid = [&](Index a, Index b) {
    const auto found = std::lower_bound(nodes.begin(), nodes.end(), sorted(a, b), before);
    return found != nodes.end() && found->edge == sorted(a, b) ? found->node : none;
  };
  mesh.face_mid_nodes.clear();
  for (const auto& [a, b, c] : mesh.faces)
    mesh.face_mid_nodes.push_back({amid(a, b), amid(b, c), amid(c, a)});
  mesh.edge_mid_nodes.clear();
  for (const auto& [a, b] : mesh.edges) mesh.edge_mid_nodes.push_back(amid(a, b));
}

void check_second_order(const MeshToCheck& to_check, CheckReport& report, Findings& findings) {
  if (to_check.mesh.order() == 1) return;
  check_not_corners(to_check, findings);
  check_shared(to_check, findings);
  check_jacobians(to_check, findings);
  check_on_features(to_check, report, findings);
}

}  // namespace collarmesh::checks
