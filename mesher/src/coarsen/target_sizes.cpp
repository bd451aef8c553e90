#include "coarsen/target_sizes.h"

#include <algorithm>
#include <functional>
#include <queue>

#include "common/cells_at_vertices.h"
#include "location/feature_shapes.h"
#include "refine/sizing.h"
#include "tolerance/facing.h"

namespace collarmesh::remeshing::coarsening {

namespace {

// Growth of edge lengths per unit of distance that meshes with a radius-edge ratio of at most 2 show.
constexpr double natural_growth = 0.7;
// Growth of sizes per unit of distance if gaps reduce them, as in the refinement.
constexpr double growth_in_gaps = 0.25;

class TargetSizes {
 public:
  TargetSizes(const TetMesh& mesh, const Plc& plc, const MeshOptions& options)
      : mesh_(mesh),
        plc_(plc),
        options_(options),
        sizing_(plc, options, Frame()),
        sizes_(mesh.points.size(), INFINITY),
        shapes_(plc) {}

  std::vector<double> run() {
    see_regions();
    for (Index v = 0; v < mesh_.points.size(); ++v) see_feature(v);
    if (options_.elements_across_gap > 0) see_gaps();
    grade_sizes(mesh_, growth(), sizes_);
    return std::move(sizes_);
  }

 private:
  void see(Index vertex, double size) { sizes_[vertex] = std::min(sizes_[vertex], size); }

  // Applies the sizes of regions to the vertices inside them. All tets at such a vertex are in its region.
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
    const Index at = nearest_triangle(shapes_.curve(curve), p);
    return sizing_.curve_size(curve, at, at, p);
  }

  double size_on_patch(Index patch, const Point& p) {
    if (options_.elements_per_circle == 0 || plc_.patches[patch].planar)
      return sizing_.feature_size(2, patch, p);
    const Index at = nearest_triangle(shapes_.patch(patch), p);
    return sizing_.triangle_size(patch, plc_.patches[patch].first_triangle + at, p);
  }

  // Applies the sizes of gaps to the corners of faces on patches. Measures gaps as the refinement does: from
  // the centre of a face across the region on each side to the surface that it faces there.
  void see_gaps() {
    const FacingSurfaces facing(plc_);
    FacingSurfaces::Crossings crossings;
    for (Index f = 0; f < mesh_.faces.size(); ++f) {
      const auto& [a, b, c] = mesh_.faces[f];
      const Index patch = mesh_.face_patch[f];
      if (patch == none) continue;
      const double widest = sizing_.widest_gap(std::max({sizes_[a], sizes_[b], sizes_[c]}));
      const Point centre = (mesh_.points[a] + mesh_.points[b] + mesh_.points[c]) / 3;
      Index at = none;
      facing.triangles().squared_distance_to(centre, INFINITY, &at,
                                             [&](Index t) { return plc_.triangles[t].patch == patch; });
      double width = widest;
      for (unsigned side = 0; side < 2 && at != none; ++side)
        if (plc_.patches[patch].regions[side] != 0)
          width = std::min(width, facing.from(centre, at, side, widest, crossings).distance);
      if (width >= widest) continue;
      for (const Index v : mesh_.faces[f]) see(v, sizing_.gap_size(width));
    }
  }

  double growth() const {
    if (options_.gradation > 0) return options_.gradation;
    return options_.elements_across_gap > 0 ? growth_in_gaps : natural_growth;
  }

  const TetMesh& mesh_;
  const Plc& plc_;
  const MeshOptions& options_;
  Sizing sizing_;
  std::vector<double> sizes_;
  FeatureShapes shapes_;
};

}  // namespace

void grade_sizes(const TetMesh& mesh, double growth, std::vector<double>& sizes) {
  const auto [least, largest] = std::ranges::minmax_element(sizes);
  if (least == sizes.end() || *least == *largest) return;
  const CellsAtVertices tets_at(mesh.tets, mesh.points.size());
  using Entry = std::pair<double, Index>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  for (Index v = 0; v < sizes.size(); ++v) front.emplace(sizes[v], v);
  while (!front.empty()) {
    const auto [size, vertex] = front.top();
    front.pop();
    if (size > sizes[vertex]) continue;
    for (const Index t : tets_at[vertex])
      for (const Index other : mesh.tets[t]) {
        const double graded = size + growth * distance(mesh.points[vertex], mesh.points[other]);
        if (graded >= sizes[other]) continue;
        sizes[other] = graded;
        front.emplace(graded, other);
      }
  }
}

std::vector<double> target_sizes(const TetMesh& mesh, const Plc& plc, const MeshOptions& options) {
  return TargetSizes(mesh, plc, options).run();
}

}  // namespace collarmesh::remeshing::coarsening
