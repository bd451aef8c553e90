#pragma once

#include <string>
#include <vector>

#include "collarmesh/pipeline.h"

namespace collarmesh::shells {

/// Some patches of a complex, with their curves and vertices.
struct ChosenPatches {
  Plc plc;
  std::vector<Index> patch, curve;  ///< in the whole complex, by the index in `plc`

  /// Makes the exact geometry and measures of the whole complex those of this part.
  void adapt(PipelineOptions& options) const;
  void adapt(ShapeMeasures& exact) const;
};

/// Throws OptionError, with the names that there are, where no patch has a name or number.
ChosenPatches choose_patches(const Plc& whole, const std::vector<std::string>& names);

}  // namespace collarmesh::shells
