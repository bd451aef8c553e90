#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace collarmesh::io {

/// Unpacks a block of LZ4 and appends its `size` bytes. Returns false if it is damaged or packs another
/// number of bytes. Precondition: `size` is at most `lz4_largest_ratio * packed.size()`; no block holds more.
bool lz4_unpack(std::string_view packed, std::size_t size, std::string& bytes);

/// The largest number of bytes that one byte of a block stands for.
constexpr std::size_t lz4_largest_ratio = 255;

}  // namespace collarmesh::io
