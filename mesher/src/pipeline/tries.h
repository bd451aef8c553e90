#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "pipeline/mesh_job.h"
#include "pipeline/mesh_maker.h"

namespace collarmesh::pipeline {

/// A sequence of tries: repairs, seeds and treatments of narrow places, one after the other, until a mesh
/// keeps every guarantee. The job keeps the best mesh.
class Tries {
 public:
  /// Keeps a reference to the job. `source` makes the complexes; null if there is only one.
  Tries(MeshJob& job, ComplexSource* source)
      : job_(job), source_(source), maker_(job, source), seed_(job.given.mesh.seed) {}

  /// Builds the complex, with repairs, and meshes it. `all` gets the complex that was meshed. Throws Ended
  /// and PlcError.
  void mesh_repaired(SoupPipelineResult& all);

  /// Meshes a complex without repairs. Throws Ended and PlcError.
  void mesh(const Plc& plc);

 private:
  void mesh_any_repaired(SoupPipelineResult& all);
  /// The outcome of an attempt at a mesh.
  enum class End {
    holds,     ///< every guarantee holds
    missed,    ///< a guarantee is missed
    too_fine,  ///< the refinement took far more vertices than the sizes ask for
    exploded,  ///< the refinement hit the bound on vertices
    refused    ///< no collar fits between features
  };

  std::string repair_sharp_creases(RepairOptions& repair, SoupPipelineResult& all);
  std::pair<End, std::string> attempt_simplest(RepairOptions& repair, SoupPipelineResult& all,
                                               std::exception_ptr& error);
  bool may_overlay() const;
  bool overlay_thin_features(RepairOptions& repair, SoupPipelineResult& all, std::size_t most);
  void build(RepairOptions repair, SoupPipelineResult& all);
  std::pair<End, std::string> attempt(const Plc& plc, std::exception_ptr& error);
  std::vector<RepairOptions> repairs_after(End end, const SoupPipelineResult& all) const;
  bool misses_collar_angle_only() const;
  bool missed(const char* guarantee) const;
  void try_seeds(const Plc& plc);
  bool take_constrained(const Plc& plc);
  void try_narrow_places_otherwise(const Plc& plc);
  double share_for_volumes() const;
  double largest_loss(const Plc& plc, std::vector<double>* shares) const;
  bool may_keep_volumes() const;
  void keep_volumes(const Plc& plc);
  bool come_nearer(const Plc& plc, const std::vector<double>& shares, double loss);
  bool come_nearer_where_missed(const Plc& plc);
  bool make_nearer(const Plc& plc, const std::vector<double>& shares, const std::string& why,
                   const std::function<bool()>& is_good_enough);

  /// Tries another way to make a mesh. Uses the new mesh and returns true if it keeps every guarantee, or if
  /// there was none before (`has_mesh`). Otherwise restores the former result.
  template <class Way>
  bool find_better(bool has_mesh, const Way& way);

  MeshJob& job_;
  ComplexSource* source_;
  MeshMaker maker_;
  std::size_t most_asked_for_ = 0;  // number of vertices above which a refinement counted as too fine
  std::size_t exploded_at_ = 0;  // number of vertices at which the first refinement exploded; 0: it did not
  // The seed and the treatment of narrow cells that made the kept mesh.
  std::uint64_t seed_;
  NarrowCells narrow_cells_ = NarrowCells::bounded_if_cheap;
};

}  // namespace collarmesh::pipeline
