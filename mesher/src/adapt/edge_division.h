#pragma once

#include <array>
#include <vector>

#include "collarmesh/mesher.h"
#include "collarmesh/progress.h"
#include "refine/sizing.h"
#include "remesh/cell_bounds.h"
#include "remesh/metric.h"
#include "remesh/operations.h"

namespace collarmesh::remeshing::adapting {

/// A division of the edges of a mesh that are longer than its sizes ask for: on curves, in patches and inside
/// regions.
class EdgeDivision {
 public:
  /// Keeps the mesh and the options by reference; `sizes` are targets at the current vertices.
  EdgeDivision(EditableMesh& edited, const MeshOptions& options, std::vector<double> sizes);

  /// Divides once each edge that is longer than `longest` times its target, the longest in target
  /// lengths first. Returns the number of divided edges. Skips edges whose division would make much worse
  /// tets. Stops at `most_vertices`; 0: no bound.
  std::size_t divide_all(double longest, std::size_t most_vertices, const Execution& execution);
  /// Divides, like `divide_all`, each edge that is farther from its smooth patch or curve than the tolerance,
  /// and the longest edge of each face whose centre is too far from the patch.
  std::size_t divide_distant(std::size_t most_vertices, const Execution& execution);
  /// Makes later calls divide an edge with a vertex near it at the place that faces the vertex, not in the
  /// middle.
  void divide_facing() { facing_ = true; }
  /// Makes later calls divide edges whatever the shapes of the new tets, as long as their volumes are
  /// positive.
  void accept_any_shape() { least_share_ = 0; }
  /// Divides edges of tets that miss their bounds: two opposite edges of a flat tet, as between the two sides
  /// of a thin wall, at the places where they are nearest to each other; or one edge at a place that faces
  /// a corner. Keeps a division if fewer tets miss their bounds then, or as many as before but the worst are
  /// better. Returns the number of tets whose edges it divided.
  std::size_t divide_crossing(const Execution& execution);

 private:
  struct LongEdge {
    double length;  // in the metric
    Index a, b;
  };

  const TetComplex& complex() const { return edited_.complex; }
  const TetMesh& mesh() const { return edited_.complex.mesh(); }
  std::size_t divide_each(const std::vector<LongEdge>& edges, std::size_t most_vertices,
                          const Execution& execution);
  std::vector<LongEdge> long_edges(double longest) const;
  std::vector<LongEdge> distant_edges() const;
  struct EdgeOfPatch {
    Index a, b, patch;
  };
  void add_edges_of_face(const std::array<Index, 3>& face, Index patch,
                         std::vector<EdgeOfPatch>& found) const;
  bool is_near(const EdgeOfPatch& edge) const;
  double length(Index a, Index b) const { return metric_.length(a, b, complex().edge(a, b)); }
  double length_by_field(const LongEdge& edge) const;
  void add_missing_sizes();
  void add_vertex(Index a, Index b, Index region, const Change& change);
  bool divide(Index a, Index b);
  double quality(Index tet) const { return rule_.quality(complex().corners(tet), complex()[tet].corners); }
  /// An edge, and the share of its length at which to divide it.
  struct Division {
    Index a, b;
    double share;
  };
  bool divide_facing_at(Index tet);
  bool try_to_divide(const std::vector<Division>& divisions);
  void apply(Trial& trial, Change change);
  void improve_changed(Trial& trial);
  Change improvement_of(Index tet);
  bool is_better(const Trial& trial);
  double share_facing(Index a, Index b, const TetComplex::Ring& ring) const;
  double size_at(const TetMesh::VertexFeature& feature, Index region, const Point& p) const;

  EditableMesh& edited_;
  const MeshOptions& options_;
  Sizing sizing_;
  Metric metric_;
  bool facing_ = false;
  // New tets must have at least this share of the quality of the worst tet at the edge. Halves of a tet have
  // about half of its smallest angle; later improvement finds better tets.
  double least_share_ = 0.4;
  ThinRule rule_;
  Operations operations_;
  std::vector<double> before_;  // qualities of the tets that the current trial replaced
  std::size_t trials_ = 0;
};

}  // namespace collarmesh::remeshing::adapting
