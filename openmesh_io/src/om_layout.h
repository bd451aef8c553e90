#pragma once

#include <cstdint>
#include <string>
#include <string_view>

/// Checks of .om files. OpenMesh 9's reader trusts counts and indices: a wrong one makes it allocate
/// gigabytes or write outside its arrays. So a file's layout is checked before OpenMesh reads the file.
namespace collarmesh::openmesh_io {

struct OmLayout {
  std::uint32_t vertices = 0, faces = 0, edges = 0;
  /// The checked bytes for OpenMesh, without custom properties: the header, the chunks of positions and
  /// topology, the status of faces in files of version 2 and later, and an end mark.
  std::string safe_bytes;
};

/// Checks a file's layout. Throws ReadError "PATH: byte N: ...".
OmLayout check_om_layout(const std::string& path, std::string_view bytes);

}  // namespace collarmesh::openmesh_io
