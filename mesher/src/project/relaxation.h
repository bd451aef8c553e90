#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "collarmesh/exact_geometry.h"
#include "collarmesh/tet_mesh.h"
#include "common/cells_at_vertices.h"
#include "remesh/cell_bounds.h"
#include "remesh/change_times.h"
#include "remesh/thin_shape.h"

namespace collarmesh::projection {

struct Bounds {
  double radius_edge, collar_angle;              ///< as in collarmesh::Bounds
  const remeshing::ThinShape* thin = nullptr;    ///< null: no tet is thin
  const remeshing::CellBounds* cells = nullptr;  ///< set if tets may be thin
  /// Largest distance of faces and edges from the exact geometry, by patch and by curve, absolute.
  std::vector<double> patch_sag, curve_sag;
};

/// A relaxation of the tets that became invalid when vertices were placed: it moves their other corners,
/// inside regions or along exact features, until the tets are within their bounds again. Changes since the
/// last `commit` can be undone.
class Relaxation {
 public:
  /// Keeps a reference to the mesh. A tet that misses a bound at the beginning may still miss it, but not by
  /// more.
  Relaxation(TetMesh& mesh, const ExactGeometry& exact, const Bounds& bounds);

  const CellsAtVertices& tets_at() const { return tets_at_; }
  /// Returns the initial place of the vertex.
  const Point& origin(Index vertex) const { return origins_[vertex]; }
  remeshing::Corners corners_of(Index tet) const { return corners(tet, mesh_.points); }
  /// Returns the initial corners of the tet.
  remeshing::Corners origins_of(Index tet) const { return corners(tet, origins_); }
  /// Returns the initial shortest edge at the vertex.
  double shortest_edge(Index vertex) const;
  /// Returns whether the tet has positive volume and misses no bound by more than at the beginning.
  bool good(Index tet) const;

  /// Returns whether a mesh edge of a curve is on course, see `projection::on_course`.
  bool on_course(Index edge) const;
  /// Returns whether all mesh edges of curves at the vertex are on course.
  bool keeps_course(Index vertex);

  void put(Index vertex, const Point& place);
  /// Sets whether `relax` may move a vertex. By default only vertices inside regions may move.
  void set_free(Index vertex, bool is_free) { free_[vertex] = is_free; }

  /// Moves vertices of spoilt tets sweep by sweep, each to a place where the penalties of the tets around it
  /// have a smaller sum. Returns the tets that still miss a bound, among `tets` and all tets around moved
  /// vertices.
  std::vector<Index> relax(std::vector<Index> tets);

  void commit();
  void roll_back();
  /// Return the number of commits so far, and whether commits after the first `since` ones changed a tet at
  /// the vertex.
  std::uint32_t commits() const { return commits_.now(); }
  bool changed_around(Index vertex, std::uint32_t since) const {
    return any_around_after(commits_, since, vertex);
  }

 private:
  using Corners = std::array<Point, 4>;

  /// The values that a tet must reach: its bounds, or its initial values where these are poorer.
  struct Wanted {
    double shape = -1;  // negative until computed
    double ratio = 0;
    double angle = 0;   // bound on its dihedral angles in a collar
    bool thin = false;  // whether its angles are bounded instead of its ratio
  };

  const Wanted& wanted(Index tet) const;
  Corners corners(Index tet, const std::vector<Point>& points) const;
  bool is_thin(Index tet, const Corners& p) const {
    return bounds_.thin != nullptr && bounds_.thin->contains(p, mesh_.tets[tet]) && may_be_thin(tet, p);
  }
  bool may_be_thin(Index tet, const Corners& p) const {
    return !bounds_.cells->forbid_thin_tets() || bounds_.cells->allow(p, mesh_.tets[tet]);
  }
  // Returns whether the tet is in a collar that was not coarsened: then only its obtuse angles are bounded.
  bool in_ball(Index tet) const { return mesh_.tet_collar[tet] != 0 && !mesh_.collar_balls.empty(); }
  double collar_score(Index tet, const Corners& p) const;
  double score(Index tet, const Corners& p) const;
  double angle_score(Index tet, const Corners& p) const;
  double penalty_of(Index tet, const Corners& p) const;
  double penalty_around(std::span<const Index> tets, Index vertex, const Point& place, double below) const;
  bool improve(Index vertex);
  bool in_vain(Index vertex) const;
  bool any_around_after(const remeshing::ChangeTimes& times, std::uint32_t time, Index vertex) const;
  std::optional<Point> on_feature(Index vertex, const Point& wish) const;
  bool fits_features(Index vertex, const Point& place);
  void find_features_around();
  double sag_around(Index vertex) const;

  TetMesh& mesh_;
  const ExactGeometry& exact_;
  Bounds bounds_;
  CellsAtVertices tets_at_, faces_at_, edges_at_;
  std::vector<Point> origins_;
  std::vector<bool> free_;
  mutable std::vector<Wanted> wanted_;  // by tet
  remeshing::ChangeTimes commits_;      // by number of commits
  remeshing::ChangeTimes moves_;        // by number of moves
  std::vector<std::uint32_t> stuck_;  // by vertex: number of moves at the last search without a better place
  std::vector<std::pair<double, Index>> worst_first_;
  std::vector<Index> around_;
  std::vector<std::pair<Index, Point>> log_;  // vertices and their previous places, in order
};

}  // namespace collarmesh::projection
