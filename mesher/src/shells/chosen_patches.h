#pragma once

#include <string>
#include <vector>

#include "collarmesh/pipeline.h"

namespace collarmesh::shells {

/// Some patches of a complex, with their curves and vertices.
struct ChosenPatches {
  Plc plc;
  std::vector<Index> patch, curve;  ///< numbers in the whole complex, by index in `plc`

  /// Restricts exact geometry and measures to this part. Precondition: they are for the whole complex.
  void adapt(PipelineOptions& options) const;
  void adapt(ShapeMeasures& exact) const;
};

/// Returns the patches with these names or numbers. Throws OptionError, which lists the patches, if one of
/// `names` is not the name or number of a patch.
ChosenPatches choose_patches(const Plc& whole, const std::vector<std::string>& names);

}  // namespace collarmesh::shells
