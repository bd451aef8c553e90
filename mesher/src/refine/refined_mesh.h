#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "collar/feature_hierarchy.h"
#include "collarmesh/plc.h"
#include "common/growing_array.h"
#include "delaunay/triangulation.h"
#include "location/voronoi_walk.h"

namespace collarmesh {

/// The Delaunay mesh and the features that its vertices lie on.
///
/// The loop inserts vertices and reports further features of a vertex; BlockRefinement inserts into blocks;
/// all other parts only read. Searching counts as reading, but it marks cells and vertices, so only one
/// thread may search, and the visitor of `visit_ball` must not call `visit_ball`. Invariant: every vertex has
/// a feature, of the lowest dimension known to contain it; dimension 3: none.
class RefinedMesh {
 public:
  /// Makes a mesh of the corners of a box. Keeps the complex by reference.
  RefinedMesh(const Plc& plc, const Box& box) : plc_(plc), triangulation_(box), walk_(triangulation_) {
    features_.resize(vertex_count(), Feature{3, none});
  }

  const Triangulation& triangulation() const { return triangulation_; }

  Index vertex_count() const { return triangulation_.vertex_count(); }
  Index last_vertex() const { return triangulation_.vertex_count() - 1; }
  const Point& point(Index vertex) const { return triangulation_.point(vertex); }
  const Feature& feature(Index vertex) const { return features_[vertex]; }

  Index cell_capacity() const { return triangulation_.cell_capacity(); }
  Index cell_count() const { return triangulation_.cell_count(); }
  bool alive(Index cell) const { return triangulation_.alive(cell); }
  std::uint32_t generation(Index cell) const { return triangulation_.generation(cell); }
  /// Returns whether the cell that had this generation still exists.
  bool alive(Index cell, std::uint32_t generation) const {
    return triangulation_.alive(cell) && triangulation_.generation(cell) == generation;
  }
  const std::array<Index, 4>& corners(Index cell) const { return triangulation_.corners(cell); }
  FaceId opposite(FaceId face) const { return triangulation_.opposite(face); }
  std::array<Index, 3> face_vertices(FaceId face) const { return triangulation_.face_vertices(face); }
  /// Prefetches the cell's corners and generation.
  void prefetch(Index cell) const { triangulation_.prefetch(cell); }
  const Point& circumcentre(Index cell) const { return triangulation_.circumcentre(cell); }
  double squared_radius(Index cell) const { return triangulation_.squared_radius(cell); }
  bool in_conflict(Index cell, const Point& p) const { return triangulation_.in_conflict(cell, p); }

  /// Returns whether a vertex lies on a patch, or on its border.
  bool on_patch(Index vertex, Index patch) const {
    const Feature& f = features_[vertex];
    if (f.dimension == 2) return f.index == patch;
    if (f.dimension == 1) return plc_.curve_on_patch(f.index, patch);
    return f.dimension == 0 && plc_.vertex_on_patch(f.index, patch);
  }
  /// Returns whether all these vertices lie on one patch.
  bool on_one_patch(std::span<const Index> vertices) const {
    for (const Index v : vertices)
      if (features_[v].dimension == 3) return false;
    const auto contains_all = [&](Index patch) {
      return std::ranges::all_of(vertices, [&](Index v) { return on_patch(v, patch); });
    };
    const Feature& f = features_[vertices[0]];
    if (f.dimension == 2) return contains_all(f.index);
    const auto& patches = f.dimension == 0 ? plc_.vertices[f.index].patches : plc_.curves[f.index].patches;
    return std::ranges::any_of(patches, contains_all);
  }

  void incident_cells(Index vertex, std::vector<Index>& cells) const {
    triangulation_.incident_cells(vertex, cells);
  }
  void adjacent_vertices(Index vertex, std::vector<Index>& adjacent) const {
    triangulation_.adjacent_vertices(vertex, adjacent);
  }
  Index conflicting_cell_around(Index vertex, const Point& p) const {
    return triangulation_.conflicting_cell_around(vertex, p);
  }
  void find_conflict_zone(const Point& p, Index start, ConflictZone& zone) const {
    triangulation_.find_conflict_zone(p, start, zone);
  }
  /// Returns the vertex whose Voronoi cell contains p. `near` is a vertex not far away, if one is known.
  Index nearest_vertex(const Point& p, Index near = none) const {
    if (vertex_count() > 8) return walk_.nearest(p, near == none ? last_vertex() : near);
    // At first the only vertices are the corners of the box, which are cospherical and not all neighbours.
    Index nearest = 0;
    for (Index corner = 1; corner < 8; ++corner)
      if (squared_distance(p, point(corner)) < squared_distance(p, point(nearest))) nearest = corner;
    return nearest;
  }
  /// Visits vertices like VoronoiWalk::visit_ball.
  template <class Visit>
  void visit_ball(const Point& x, Index nearest, const double& squared_radius, const Visit& visit) const {
    walk_.visit_ball(x, nearest, squared_radius, visit);
  }

  /// Replaces the zone's cells by cells around its point. Only the loop calls this.
  Index insert(ConflictZone& zone, const Feature& feature) {
    features_.push_back(feature);
    return triangulation_.insert(zone);
  }
  /// Divides the mesh into blocks, like Triangulation::divide.
  std::vector<Triangulation::Block> divide(std::span<const Index> insertions, Triangulation::Owners& owners) {
    auto blocks = triangulation_.divide(insertions, owners);
    features_.resize(vertex_count(), Feature{3, none});
    return blocks;
  }
  /// Inserts into a block. Several threads may call it, each with its own block.
  Index insert(Triangulation::Block& block, ConflictZone& zone, const Feature& feature) {
    const Index vertex = block.insert(zone);
    features_[vertex] = feature;
    return vertex;
  }
  Renumbering join(std::vector<Triangulation::Block>& blocks) {
    Renumbering renumbering = triangulation_.join(blocks);
    renumbering.apply(features_);
    return renumbering;
  }
  /// Records that a vertex also lies on this feature: it becomes the vertex's feature if its dimension is
  /// lower.
  void lower_feature(Index vertex, const Feature& feature) {
    if (feature.dimension < features_[vertex].dimension) features_[vertex] = feature;
  }

  std::size_t bytes() const { return triangulation_.bytes() + features_.bytes(); }

 private:
  const Plc& plc_;
  mutable Triangulation triangulation_;  // mutable for its marks
  mutable VoronoiWalk walk_;
  GrowingArray<Feature> features_;
};

}  // namespace collarmesh
