#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace collarmesh::io {

/// Appends the `size` bytes that a block of LZ4 packs. False if it is damaged or packs another number of
/// bytes. Precondition: `size` is at most `lz4_largest_ratio * packed.size()`; more fits in no block.
bool lz4_unpack(std::string_view packed, std::size_t size, std::string& bytes);

/// A byte of a block stands for no more bytes than these.
constexpr std::size_t lz4_largest_ratio = 255;

}  // namespace collarmesh::io
