#pragma once

#include <string>
#include <string_view>

namespace collarmesh::io {

/// Returns `format` or, if it is empty, the extension of the path; in lower case, with the dot.
std::string format_of(const std::string& path, std::string_view format = {});

/// Returns the entry of `formats` whose extension is `format_of(path, format)`; null if there is none.
template <class Formats>
const typename Formats::value_type* find_format(const Formats& formats, const std::string& path,
                                                std::string_view format) {
  const std::string extension = format_of(path, format);
  for (const auto& known : formats)
    if (known.extension == extension) return &known;
  return nullptr;
}

}  // namespace collarmesh::io
