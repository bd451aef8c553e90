#pragma once

#include "collarmesh/brep/cad_labels.h"
#include "collarmesh/plc.h"

namespace collarmesh::files {

/// Gives regions without a name those of their solids, as other programs take them: valid UTF-8 of at most
/// 60 bytes. Names that come again, or differ only by what formats do not keep, get numbers ("Bolt",
/// "Bolt_2"). Names like those of numbers ("Solid2") are left out.
void name_regions(const brep::CadLabels& labels, Plc& plc);

}  // namespace collarmesh::files
