#include "periodic/node_map.h"

#include <algorithm>
#include <cassert>
#include <set>
#include <span>

#include "common/box_tree.h"
#include "common/edge_key.h"
#include "common/sort_uniquely.h"

namespace collarmesh::periodicity {

namespace {

// Largest distance between the moved place of a corner and its image, relative to the diagonal of the second
// faces. Vertices of CAD shapes are images of each other only to 1e-7.
constexpr double apart = 1e-6;

/// The corners of faces with certain tags, sorted, and the edges of these faces with their mid-edge nodes.
struct Nodes {
  std::vector<Index> corners;
  std::vector<std::pair<std::uint64_t, Index>> mid_nodes;
};

Nodes nodes_of(const TetMesh& mesh, std::span<const Tag> tags, std::size_t& faces) {
  Nodes nodes;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    if (!std::binary_search(tags.begin(), tags.end(), mesh.face_tag[f])) continue;
    ++faces;
    const auto& corners = mesh.faces[f];
    nodes.corners.insert(nodes.corners.end(), corners.begin(), corners.end());
    if (mesh.order() == 2)
      for (unsigned i = 0; i < 3; ++i)
        nodes.mid_nodes.emplace_back(edge_key(corners[i], corners[(i + 1) % 3]), mesh.face_mid_nodes[f][i]);
  }
  sort_uniquely(nodes.corners);
  sort_uniquely(nodes.mid_nodes);
  return nodes;
}

/// Returns the image of each corner of `first`; none if no corner of `second` is at its moved place.
std::vector<Index> images_of(const TetMesh& mesh, const Nodes& first, const Nodes& second,
                             const TetMesh::Motion& motion) {
  std::vector<Box> boxes;
  Box all;
  for (const Index v : second.corners) {
    all.add(mesh.points[v]);
    boxes.push_back({mesh.points[v], mesh.points[v]});
  }
  const BoxTree tree(boxes);
  const double tolerance = apart * all.diagonal();
  const Vector margin{tolerance, tolerance, tolerance};
  std::vector<Index> images;
  for (const Index v : first.corners) {
    const Point image = motion(mesh.points[v]);
    Index nearest = none;
    tree.for_each_meeting({image - margin, image + margin}, [&](Index i) {
      const Index w = second.corners[i];
      if (nearest == none ||
          squared_distance(mesh.points[w], image) < squared_distance(mesh.points[nearest], image))
        nearest = w;
    });
    images.push_back(nearest);
  }
  return images;
}

void finish_pair(TetMesh& mesh, TetMesh::PeriodicFaces& pair, PeriodicReport::Pair& report) {
  std::size_t faces_of_second = 0;
  const Nodes first = nodes_of(mesh, pair.first, report.faces),
              second = nodes_of(mesh, pair.second, faces_of_second);
  const auto image_of = [corners = pair.nodes](Index v) {
    const auto found = std::lower_bound(corners.begin(), corners.end(), std::array{v, Index{0}});
    return found != corners.end() && (*found)[0] == v ? (*found)[1] : none;
  };
  for (const auto& [edge, node] : first.mid_nodes) {
    const Index a = image_of(static_cast<Index>(edge >> 32U)), b = image_of(static_cast<Index>(edge));
    if (a == none || b == none) continue;
    const auto found = std::lower_bound(second.mid_nodes.begin(), second.mid_nodes.end(),
                                        std::pair{edge_key(a, b), Index{0}});
    if (found != second.mid_nodes.end() && found->first == edge_key(a, b))
      pair.nodes.push_back({node, found->second});
  }
  std::sort(pair.nodes.begin(), pair.nodes.end());
  for (const auto& [node, image] : pair.nodes) {
    const Point place = pair.motion(mesh.points[node]);
    report.largest_gap = std::max(report.largest_gap, distance(place, mesh.points[image]));
    if (node != image) mesh.points[image] = place;
  }
  report.nodes = pair.nodes.size();
  const std::set<Index> corners(first.corners.begin(), first.corners.end());
  report.edges = static_cast<std::size_t>(std::ranges::count_if(
      mesh.edges, [&](const auto& edge) { return corners.contains(edge[0]) && corners.contains(edge[1]); }));
}

}  // namespace

void map_corners(TetMesh& mesh) {
  for (TetMesh::PeriodicFaces& pair : mesh.periodic) {
    std::size_t faces = 0;
    const Nodes first = nodes_of(mesh, pair.first, faces), second = nodes_of(mesh, pair.second, faces);
    const std::vector<Index> images = images_of(mesh, first, second, pair.motion);
    assert(faces > 0 && first.corners.size() == second.corners.size());
    pair.nodes.clear();
    for (std::size_t i = 0; i < images.size(); ++i)
      if (images[i] != none) pair.nodes.push_back({first.corners[i], images[i]});
  }
}

void finish_map(TetMesh& mesh, PeriodicReport& report) {
  for (std::size_t k = 0; k < mesh.periodic.size(); ++k) finish_pair(mesh, mesh.periodic[k], report.pairs[k]);
}

}  // namespace collarmesh::periodicity
