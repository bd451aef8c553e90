#pragma once

#include <utility>
#include <vector>

#include "collarmesh/plc.h"
#include "periodic/pair_choice.h"

namespace collarmesh::periodicity {

/// The features of the first group of a pair, each with its image among those of the second.
struct FeatureImages {
  using Images = std::vector<std::pair<Index, Index>>;
  Images vertices, curves, patches;
};

/// Finds the images. A vertex is at the place of its image but for the rounding of the input; curves that are
/// not straight are within `distance` of theirs. Throws OptionError if there is none: the message names the
/// feature, the largest distance and where. Cost: the numbers of curves of both groups multiplied, for their
/// boxes.
FeatureImages find_images(const PatchPair& pair, const Plc& plc, double distance);

/// A curve, and what takes another one onto it.
struct CurveImage {
  Index curve = none;
  Motion motion;
};
/// Curves that have the mesh of one of them.
struct CurveClass {
  Index original = none;
  std::vector<CurveImage> images;
};

/// Returns the curves that are images of one another by one or several pairs, as the edges of a cell are.
std::vector<CurveClass> curve_classes(const std::vector<PatchPair>& pairs,
                                      const std::vector<FeatureImages>& images, std::size_t curves);

}  // namespace collarmesh::periodicity
