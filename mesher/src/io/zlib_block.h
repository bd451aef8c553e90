#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace collarmesh::io {

/// Compresses to zlib's format (RFC 1950), at a level of libdeflate from 1 (fastest) to 12 (smallest). Throws
/// std::bad_alloc.
std::string zlib_pack(std::string_view bytes, int level);

/// Appends the decompressed data, which has `size` bytes. Returns false if it has another size, or is
/// damaged. Throws std::bad_alloc.
bool zlib_unpack(std::string_view packed, std::size_t size, std::string& bytes);

}  // namespace collarmesh::io
