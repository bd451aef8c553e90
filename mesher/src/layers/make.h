#pragma once

#include "collarmesh/layers.h"

namespace collarmesh::layering {

/// Makes layers as `make_layers` does. In second order, `made` gets a report of the nodes of the whole mesh,
/// but its list of straightened nodes omits those that were straightened before.
LayersReport make(TetMesh& mesh, const Plc& plc, const LayerOptions& options,
                  const ImproveOptions& improvement, const SecondOrderOptions& second_order,
                  const Execution& execution, SecondOrderReport& made);

}  // namespace collarmesh::layering
