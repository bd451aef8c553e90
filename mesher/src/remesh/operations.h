#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "remesh/editable_mesh.h"
#include "remesh/hull_shapes.h"
#include "remesh/shape_rule.h"

namespace collarmesh::remeshing {

/// The local operations. Each writes its proposal into `change` if it keeps every guarantee, and if its worst
/// new tet is better than the worst old tet of its cavity and than the worst new tet of the proposal that
/// `change` holds. The operations' comments name exceptions. Each thread has its own object.
class Operations {
 public:
  /// Keeps references to both arguments.
  Operations(const EditableMesh& edited, const ShapeRule& rule)
      : edited_(edited),
        complex_(edited.complex),
        mesh_(edited.complex.mesh()),
        plc_(edited.plc),
        surfaces_(edited.surfaces),
        curves_(edited.curves),
        rule_(rule) {}

  /// Removes the edge between two corners of a tet by retriangulating its ring as well as possible. For an
  /// edge inside a patch, two other triangles replace the two at the edge; a sliver with both old triangles
  /// goes to the region on their other side. `anyhow_above`: if set, the new tets may be worse than the old
  /// ones, but all must be better than this value.
  void remove_edge(Index tet, unsigned i, unsigned j, Change& change,
                   std::optional<double> anyhow_above = {});
  /// Removes an edge of a tet: the one whose removal leaves the best tets.
  void remove_best_edge(Index tet, Change& change);
  /// Removes an edge of a tet and an edge of a neighbouring tet: fills the space of all tets at these two
  /// edges anew. Helps where removing a single edge leaves inverted tets, as between two prisms of a thin
  /// wall.
  void reconnect(Index tet, Change& change);
  /// Moves a vertex within its feature to a place where the worst tet around it is better.
  void move_vertex(Index vertex, Change& change);
  /// Moves a vertex within its patch to a place opposite another vertex of its tets, if the worst of these
  /// tets becomes better. In thin places long edges need vertices that lie opposite each other.
  void move_to_face(Index vertex, Change& change);
  /// Inserts a vertex on an edge inside a region or a patch, at the best place, if all new tets are better
  /// than `least`.
  void split_edge(Index a, Index b, double least, Change& change);
  /// Inserts a vertex like `split_edge`, even if the old tets at the edge, or the proposal that `change`
  /// holds, are better.
  void split_edge_anyhow(Index a, Index b, double least, Change& change);
  /// Inserts a vertex inside a region. Removes a tet or all tets at one of its edges, then further tets
  /// beside them as long as that makes the worst new tet better, and joins the vertex to the cavity's border.
  /// All new tets must be better than `least` and than `change`, but may be worse than the old tets.
  void insert_in_cavity(Index tet, double least, Change& change);
  /// Inserts a vertex on an edge, however many tets it has, if all new tets are better than `least`, even if
  /// the old tets or those of `change` are better. Inside a region or in a patch, inserts it at this share of
  /// the edge's length or, if that fails, at the best place; on a curve in the middle of the edge.
  void divide_edge(Index a, Index b, double share, double least, Change& change);
  /// The permitted lengths of edges that a collapse makes: at most the cavity's longest edge, or any length.
  enum class Lengths { no_longer, any };
  /// Collapses an edge: moves a vertex along it, within the vertex's feature, onto the other end, so that the
  /// tets at the edge vanish. `anyhow_above`: as for `remove_edge`.
  void collapse_edge(Index vertex, Index onto, Change& change, std::optional<double> anyhow_above = {},
                     Lengths lengths = Lengths::no_longer);
  /// Collapses an edge of a tet: the one whose collapse leaves the best tets.
  void collapse_best_edge(Index tet, Change& change, Lengths lengths = Lengths::no_longer);

  /// Begins queries about collapses of edges at this vertex. `star`: its tets. Returns false if the vertex
  /// has to stay.
  bool begin_collapses(Index vertex, std::span<const Index> star);
  /// Proposes the collapse of the queried vertex onto `onto`, under other conditions: all new tets are better
  /// than `least`; they are at least as good as `enough` or as the worst tet of the cavity. New edges may
  /// have any length, and `change` may hold a better proposal.
  void collapse_onto(Index onto, double least, double enough, Change& change);
  /// Returns the quality of the worst tet at the queried vertex.
  double worst_at_vertex() { return worst_at_vertex(vertex_); }

 private:
  /// Largest number of tets around an edge: operations at edges with more tets hardly ever help.
  static constexpr std::size_t largest_ring = 9;

  static constexpr std::size_t all_passed = SIZE_MAX;

  using Polygon = std::vector<Index>;
  /// The directions in which a vertex may be moved, and the patch that it has to stay on, if any.
  struct Freedom {
    std::array<Vector, 3> directions;
    unsigned count;
    Index patch;  ///< the patch, planar or smooth, or none
  };
  static constexpr Freedom everywhere{{Vector{1, 0, 0}, Vector{0, 1, 0}, Vector{0, 0, 1}}, 3, none};
  /// A cavity to be filled from an apex, which is a vertex of the mesh or one to be inserted: each new tet
  /// joins the apex to a triangle of the cavity's hull, each new mesh face joins it to an edge of the rim.
  struct Cone {
    std::vector<Index> tets;
    double worst = INFINITY;                 ///< worst quality of `tets`; infinite if not known yet
    std::vector<std::array<Index, 3>> hull;  ///< faces that make positive tets with the apex
    std::vector<Index> hull_tet;             ///< the tet behind each face of the hull
    HullShapes shapes;                       ///< shapes of the hull's faces; empty if not known yet
    std::size_t decisive = 0;                ///< the pair of faces that ruled out the last apex
    std::vector<Index> faces;
    double agreement = NAN;                 ///< agreement of the faces with their patches; NaN if not known
                                            ///< yet
    std::vector<std::array<Index, 2>> rim;  ///< edges that make faces with the apex
    std::vector<Index> rim_face;

    void clear() {
      tets.clear(), hull.clear(), hull_tet.clear(), faces.clear(), rim.clear(), rim_face.clear();
      shapes.clear(), decisive = 0;
      worst = INFINITY;
      agreement = NAN;
    }
  };

  double new_quality(const std::array<Index, 4>& corners, double above) const;

  // Edge removal:
  double triangulate(Index a, Index b, const Polygon& polygon, bool closed, double above);
  bool edges_allowed(Index vertex, const Point& from, const Point& to) const;
  void collect(Index a, Index b, const Polygon& polygon, std::size_t i, std::size_t j, Index like,
               Change& change) const;
  bool flat(Index a, Index b, Index c, Index d) const;
  bool may_turn(Change& change);
  bool may_lose(Index tet, Index a, Index b) const;

  // Reconnection:
  void refill(const std::vector<Index>& cavity, Change& change);

  // Cones:
  bool find_cone_of_vertex(Index vertex);
  bool make_cone_of_vertex(Index vertex);
  void grow_and_insert(std::vector<Index> cavity, double least, Change& change);
  bool find_cone_of_cavity(const std::vector<Index>& cavity);
  Point centre_of_hull() const;
  Index beyond_worst_of_hull(const Point& apex) const;
  bool find_cone_of_edge(Index a, Index b);
  bool make_cone_of_edge(Index a, Index b);
  bool faces_are_of_one_patch() const;
  bool find_whole_ring(Index a, Index b);
  void divide_curve_edge(Index a, Index b, double least, Change& change);
  void insert_in_cone(Index a, Index b, double least, Change& change);
  void add_to_rim(Index face, Index apex);
  double quality_around(const Point& apex, Index id, double above);
  double worst_of_cone();
  double worst_at_vertex(Index vertex);
  template <class Passes>
  std::size_t for_each_shape(const Point& apex, std::size_t first_pair, const Passes& passes);
  double quality_by_angles(const AngleRule& rule, const Point& apex, Index id, double above);
  double quality_by_tets(const Point& apex, Index id, double above);
  Corners with_apex(const Point& apex, const std::array<Index, 4>& corners) const;
  bool may_be_made(const Point& apex, const std::array<Index, 4>& corners, double quality) const;
  bool surfaces_allow(const Point& apex, Index id);
  Freedom on_patch(Index patch, const Point& p);
  std::optional<Freedom> freedom(Index vertex);
  Point back_on_feature(const Point& p, const Point& from, const Freedom& freedom);
  std::pair<Point, double> best_place(const Point& start, Index id, const Freedom& freedom, double best);
  std::pair<double, double> best_way(Index vertex, double best);
  std::vector<Point> facing_places(Index vertex, const Freedom& where);
  void fill_move(Index vertex, const Point& place, double quality, Change& change);
  bool may_collapse(Index vertex, Index onto);
  bool keeps_topology(Index vertex, Index onto);
  bool keeps_lengths(Index vertex, Index onto) const;
  void fill(Index apex, Change& change) const;
  void fill_insertion(const Point& place, double quality, const TetMesh::VertexFeature& feature,
                      Change& change) const;
  void fill_collapse(Index vertex, Index onto, double quality, Change& change) const;

  bool untouchable(const TetComplex::Tet& tet) const {
    return (tet.collar && !rule_.dissolves_collars()) || edited_.leaves(tet);
  }
  double quality(Index tet) const { return rule_.quality(complex_.corners(tet), complex_[tet].corners); }

  Index patch_of_cone() const { return cone_.faces.empty() ? none : mesh_.face_patch[cone_.faces[0]]; }
  static Index inserted_in(Index patch) { return patch == none ? none : inserted_on_surface; }
  static TetMesh::VertexFeature inside(Index patch) {
    return patch == none ? TetMesh::VertexFeature{} : TetMesh::VertexFeature{2, patch};
  }
  bool is_there(Index vertex) const { return vertex < mesh_.points.size(); }

  /// Returns whether the triangle belongs to a patch whose faces stay as they are.
  bool stays(Index face) const { return edited_.keeps(mesh_.face_patch[face]); }

  const EditableMesh& edited_;
  const TetComplex& complex_;
  const TetMesh& mesh_;
  const Plc& plc_;
  const SmoothSurfaces& surfaces_;
  const CurveSlides& curves_;
  const ShapeRule& rule_;
  TetComplex::Ring ring_;
  Cone cone_;
  Index vertex_ = none;  // the vertex of the current queries about collapses
  bool ask_surfaces_ = true;
  std::vector<Index> star_;
  std::vector<SmoothSurfaces::Face> faces_;  // faces that would be created
  std::vector<double> best_;                 // by vertices i and j: best quality of the polygon's part
                                             // between them
  std::vector<std::size_t> apex_;            // the third vertex of the triangle on ij in that part
};

}  // namespace collarmesh::remeshing
