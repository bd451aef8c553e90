#include "shells/curve_mesher.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "location/curve_paths.h"
#include "refine/sizing.h"
#include "shells/curve_division.h"
#include "shells/surface_sizes.h"

namespace collarmesh::shells {

namespace {

/// Returns options with exact sizes, for lines. Edges of triangles and tets may be somewhat longer than the
/// size, so that their mean is the size; lines may not.
MeshOptions exact_sizes(const Plc& plc, MeshOptions options) {
  constexpr double factor = 1 / Sizing::edge_per_size;
  options.size = factor * default_size(plc, options);
  options.size_min *= factor;
  for (auto* const sizes : {&options.patch_size, &options.curve_size})
    for (auto& [tag, size] : *sizes) size *= factor;
  if (options.size_field)
    options.size_field = [field = options.size_field](const Point& p) { return factor * field(p); };
  return options;
}

class CurveMesher {
 public:
  CurveMesher(const Plc& plc, const MeshOptions& options, const SurfaceTolerance& tolerance, unsigned order,
              const ExactGeometry& exact)
      : plc_(plc),
        tolerance_(tolerance),
        order_(order),
        exact_(exact),
        paths_(plc, plc.points),
        options_(exact_sizes(plc, options)),
        sizes_(plc, paths_, options_),
        node_of_(plc.vertices.size(), none) {}

  CurveMesh run() {
    for (Index c = 0; c < plc_.curves.size(); ++c) add_edges(c);
    if (order_ == 2)
      for (std::size_t e = 0; e < mesh_.edges.size(); ++e) add_middle(e);
    made_.second_order.nodes = mesh_.edge_mid_nodes.size();
    mesh_.names = plc_.names;
    return std::move(made_);
  }

 private:
  Index add_point(const Point& p, const TetMesh::VertexFeature& feature) {
    mesh_.points.push_back(p);
    mesh_.features.push_back(feature);
    return static_cast<Index>(mesh_.points.size() - 1);
  }

  Index node_at_vertex(Index vertex) {
    if (node_of_[vertex] == none)
      node_of_[vertex] = add_point(plc_.points[plc_.vertices[vertex].point], {0, vertex});
    return node_of_[vertex];
  }

  Index node_on_curve(Index curve, double parameter) {
    const Point place = paths_.point(curve, parameter);
    const Index node = add_point(place, {1, curve});
    const std::optional<Point> exact = exact_ ? exact_(1, curve, place) : std::nullopt;
    if (!exact) return node;
    ProjectReport& report = made_.projection;
    ++report.vertices;
    const double way = distance(place, *exact);
    if (way <= tolerance_.largest()) {
      mesh_.points[node] = *exact;
      report.largest_move = std::max(report.largest_move, way);
    } else {
      report.largest_distance = std::max(report.largest_distance, way);
      report.exceptions.push_back({node, 1, curve, place, way});
    }
    return node;
  }

  void add_edges(Index curve) {
    const Plc::Curve& c = plc_.curves[curve];
    const std::vector<double> at = divide_curve(
        plc_, paths_, [&](Index point) { return tolerance_.at_point(point); }, sizes_, curve, {0, 0});
    const Index first = c.closed ? node_on_curve(curve, 0) : node_at_vertex(c.ends[0]);
    Index before = first;
    for (std::size_t i = 1; i < at.size(); ++i) {
      const bool last = i + 1 == at.size();
      const Index next = !last ? node_on_curve(curve, at[i]) : c.closed ? first : node_at_vertex(c.ends[1]);
      mesh_.edges.push_back({before, next});
      mesh_.edge_curve.push_back(curve);
      mesh_.edge_tag.push_back(c.tag);
      middles_.push_back(0.5 * (at[i - 1] + at[i]));
      before = next;
    }
  }

  /// Adds the mid-edge node at the middle parameter of an edge. An edge of second order does not fold if its
  /// node is within a quarter of its length from the middle of the chord, measured along the chord.
  void add_middle(std::size_t edge) {
    constexpr double most_shift = 0.24;
    const Index curve = mesh_.edge_curve[edge];
    const Point a = mesh_.points[mesh_.edges[edge][0]], b = mesh_.points[mesh_.edges[edge][1]];
    const Point middle = 0.5 * (a + b), place = paths_.point(curve, middles_[edge]);
    const std::optional<Point> exact =
        exact_ && !plc_.curves[curve].straight ? exact_(1, curve, place) : std::nullopt;
    const double reach = 0.5 * distance(a, b);
    const Point wanted = plc_.curves[curve].straight                ? middle
                         : exact && distance(*exact, place) < reach ? *exact
                                                                    : place;
    const bool folds = std::fabs(dot(wanted - middle, b - a)) > most_shift * squared_norm(b - a);
    const Index node = add_point(folds ? middle : wanted, {1, curve});
    mesh_.edge_mid_nodes.push_back(node);
    if (!folds && wanted != middle) ++made_.second_order.curved;
    if (folds)
      made_.second_order.straightened.push_back(
          {node, mesh_.edges[edge], {1, curve}, plc_.curves[curve].tag, middle, distance(middle, wanted)});
  }

  const Plc& plc_;
  const SurfaceTolerance& tolerance_;
  const unsigned order_;
  const ExactGeometry& exact_;
  CurvePaths paths_;
  MeshOptions options_;
  SurfaceSizes sizes_;
  std::vector<Index> node_of_;   // by vertex of the complex
  std::vector<double> middles_;  // parameters of mid-edge nodes, by edge
  CurveMesh made_;
  TetMesh& mesh_ = made_.mesh;
};

}  // namespace

CurveMesh mesh_curves(const Plc& plc, const MeshOptions& options, const SurfaceTolerance& tolerance,
                      unsigned order, const ExactGeometry& exact) {
  return CurveMesher(plc, options, tolerance, order, exact).run();
}

}  // namespace collarmesh::shells
