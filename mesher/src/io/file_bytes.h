#pragma once

#include <string>

namespace collarmesh::io {

/// The bytes of a file. Throws ReadError with the system's reason. Allocates what the file really
/// holds, never what something in it claims.
std::string read_bytes(const std::string& path);

/// The extension in lower case with its dot, empty if there is none.
std::string lower_extension(const std::string& path);

}  // namespace collarmesh::io
