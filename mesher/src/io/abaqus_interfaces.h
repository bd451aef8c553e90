#pragma once

#include <map>
#include <string>

#include "collarmesh/split.h"
#include "io/file_writer.h"

namespace collarmesh::io {

using NamesByTag = std::map<Tag, std::string>;

/// Writes a mesh like `write_abaqus` without interfaces, and adds the elements and conditions between the
/// sides of split patches.
void write_abaqus(const std::string& path, const TetMesh& mesh, const Interfaces& interfaces);

/// Writes the elements and conditions between the sides of split patches to an .inp file. `names` are those
/// of the patches' surfaces.
void write_abaqus_interfaces(FileWriter& out, const TetMesh& mesh, const Interfaces& interfaces,
                             const NamesByTag& names);

}  // namespace collarmesh::io
