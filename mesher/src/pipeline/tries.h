#pragma once

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "collarmesh/error.h"
#include "pipeline/mesh_job.h"
#include "pipeline/mesh_maker.h"

namespace collarmesh::pipeline {

/// Tries repairs, seeds and bounds in narrow places in turn, until a mesh keeps every guarantee. The mesh
/// that is best is that of the job.
class Tries {
 public:
  /// Keeps the job by reference; `source` is that of the complexes, null if there is one only.
  Tries(MeshJob& job, ComplexSource* source) : job_(job), source_(source), maker_(job, source) {}

  /// Builds the complex, as repaired, and meshes it; `all` gets the complex that was meshed. Throws Ended and
  /// PlcError.
  void mesh_repaired(SoupPipelineResult& all);

  /// Meshes a complex as it is. Throws Ended and PlcError.
  void mesh(const Plc& plc);

 private:
  /// The outcome of an attempt at a mesh.
  enum class End {
    holds,     ///< every guarantee
    missed,    ///< a guarantee
    exploded,  ///< it took more vertices than its sizes ask for
    refused    ///< no collar fits between features
  };

  void build(const RepairOptions& repair, SoupPipelineResult& all);
  std::pair<End, std::string> attempt(const Plc& plc, std::exception_ptr& error);
  std::vector<RepairOptions> repairs_after(End end, const SoupPipelineResult& all) const;
  bool misses_collar_angle_only() const;
  bool missed(const char* guarantee) const;
  void try_seeds(const Plc& plc);
  void try_narrow_places_otherwise(const Plc& plc);
  double share_for_volumes() const;

  /// Tries another way. The present result stays unless it is no mesh or the other one keeps every guarantee.
  template <class Way>
  bool find_better(bool has_mesh, const Way& way);

  MeshJob& job_;
  ComplexSource* source_;
  MeshMaker maker_;
};

}  // namespace collarmesh::pipeline
