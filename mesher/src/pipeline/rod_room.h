#pragma once

#include <vector>

#include "collarmesh/plc.h"
#include "collarmesh/progress.h"
#include "constrained/sheathed_rods.h"

namespace collarmesh::pipeline {

/// Removes the rods whose sheaths are so near to other features of the complex, or to the sheath of an
/// earlier rod, that tets around the sheath would touch these features or that sheath. If cancelled, removes
/// all. Cost: near linear in the features plus the length of the axes.
void remove_rods_without_room(const Plc& plc, std::vector<SheathedRod>& rods, const Execution& execution);

}  // namespace collarmesh::pipeline
