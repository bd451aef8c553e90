#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "collarmesh/surface_tolerance.h"
#include "collarmesh/tet_mesh.h"
#include "location/triangle_hierarchy.h"

namespace collarmesh::constrained {

/// A place on the axis of a rod, and a frame there.
struct RodSection {
  Point centre;
  Vector along, across;
  double radius = 0, tolerance = 0;
  double spacing = 0;  ///< the largest distance between neighbouring rings here
  double rings = 0;    ///< the number of rings from the first section to this one, not rounded

  /// Returns the direction at an angle from `across`, around the axis.
  Vector turned(double angle) const;
};

/// A planar end of a rod.
struct RodEnd {
  Index patch, curve;
  Point centre;
  Vector outward;
};

/// A thin body of round section that one smooth patch and two planar ends bound, or one smooth patch alone:
/// its axis, and the rings of vertices around it.
class Rod {
 public:
  /// Keeps references to the complex, the tolerance and the execution.
  Rod(const Plc& plc, const SurfaceTolerance& tolerance, double size, const Execution& execution,
      Index region, const std::vector<Index>& patches);

  /// Returns whether the body may be a rod, judged by its patches, volume and area.
  bool begin() {
    return patch_ != none && (planar_.empty() || planar_.size() == 2) && find_ends() && !is_thick();
  }
  /// Finds the axis. Returns whether the body is a rod.
  bool find_axis();
  /// Finds how many vertices each ring has. Returns whether rings can keep the tolerance.
  bool find_vertices_around();
  /// Changes the number of vertices in a ring. Returns whether it is not too large.
  bool set_in_ring(std::size_t vertices);
  /// Finds how far apart rings are: at most `most_radii` radii, and so near that edges along a bent rod cut
  /// it by at most `share_along` of the tolerance. The number of steps from ring to ring is a multiple of
  /// `times`. Call it after `find_vertices_around`.
  void find_spacing(double most_radii = INFINITY, double share_along = 0.1, std::size_t times = 1);
  /// Finds the vertices of all rings. `parts_of_turn`: a pattern around the rod looks the same after each of
  /// this many parts of a turn (0: as many parts as a ring has vertices). The rings of a closed rod are
  /// turned so that the pattern fits where the rod closes. Returns whether all vertices were found, including
  /// those of the complex at the ends.
  bool find_rings(std::size_t parts_of_turn);

  /// Returns whether the faces between rings and the patch are within the tolerance of each other.
  bool faces_keep_tolerance() const;

  /// Returns the fewest vertices that a rod of this length takes. Call it after `begin`.
  std::size_t fewest_vertices() const;
  /// Returns the number of vertices. Call it after `find_spacing`.
  std::size_t vertices() const {
    return is_loop() ? steps_ * (in_ring_ + 1) : steps_ * (in_ring_ + 1) + in_ring_ + 2;
  }

  Index region() const { return region_; }
  Index patch_index() const { return patch_; }
  const Plc& plc() const { return plc_; }
  const std::vector<RodEnd>& ends() const { return ends_; }
  bool is_loop() const { return ends_.empty(); }
  /// Returns the mean radius.
  double radius() const { return radius_; }
  /// Returns the length, as estimated from the surface.
  double length() const { return length_; }
  /// Returns the largest curvature of the axis. Call it after `find_axis`.
  double largest_bend() const;

  std::size_t in_ring() const { return in_ring_; }
  /// Returns the number of steps from ring to ring.
  std::size_t steps() const { return steps_; }
  /// Returns the rings' vertices; a closed rod does not repeat the first ring.
  const std::vector<std::vector<Point>>& rings() const { return rings_; }
  /// Returns the points on the axis in the middle between neighbouring rings.
  const std::vector<Point>& axis() const { return axis_; }
  /// Returns by how many of the parts of a turn (see `find_rings`) the first ring of a closed rod lags behind
  /// the ring that would follow the last one.
  std::size_t shift() const { return shift_; }
  /// Returns the section at a share of the rings (0: the first ring, 1: the last one). Turns its frame so
  /// that a ring there has its first vertex in the direction `across`.
  RodSection frame_at(double share) const;
  TetMesh::VertexFeature feature_of(std::size_t ring, const Point& point) const;

 private:
  struct Hit {
    Point at;
    Index triangle = none;
    double distance = INFINITY;
  };

  const Plc::Patch& patch() const { return plc_.patches[patch_]; }
  bool have_vertices() const;
  bool find_ends();
  bool is_thick();
  Hit hit(const Point& from, const Vector& way) const;
  bool measure(RodSection& section) const;
  bool find_sections();
  Vector direction_after(std::size_t last) const;
  bool begin_at_end(RodSection& first) const;
  RodSection section_at_end(std::size_t end) const;
  bool finish_at_end();
  bool begin_loop(RodSection& first) const;
  void aim_at_corner(RodSection& section) const;
  bool finish_loop();
  bool set_directions();
  double bend_after(std::size_t section) const;
  bool is_bent() const;
  bool chords_keep_tolerance() const;
  RodSection at_share(double share) const;
  void find_turn(std::size_t parts_of_turn);
  Hit on_curve(const RodEnd& end, const RodSection& section, const Vector& way) const;

  const Plc& plc_;
  const SurfaceTolerance& tolerance_;
  const Execution& execution_;
  double size_, radius_ = 0, length_ = 0;
  Index region_, patch_ = none;
  std::vector<Index> planar_;
  std::vector<RodEnd> ends_;
  double reach_ = 0;  // length of rays
  std::unique_ptr<TriangleHierarchy> hierarchy_;
  mutable std::vector<TriangleHierarchy::Crossing> crossings_;
  std::vector<RodSection> sections_;
  Vector aim_;  // direction from the axis to the complex's vertex at the second end
  std::size_t in_ring_ = 0, steps_ = 0, shift_ = 0, parts_of_turn_ = 1;
  double turn_ = 0;  // the angle by which frames are turned over the whole length, radians
  std::vector<std::vector<Point>> rings_;
  std::vector<Point> axis_;
};

}  // namespace collarmesh::constrained
