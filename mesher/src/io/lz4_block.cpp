#include "io/lz4_block.h"

#include <lz4.h>

#include <cassert>
#include <limits>

namespace collarmesh::io {

bool lz4_unpack(std::string_view packed, std::size_t size, std::string& bytes) {
  assert(size / lz4_largest_ratio <= packed.size());
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (packed.size() > most || size > most) return false;
  const std::size_t before = bytes.size();
  bytes.resize(before + size);
  return LZ4_decompress_safe(packed.data(), bytes.data() + before, static_cast<int>(packed.size()),
                             static_cast<int>(size)) == static_cast<int>(size);
}

}  // namespace collarmesh::io
