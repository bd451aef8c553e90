#pragma once

#include <petscdmplex.h>

#include <utility>
#include <vector>

#include "collarmesh/plc.h"

namespace collarmesh::distributed {

/// Sets a label, given as pairs of a value and a point. Replaces an existing label.
void set_label(DM dm, const char* name, std::vector<std::pair<PetscInt, PetscInt>> values_and_points);

/// Removes a label from all points of other depths than this: refinement also labels the new points inside
/// labelled ones.
void keep_depth(DM dm, const char* name, PetscInt depth);

/// Makes the labels `patch` and `curve` from `feature`.
void label_patches_and_curves(DM dm, const Plc& plc);

}  // namespace collarmesh::distributed
