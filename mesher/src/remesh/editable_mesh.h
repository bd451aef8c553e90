#pragma once

#include <algorithm>
#include <cassert>
#include <memory>
#include <utility>
#include <vector>

#include "collarmesh/bounds.h"
#include "collarmesh/plc.h"
#include "common/index_set.h"
#include "remesh/cell_bounds.h"
#include "remesh/curve_slides.h"
#include "remesh/smooth_surfaces.h"
#include "remesh/tet_complex.h"

namespace collarmesh::remeshing {

/// A proposed change of the mesh.
struct Change {
  enum class Kind { none, edge_removal, boundary_flip, move, insertion, collapse };
  /// Stands for the vertex that an insertion makes.
  static constexpr Index inserted = none;

  Kind kind = Kind::none;
  double quality = 0;                   ///< quality of the worst new tet
  TetComplex::Replacement replacement;  ///< has only faces if a vertex moves
  std::vector<Index> read;              ///< further tets that were read to propose or refuse a change
  Index vertex = none;                  ///< the vertex that is moved or removed
  Point place{};                        ///< new place of the moved or inserted vertex
  double way = 0;                       ///< arc length by which a vertex on a curve slides
  TetMesh::VertexFeature feature;       ///< feature of the inserted vertex
  /// For a vertex inserted on a curve: the edge that it divides, and the arc length
  /// at which the vertex lies on the curve.
  CurveSlides::Middle middle = {};

  bool is_none() const { return kind == Kind::none; }
};

/// A mesh that changes step by step, with the smooth surfaces and curves that its faces and edges
/// approximate. Coarsening, improvement, adaptation and the replacement of tets work on it: they choose
/// changes by `Operations` under a `ShapeRule` and apply them, for good or in a `Trial`; `store` writes the
/// tets back in the end. Several threads may read it while no change is applied.
class EditableMesh {
 public:
  /// Keeps the mesh and the complex by reference. Curves that turn by half a circle or more keep at least
  /// `edges_per_hole` edges to a full circle. `neighbours` as in TetComplex, `lower_where_forced` as in
  /// Bounds.
  EditableMesh(TetMesh& mesh, const Plc& meant, const SurfaceTolerance& tolerance, double edges_per_hole = 0,
               bool lower_where_forced = true, const KnownNeighbours& neighbours = {})
      : complex(mesh, neighbours),
        surfaces(meant, mesh, tolerance),
        curves(meant, mesh, tolerance, edges_per_hole),
        plc(meant),
        forced(forced_edges_of(meant, mesh, lower_where_forced)),
        kept_(patches_to_keep(meant, mesh)) {}

  /// Takes the surface tolerance from these bounds (tolerance_of_any_size), for callers that do not know the
  /// target edge lengths.
  EditableMesh(TetMesh& mesh, const Plc& meant, const Bounds& bounds, double edges_per_hole = 0,
               const KnownNeighbours& neighbours = {})
      : EditableMesh(mesh, meant, tolerance_of_any_size(meant, bounds), edges_per_hole,
                     bounds.lower_where_forced, neighbours) {}

  /// Writes the tets back to the mesh. Call no other function afterwards.
  void store() { complex.store(); }
  /// Writes the tets back like `store`, and marks the mesh's collars and thin tets by these bounds.
  void store_marked(const Bounds& bounds);

  /// Returns the bounds for the tets of this mesh.
  TetBounds tet_bounds(const Bounds& bounds) const {
    return {ThinShape(plc, complex.mesh(), bounds.thin_angle, bounds.reserve, forced, bounds.tets_across()),
            CellBounds(plc, complex.mesh(), bounds)};
  }

  /// Returns whether the triangles of this patch must stay, as on periodic faces.
  bool keeps(Index patch) const { return !kept_.empty() && patch != none && kept_[patch]; }

  /// Keeps the triangles of further patches from now on: those of each `patch` with `patches[patch]`.
  void keep_triangles_of(const std::vector<bool>& patches) {
    kept_.resize(patches.size(), false);
    for (std::size_t patch = 0; patch < patches.size(); ++patch)
      if (patches[patch]) kept_[patch] = true;
  }

  /// Fixes these vertices at their places.
  void fix(const std::vector<Index>& vertices) {
    for (const Index v : vertices) {
      if (v >= fixed_.size()) fixed_.resize(v + std::size_t{1}, false);
      fixed_[v] = true;
    }
  }
  bool is_fixed(Index vertex) const { return vertex < fixed_.size() && fixed_[vertex]; }

  /// Leaves tets unchanged from now on if all their corners are among these vertices. `vertices`: by vertex.
  void leave(std::vector<bool> vertices) { left_ = std::move(vertices); }
  bool leaves(const TetComplex::Tet& tet) const {
    return !left_.empty() &&
           std::ranges::all_of(tet.corners, [&](Index v) { return v < left_.size() && left_[v]; });
  }

  /// Returns false if the change is a collapse on a curve that is no longer allowed, because other collapses
  /// on this curve have used up its spare edges.
  bool curve_can_spare(const Change& change) const {
    return change.kind != Change::Kind::collapse || complex.mesh().features[change.vertex].dimension != 1 ||
           curves.may_skip(change.vertex);
  }
  /// Returns whether an edge to `onto` could lie in the vertex's curve or patch. Returns true for a vertex
  /// inside a region.
  bool may_share_feature(Index vertex, Index onto) const {
    const auto& [dimension, feature] = complex.mesh().features[vertex];
    const auto& other = complex.mesh().features[onto];
    return dimension == 3 || other.dimension < dimension ||
           (other.dimension == dimension && other.feature == feature);
  }
  /// Returns whether all tets that a change makes are positively oriented, decided exactly. Qualities have
  /// rounding errors, so they mean nothing if the distance of vertices is only 1e-12 of their coordinates.
  bool stays_oriented(const Change& change) const;
  /// Applies a change. Returns the new and the changed tets, valid until the next call. Precondition: nothing
  /// that the change depends on has changed since it was proposed.
  const std::vector<Index>& apply(Change change);

  /// Builds the data that is otherwise built on first use; call it before the first trial.
  void prepare() {
    surfaces.prepare(), curves.prepare();
    prepared_ = true;
  }
  bool is_prepared() const { return prepared_; }

  TetComplex complex;
  SmoothSurfaces surfaces;
  CurveSlides curves;
  const Plc& plc;
  std::shared_ptr<const ForcedEdges> forced;

 private:
  static std::vector<bool> patches_to_keep(const Plc& plc, const TetMesh& mesh);

  std::vector<bool> kept_;          // by patch: whether its triangles stay; empty: none stays
  std::vector<bool> fixed_, left_;  // by vertex; vertices without an entry are neither fixed nor left
  std::vector<Index> changed_;
  bool prepared_ = false;
};

/// Changes of a mesh that are undone as a whole at the end unless they are kept. Precondition: the mesh
/// is prepared and has no other trial.
class Trial {
 public:
  /// Keeps the mesh by reference.
  explicit Trial(EditableMesh& on) : on_(on) {
    assert(on.is_prepared());
    on.complex.begin_trial(), on.surfaces.begin_trial(), on.curves.begin_trial();
  }
  /// Undoes changes that are neither kept nor undone, as after an exception. Undoing may fail for lack of
  /// memory; such a failure is ignored, because the exception ends the work on this mesh.
  ~Trial() {
    try {
      undo();
    } catch (...) {
      open_ = false;
    }
  }
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

  /// Applies a change. Before it does, calls `see(tet)` for each tet that the change removes or moves and
  /// that has not changed in the trial yet. Returns the new and the changed tets, valid until the next call.
  template <class See>
  const std::vector<Index>& apply(Change change, const See& see) {
    std::vector<Index> old = change.replacement.old;
    if (change.kind == Change::Kind::move) on_.complex.star(change.vertex, old);
    for (const Index t : old)
      if (note(t)) see(t);
    const std::vector<Index>& changed = on_.apply(std::move(change));
    for (const Index t : changed) note(t);
    return changed;
  }
  /// Returns the tets of all changes that were made by `apply` of this trial, not by EditableMesh::apply.
  /// Later changes may have removed some of these tets.
  const std::vector<Index>& changed() const { return changed_; }

  void keep() {
    on_.complex.keep(), on_.surfaces.keep(), on_.curves.keep();
    open_ = false;
  }
  void undo() {
    if (std::exchange(open_, false)) on_.complex.undo(), on_.surfaces.undo(), on_.curves.undo();
  }

 private:
  bool note(Index tet) {
    const bool is_new = known_.insert(tet);
    if (is_new) changed_.push_back(tet);
    return is_new;
  }

  EditableMesh& on_;
  bool open_ = true;
  IndexSet known_;
  std::vector<Index> changed_;
};

}  // namespace collarmesh::remeshing
