// The certificate of periodic faces.
#include "check/periodic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

#include "check/findings.h"
#include "common/sorted.h"

namespace collarmesh::checks {

namespace {

using Corners = std::array<Index, 3>;
using Ends = std::array<Index, 2>;
using Map = std::unordered_map<Index, Index>;

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;

bool is_translation(const TetMesh::Motion& motion) { return motion.rows == TetMesh::Motion().rows; }

/// Bounds the distance that rounding alone causes between an image and the place to which the motion takes
/// its node. Let p be a node, q its image, R and s the rotation and shift of the motion, r the largest of
/// |p|, |q| and |s|, and u = 2^-53.
/// - Evaluating R p + s: three products and two sums for each row, |error| <= 3 u |R| |p| elementwise, at
///   most 3 sqrt(3) u r in norm as the rows have length 1; then the last sum, u r. Together e = (1 + 3
///   sqrt(3)) u r (terms in u^2 are negligible). If R is the identity, only the last sum is rounded.
/// - Where pairs meet, as at the edges and corners of a cell of three pairs, p and q may come from one node
///   by different motions, each composed of the motions of up to three pairs. At most six evaluations, this
///   check's included, then separate p and q: three on either side.
/// - A mid-edge node is the middle of two nodes: one sum on either side, u r each.
/// - Corners that the input gives are not moved to their images, so the rounding of the motion itself counts:
///   if it is a translation from the middle of one box to that of the other, three sums, u r each.
double rounding_of(const TetMesh::Motion& motion, double r) {
  const double evaluation = is_translation(motion) ? 1 : 1 + 3 * std::sqrt(3.0);
  constexpr double evaluations = 6, others = 5;
  return (evaluations * evaluation + others) * unit_roundoff * r;
}

/// The check of one pair of groups of faces.
class PeriodicCheck {
 public:
  PeriodicCheck(const TetMesh& mesh, std::size_t number, Findings& findings)
      : mesh_(mesh), pair_(mesh.periodic[number]), number_(number + 1), findings_(findings) {}

  /// Returns the map from nodes to images; nothing if it names nodes that the mesh does not have.
  std::optional<Map> run() {
    check_motion();
    if (!read_map()) return std::nullopt;
    find_faces();
    check_nodes();
    check_places();
    check_faces();
    check_edges();
    return map_;
  }

 private:
  static bool contains(const std::vector<Tag>& tags, Tag tag) {
    return std::find(tags.begin(), tags.end(), tag) != tags.end();
  }
  const Point& at(Index node) const { return mesh_.points[node]; }

  void check_motion() {
    const auto& [x, y, z] = pair_.motion.rows;
    // Sines and cosines, and their products, are rounded a few times each.
    constexpr double allowed = 32 * unit_roundoff;
    const double off = std::max({std::fabs(dot(x, x) - 1), std::fabs(dot(y, y) - 1), std::fabs(dot(z, z) - 1),
                                 std::fabs(dot(x, y)), std::fabs(dot(y, z)), std::fabs(dot(z, x))});
    if (!(off <= allowed) || !(dot(cross(x, y), z) > 0))
      findings_.add(guarantee::periodic_motion, pair_.motion.shift, {},
                    "The motion of periodic pair {} is not rigid: its rows are off unit length and right "
                    "angles by {:.3g}, or it mirrors.",
                    number_, off);
  }

  bool read_map() {
    for (const auto& [node, image] : pair_.nodes) {
      if (node >= mesh_.points.size() || image >= mesh_.points.size()) {
        findings_.add(guarantee::periodic_nodes, {}, {node, image},
                      "Periodic pair {} maps node {} onto {}, but the mesh has {} nodes.", number_, node,
                      image, mesh_.points.size());
        return false;
      }
      if (!map_.emplace(node, image).second)
        findings_.add(guarantee::periodic_nodes, at(node), {node},
                      "Periodic pair {} maps node {} at {} twice.", number_, node, At{at(node)});
    }
    return true;
  }

  void find_faces() {
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      if (contains(pair_.first, mesh_.face_tag[f])) first_faces_.push_back(f);
      if (contains(pair_.second, mesh_.face_tag[f])) second_faces_.emplace(sorted(mesh_.faces[f]), f);
    }
  }

  template <class Faces, class FaceOf>
  std::set<Index> nodes_of(const Faces& faces, const FaceOf& face_of) const {
    std::set<Index> nodes;
    for (const auto& each : faces) {
      const Index f = face_of(each);
      nodes.insert(mesh_.faces[f].begin(), mesh_.faces[f].end());
      if (mesh_.order() == 2) nodes.insert(mesh_.face_mid_nodes[f].begin(), mesh_.face_mid_nodes[f].end());
    }
    return nodes;
  }

  void check_nodes() {
    const std::set<Index> first = nodes_of(first_faces_, [](Index f) { return f; }),
                          second = nodes_of(second_faces_, [](const auto&face) { return face.second; });
    if (first.empty() || second.empty())
      findings_.add(guarantee::periodic_nodes, {}, {}, "Periodic pair {} has no triangles on a side.",
                    number_);
    for (const Index node : first)
      if (!map_.contains(node))
        findings_.add(guarantee::periodic_nodes, at(node), {node},
                      "Node {} at {} of the first side of periodic pair {} has no image.", node, At{at(node)},
                      number_);
    std::map<Index, Index> node_of;
    for (const auto& [node, image] : pair_.nodes) {
      if (!first.contains(node) || !second.contains(image))
        findings_.add(guarantee::periodic_nodes, at(node), {node, image},
                      "Periodic pair {} maps node {} at {} onto node {} at {}, but they are not on its first "
                      "side and its second side.",
                      number_, node, At{at(node)}, image, At{at(image)});
      const auto [other, added] = node_of.emplace(image, node);
      if (!added && other->second != node)
        findings_.add(guarantee::periodic_nodes, at(image), {other->second, node, image},
                      "Periodic pair {} maps two nodes, {} and {}, onto node {} at {}.", number_,
                      other->second, node, image, At{at(image)});
    }
    for (const Index image : second)
      if (!node_of.contains(image))
        findings_.add(guarantee::periodic_nodes, at(image), {image},
                      "Node {} at {} of the second side of periodic pair {} is the image of no node.", image,
                      At{at(image)}, number_);
  }

  void check_places() {
    double r = norm(pair_.motion.shift);
    for (const auto& [node, image] : pair_.nodes) r = std::max({r, norm(at(node)), norm(at(image))});
    const double allowed = rounding_of(pair_.motion, r);
    for (const auto& [node, image] : pair_.nodes)
      if (const double gap = distance(pair_.motion(at(node)), at(image)); !(gap <= allowed))
        findings_.add(guarantee::periodic_places, at(image), {node, image},
                      "Node {} at {} is {:.3g} from the image of node {} at {} in periodic pair {}; rounding "
                      "explains at most {:.3g}.",
                      image, At{at(image)}, gap, node, At{at(node)}, number_, allowed);
  }

  /// Returns the image of a node, or none if it has none: check_nodes has reported that.
  Index image_of(Index node) const {
    const auto found = map_.find(node);
    return found == map_.end() ? none : found->second;
  }

  void check_faces() {
    std::set<Index> met;
    for (const Index f : first_faces_) {
      Corners images;
      std::transform(mesh_.faces[f].begin(), mesh_.faces[f].end(), images.begin(),
                     [&](Index node) { return image_of(node); });
      const auto found = second_faces_.find(sorted(images));
      if (found == second_faces_.end()) {
        if (std::find(images.begin(), images.end(), none) == images.end())
          findings_.add(
              guarantee::periodic_faces, at(mesh_.faces[f][0]), {f},
              "Face {} at {} of the first side of periodic pair {} has no image: nodes {}, {} and {} "
              "of the second side have no triangle.",
              f, At{at(mesh_.faces[f][0])}, number_, images[0], images[1], images[2]);
        continue;
      }
      met.insert(found->second);
      if (!are_turned(f, images, found->second))
        findings_.add(guarantee::periodic_faces, at(mesh_.faces[f][0]), {f, found->second},
                      "Face {} at {} and its image, face {}, of periodic pair {} do not have opposite "
                      "orientations, or their mid-edge nodes differ.",
                      f, At{at(mesh_.faces[f][0])}, found->second, number_);
    }
    for (const auto& [corners, f] : second_faces_)
      if (!met.contains(f))
        findings_.add(guarantee::periodic_faces, at(corners[0]), {f},
                      "Face {} at {} of the second side of periodic pair {} is the image of no face.", f,
                      At{at(corners[0])}, number_);
  }

  /// Returns whether face g runs through these images of the corners of face f in reverse order, mid-edge
  /// nodes included.
  bool are_turned(Index f, const Corners& images, Index g) const {
    const Corners& corners = mesh_.faces[g];
    const auto start =
        static_cast<unsigned>(std::find(corners.begin(), corners.end(), images[0]) - corners.begin());
    if (corners[(start + 1) % 3] != images[2] || corners[(start + 2) % 3] != images[1]) return false;
    if (mesh_.order() == 1) return true;
    const Corners &m = mesh_.face_mid_nodes[f], &n = mesh_.face_mid_nodes[g];
    return image_of(m[0]) == n[(start + 2) % 3] && image_of(m[1]) == n[(start + 1) % 3] &&
           image_of(m[2]) == n[start];
  }

  template <class Faces, class FaceOf>
  std::set<Ends> sides_of(const Faces& faces, const FaceOf& face_of) const {
    std::set<Ends> sides;
    for (const auto& each : faces) {
      const Corners& corners = mesh_.faces[face_of(each)];
      for (unsigned i = 0; i < 3; ++i) sides.insert(sorted(Ends{corners[i], corners[(i + 1) % 3]}));
    }
    return sides;
  }

  /// Returns the edges on curves that are among these sides, by their ends.
  std::map<Ends, Index> edges_among(const std::set<Ends>& sides) const {
    std::map<Ends, Index> edges;
    for (Index e = 0; e < mesh_.edges.size(); ++e)
      if (const Ends ends = sorted(mesh_.edges[e]); sides.contains(ends)) edges.emplace(ends, e);
    return edges;
  }

  void check_edges() {
    const std::map<Ends, Index> first = edges_among(sides_of(first_faces_, [](Index f) { return f; })),
                                second = edges_among(
                                    sides_of(second_faces_, [](const auto&face) { return face.second; }));
    std::set<Index> met;
    for (const auto& [ends, e] : first) {
      const Ends images{image_of(ends[0]), image_of(ends[1])};
      const auto found = second.find(sorted(images));
      if (found != second.end()) met.insert(found->second);
      if (found == second.end() ||
          (mesh_.order() == 2 && image_of(mesh_.edge_mid_nodes[e]) != mesh_.edge_mid_nodes[found->second]))
        findings_.add(
            guarantee::periodic_edges, at(ends[0]), {e},
            "Edge {} at {}, on a curve of the first side of periodic pair {}, has no image on a curve "
            "of the second.",
            e, At{at(ends[0])}, number_);
    }
    for (const auto& [ends, e] : second)
      if (!met.contains(e))
        findings_.add(guarantee::periodic_edges, at(ends[0]), {e},
                      "Edge {} at {}, on a curve of the second side of periodic pair {}, is the image of no "
                      "edge on a curve of the first.",
                      e, At{at(ends[0])}, number_);
  }

  const TetMesh& mesh_;
  const TetMesh::PeriodicFaces& pair_;
  std::size_t number_;  // number in messages, from 1
  Findings& findings_;
  Map map_;
  std::vector<Index> first_faces_;
  std::map<Corners, Index> second_faces_;  // by sorted corners
};

/// Returns whether two motions, applied to this point in either order, lead to one place.
bool commute(const TetMesh::Motion& f, const TetMesh::Motion& g, const Point& p) {
  const Point one = g(f(p)), other = f(g(p));
  const double r =
      std::max({norm(p), norm(one), norm(other), norm(f(p)), norm(g(p)), norm(f.shift), norm(g.shift)});
  return distance(one, other) <= rounding_of(f, r) + rounding_of(g, r);
}

/// Checks nodes at the edges of a periodic cell: they have images by two pairs, and each image has an image
/// by the other pair. If the motions commute there, both second images must be the same node.
void check_corners(const TetMesh& mesh, const std::vector<std::optional<Map>>& maps, Findings& findings) {
  for (std::size_t i = 0; i < maps.size(); ++i)
    for (std::size_t j = i + 1; j < maps.size(); ++j) {
      if (!maps[i] || !maps[j]) continue;
      const Map &f = *maps[i], &g = *maps[j];
      for (const std::array<Index, 2>& each : mesh.periodic[i].nodes) {
        const Index node = each[0];
        const auto by_f = f.find(node), by_g = g.find(node);
        if (by_f == f.end() || by_g == g.end()) continue;
        const auto one = g.find(by_f->second), other = f.find(by_g->second);
        if (one == g.end() || other == f.end() || one->second == other->second) continue;
        if (!commute(mesh.periodic[i].motion, mesh.periodic[j].motion, mesh.points[node])) continue;
        findings.add(guarantee::periodic_corners, mesh.points[node], {node, one->second, other->second},
                     "Periodic pairs {} and {} take node {} at {} to node {} if applied in this order, but "
                     "to node {} in the other order.",
                     i + 1, j + 1, node, At{mesh.points[node]}, one->second, other->second);
      }
    }
}

}  // namespace

void check_periodic(const TetMesh& mesh, CheckReport& report) {
  constexpr std::size_t listed = 20;
  Findings findings(report, listed);
  std::vector<std::optional<Map>> maps;
  for (std::size_t k = 0; k < mesh.periodic.size(); ++k)
    maps.push_back(PeriodicCheck(mesh, k, findings).run());
  check_corners(mesh, maps, findings);
}

}  // namespace collarmesh::checks
