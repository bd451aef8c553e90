#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/number_bytes.h"

/// Values of VTK's XML formats as they are stored outside the XML: blocks of bytes, raw or base64,
/// compressed or not.
namespace collarmesh::io {

NumberType vtk_type(std::string_view name);

enum class VtkCompression { none, zlib, lz4 };

/// The way in which a file stores its arrays.
struct VtkStorage {
  std::endian order = std::endian::little;
  std::size_t header_bytes = 4;  ///< bytes of each number in the header of an array
  VtkCompression compression = VtkCompression::none;
};

/// Largest compression ratio of zlib. That of LZ4 is less than a quarter of it.
constexpr std::uint64_t vtk_largest_ratio = 1032;

/// A fault of stored values, to which the caller adds the file and the place.
struct VtkArrayError {
  std::string message;
};

/// Decodes an array that begins where `stored` begins. Throws VtkArrayError. Allocates no more than the
/// stored bytes can hold.
std::string decode_vtk_array(std::string_view stored, bool base64, const VtkStorage& storage);

/// Converts numbers of any type to doubles or 64-bit integers.
template <class To>
std::vector<To> convert_vtk_values(std::string_view bytes, NumberType type, std::endian order);

}  // namespace collarmesh::io
