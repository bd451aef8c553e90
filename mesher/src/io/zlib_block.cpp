#include "io/zlib_block.h"

#include <libdeflate.h>

#include <array>
#include <memory>
#include <new>

namespace collarmesh::io {

namespace {

struct Free {
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
  void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};

constexpr std::size_t levels = 13;

/// Returns a compressor. Compressors are large, so each thread keeps one for each level that it uses.
libdeflate_compressor* compressor(int level) {
  thread_local std::array<std::unique_ptr<libdeflate_compressor, Free>, levels> compressors;
  auto& made = compressors.at(static_cast<std::size_t>(level));
  if (!made) made.reset(libdeflate_alloc_compressor(level));
  if (!made) throw std::bad_alloc();
  return made.get();
}

libdeflate_decompressor* decompressor() {
  thread_local std::unique_ptr<libdeflate_decompressor, Free> made;
  if (!made) made.reset(libdeflate_alloc_decompressor());
  if (!made) throw std::bad_alloc();
  return made.get();
}

}  // namespace

std::string zlib_pack(std::string_view bytes, int level) {
  libdeflate_compressor* const with = compressor(level);
  const std::size_t most = libdeflate_zlib_compress_bound(with, bytes.size());
  const auto packed = std::make_unique_for_overwrite<char[]>(most);
  return {packed.get(), libdeflate_zlib_compress(with, bytes.data(), bytes.size(), packed.get(), most)};
}

bool zlib_unpack(std::string_view packed, std::size_t size, std::string& bytes) {
  const std::size_t before = bytes.size();
  bytes.resize(before + size);
  return libdeflate_zlib_decompress(decompressor(), packed.data(), packed.size(), bytes.data() + before, size,
                                    nullptr) == LIBDEFLATE_SUCCESS;
}

}  // namespace collarmesh::io
