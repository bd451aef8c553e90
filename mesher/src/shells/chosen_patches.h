#pragma once

#include <string>
#include <vector>

#include "collarmesh/pipeline.h"

namespace collarmesh::shells {

/// Some patches of a complex, with their curves and vertices.
struct ChosenPatches {
  Plc plc;
  std::vector<Index> patch, curve;  ///< numbers in the whole complex, by index in `plc`

  /// Restricts the exact geometry and measures of the whole complex to this part.
  void adapt(PipelineOptions& options) const;
  void adapt(ShapeMeasures& exact) const;
};

/// Chooses patches. Throws OptionError, with the known names, if one of `names` is not the name or number of
/// a patch.
ChosenPatches choose_patches(const Plc& whole, const std::vector<std::string>& names);

}  // namespace collarmesh::shells
