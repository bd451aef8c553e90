#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace collarmesh::io {

/// Characters that `bytes` bytes take, with padding.
constexpr std::size_t base64_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

std::string base64_encode(std::string_view bytes);
/// The same into `base64_size` characters that are there. Texts of pieces follow each other when all pieces
/// but the last have a multiple of three bytes.
void base64_encode(std::string_view bytes, char* text);

/// The bytes of a text of whole groups of four characters; nothing if it is none.
std::optional<std::string> base64_decode(std::string_view text);

}  // namespace collarmesh::io
