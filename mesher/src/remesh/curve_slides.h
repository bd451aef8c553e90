#pragma once

#include <array>
#include <cassert>
#include <mutex>
#include <optional>
#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/surface_tolerance.h"
#include "collarmesh/tet_mesh.h"
#include "location/curve_paths.h"
#include "remesh/undo_log.h"

namespace collarmesh::remeshing {

/// The curves of a complex and the mesh edges on them: decides where else on its curve a vertex may lie. A
/// curve and its edges are within the tolerance of each other: corners of the polyline are near their edges,
/// and points of an edge are near its part of the polyline.
class CurveSlides {
 public:
  /// Keeps the complex and the mesh by reference. Several threads may query it at once.
  CurveSlides(const Plc& plc, const TetMesh& mesh, SurfaceTolerance tolerance, double edges_per_hole = 0);

  /// Returns whether this vertex on a curve can move at all.
  bool movable(Index vertex) const;
  /// Returns the point that lies ahead of the vertex on its curve by this arc length.
  Point ahead(Index vertex, double way) const;
  /// Returns whether the vertex may slide by this arc length.
  bool fits(Index vertex, double way) const;
  /// Records that the vertex slid by this arc length.
  void moved(Index vertex, double way) {
    old_places_.note(vertex);
    places_[vertex].parameter += way;
  }
  /// Returns the mesh vertices before and after the vertex. Precondition: it is movable.
  const std::array<Index, 2>& neighbours(Index vertex) const {
    assert(movable(vertex));
    return places_[vertex].neighbours;
  }
  /// Returns whether the curve has an edge to spare, and a single edge could join the vertex's neighbours.
  bool may_skip(Index vertex) const;
  /// Records that a single edge joins the vertex's neighbours.
  void skipped(Index vertex);

  /// The middle of an edge on a curve.
  struct Middle {
    std::array<Index, 2> ends{none, none};  ///< ends of the edge, in the order of the curve
    double parameter = 0;
  };
  /// Returns the middle of this mesh edge, by arc length of the curve; nothing if the edge's place on the
  /// curve is unknown.
  std::optional<Middle> middle(Index curve, Index a, Index b) const;
  /// Returns whether this mesh edge and its part of the curve are within the tolerance of each other. Returns
  /// false if that part is unknown.
  bool edge_is_near(Index curve, Index a, Index b) const;
  Point place(Index curve, const Middle& middle) const { return paths_.point(curve, middle.parameter); }
  /// Records that a new vertex divides an edge at this middle.
  void divided(Index vertex, const Middle& middle);

  /// Finds the places of all vertices now instead of at the first query.
  void prepare() const {
    std::call_once(prepared_, [this] { find_all_places(); });
  }
  /// Begins a trial: later moves and skips can be undone until `keep`.
  void begin_trial() { old_places_.begin(), old_spare_edges_.begin(); }
  void keep() { old_places_.keep(), old_spare_edges_.keep(); }
  void undo() { old_places_.undo(), old_spare_edges_.undo(); }

 private:
  struct Place {
    double parameter = 0;
    std::array<Index, 2> neighbours{none, none};  // mesh vertices before and after it
  };

  void find_all_places() const;
  void find_places(Index curve, std::vector<Index>& vertices, const std::array<Index, 2>& ends) const;
  bool follows(Index curve, Index vertex, Index next) const;
  /// The part of a curve that a mesh edge follows.
  struct Part {
    std::array<Index, 2> ends;  // in the order of the curve
    double from, to;            // arc lengths; `to` may be beyond the seam of a closed curve
  };
  std::optional<Part> part_of_edge(Index curve, Index a, Index b) const;
  double way_to_neighbour(Index vertex, unsigned side) const;
  bool edge_fits(Index curve, double from, double way, const Point& a, const Point& b) const;

  const Plc& plc_;
  const TetMesh& mesh_;
  SurfaceTolerance tolerance_;
  CurvePaths paths_;
  mutable std::once_flag prepared_;
  // By vertex. Computed at the first use for the vertices that exist then; `divided` adds others.
  mutable std::vector<Place> places_;
  std::vector<std::ptrdiff_t> spare_edges_;  // by curve: its number of edges minus the least permitted number
  UndoLog<std::vector<Place>> old_places_{places_};
  UndoLog<std::vector<std::ptrdiff_t>> old_spare_edges_{spare_edges_};
};

}  // namespace collarmesh::remeshing
