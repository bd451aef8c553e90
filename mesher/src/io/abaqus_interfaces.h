#pragma once

#include <map>
#include <string>

#include "collarmesh/split.h"
#include "io/file_writer.h"

namespace collarmesh::io {

using NamesByTag = std::map<Tag, std::string>;

/// Writes a mesh as the `write_abaqus` of tet_mesh_formats.h does, and adds the elements and conditions
/// between the sides of split patches.
void write_abaqus(const std::string& path, const TetMesh& mesh, const Interfaces& interfaces);

/// Writes the elements and conditions between the sides of split patches to an .inp file. `names`: the name
/// of each patch's surface, by the patch's tag.
void write_abaqus_interfaces(FileWriter& out, const TetMesh& mesh, const Interfaces& interfaces,
                             const NamesByTag& names);

}  // namespace collarmesh::io
