#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace collarmesh::io {

/// Returns the number of base64 characters for `bytes` bytes, with padding.
constexpr std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

std::string base64_encode(std::string_view bytes);
/// Encodes into the `base64_size(bytes.size())` characters at `text`. Data may be encoded piece by piece and
/// the texts joined if each piece before the last has a multiple of three bytes.
void base64_encode(std::string_view bytes, char* text);

/// Decodes a text of whole groups of four characters; returns nothing if it is not base64.
std::optional<std::string> base64_decode(std::string_view text);

}  // namespace collarmesh::io
