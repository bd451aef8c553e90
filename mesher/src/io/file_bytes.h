#pragma once

#include <string>
#include <string_view>

namespace collarmesh::io {

/// Reads the bytes of a file. Throws ReadError with the system's reason. Allocates as much as the file really
/// holds, whatever sizes it claims.
std::string read_bytes(const std::string& path);

/// Returns the given format, or else the extension of the path, in lower case with its dot.
std::string format_of(const std::string& path, std::string_view format = {});

/// Returns the entry of a table of formats, by their extensions, for a file; null if there is none.
template <class Formats>
const typename Formats::value_type* find_format(const Formats& formats, const std::string& path,
                                                std::string_view format) {
  const std::string extension = format_of(path, format);
  for (const auto& known : formats)
    if (known.extension == extension) return &known;
  return nullptr;
}

}  // namespace collarmesh::io
