#pragma once

#include "collarmesh/brep/cad_model.h"
#include "tessellation.h"
#include "topology.h"

namespace collarmesh::brep {

/// Integrates over the exact solids, faces and edges, and sums up their triangles and chords.
CadMeasures measure(const Topology& topology, const Tessellation& tessellation, double deflection);

}  // namespace collarmesh::brep
