#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/shape_measures.h"
#include "files/cad_files.h"

namespace collarmesh::files {

/// The soups from which a complex was made, and the tags that its features got from them.
struct FeatureSources {
  const std::vector<PolygonSoup>& soups;  ///< the soups as they were read
  const std::vector<Tag>& patches;        ///< tags of patches before names were applied
  const std::vector<Tag>& curves;
};

/// Returns for each curve the soup it came from: the soup of its first patch; for a curve on no patch, the
/// soup with a segment of its tag at one of its points; none if repair moved all its points.
std::vector<Index> files_of_curves(const Plc& plc, const std::vector<PolygonSoup>& soups,
                                   const std::vector<Tag>& numbers);

/// Returns lengths, areas and volumes of the CAD shapes behind a complex: the measures of its features,
/// corrected by the difference between shape and tessellation. NaN for features of
/// an edge or face that the complex has only in part, and for regions other than a solid minus the solids
/// inside it.
ShapeMeasures measures_behind(const Plc& plc, const FeatureSources& sources, const CadFiles& cad);

}  // namespace collarmesh::files
