#pragma once

#include <string>
#include <vector>

#include "collarmesh/periodic.h"
#include "collarmesh/plc.h"
#include "periodic/motions.h"

namespace collarmesh::periodicity {

/// Two groups of patches of a complex. The second must be the image of the first.
struct PatchPair {
  std::string text;                  ///< the pair as the option gives it
  std::vector<Index> first, second;  ///< sorted
  Motion motion;                     ///< takes the first group to the second
};

/// Returns the pairs that the options name. Throws OptionError for too many pairs, a pair that cannot be
/// read, a name that no patch has, and a patch that is not planar, not on the boundary or in two groups.
std::vector<PatchPair> choose_pairs(const PeriodicOptions& options, const Plc& plc);

}  // namespace collarmesh::periodicity
