#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "constrained/sheathed_rods.h"
#include "pipeline/constrained_start.h"
#include "pipeline/mesh_job.h"
#include "pipeline/refinement.h"

namespace collarmesh::pipeline {

/// A maker of meshes of one complex after another, with given seeds. If a refinement makes far too many tets,
/// the maker starts again, from constrained tetrahedra.
class MeshMaker {
 public:
  /// The edge lengths permitted in a mesh made from constrained tetrahedra: any, or only about the target
  /// lengths, as in a refined mesh.
  enum class Lengths { any, kept };

  /// Keeps a reference to the job. `source` makes the complexes; null if there is only one.
  MeshMaker(MeshJob& job, ComplexSource* source) : job_(job), source_(source) {}

  /// Forgets everything about the previous complex.
  void take_new_complex();
  /// Tells the job that the complex that the source built last is now at the address of `plc`.
  void move_to(const Plc& plc);

  /// Takes a complex through all stages. Throws Ended, PlcError and, with Fineness::as_asked, FarTooFine.
  /// Throws Hopeless if it starts from constrained tetrahedra that must yield a good mesh (Hope::good), but
  /// many tets miss their bounds.
  void make(const Plc& plc, std::uint64_t seed);

  /// Meshes a complex when other ways have failed. Uses constrained tetrahedra if they keep every guarantee.
  /// Otherwise refines, if more vertices are allowed than `tried`, the number at which a refinement of this
  /// complex ended before. If that makes no mesh, or one that misses far more guarantees (misses_far_less),
  /// uses constrained tetrahedra that keep all guarantees except those on shapes. `why`: the reason that a
  /// note gives for constrained tetrahedra.
  void make_anyhow(const Plc& plc, const std::string& why, std::size_t tried);

  /// Meshes a complex from its constrained tetrahedra. Returns nothing if there are none, if the options ask
  /// for another start, if the mesh misses guarantees other than bounds on shapes or, with Hope::good, if
  /// many tets miss these bounds. Does not change the mesh that the job keeps.
  std::optional<PipelineResult> from_constrained(const Plc& plc, const std::string& why, Hope hope);

  /// If few tets of a mesh made from constrained tetrahedra miss the bounds on their shapes, and nothing else
  /// is missed, makes it again with further seeds. Keeps the mesh with the fewest findings.
  void try_seeds_of_constrained(const Plc& plc);

  /// Makes a mesh from the constrained tetrahedra. Uses it if it keeps every guarantee and the permitted
  /// lengths. Returns whether it is used. After a failure, does not try the same complex again.
  bool take_constrained(const Plc& plc, const std::string& why, Lengths lengths = Lengths::any);

  /// Removes and returns the last mesh of this complex that `take_constrained` did not use although few tets
  /// miss bounds on shapes and nothing else is missed, if there is one.
  std::optional<PipelineResult> take_nearly_good() { return std::exchange(nearly_good_, std::nullopt); }
  /// Returns the number of vertices of the last mesh made from constrained tetrahedra of this complex, even
  /// if that mesh was given up; 0: there is none.
  std::size_t constrained_vertices() const { return constrained_vertices_; }
  /// Uses a mesh made from constrained tetrahedra of the job's current complex.
  void use_constrained(PipelineResult constrained);

  /// Makes sure that the constrained tetrahedra of this complex are not tried unless all else fails.
  void give_up_constrained(const Plc& plc) { hopeless_ = &plc; }
  bool has_given_up_constrained(const Plc& plc) const { return hopeless_ == &plc; }

  /// Returns whether the last mesh was refined to many times the predicted number of tets, and coarsened.
  bool was_far_too_fine() const { return was_far_too_fine_; }

  /// Returns whether the kept mesh started from constrained tetrahedra. Callers that restore an earlier mesh
  /// must set this again.
  bool is_constrained() const { return is_constrained_; }
  void set_constrained(bool constrained) { is_constrained_ = constrained; }

  /// Returns whether the kept mesh was refined, so that another seed changes it. Further seeds of constrained
  /// tetrahedra have been tried already.
  bool depends_on_seed() const { return !is_constrained_ && job_.start != Start::constrained; }

  /// Makes the kept mesh again, with the present tolerance: by `take_constrained` if that made it, else by
  /// `make` with this seed. Throws as `make` does, and Hopeless if `take_constrained` does not use the mesh.
  void make_again(const Plc& plc, std::uint64_t seed);
  /// Returns whether `take_constrained` made the kept mesh.
  bool prefers_constrained() const { return constrained_.has_value(); }

  /// Multiplies the surface tolerance of first order by this share in further meshes of this complex.
  void come_nearer(const Plc& plc, double share);
  /// Multiplies the tolerance on each smooth patch by the patch's share. But if a side of a wall has a share
  /// below 1 and the tolerances of the two sides differ, gives both sides the smaller of these tolerances.
  void come_nearer(const Plc& plc, const std::vector<double>& shares);

  void set_narrow_cells(NarrowCells cells) { narrow_cells_ = cells; }
  /// Sets whether `make` throws FarTooFine.
  void set_fineness(Fineness fineness) { fineness_ = fineness; }

 private:
  /// The arguments of a call of `take_constrained`.
  struct Constrained {
    std::string why;
    Lengths lengths;
  };

  void set_up(const Plc& plc, std::uint64_t seed);
  bool may_be_better_constrained() const;
  bool take_rods();
  bool take_sheathed_rods();
  bool is_good_with_sheaths(std::vector<SheathedRod>& rods);
  bool refines_with_few_vertices();
  bool may_take_constrained(const Plc& plc) const;
  bool is_far_too_fine() const;
  bool replace_refined();
  bool refines_within_budgets(const Plc& plc, std::size_t tried, bool has_mesh);
  static bool has_few_triangles(const Plc& plc);
  const SurfaceTolerance& tolerance(const Plc& plc);
  SurfaceTolerance tolerance(const Plc& plc, int order) const;

  MeshJob& job_;
  ComplexSource* source_;
  NarrowCells narrow_cells_ = NarrowCells::bounded_if_cheap;
  Fineness fineness_ = Fineness::any;
  Hope hope_ = Hope::any;
  bool was_far_too_fine_ = false;
  bool is_constrained_ = false;             // whether the kept mesh started from constrained tetrahedra
  std::optional<Constrained> constrained_;  // how `take_constrained` made the kept mesh
  std::optional<PipelineResult> nearly_good_;
  std::size_t constrained_vertices_ = 0;
  const Plc* no_rods_ = nullptr;               // the complex for which rings around rods made no good mesh
  const Plc* no_sheaths_ = nullptr;            // likewise, for rods inside other regions
  const Plc* hopeless_ = nullptr;              // the complex whose constrained tetrahedra are not tried
  std::optional<SurfaceTolerance> tolerance_;  // tolerance of the current complex
  std::optional<SurfaceTolerance> nearer_;     // smaller tolerance for another try, after regions lost volume
};

}  // namespace collarmesh::pipeline
