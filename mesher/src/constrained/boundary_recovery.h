#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"
#include "constrained/local_changes.h"
#include "constrained/tetrahedra.h"

namespace collarmesh::constrained {

/// A triangle that has to become a face of the mesh.
struct Facet {
  std::array<Index, 3> corners;
  Index patch;
  bool alive = true;  ///< false: divided into other facets, which replace it
};

/// A way to recover features. Rounded points may make the recovery fail in one way but not in another.
struct RecoveryWay {
  bool turns_first = false;  ///< flip a missing edge between coplanar facets, if possible, before dividing it
  bool reversed = false;     ///< recover the edges in the reverse order
};

/// A recovery, which changes a mesh until it has the edges and triangles of a complex: by local changes of
/// the tetrahedra that obstruct them and, if no change helps, by inserting a point at a crossing.
/// Edges come first. Features do not cross, so a triangle whose edges exist can only be obstructed by edges
/// that pass through its interior. Each change or point leaves fewer obstacles, so the process ends.
class BoundaryRecovery {
 public:
  /// Keeps references to the mesh and the complex. Precondition: the mesh's first points are those of the
  /// complex.
  BoundaryRecovery(Tetrahedra& mesh, const Plc& plc, RecoveryWay way = {});

  /// Recovers all features. Returns false if `go_on` returned false. Throws PlcError, with the place, if
  /// rounded points make recovery impossible.
  bool run(const std::function<bool()>& go_on);

  const std::vector<Facet>& facets() const { return facets_; }
  /// Calls `visit` with the ends and the curve of each edge on a curve.
  template <class Visit>
  void for_each_curve_edge(const Visit& visit) const {
    for (const auto& [key, edge] : edges_)
      if (edge.curve != none) visit(static_cast<Index>(key >> 32U), static_cast<Index>(key), edge.curve);
  }
  /// Returns the number of points that were added.
  std::size_t added_points() const { return added_; }

 private:
  struct RequiredEdge {
    Index curve = none;
    std::vector<Index> facets;
  };
  struct CrossedFace {
    Tetrahedra::Face face;
    Tetrahedra::Corners corners;  // corners of its tetrahedron
    double place;                 // position on the edge, from 0 at the first end to 1 at the other
  };
  using Ends = std::array<Index, 2>;
  /// An edge that is still missing, and the depth to which other edges are removed for it.
  struct EdgeToDo {
    Index a, b;
    unsigned depth;
  };

  RequiredEdge& require(Index a, Index b);
  void make_planar_facets_delaunay();
  bool turn_edge(std::uint64_t key, double least_angles, std::vector<std::uint64_t>& changed);
  bool turn_once(Index a, Index b);
  void add_facet(const std::array<Index, 3>& corners, Index patch);
  void remove_facet(Index facet);
  void divide_required(Index a, Index b, Index x);
  void recover_edge(const EdgeToDo& edge);
  Index find_crossed(Index a, Index b, std::vector<CrossedFace>& crossed) const;
  bool clear_edge(const std::vector<CrossedFace>& crossed, const Obstacles& obstacles, unsigned depth);
  Index divide_at_crossing(Index a, Index b, std::vector<CrossedFace>& crossed);
  std::array<std::pair<double, Index>, 2> places_beside(const CrossedFace& face,
                                                        const std::vector<CrossedFace>& crossed) const;
  bool add_room(const std::vector<CrossedFace>& crossed);
  Vector across(const CrossedFace& c) const;
  void recover_facet(Index facet);
  std::vector<Ends> find_piercing(const Facet& facet, const Obstacles& obstacles) const;
  void divide_facet(Index facet, const std::vector<Ends>& piercing);
  bool reduce(const std::function<std::optional<int>()>& change);
  [[noreturn]] void fail(Index at, const char* what) const;

  Tetrahedra& mesh_;
  const Plc& plc_;
  RecoveryWay way_;
  std::unordered_set<std::uint64_t> required_;
  LocalChanges changes_;
  std::unordered_map<std::uint64_t, RequiredEdge> edges_;
  std::vector<Facet> facets_;
  std::deque<EdgeToDo> edges_to_do_;
  std::deque<Index> facets_to_do_;
  std::unordered_set<std::uint64_t> turned_;  // edges that `turn_once` has tried to flip
  std::size_t added_ = 0, most_added_;
};

}  // namespace collarmesh::constrained
