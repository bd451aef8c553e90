#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"
#include "improve/tet_complex.h"

namespace collarmesh::improvement {

/// Tets that may take the place of others, all better than the worst of these.
struct Change {
  enum class Kind { none, edge_removal, boundary_flip };
  Kind kind = Kind::none;
  double quality = 0;  ///< of the worst new tet
  std::vector<Index> old;
  std::vector<TetComplex::NewTet> created;
  std::vector<TetComplex::Face> kept;
};

/// The local operations. Each proposes what it would do, or nothing when that would not raise the
/// smallest quality in its cavity above `change.quality` or would break a guarantee.
class Operations {
 public:
  Operations(TetComplex& complex, const Plc& plc, double radius_edge)
      : complex_(complex), plc_(plc), squared_radius_edge_(radius_edge * radius_edge) {}

  double quality(Index tet) const;
  /// Remove the edge between two corners of a tet: its ring is triangulated anew, as well as possible.
  /// An edge inside a planar patch is removed together with its two triangles there.
  void remove_edge(Index tet, unsigned i, unsigned j, Change& change);
  /// Move a vertex within its feature to where the worst tet around it is better. False when it stays.
  bool move_vertex(Index vertex);
  /// Insert a vertex amid an edge inside a region and move it to where it serves best. False, and
  /// nothing has changed, when the worst tet around it would not be better than the worst one around the
  /// edge and than `least`.
  bool split_edge(Index a, Index b, double least);
  /// The tets around the vertex that was moved or inserted last.
  const std::vector<Index>& star() const { return star_; }

 private:
  using Polygon = std::vector<Index>;
  /// The directions a vertex may be moved in, and the plane it has to stay in, if any.
  struct Freedom {
    std::array<Vector, 3> directions;
    unsigned count;
    const Plc::Patch* plane;
  };
  static constexpr Freedom everywhere{{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}}, 3, nullptr};

  double new_quality(const std::array<Index, 4>& corners, double above) const;
  std::optional<Freedom> freedom(Index vertex) const;
  double quality_around(const Point& at, double above) const;
  std::pair<Point, double> best_place(const Point& start, const Freedom& freedom, double best) const;
  double triangulate(Index a, Index b, const Polygon& polygon, double above);
  void collect(Index a, Index b, const Polygon& polygon, std::size_t i, std::size_t j, Index like,
               Change& change) const;
  bool flat(Index a, Index b, Index c, Index d) const;

  TetComplex& complex_;
  const Plc& plc_;
  double squared_radius_edge_;
  TetComplex::Ring ring_;
  std::vector<Index> star_;
  std::vector<std::array<Index, 3>> around_;  // faces that make positive tets with the vertex at hand
  std::vector<double> best_;                  // of the polygon's parts from vertex i to j
  std::vector<std::size_t> apex_;             // the third vertex of the triangle on ij there
};

}  // namespace collarmesh::improvement
