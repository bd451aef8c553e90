#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/shape_measures.h"
#include "files/cad_files.h"

namespace collarmesh::files {

/// The soups that a complex was made of, and the tags that it got from them.
struct FeatureSources {
  const std::vector<PolygonSoup>& soups;  ///< as they were read
  const std::vector<Tag>& patches;        ///< their tags before names were given
  const std::vector<Tag>& curves;
};

/// For each curve, the soup it came from: that of its first patch, or for a curve of no patch the one with a
/// segment of its number at one of its points; none if repair moved all its points.
std::vector<Index> files_of_curves(const Plc& plc, const std::vector<PolygonSoup>& soups,
                                   const std::vector<Tag>& numbers);

/// Lengths, areas and volumes of the CAD shapes behind a complex: what features measure, corrected by what
/// the tessellation lacks. Features that are not all of an edge or face, and regions that are no solid
/// without those that lie in it, have none.
ShapeMeasures measures_behind(const Plc& plc, const FeatureSources& sources, const CadFiles& cad);

}  // namespace collarmesh::files
