#pragma once

#include <string>

#include "collarmesh/plc.h"

namespace collarmesh {

/// Name patches, curves and regions of a complex, by their numbers or by a point on them:
///
///     {"patches": {"inlet": 3, "outlet": {"at": [10, 0, 5]}, "walls": [1, 2, {"at": [0, 0, 1]}]},
///      "curves": {"rim": 4}, "regions": {"steel": 1, "copper": {"at": [5, 5, 5]}}}
///
/// What has one name gets one number, the smallest that any of it had. A point may be off its patch or curve
/// by a hundredth of the diagonal; one in a region must lie in it. Throws OptionError, with the place in the
/// text, for numbers that are none and points that are near nothing.
void name_features(const std::string& json, Plc& plc);

}  // namespace collarmesh
