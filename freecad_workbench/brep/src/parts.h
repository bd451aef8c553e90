#pragma once

#include "collarmesh/brep/cad_model.h"
#include "face_integrals.h"
#include "nearest.h"
#include "tessellation.h"
#include "topology.h"

namespace collarmesh::brep {

struct CadModel::Parts {
  std::string name;
  CadLabels labels;
  double diagonal = 0;
  Topology topology;
  Tessellation tessellation;
  double deflection = 0;                     ///< deflection of `tessellation`, absolute
  std::unique_ptr<FaceIntegrals> integrals;  ///< null until measures are asked for
  std::unique_ptr<NearestOnShape> exact;     ///< search for nearest points; it refers to `tessellation`
};

}  // namespace collarmesh::brep
