// Checks of the balls of collars (paper, section 3.2): their sizes and positions.
#include <algorithm>
#include <cmath>

#include "check/mesh_to_check.h"
#include "common/box_tree.h"
#include "common/distances.h"
#include "common/segments.h"
#include "common/shared_bounds.h"

namespace collarmesh::checks {

namespace {

constexpr double distance_slack = 1 - 1e-9;  // factor for distances that leaves room for rounding

double to_triangle(const Point& p, const std::array<Point, 3>& t) {
  return std::sqrt(squared_distance_to_triangle(p, t[0], t[1], t[2]));
}

class CollarCheck {
 public:
  CollarCheck(const MeshToCheck& to_check, Findings& findings)
      : to_check_(to_check),
        plc_(to_check.plc),
        balls_(to_check.mesh.collar_balls),
        ball_at_(to_check.mesh.points.size(), none),
        overlapping_(balls_.size()),
        findings_(findings) {
    for (Index b = 0; b < balls_.size(); ++b) ball_at_[balls_[b].point] = b;
  }

  void run() {
    check_centres();
    collect_elements();
    look_around();
    check_circles();
    check_cells();
  }

 private:
  struct Element {
    unsigned dimension;
    Index feature;
    std::array<Index, 3> points;
  };

  // Returns where the ball's centre was before vertices moved onto exact geometry: gaps and overlaps are
  // measured in the complex, not in the exact geometry.
  const Point& centre(Index ball) const { return balls_[ball].centre; }
  double radius(Index ball) const { return balls_[ball].radius; }
  const TetMesh::VertexFeature& feature_of(Index ball) const {
    return to_check_.mesh.features[balls_[ball].point];
  }

  // Checks how far the points at the centres have moved since the balls were made. A vertex of the complex
  // must not move; a point on a curve may move onto exact geometry, within the distance tolerance.
  void check_centres() {
    for (Index b = 0; b < balls_.size(); ++b) {
      const Point& now = to_check_.point(balls_[b].point);
      const double way = distance(centre(b), now);
      const double allowed =
          to_check_.rounding + (feature_of(b).dimension == 0 ? 0 : to_check_.tolerance.largest());
      if (way <= allowed) continue;
      findings_.add(
          guarantee::collar_centre, now, {balls_[b].point},
          "The collar's ball at {} (radius {:.9g}) belongs to point {}, which is {:.6g} away from the ball's "
          "centre, allowed is {:.6g}; the point was moved, or the ball belongs to another point.",
          At{centre(b)}, radius(b), balls_[b].point, way, allowed);
    }
  }

  // Lists the vertices, segments and triangles of the complex, except those of features outside all regions,
  // which are not in the mesh.
  void collect_elements() {
    for (Index v = 0; v < plc_.vertices.size(); ++v) {
      const Index p = plc_.vertices[v].point;
      if (!vertex_is_outside(to_check_, v)) elements_.push_back({0, v, {p, p, p}});
    }
    for (Index c = 0; c < plc_.curves.size(); ++c) {
      if (curve_is_outside(to_check_, c)) continue;
      visit_segments(plc_.curves[c], [&](Index a, Index b) { elements_.push_back({1, c, {a, b, a}}); });
    }
    for (const Plc::Triangle& t : plc_.triangles)
      if (!patch_is_outside(to_check_, t.patch)) elements_.push_back({2, t.patch, t.points});
  }

  bool contains(const Element& element, const TetMesh::VertexFeature& v) const {
    if (v.dimension == 0) {
      if (element.dimension == 0) return element.feature == v.feature;
      return element.dimension == 1 ? plc_.vertex_on_curve(v.feature, element.feature)
                                    : plc_.vertex_on_patch(v.feature, element.feature);
    }
    if (element.dimension == 1) return element.feature == v.feature;
    return element.dimension == 2 && plc_.curve_on_patch(v.feature, element.feature);
  }

  // Checks the distances of balls from the features of the complex and from each other.
  void look_around() {
    std::vector<Box> boxes;
    for (Index b = 0; b < balls_.size(); ++b) {
      boxes.emplace_back();
      const Vector reach = gap_per_radius * radius(b) * Vector{1, 1, 1};
      boxes.back().add(centre(b) - reach);
      boxes.back().add(centre(b) + reach);
    }
    for (const Element& e : elements_) {
      boxes.emplace_back();
      for (const Index p : e.points) boxes.back().add(plc_.points[p]);
    }
    BoxTree(boxes).for_each_pair([&](Index i, Index j) {
      const auto [first, second] = std::minmax(i, j);
      if (first >= balls_.size()) return;
      if (second >= balls_.size())
        check_gap(first, elements_[second - balls_.size()]);
      else
        check_overlap(first, second);
    });
  }

  void check_gap(Index ball, const Element& element) {
    if (contains(element, feature_of(ball))) return;
    const std::array<Point, 3> t{plc_.points[element.points[0]], plc_.points[element.points[1]],
                                 plc_.points[element.points[2]]};
    const double gap = to_triangle(centre(ball), t);
    if (gap >= gap_per_radius * radius(ball) * distance_slack - to_check_.rounding) return;
    static constexpr const char* kinds[] = {"vertex", "curve", "patch"};
    findings_.add(
        guarantee::collar_gap, centre(ball), {balls_[ball].point},
        "The collar's ball at {} has radius {:.9g}, more than a third of the distance {:.9g} to {} {}; "
        "report it with the input and the options.",
        At{centre(ball)}, radius(ball), gap, kinds[element.dimension], element.feature);
  }

  // Returns whether two balls belong to one crease: both are on one curve, or one is at an end of the other's
  // curve.
  bool of_one_crease(Index a, Index b) const {
    const auto &f = feature_of(a), &g = feature_of(b);
    if (f.dimension == 1 && g.dimension == 1) return f.feature == g.feature;
    if (f.dimension == g.dimension) return false;
    return f.dimension == 0 ? plc_.vertex_on_curve(f.feature, g.feature)
                            : plc_.vertex_on_curve(g.feature, f.feature);
  }

  void check_overlap(Index a, Index b) {
    if (distance(centre(a), centre(b)) >= (radius(a) + radius(b)) * distance_slack) return;
    overlapping_[a].push_back(b);
    overlapping_[b].push_back(a);
    if (of_one_crease(a, b)) return;
    findings_.add(
        guarantee::collar_disjoint, centre(a), {balls_[a].point, balls_[b].point},
        "The collars' balls at {} (radius {:.9g}) and {} (radius {:.9g}) belong to different creases and "
        "overlap; report it with the input and the options.",
        At{centre(a)}, radius(a), At{centre(b)}, radius(b));
  }

  // Checks that consecutive balls, whose centres are joined by an edge on their crease, meet in a circle that
  // no third ball reaches.
  void check_circles() {
    for (const auto& [p, q] : to_check_.mesh.edges) {
      const Index a = ball_at_[p], b = ball_at_[q];
      if (a == none || b == none || !of_one_crease(a, b)) continue;
      const double d = distance(centre(a), centre(b));
      const Vector axis = (centre(b) - centre(a)) / d;
      const double along = (d * d + radius(a) * radius(a) - radius(b) * radius(b)) / (2 * d);
      const double squared = radius(a) * radius(a) - along * along;
      const Point middle = centre(a) + along * axis;
      if (squared <= 0) {
        report_circle(a, b, "do not overlap");
        continue;
      }
      for (const Index k : overlapping_[a]) {
        if (k == b) continue;
        const Vector to = centre(k) - middle;
        const double height = dot(to, axis);
        const double off = std::sqrt(std::max(0.0, squared_norm(to) - height * height));
        if (std::hypot(height, off - std::sqrt(squared)) < radius(k) * distance_slack)
          report_circle(a, b, "meet in a circle that a third ball reaches");
      }
    }
  }

  void report_circle(Index a, Index b, const char* what) {
    findings_.add(
        guarantee::collar_disjoint, centre(a), {balls_[a].point, balls_[b].point},
        "Two consecutive balls of a collar at {} (radius {:.9g}) and {} (radius {:.9g}) {}; report it "
        "with the input and the options.",
        At{centre(a)}, radius(a), At{centre(b)}, radius(b), what);
  }

  // Checks that each tet has as many centres of balls among its corners as its mark demands: a tet in a star
  // one, a tet in a book two, other tets none.
  void check_cells() {
    const TetMesh& mesh = to_check_.mesh;
    for (Index t = 0; t < mesh.tets.size(); ++t) {
      const auto centres = std::count_if(mesh.tets[t].begin(), mesh.tets[t].end(),
                                         [&](Index p) { return ball_at_[p] != none; });
      if (centres == mesh.tet_collar[t]) continue;
      const Point where = 0.5 * (to_check_.point(mesh.tets[t][0]) + to_check_.point(mesh.tets[t][1]));
      findings_.add(
          guarantee::collar_cells, where, {t},
          "Tet {} at {} has {} corners that are centres of collars' balls, but its mark as a cell of a "
          "collar demands {}; correct the mark, or add the missing cell.",
          t, At{where}, centres, mesh.tet_collar[t]);
    }
  }

  const MeshToCheck& to_check_;
  const Plc& plc_;
  const std::vector<TetMesh::CollarBall>& balls_;
  std::vector<Index> ball_at_;                   // by mesh point
  std::vector<std::vector<Index>> overlapping_;  // by ball
  std::vector<Element> elements_;
  Findings& findings_;
};

}  // namespace

void check_collars(const MeshToCheck& to_check, Findings& findings) {
  if (!to_check.mesh.collar_balls.empty()) CollarCheck(to_check, findings).run();
}

}  // namespace collarmesh::checks
