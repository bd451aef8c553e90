#include "check/border_edges.h"

#include <map>
#include <tuple>

#include "common/distance_tree.h"
#include "common/segments.h"
#include "common/sort_uniquely.h"

namespace collarmesh::checks {

namespace {

struct Side {
  std::array<Index, 2> ends;  // sorted
  Tag tag;

  friend bool operator<(const Side& a, const Side& b) {
    return std::tie(a.ends, a.tag) < std::tie(b.ends, b.tag);
  }
};

std::vector<Side> sides_of(const TetMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.faces.size());
  for (Index f = 0; f < mesh.faces.size(); ++f)
    for (unsigned k = 0; k < 3; ++k)
      sides.push_back({sorted(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]), mesh.face_tag[f]});
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// Bent curves whose patches have the same tags. Finds the curve nearest to a point.
class CurvesOfTags {
 public:
  void add(const Plc& plc, Index curve) {
    visit_segments(plc.curves[curve], [&](Index a, Index b) {
      segments_.push_back({plc.points[a], plc.points[b], plc.points[b]});
      curves_.push_back(curve);
    });
  }

  Index nearest(const Point& p) {
    if (!tree_) tree_.emplace(segments_);
    return curves_[tree_->nearest(p).triangle];
  }

 private:
  std::vector<DistanceTree::Triangle> segments_;
  std::vector<Index> curves_;  // by segment
  std::optional<DistanceTree> tree_;
};

std::map<std::vector<Tag>, CurvesOfTags> curves_by_tags(const Plc& plc) {
  std::map<std::vector<Tag>, CurvesOfTags> found;
  for (Index c = 0; c < plc.curves.size(); ++c) {
    if (plc.curves[c].straight) continue;
    std::vector<Tag> tags;
    for (const Index patch : plc.curves[c].patches) tags.push_back(plc.patches[patch].tag);
    sort_uniquely(tags);
    if (!tags.empty()) found[tags].add(plc, c);
  }
  return found;
}

}  // namespace

std::vector<std::vector<std::array<Index, 2>>> border_edges(const MeshToCheck& to_check) {
  std::vector<std::vector<std::array<Index, 2>>> edges(to_check.plc.curves.size());
  auto curves = curves_by_tags(to_check.plc);
  const std::vector<Side> sides = sides_of(to_check.mesh);
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    std::vector<Tag> tags;
    for (j = i; j < sides.size() && sides[j].ends == sides[i].ends; ++j)
      if (tags.empty() || tags.back() != sides[j].tag) tags.push_back(sides[j].tag);
    if (tags.size() == 1 && j - i == 2) continue;
    const auto found = curves.find(tags);
    if (found != curves.end())
      edges[found->second.nearest(to_check.midpoint(sides[i].ends))].push_back(sides[i].ends);
  }
  return edges;
}

}  // namespace collarmesh::checks
