#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "collarmesh/plc.h"
#include "improve/curve_slides.h"
#include "improve/smooth_surfaces.h"
#include "improve/tet_complex.h"

namespace collarmesh::improvement {

/// What an operation would do. All new tets are better than the worst of those they replace.
struct Change {
  enum class Kind { none, edge_removal, boundary_flip, move, insertion, contraction };
  Kind kind = Kind::none;
  double quality = 0;  ///< of the worst new tet
  TetComplex::Replacement replacement;
  Index vertex = none;  ///< that is moved, or that the edge from it to `onto` takes along
  Index onto = none;
  Point place{};                   ///< of the moved or inserted vertex
  double way = 0;                  ///< that a vertex on a curve slides
  TetMesh::VertexFeature feature;  ///< of the inserted vertex
};

/// The local operations. Each proposes what it would do when that raises the smallest quality in its
/// cavity and that of `change` and keeps every guarantee; else `change` stays as it is.
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
  /// Move a vertex within its feature to where the worst tet around it is better.
  void move_vertex(Index vertex, Change& change);
  /// Insert a vertex amid an edge inside a region or a patch, where it serves best, when the tets around it
  /// are all better than `least`.
  void split_edge(Index a, Index b, double least, Change& change);
  /// Move a vertex along an edge within its feature onto the other end, so that the tets at the edge vanish.
  /// No edge becomes longer than the longest one of the cavity.
  void contract_edge(Index vertex, Index onto, Change& change);

  /// Do it. Returns the tets that are new or have changed, until the next call.
  const std::vector<Index>& apply(const Change& change);

 private:
  using Polygon = std::vector<Index>;
  /// The directions a vertex may be moved in, and the patch it has to stay on, if any.
  struct Freedom {
    std::array<Vector, 3> directions;
    unsigned count;
    Index patch;  ///< planar or smooth
  };
  static constexpr Freedom everywhere{{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}}, 3, none};
  /// A cavity whose tets, and the mesh' faces in it, are cones that share an apex: a vertex that is there
  /// or would be.
  struct Cone {
    std::vector<Index> tets;
    double worst = INFINITY;                 ///< of their qualities
    std::vector<std::array<Index, 3>> hull;  ///< make positive tets with the apex
    std::vector<Index> hull_tet;             ///< where each of these comes from
    std::vector<Index> faces;
    std::vector<std::array<Index, 2>> rim;  ///< make faces with the apex
    std::vector<Index> rim_face;
  };

  double new_quality(const std::array<Index, 4>& corners, double above) const;

  // Edge removal.
  double triangulate(Index a, Index b, const Polygon& polygon, double above);
  void collect(Index a, Index b, const Polygon& polygon, std::size_t i, std::size_t j, Index like,
               Change& change) const;
  bool flat(Index a, Index b, Index c, Index d) const;
  bool may_turn(const Change& change);
  bool may_lose(Index tet, Index a, Index b) const;

  // Cones.
  bool find_cone_of_vertex(Index vertex);
  bool find_cone_of_edge(Index a, Index b);
  void add_to_rim(Index face, Index apex);
  double quality_around(const Point& apex, double above) const;
  bool surfaces_allow(const Point& apex);
  Freedom on_patch(Index patch, const Point& p);
  std::optional<Freedom> freedom(Index vertex);
  Point back_on_feature(const Point& p, const Point& from, const Freedom& freedom);
  std::pair<Point, double> best_place(const Point& start, const Freedom& freedom, double best);
  std::pair<double, double> best_way(Index vertex, double best);
  bool may_contract(Index vertex, Index onto);
  bool keeps_topology(Index vertex, Index onto);
  bool keeps_lengths(Index vertex, Index onto) const;
  void fill(const Cone& cone, Index apex, Change& change) const;

  TetComplex& complex_;
  const Plc& plc_;
  SmoothSurfaces surfaces_;
  CurveSlides curves_;
  double squared_radius_edge_;
  TetComplex::Ring ring_;
  Cone cone_;
  bool ask_surfaces_ = true;
  std::vector<Index> star_, joined_;
  std::vector<SmoothSurfaces::Face> faces_;  // that would be created
  std::vector<Index> changed_;
  std::vector<double> best_;       // of the polygon's parts from vertex i to j
  std::vector<std::size_t> apex_;  // the third vertex of the triangle on ij there
};

}  // namespace collarmesh::improvement
