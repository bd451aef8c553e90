#pragma once

#include <string>

namespace collarmesh::io {

/// Returns the bytes of a file, which may be a pipe. Throws ReadError with the system's reason.
std::string read_bytes(const std::string& path);

}  // namespace collarmesh::io
