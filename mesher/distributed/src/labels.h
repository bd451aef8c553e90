#pragma once

#include <petscdmplex.h>

#include <utility>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh::distributed {

/// Make a label, or make it anew: the points that have each value.
void set_label(DM dm, const char* name, std::vector<std::pair<PetscInt, PetscInt>> values_and_points);

/// Refinement labels everything inside of what had a label: leave the points of one depth alone.
void keep_depth(DM dm, const char* name, PetscInt depth);

/// Make `patch` and `curve` of `feature`.
void label_patches_and_curves(DM dm, const Plc& plc);

}  // namespace collarmesh::distributed
