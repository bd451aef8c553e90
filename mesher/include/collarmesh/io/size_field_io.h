#pragma once

#include <memory>
#include <string>

#include "collarmesh/plc.h"
#include "collarmesh/size_field.h"

namespace collarmesh::io {

/// Reads a size field: .json (a description, see `size_field_from_json`), or .vtu or .msh (a mesh with a
/// scalar field of target edge lengths on its points). The field keeps `use`, if there is one, and records in
/// it the sizes that each source asks for. Throws ReadError for a file that cannot be read, OptionError for
/// one that describes no size field.
SizeField read_size_field(const std::string& path, const Plc& plc,
                          const std::shared_ptr<SizeFieldUse>& use = nullptr);

}  // namespace collarmesh::io
