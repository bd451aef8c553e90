#include "coarsen/target_sizes.h"

#include <algorithm>
#include <memory>
#include <queue>

#include "coarsen/gap_widths.h"
#include "common/segments.h"
#include "location/triangle_hierarchy.h"
#include "refine/sizing.h"

namespace collarmesh::coarsening {

namespace {

// Growth per unit length of edges in meshes with a radius-edge ratio of at most 2, as observed.
constexpr double natural_growth = 0.7;
// Growth of sizes between the faces of a gap, as in the refinement.
constexpr double growth_in_gaps = 0.25;

class TargetSizes {
 public:
  TargetSizes(const TetMesh& mesh, const Plc& plc, const MeshOptions& options)
      : mesh_(mesh),
        plc_(plc),
        options_(options),
        sizing_(plc, options, Frame()),
        sizes_(mesh.points.size(), INFINITY),
        on_patch_(plc.patches.size()),
        on_curve_(plc.curves.size()) {}

  std::vector<double> run() {
    see_regions();
    for (Index v = 0; v < mesh_.points.size(); ++v) see_feature(v);
    if (options_.elements_across_gap > 0) see_gaps();
    grade();
    return std::move(sizes_);
  }

 private:
  void see(Index vertex, double size) { sizes_[vertex] = std::min(sizes_[vertex], size); }

  // Finds the region of each vertex. All tets at a vertex inside a region are in that region.
  void see_regions() {
    std::vector<Index> region_of(mesh_.points.size(), none);
    for (Index t = 0; t < mesh_.tets.size(); ++t)
      for (const Index v : mesh_.tets[t]) region_of[v] = mesh_.tet_region[t];
    for (Index v = 0; v < mesh_.points.size(); ++v)
      if (region_of[v] != none && mesh_.features[v].dimension == 3)
        see(v, sizing_.region_size(region_of[v], mesh_.points[v]));
  }

  void see_feature(Index vertex) {
    const auto& [dimension, feature] = mesh_.features[vertex];
    const Point& p = mesh_.points[vertex];
    if (feature == none) return see(vertex, dimension == 3 ? INFINITY : sizing_.default_size(p));
    if (dimension == 0) {
      see(vertex, sizing_.default_size(p));
      for (const Index curve : plc_.vertices[feature].curves) see(vertex, size_on_curve(curve, p));
      for (const Index patch : plc_.vertices[feature].patches) see(vertex, size_on_patch(patch, p));
    } else if (dimension == 1) {
      see(vertex, size_on_curve(feature, p));
    } else if (dimension == 2) {
      see(vertex, size_on_patch(feature, p));
    }
  }

  double size_on_curve(Index curve, const Point& p) {
    if (options_.elements_per_circle == 0 || plc_.curves[curve].straight)
      return sizing_.feature_size(1, curve, p);
    auto& segments = on_curve_[curve];
    if (!segments)
      segments = std::make_unique<TriangleHierarchy>(plc_.points, flat_triangles_of(plc_.curves[curve]));
    Index at = 0;
    segments->squared_distance_to(p, INFINITY, &at);
    return sizing_.curve_size(curve, at, at, p);
  }

  double size_on_patch(Index patch, const Point& p) {
    if (options_.elements_per_circle == 0 || plc_.patches[patch].planar)
      return sizing_.feature_size(2, patch, p);
    auto& triangles = on_patch_[patch];
    if (!triangles) triangles = hierarchy_of_patch(plc_, patch);
    Index at = 0;
    triangles->squared_distance_to(p, INFINITY, &at);
    return sizing_.triangle_size(patch, plc_.patches[patch].first_triangle + at, p);
  }

  void see_gaps() {
    GapWidths gaps(plc_);
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      const auto& [a, b, c] = mesh_.faces[f];
      if (mesh_.face_patch[f] == none) continue;
      const double widest = sizing_.widest_gap(std::max({sizes_[a], sizes_[b], sizes_[c]}));
      const Point centre = (mesh_.points[a] + mesh_.points[b] + mesh_.points[c]) / 3;
      const double width = gaps.from(centre, mesh_.face_patch[f], widest);
      if (width >= widest) continue;
      for (const Index v : mesh_.faces[f]) see(v, sizing_.gap_size(width));
    }
  }

  double growth() const {
    if (options_.gradation > 0) return options_.gradation;
    return options_.elements_across_gap > 0 ? growth_in_gaps : natural_growth;
  }

  // Spreads the smallest sizes along the edges of the mesh.
  void grade() {
    const auto [least, largest] = std::minmax_element(sizes_.begin(), sizes_.end());
    if (least == sizes_.end() || *least == *largest) return;
    const double growth = this->growth();
    find_neighbours();
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    for (Index v = 0; v < sizes_.size(); ++v) front.push({sizes_[v], v});
    while (!front.empty()) {
      const auto [size, vertex] = front.top();
      front.pop();
      if (size > sizes_[vertex]) continue;
      for (std::size_t i = first_neighbour_[vertex]; i < first_neighbour_[vertex + 1]; ++i) {
        const Index other = neighbours_[i];
        const double graded = size + growth * distance(mesh_.points[vertex], mesh_.points[other]);
        if (graded >= sizes_[other]) continue;
        sizes_[other] = graded;
        front.push({graded, other});
      }
    }
  }

  // Finds the neighbours of each vertex; lists a neighbour once for each tet at the common edge.
  void find_neighbours() {
    first_neighbour_.assign(mesh_.points.size() + 1, 0);
    for (const auto& tet : mesh_.tets)
      for (const Index v : tet) first_neighbour_[v + 1] += 3;
    for (std::size_t v = 1; v < first_neighbour_.size(); ++v) first_neighbour_[v] += first_neighbour_[v - 1];
    neighbours_.resize(first_neighbour_.back());
    std::vector<std::size_t> next(first_neighbour_.begin(), first_neighbour_.end() - 1);
    for (const auto& tet : mesh_.tets)
      for (const Index v : tet)
        for (const Index w : tet)
          if (w != v) neighbours_[next[v]++] = w;
  }

  const TetMesh& mesh_;
  const Plc& plc_;
  const MeshOptions& options_;
  Sizing sizing_;
  std::vector<double> sizes_;
  std::vector<std::unique_ptr<TriangleHierarchy>> on_patch_, on_curve_;
  std::vector<std::size_t> first_neighbour_;
  std::vector<Index> neighbours_;
};

}  // namespace

std::vector<double> target_sizes(const TetMesh& mesh, const Plc& plc, const MeshOptions& options) {
  return TargetSizes(mesh, plc, options).run();
}

}  // namespace collarmesh::coarsening
