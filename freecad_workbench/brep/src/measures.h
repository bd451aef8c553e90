#pragma once

#include "collarmesh/brep/cad_model.h"
#include "face_integrals.h"
#include "tessellation.h"
#include "topology.h"

namespace collarmesh::brep {

/// Sums up the integrals over the exact solids, faces and edges, and the sizes of their triangles and chords.
/// `integrals`: those of all faces of the topology.
CadMeasures measure(const Topology& topology, const FaceIntegrals& integrals,
                    const Tessellation& tessellation, double deflection);

}  // namespace collarmesh::brep
