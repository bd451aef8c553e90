// Classification: finds the feature of each entity of the mesh. A mesh read from a file has only tags: faces
// and edges are collected into pieces that belong to one feature, and each piece gets the nearest
// feature with its tag.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include "check/mesh_to_check.h"
#include "common/disjoint_sets.h"
#include "common/distance_tree.h"
#include "common/segments.h"

namespace collarmesh::checks {

namespace {

// The features of one kind with one tag, as triangles for measuring distances.
struct TaggedFeatures {
  std::vector<DistanceTree::Triangle> triangles;
  std::vector<Index> feature;  // by triangle
  std::unique_ptr<DistanceTree> tree;
};

class NearestFeature {
 public:
  void add(Tag tag, Index feature, const DistanceTree::Triangle& triangle) {
    TaggedFeatures& features = by_tag_[tag];
    features.triangles.push_back(triangle);
    features.feature.push_back(feature);
  }
  /// Returns the nearest feature with this tag, or none if there is no such feature.
  Index find(Tag tag, const Point& p) {
    const auto found = by_tag_.find(tag);
    if (found == by_tag_.end()) return none;
    TaggedFeatures& features = found->second;
    if (!features.tree) features.tree = std::make_unique<DistanceTree>(std::move(features.triangles));
    return features.feature[features.tree->nearest(p).triangle];
  }

 private:
  std::map<Tag, TaggedFeatures> by_tag_;
};

class PointSearch {
 public:
  explicit PointSearch(const std::vector<Point>& points) : points_(points), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), Index{0});
    std::sort(order_.begin(), order_.end(), [&](Index a, Index b) { return less(points_[a], points_[b]); });
  }

  /// Returns the point nearest to p within the tolerance, or none if there is no such point.
  Index find(const Point& p, double tolerance) const {
    const auto exact = std::lower_bound(order_.begin(), order_.end(), p,
                                        [&](Index i, const Point& q) { return less(points_[i], q); });
    if (exact != order_.end() && points_[*exact] == p) return *exact;
    Index best = none;
    double least = tolerance;
    auto i = std::lower_bound(order_.begin(), order_.end(), p.x - tolerance,
                              [&](Index k, double x) { return points_[k].x < x; });
    for (; i != order_.end() && points_[*i].x <= p.x + tolerance; ++i) {
      const double d = distance(points_[*i], p);
      if (d > least) continue;
      least = d;
      best = *i;
    }
    return best;
  }

 private:
  static bool less(const Point& a, const Point& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  }
  const std::vector<Point>& points_;
  std::vector<Index> order_;
};

// A vote that assigns pieces to features: each entity of a piece votes for the feature nearest to its middle,
// and its size is the weight of its vote.
class Ballot {
 public:
  void vote(Index piece, Index feature, double weight) {
    if (feature != none) votes_.push_back({piece, feature, weight});
  }
  /// Returns for each piece the feature with the largest total weight of votes; none for a piece without
  /// votes.
  std::vector<Index> count(std::size_t pieces) {
    std::stable_sort(votes_.begin(), votes_.end(), [](const Vote& a, const Vote& b) {
      return a.piece != b.piece ? a.piece < b.piece : a.feature < b.feature;
    });
    std::vector<Index> elected(pieces, none);
    std::vector<double> most(pieces, 0);
    for (std::size_t i = 0, j = 0; i < votes_.size(); i = j) {
      double sum = 0;
      for (j = i;
           j < votes_.size() && votes_[j].piece == votes_[i].piece && votes_[j].feature == votes_[i].feature;
           ++j)
        sum += votes_[j].weight;
      if (sum <= most[votes_[i].piece]) continue;
      most[votes_[i].piece] = sum;
      elected[votes_[i].piece] = votes_[i].feature;
    }
    return elected;
  }

 private:
  struct Vote {
    Index piece, feature;
    double weight;
  };
  std::vector<Vote> votes_;
};

// Joins edges of one tag that meet in a point, unless further edges meet there or a vertex of the complex is
// there.
DisjointSets edge_pieces(const TetMesh& mesh, const std::vector<Index>& vertex_point) {
  std::vector<std::array<Index, 2>> ends;  // point, edge
  for (Index e = 0; e < mesh.edges.size(); ++e)
    for (const Index p : mesh.edges[e]) ends.push_back({p, e});
  std::sort(ends.begin(), ends.end());
  std::vector<bool> is_vertex(mesh.points.size(), false);
  for (const Index p : vertex_point)
    if (p != none) is_vertex[p] = true;
  DisjointSets pieces(mesh.edges.size());
  for (std::size_t i = 0, j = 0; i < ends.size(); i = j) {
    for (j = i; j < ends.size() && ends[j][0] == ends[i][0];) ++j;
    if (j - i == 2 && !is_vertex[ends[i][0]] && mesh.edge_tag[ends[i][1]] == mesh.edge_tag[ends[i + 1][1]])
      pieces.unite(ends[i][1], ends[i + 1][1]);
  }
  return pieces;
}

// Joins faces that have the same pair of regions (and, if `by_tag`, the same tag) and share an edge that lies
// on no curve and is a side of no third face.
DisjointSets face_pieces(const TetMesh& mesh, bool by_tag) {
  struct FaceEdge {
    std::array<Index, 2> ends;
    Index face;  // none: an edge on a curve
    bool operator<(const FaceEdge& other) const {
      return ends != other.ends ? ends < other.ends : face < other.face;
    }
  };
  std::vector<FaceEdge> sides;
  for (const auto& e : mesh.edges) sides.push_back({sorted(e[0], e[1]), none});
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (unsigned i = 0; i < 3; ++i)
      sides.push_back({sorted(mesh.faces[f][i], mesh.faces[f][(i + 1) % 3]), f});
  std::sort(sides.begin(), sides.end());
  DisjointSets pieces(mesh.faces.size());
  const auto alike = [&](Index f, Index g) {
    const auto &r = mesh.face_regions[f], &s = mesh.face_regions[g];
    return (!by_tag || mesh.face_tag[f] == mesh.face_tag[g]) && sorted(r[0], r[1]) == sorted(s[0], s[1]);
  };
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    for (j = i; j < sides.size() && sides[j].ends == sides[i].ends;) ++j;
    if (j - i == 2 && sides[j - 1].face != none && alike(sides[i].face, sides[i + 1].face))
      pieces.unite(sides[i].face, sides[i + 1].face);
  }
  return pieces;
}

std::vector<Index> match_edges(const TetMesh& mesh, const Plc& plc, const std::vector<Index>& vertex_point) {
  std::vector<Index> curves = mesh.edge_curve;
  if (std::find(curves.begin(), curves.end(), none) == curves.end()) return curves;
  NearestFeature nearest;
  for (Index c = 0; c < plc.curves.size(); ++c)
    visit_segments(plc.curves[c], [&](Index a, Index b) {
      nearest.add(plc.curves[c].tag, c, {plc.points[a], plc.points[b], plc.points[b]});
    });
  DisjointSets pieces = edge_pieces(mesh, vertex_point);
  Ballot ballot;
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    const Point &a = mesh.points[mesh.edges[e][0]], &b = mesh.points[mesh.edges[e][1]];
    if (curves[e] == none)
      ballot.vote(pieces.find(e), nearest.find(mesh.edge_tag[e], 0.5 * (a + b)), distance(a, b));
  }
  const auto elected = ballot.count(mesh.edges.size());
  for (Index e = 0; e < mesh.edges.size(); ++e)
    if (curves[e] == none) curves[e] = elected[pieces.find(e)];
  return curves;
}

}  // namespace

std::vector<Index> match_vertices(const TetMesh& mesh, const Plc& plc, double rounding) {
  std::vector<Index> points(plc.vertices.size(), none);
  for (Index p = 0; p < mesh.features.size(); ++p) {
    const auto [dimension, feature] = mesh.features[p];
    if (dimension == 0 && feature != none &&
        distance(mesh.points[p], plc.points[plc.vertices[feature].point]) <= rounding)
      points[feature] = p;
  }
  if (std::find(points.begin(), points.end(), none) == points.end()) return points;
  const PointSearch search(mesh.points);
  for (Index v = 0; v < plc.vertices.size(); ++v)
    if (points[v] == none) points[v] = search.find(plc.points[plc.vertices[v].point], rounding);
  return points;
}

std::vector<Index> match_faces(const TetMesh& mesh, const Plc& plc, bool by_tag) {
  std::vector<Index> patches = mesh.face_patch;
  if (std::find(patches.begin(), patches.end(), none) == patches.end()) return patches;
  NearestFeature nearest;
  for (const Plc::Triangle& t : plc.triangles)
    nearest.add(by_tag ? plc.patches[t.patch].tag : 0, t.patch,
                {plc.points[t.points[0]], plc.points[t.points[1]], plc.points[t.points[2]]});
  DisjointSets pieces = face_pieces(mesh, by_tag);
  Ballot ballot;
  for (Index f = 0; f < mesh.faces.size(); ++f) {
    const auto& [i, j, k] = mesh.faces[f];
    const Point &a = mesh.points[i], &b = mesh.points[j], &c = mesh.points[k];
    if (patches[f] == none)
      ballot.vote(pieces.find(f), nearest.find(by_tag ? mesh.face_tag[f] : 0, (a + b + c) / 3),
                  area(a, b, c));
  }
  const auto elected = ballot.count(mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f)
    if (patches[f] == none) patches[f] = elected[pieces.find(f)];
  return patches;
}

FeatureMatch match_features(const TetMesh& mesh, const Plc& plc, double rounding) {
  FeatureMatch match;
  match.vertex_point = match_vertices(mesh, plc, rounding);
  match.edge_curve = match_edges(mesh, plc, match.vertex_point);
  match.face_patch = match_faces(mesh, plc, true);
  return match;
}

}  // namespace collarmesh::checks
