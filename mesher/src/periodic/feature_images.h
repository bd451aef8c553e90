#pragma once

#include <utility>
#include <vector>

#include "collarmesh/plc.h"
#include "periodic/pair_choice.h"

namespace collarmesh::periodicity {

/// The features of the first group of a pair, each with its image in the second group.
struct FeatureImages {
  using Images = std::vector<std::pair<Index, Index>>;
  Images vertices, curves, patches;
};

/// Finds the images. A moved vertex or straight curve must be at its image, except for the rounding of the
/// input; other moved curves must be within `distance` (in input units) of their images. Throws OptionError
/// if a feature has no image, and names the feature and, for a vertex or curve, the distance to the nearest
/// candidate. Throws OptionError, too, if the groups have different numbers of features.
/// Cost: the product of the numbers of curves of both groups, for comparing boxes.
FeatureImages find_images(const PatchPair& pair, const Plc& plc, double distance);

/// A curve, and the motion that takes the original curve onto it.
struct CurveImage {
  Index curve = none;
  Motion motion;
};
/// Curves whose meshes are copies of the mesh of one of them.
struct CurveClass {
  Index original = none;
  std::vector<CurveImage> images;
};

/// Returns the classes of curves that are images of one another by one or several pairs, like parallel edges
/// of a periodic cell.
std::vector<CurveClass> curve_classes(const std::vector<PatchPair>& pairs,
                                      const std::vector<FeatureImages>& images, std::size_t curves);

}  // namespace collarmesh::periodicity
