#pragma once

#include <string>

namespace collarmesh::io {

/// Reads the bytes of a file. Throws ReadError with the system's reason. Allocates as much as the file really
/// holds, whatever sizes it claims.
std::string read_bytes(const std::string& path);

}  // namespace collarmesh::io
