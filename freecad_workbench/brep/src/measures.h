#pragma once

#include "collarmesh/brep/cad_model.h"
#include "face_integrals.h"
#include "tessellation.h"
#include "topology.h"

namespace collarmesh::brep {

/// Measures the exact solids, faces and edges, by integrals, and their triangles and chords. Leaves out a
/// measure if the difference of both is larger than this deflection (absolute) explains. `integrals` are
/// those of all faces of the topology.
CadMeasures measure(const Topology& topology, const FaceIntegrals& integrals,
                    const Tessellation& tessellation, double deflection);

}  // namespace collarmesh::brep
