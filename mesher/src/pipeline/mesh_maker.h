#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "pipeline/constrained_start.h"
#include "pipeline/mesh_job.h"

namespace collarmesh::pipeline {

/// Makes the meshes of one complex after another: with a seed, and in place of a refinement that makes too
/// much from constrained tetrahedra.
class MeshMaker {
 public:
  /// Keeps the job by reference; `source` makes the complexes; null if there is only one.
  MeshMaker(MeshJob& job, ComplexSource* source) : job_(job), source_(source) {}

  /// Forgets what is known about the complex before.
  void take_new_complex();

  /// Takes a complex through all stages. Throws Ended and PlcError; Hopeless if it starts with constrained
  /// tetrahedra, only good hope is allowed, and many tets miss their bounds.
  void make(const Plc& plc, std::uint64_t seed);

  /// Meshes a complex; where the refinement takes far too many vertices, from its constrained tetrahedra.
  void make_refined_or_constrained(const Plc& plc);

  /// Meshes a complex where no other way is left: from its constrained tetrahedra if that keeps every
  /// guarantee; else refined as far as the budgets allow; else from these tetrahedra all the same.
  void make_anyhow(const Plc& plc, const std::string& why);

  /// Meshes a complex from its constrained tetrahedra; nothing where there are none, where others are asked
  /// for, where the mesh misses more than bounds on shapes, or, with good hope only, where many tets miss
  /// these. The mesh of the job stays.
  std::optional<PipelineResult> from_constrained(const Plc& plc, const std::string& why, Hope hope);

  /// Returns whether a seed may change the mesh that is kept: one of constrained tetrahedra has none.
  bool depends_on_seed() const { return !is_constrained_ && job_.start != Start::constrained; }

  /// Further meshes of this complex keep this share of its surface tolerance of first order.
  void come_nearer(const Plc& plc, double share);

  void set_narrow_cells(NarrowCells cells) { narrow_cells_ = cells; }

 private:
  void set_up(const Plc& plc, std::uint64_t seed);
  bool is_far_too_fine() const;
  bool replace_refined();
  bool take_constrained(const Plc& plc, const std::string& why);
  void make_or_take_constrained(const Plc& plc, const std::string* why);
  const SurfaceTolerance& tolerance(const Plc& plc);
  SurfaceTolerance tolerance(const Plc& plc, int order) const;

  MeshJob& job_;
  ComplexSource* source_;
  NarrowCells narrow_cells_ = NarrowCells::bounded_if_cheap;
  Hope hope_ = Hope::any;
  bool is_constrained_ = false;                // the mesh that is kept
  const Plc* hopeless_ = nullptr;              // this complex's constrained tetrahedra were tried in vain
  std::optional<SurfaceTolerance> tolerance_;  // of the complex at hand
  std::optional<SurfaceTolerance> nearer_;     // what a further try keeps where regions lost volume
};

}  // namespace collarmesh::pipeline
