#pragma once

#include <vector>

#include "common/growing_array.h"
#include "location/location_objects.h"
#include "refine/candidate.h"
#include "refine/refined_mesh.h"
#include "refine/work_queue.h"

namespace collarmesh {

/// Points that the mesh must have and does not have yet: vertices of the complex, ends of subsegments, seeds,
/// corner points of collars.
/// Invariant: each point is found from the mesh vertex nearest to it and, unless it is dormant, is in the
/// queue with the empty ball around it. Any part may add points. The loop resolves them when their turn has
/// come or when a candidate warps to them.
class UnresolvedPoints {
 public:
  struct Unresolved {
    Point point;
    Feature feature;
    Index object = none;   // index in objects_; none when resolved or withdrawn
    Index vertex = none;   ///< the mesh vertex that the point became
    Index across = none;   ///< the mesh vertex that the point faces across a gap
    bool dormant = false;  ///< inserted only when a candidate warps to it
    double apart = 0;      ///< a vertex of the same patch nearer than this takes the point's place
  };

  /// Keeps all by reference. `theta`: how far to warp, in radii of the ball to destroy
  /// (paper, Procedure 2).
  UnresolvedPoints(const RefinedMesh& mesh, double theta, WorkQueue& queue)
      : mesh_(mesh), queue_(queue), theta_(theta) {}

  /// Adds a point. `near` is a mesh vertex not far away, if one is known. Points are numbered in the order in
  /// which they are added.
  Index add(const Point& p, const Feature& feature, Index near = none) {
    return add(Unresolved{p, feature}, near);
  }
  Index add(Unresolved point, Index near);
  /// Removes a point that is no longer needed. Precondition: it is not resolved.
  void withdraw(Index point);
  const Unresolved& operator[](Index point) const { return points_[point]; }
  std::size_t size() const { return points_.size(); }
  bool resolved(Index point) const { return points_[point].vertex != none; }
  /// Returns whether every point is resolved or withdrawn.
  bool all_resolved() const {
    for (Index point = 0; point < size(); ++point)
      if (points_[point].object != none) return false;
    return true;
  }
  /// Returns whether the vertices of the complex are the first points, in their order.
  bool begin_with_vertices_of(const Plc& plc) const {
    for (Index v = 0; v < plc.vertices.size(); ++v)
      if (v >= size() || points_[v].feature != Feature{0, v}) return false;
    return true;
  }
  /// Returns whether an unresolved point is theta_0-medial (paper, section 3.1 and appendix A): the second
  /// nearest mesh vertex is not much farther away than the nearest one.
  bool medial(Index point) const;
  /// Returns the mesh vertex that a point became or, while it is unresolved, the nearest mesh vertex.
  Index vertex_near(Index point) const {
    const Unresolved& p = points_[point];
    return p.vertex != none ? p.vertex : objects_[p.object].vertex;
  }
  /// Returns whether a queue entry with this stamp is still due. If the point is still needed but the ball
  /// around it has become smaller since it was queued, queues it anew with the smaller ball and returns
  /// false.
  bool is_due(Index point, std::uint32_t stamp);
  /// Queues a point again if it is still needed. For use after another point was inserted in its place.
  void queue_again(Index point) {
    if (points_[point].object != none) queue(point);
  }
  /// Returns whether any unresolved point lies in the Voronoi cell of this mesh vertex.
  bool any_at(Index mesh_vertex) const { return objects_.first_at(mesh_vertex) != none; }
  /// Records that a point becomes this vertex, which exists or is inserted next.
  void resolve(Index point, Index vertex);

  /// Returns the unresolved point that a candidate with this zone warps to (paper, Procedure 2). Only points
  /// on features of lower dimension than the candidate's count, and only if their distance from the centre of
  /// the ball to destroy is at most theta times its radius. Returns the nearest one among those of the lowest
  /// dimension; none if there are none.
  Index warp_target(const ConflictZone& zone, const Candidate& candidate) const;
  /// Returns the only unresolved vertex of the complex in the Voronoi cell of this mesh vertex; none if there
  /// are several or none.
  Index only_vertex_at(Index mesh_vertex) const;

  void cells_made(const ConflictZone& zone, Index vertex);

  const LocationObjects& objects() const { return objects_; }
  std::size_t bytes() const { return objects_.bytes() + points_.bytes(); }

 private:
  void queue(Index point);
  double squared_ball(const Unresolved& p) const {
    return squared_distance(p.point, mesh_.point(objects_[p.object].vertex));
  }

  const RefinedMesh& mesh_;
  WorkQueue& queue_;
  double theta_;
  GrowingArray<Unresolved> points_;
  LocationObjects objects_;
  mutable std::vector<Index> adjacent_;  // scratch
};

}  // namespace collarmesh
