#pragma once

#include "collarmesh/brep/cad_labels.h"
#include "collarmesh/plc.h"

namespace collarmesh::files {

/// Names regions without a name after their solids, in a form that other programs accept: valid UTF-8 of at
/// most 60 bytes. Names that occur again, or differ only in characters that formats do not keep, get numbers
/// ("Bolt", "Bolt_2"). Names that look like numbers of features ("Solid2") are left out.
void name_regions(const brep::CadLabels& labels, Plc& plc);

}  // namespace collarmesh::files
