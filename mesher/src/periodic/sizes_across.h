#pragma once

#include <optional>

#include "collarmesh/periodic.h"
#include "collarmesh/size_field.h"

namespace collarmesh::periodicity {

/// Elements beside a periodic patch have to suit what is near it on the other side as well. Returns the edge
/// lengths of each group where the other one has clearly longer edges, at the places of these, growing with
/// the distance; nothing if there are none. Cost: near linear in the triangles of these patches; each place
/// asked for costs as many steps as there are such places that no other one implies.
std::optional<SizeField> sizes_across(const TetMesh& mesh, const Plc& plc, const PeriodicOptions& options);

}  // namespace collarmesh::periodicity
