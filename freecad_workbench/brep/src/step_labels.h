#pragma once

#include "collarmesh/brep/cad_labels.h"

class STEPControl_Reader;
class TopoDS_Shape;

namespace collarmesh::brep {

/// Reads the names of products and solids, and the colours of faces and solids. The labels' numbers are those
/// of the sub-shapes of `shape`, which the reader has made of all roots. Cost: linear in the entities of the
/// file.
CadLabels step_labels(const STEPControl_Reader& reader, const TopoDS_Shape& shape);

}  // namespace collarmesh::brep
