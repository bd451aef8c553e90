#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace collarmesh::io {

/// Returns the number of characters for `bytes` bytes, with padding.
constexpr std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

std::string base64_encode(std::string_view bytes);
/// Encodes into existing characters at `text`, `base64_size` of them. Data may be encoded in pieces whose
/// texts are joined if all pieces but the last have a multiple of three bytes.
void base64_encode(std::string_view bytes, char* text);

/// Decodes a text of whole groups of four characters; returns nothing if it is not base64.
std::optional<std::string> base64_decode(std::string_view text);

}  // namespace collarmesh::io
