// What the module offers to programs that load it when they need it, by name.
#include <memory>

#include "collarmesh/brep/cad_model.h"

extern "C" __attribute__((visibility("default"))) void collarmesh_read_cad(
    const std::string& path, std::string_view format, std::unique_ptr<collarmesh::brep::CadModel>& model) {
  model = std::make_unique<collarmesh::brep::CadModel>(collarmesh::brep::read_cad(path, format));
}
