#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"
#include "improve/curve_slides.h"
#include "improve/smooth_surfaces.h"
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
  Operations(TetComplex& complex, const Plc& plc, double radius_edge, double distance)
      : complex_(complex),
        plc_(plc),
        surfaces_(plc, complex.mesh(), distance),
        curves_(plc, complex.mesh(), distance),
        squared_radius_edge_(radius_edge * radius_edge) {}

  double quality(Index tet) const;
  /// Remove the edge between two corners of a tet: its ring is triangulated anew, as well as possible.
  /// An edge inside a patch is removed together with its two triangles there, and a sliver that has both
  /// of them goes to the other side.
  void remove_edge(Index tet, unsigned i, unsigned j, Change& change);
  /// Move a vertex within its feature to where the worst tet around it is better. False when it stays.
  bool move_vertex(Index vertex);
  /// Insert a vertex amid an edge inside a region and move it to where it serves best. False, and
  /// nothing has changed, when the worst tet around it would not be better than the worst one around the
  /// edge and than `least`.
  bool split_edge(Index a, Index b, double least);
  /// The change has been made.
  void made(const Change& change);
  /// The tets around the vertex that was moved or inserted last.
  const std::vector<Index>& star() const { return star_; }

 private:
  using Polygon = std::vector<Index>;
  /// The directions a vertex may be moved in, and the patch it has to stay on, if any.
  struct Freedom {
    std::array<Vector, 3> directions;
    unsigned count;
    Index patch;  ///< planar or smooth
  };
  static constexpr Freedom everywhere{{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}}, 3, none};

  double new_quality(const std::array<Index, 4>& corners, double above) const;
  std::optional<Freedom> freedom(Index vertex);
  double quality_around(const Point& at, double above) const;
  std::pair<Point, double> best_place(const Point& start, Index vertex, const Freedom& freedom, double best);
  std::pair<double, double> best_way(Index vertex, double best);
  Point back_on_feature(const Point& p, const Point& from, const Freedom& freedom);
  void find_faces(Index vertex);
  bool surfaces_allow(Index vertex, const Point& at);
  double triangulate(Index a, Index b, const Polygon& polygon, double above);
  void collect(Index a, Index b, const Polygon& polygon, std::size_t i, std::size_t j, Index like,
               Change& change) const;
  bool flat(Index a, Index b, Index c, Index d) const;
  bool may_turn(const std::vector<TetComplex::Face>& turned);
  bool may_lose(Index tet, Index a, Index b) const;

  TetComplex& complex_;
  const Plc& plc_;
  SmoothSurfaces surfaces_;
  CurveSlides curves_;
  double squared_radius_edge_;
  TetComplex::Ring ring_;
  std::vector<Index> star_;
  std::vector<std::array<Index, 3>> around_;  // faces that make positive tets with the vertex at hand
  std::vector<Index> faces_;                  // of smooth patches, at the vertex at hand
  std::vector<SmoothSurfaces::Triangle> triangles_;
  std::vector<double> best_;       // of the polygon's parts from vertex i to j
  std::vector<std::size_t> apex_;  // the third vertex of the triangle on ij there
};

}  // namespace collarmesh::improvement
