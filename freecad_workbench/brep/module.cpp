// The function that programs look up by name when they load this module. The name contains the version,
// because module and program must have the same version.
#include <memory>

#include "collarmesh/brep/cad_model.h"

extern "C" __attribute__((visibility("default"))) void COLLARMESH_READ_CAD(
    const std::string& path, std::string_view format, const collarmesh::brep::CadOptions& options,
    std::unique_ptr<collarmesh::brep::CadModel>& model) {
  model = std::make_unique<collarmesh::brep::CadModel>(collarmesh::brep::read_cad(path, format, options));
}
