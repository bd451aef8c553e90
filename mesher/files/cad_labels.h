#pragma once

#include "collarmesh/brep/cad_labels.h"
#include "collarmesh/plc.h"

namespace collarmesh::files {

/// Gives regions without a name the names of their solids, in a form that other programs accept: valid UTF-8
/// of at most 60 bytes. Numbers are appended to names that occur again, or that differ only in characters
/// that some formats drop ("Bolt", "Bolt_2"). Names that look like numbers of features ("Solid2") are not
/// used.
void name_regions(const brep::CadLabels& labels, Plc& plc);

}  // namespace collarmesh::files
