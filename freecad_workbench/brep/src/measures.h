#pragma once

#include "collarmesh/brep/cad_model.h"
#include "tessellation.h"
#include "topology.h"

namespace collarmesh::brep {

/// Integrate over the exact solids, faces and edges, and sum up their triangles and chords.
CadMeasures measure(const Topology& topology, const Tessellation& tessellation, double deflection);

}  // namespace collarmesh::brep
