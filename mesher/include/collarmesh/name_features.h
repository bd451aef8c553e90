#pragma once

#include <string>

#include "collarmesh/plc.h"

namespace collarmesh {

/// Names patches, curves and regions of a complex, by their numbers or by a point on them:
///
///     {"patches": {"inlet": 3, "outlet": {"at": [10, 0, 5]}, "walls": [1, 2, {"at": [0, 0, 1]}]},
///      "curves": {"rim": 4}, "regions": {"steel": 1, "copper": {"at": [5, 5, 5]}}}
///
/// Features with the same name get one number, the smallest that any of them had. A point may be off its
/// patch or curve by a hundredth of the diagonal; one in a region must lie in it. Throws OptionError, with
/// the place in the text, for unknown numbers and for points that are near no feature.
void name_features(const std::string& json, Plc& plc);

}  // namespace collarmesh
