// Checks that every curve is a union of mesh edges.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "check/mesh_to_check.h"
#include "check/polyline.h"
#include "check/predicates.h"

namespace collarmesh::checks {

namespace {

struct ListedEdge {
  std::array<Index, 2> ends;
  Index edge;
  bool in_tet = false;

  friend bool operator<(const ListedEdge& a, const ListedEdge& b) { return a.ends < b.ends; }
};

void mark_edges_of_tets(const TetMesh& mesh, std::vector<ListedEdge>& edges) {
  std::vector<bool> at_edge(mesh.points.size(), false);
  for (const ListedEdge& e : edges) at_edge[e.ends[0]] = at_edge[e.ends[1]] = true;
  for (const auto& t : mesh.tets)
    for (unsigned i = 0; i < 3; ++i) {
      if (!at_edge[t[i]]) continue;
      for (unsigned j = i + 1; j < 4; ++j) {
        if (!at_edge[t[j]]) continue;
        const auto [first, last] =
            std::equal_range(edges.begin(), edges.end(), ListedEdge{sorted(t[i], t[j]), none});
        for (auto e = first; e != last; ++e) e->in_tet = true;
      }
    }
}

// The edges of one curve, walked from end to end.
class CurveCheck {
 public:
  CurveCheck(const MeshToCheck& to_check, Index curve, const Index* first, const Index* last,
             CheckReport& report, Findings& findings)
      : to_check_(to_check),
        curve_(to_check.plc.curves[curve]),
        id_(curve),
        edges_(first, last),
        allowed_(to_check.curve_allowance[curve]),
        report_(report),
        findings_(findings) {}

  void run() {
    if (edges_.empty()) {
      if (!curve_is_outside(to_check_, id_))
        report_gap(to_check_.plc.points[curve_.points[0]], "has no edges");
      return;
    }
    if (!curve_.closed && (end_point(0) == none || end_point(1) == none)) return;  // a vertex is missing
    if (find_chain()) compare(make_polyline());
  }

 private:
  bool is_loop() const { return curve_.closed || curve_.ends[0] == curve_.ends[1]; }
  Index end_point(unsigned i) const { return to_check_.match.vertex_point[curve_.ends[i]]; }

  NamedFeature name() const { return {"curve", id_, curve_.tag}; }
  void report_gap(const Point& where, std::string_view how) {
    checks::report_gap(name(), where, how, findings_);
  }

  // Puts the points of the edges into chain_, in order. Returns false, with findings, if the edges form no
  // chain.
  bool find_chain() {
    std::vector<std::array<Index, 2>> ends;  // point, edge
    for (const Index e : edges_)
      for (const Index p : to_check_.mesh.edges[e]) ends.push_back({p, e});
    std::sort(ends.begin(), ends.end());
    if (!check_degrees(ends)) return false;
    const Index start = curve_.closed ? ends[0][0] : end_point(0);
    Index at = start, by = none;
    chain_ = {start};
    for (std::size_t step = 0; step < edges_.size(); ++step) {
      auto next = std::lower_bound(ends.begin(), ends.end(), std::array<Index, 2>{at, 0});
      if (next != ends.end() && (*next)[0] == at && (*next)[1] == by) ++next;
      if (next == ends.end() || (*next)[0] != at) break;
      by = (*next)[1];
      const auto& edge = to_check_.mesh.edges[by];
      at = edge[0] == at ? edge[1] : edge[0];
      chain_.push_back(at);
      if (is_loop() && at == start) break;
    }
    if (chain_.size() == edges_.size() + 1) return true;
    report_gap(to_check_.point(chain_.back()),
               fmt::format("has {} edges beyond the end of its chain", edges_.size() + 1 - chain_.size()));
    return false;
  }

  bool check_degrees(const std::vector<std::array<Index, 2>>& ends) {
    bool good = true;
    const auto degree_at = [&](Index point) {
      const auto first = std::lower_bound(ends.begin(), ends.end(), std::array<Index, 2>{point, 0});
      return std::find_if(first, ends.end(), [&](const auto& e) { return e[0] != point; }) - first;
    };
    const auto expect = [&](Index point, std::ptrdiff_t expected) {
      good = check_edges_at(name(), to_check_.point(point), degree_at(point), expected, findings_) && good;
    };
    if (!curve_.closed)
      for (unsigned i = 0; i < (is_loop() ? 1 : 2); ++i) expect(end_point(i), is_loop() ? 2 : 1);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const Index point = ends[i][0];
      const bool first = i == 0 || ends[i - 1][0] != point;
      const bool end = !curve_.closed && (point == end_point(0) || point == end_point(1));
      if (first && !end) expect(point, 2);
    }
    return good;
  }

  // Returns the curve as a polyline that starts at the first point of the chain. Reverses the chain if it
  // runs against the curve.
  Polyline make_polyline() {
    std::vector<Point> points;
    for (const Index i : curve_.points) points.push_back(to_check_.plc.points[i]);
    if (curve_.closed) points.push_back(points.front());
    Polyline polyline(std::move(points));
    if (curve_.closed) polyline = polyline.started_at(polyline.nearest(to_check_.point(chain_[0])).arc);
    if (is_loop() && polyline.nearest(to_check_.point(chain_[1])).arc >
                         polyline.nearest(to_check_.point(chain_[chain_.size() - 2])).arc)
      std::reverse(chain_.begin(), chain_.end());
    return polyline;
  }

  void compare(const Polyline& polyline) {
    double arc = 0;
    for (std::size_t i = 1; i < chain_.size(); ++i) {
      const Point &a = to_check_.point(chain_[i - 1]), &b = to_check_.point(chain_[i]);
      const bool last = i + 1 == chain_.size();
      // Search the nearest point only up to here: an arc that stays close to its chord is not much longer
      // than the chord.
      const double reach = std::fmin(polyline.length(), arc + 3 * distance(a, b) + 4 * allowed_);
      const Polyline::Nearest here =
          last ? Polyline::Nearest{polyline.length(), distance(b, polyline.points().back())}
               : polyline.nearest(b, arc, reach);
      if (here.distance > allowed_ && polyline.nearest(b).distance <= allowed_) {
        report_gap(b, "has edges that leave it and return elsewhere, or run backwards");
        return;
      }
      if (here.arc <= arc) {
        report_gap(b, "has edges that run backwards");
        return;
      }
      measure(here.distance, chain_[i], b);
      compare_edge(polyline, arc, here.arc, i);
      arc = here.arc;
    }
  }

  // Checks the two-sided distance between an edge of the chain and its part of the curve.
  void compare_edge(const Polyline& polyline, double from, double to, std::size_t i) {
    const Point &a = to_check_.point(chain_[i - 1]), &b = to_check_.point(chain_[i]);
    const auto corners = polyline.corners_between(from, to);
    for (std::size_t k = corners.first; k < corners.last; ++k)
      measure(nearest_on_segment(polyline.points()[k], a, b).distance, chain_[i], polyline.points()[k]);
    for (const double t : {0.25, 0.5, 0.75}) {
      const Point sample = a + t * (b - a);
      measure(polyline.nearest(sample, from, to).distance, chain_[i], sample);
    }
  }

  void measure(double distance, Index point, const Point& where) {
    if (!curve_.straight) report_.max_surface_distance = std::fmax(report_.max_surface_distance, distance);
    if (distance <= allowed_) return;
    findings_.add(
        guarantee::curve_distance, where, {id_, point},
        "The edges of curve {} (tag {}) and the curve are {:.6g} apart at {} (mesh point {}), allowed is "
        "{:.6g}; {}.",
        id_, curve_.tag, distance, At{where}, point, allowed_,
        curve_.straight ? "the point is not on the straight curve"
                        : "use a smaller size there or allow a larger distance");
  }

  const MeshToCheck& to_check_;
  const Plc::Curve& curve_;
  Index id_;
  std::vector<Index> edges_;
  double allowed_;
  CheckReport& report_;
  Findings& findings_;
  std::vector<Index> chain_;
};

}  // namespace

void check_listed_edges(const MeshToCheck& to_check, Findings& findings) {
  assert(to_check.is_matched());
  const TetMesh& mesh = to_check.mesh;
  std::vector<ListedEdge> edges;
  for (Index e = 0; e < mesh.edges.size(); ++e)
    edges.push_back({sorted(mesh.edges[e][0], mesh.edges[e][1]), e});
  std::sort(edges.begin(), edges.end());
  mark_edges_of_tets(mesh, edges);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [ends, edge, in_tet] = edges[i];
    const Point where = to_check.midpoint(ends);
    if (!in_tet)
      findings.add(
          guarantee::listed_edges, where, {edge},
          "Edge {} of points {} and {} at {} is an edge of no tet; the mesh does not follow the curve there.",
          edge, ends[0], ends[1], At{where});
    if (i > 0 && edges[i - 1].ends == ends)
      findings.add(guarantee::listed_edges, where, {edges[i - 1].edge, edge},
                   "Edges {} and {} at {} have the same points {} and {}; list the edge once.",
                   edges[i - 1].edge, edge, At{where}, ends[0], ends[1]);
  }
}

void check_curves(const MeshToCheck& to_check, CheckReport& report, Findings& findings) {
  assert(to_check.is_matched());
  const TetMesh& mesh = to_check.mesh;
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    const Index curve = to_check.match.edge_curve[e];
    const Point where = to_check.midpoint(mesh.edges[e]);
    if (curve == none)
      findings.add(guarantee::curve_tag, where, {e},
                   "Edge {} at {} has tag {}, which no curve of the complex has; correct the tag.", e,
                   At{where}, mesh.edge_tag[e]);
    else if (mesh.edge_tag[e] != to_check.plc.curves[curve].tag)
      findings.add(guarantee::curve_tag, where, {e},
                   "Edge {} at {} has tag {}, but its curve {} has tag {}; correct the tag or the curve.", e,
                   At{where}, mesh.edge_tag[e], curve, to_check.plc.curves[curve].tag);
  }
  const Grouping by_curve(to_check.match.edge_curve, to_check.plc.curves.size());
  for (Index c = 0; c < to_check.plc.curves.size(); ++c)
    CurveCheck(to_check, c, by_curve.begin(c), by_curve.end(c), report, findings).run();
}

}  // namespace collarmesh::checks
