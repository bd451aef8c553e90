#pragma once

#include <string>

#include "collarmesh/plc.h"

namespace collarmesh {

/// Gives names to patches, curves and regions of a complex, which the text identifies by number or by a point
/// on them:
///     {"patches": {"inlet": 3, "outlet": {"at": [10, 0, 5]}, "walls": [1, 2, {"at": [0, 0, 1]}]},
///      "curves": {"rim": 4}, "regions": {"steel": 1, "copper": {"at": [5, 5, 5]}}}
/// Features with the same name get one number, the smallest of theirs. A point may be off its patch or curve
/// by a hundredth of the diagonal; a region's point must lie in it. Throws OptionError, with the place in the
/// text, for unknown numbers and for points that are near no feature.
void name_features(const std::string& json, Plc& plc);

}  // namespace collarmesh
