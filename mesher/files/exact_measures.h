#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/shape_measures.h"
#include "files/cad_files.h"

namespace collarmesh::files {

/// The soups that a complex was made of, and the tags that it got from them.
struct FeatureSources {
  const std::vector<PolygonSoup>& soups;  ///< as they were read
  const std::vector<Tag>& patches;        ///< tags of patches before names were given
  const std::vector<Tag>& curves;
};

/// Returns for each curve the soup it came from: that of its first patch; for a curve of no patch, the soup
/// with a segment of its number at one of its points; none if repair moved all its points.
std::vector<Index> files_of_curves(const Plc& plc, const std::vector<PolygonSoup>& soups,
                                   const std::vector<Tag>& numbers);

/// Returns lengths, areas and volumes of the CAD shapes behind a complex: the measures of features, corrected
/// by the difference between shape and tessellation. Features that are only a part of an edge or face have
/// none, nor have regions that are not a solid without the solids inside it.
ShapeMeasures measures_behind(const Plc& plc, const FeatureSources& sources, const CadFiles& cad);

}  // namespace collarmesh::files
