#include "io/vtk_array.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "io/base64.h"
#include "io/lz4_block.h"
#include "io/zlib_block.h"

namespace collarmesh::io {

namespace {

struct XmlType {
  std::string_view name;
  NumberType type;
};
constexpr std::array<XmlType, 10> xml_types{{{"Int8", NumberType::i8},
                                             {"UInt8", NumberType::u8},
                                             {"Int16", NumberType::i16},
                                             {"UInt16", NumberType::u16},
                                             {"Int32", NumberType::i32},
                                             {"UInt32", NumberType::u32},
                                             {"Int64", NumberType::i64},
                                             {"UInt64", NumberType::u64},
                                             {"Float32", NumberType::f32},
                                             {"Float64", NumberType::f64}}};

/// A reader that takes bytes from the front of the stored data.
class Stored {
 public:
  Stored(std::string_view text, bool base64) : text_(text), base64_(base64) {}

  /// Returns an upper bound of the number of bytes left.
  std::size_t left() const { return base64_ ? text_.size() / 4 * 3 : text_.size(); }

  /// Takes bytes. In base64 they must be a run that was encoded by itself, with its own padding.
  std::string take(std::uint64_t count) {
    std::string bytes = peek(count);
    if (bytes.size() < count) fail(count, bytes.size());
    text_.remove_prefix(base64_ ? base64_size(count) : count);
    return bytes;
  }

  /// Returns bytes without taking them; fewer if padding ends the run earlier.
  std::string peek(std::uint64_t count) const {
    if (count > left()) fail(count, left());
    if (!base64_) return std::string(text_.substr(0, count));
    std::optional<std::string> bytes = base64_decode(text_.substr(0, base64_size(count)));
    if (!bytes) throw VtkArrayError{"the values are not base64"};
    bytes->resize(std::min<std::size_t>(bytes->size(), count));
    return *std::move(bytes);
  }

  /// Returns whether padding ends the run after this many bytes.
  bool ends_after(std::size_t count) const {
    return base64_ && base64_size(count) <= text_.size() && text_[base64_size(count) - 1] == '=';
  }

 private:
  [[noreturn]] static void fail(std::uint64_t expected, std::size_t found) {
    throw VtkArrayError{fmt::format("expected {} bytes of values, found {}", expected, found)};
  }

  std::string_view text_;
  bool base64_;
};

std::uint64_t header_number(std::string_view header, std::size_t i, const VtkStorage& storage) {
  return storage.header_bytes == 8 ? value_at<std::uint64_t>(header, 8 * i, storage.order)
                                   : value_at<std::uint32_t>(header, 4 * i, storage.order);
}

/// Decodes the number of bytes, then the bytes themselves. Some writers encode the number as a base64 text of
/// its own.
std::string decode_plain(Stored& stored, const VtkStorage& storage) {
  const std::string header = stored.peek(storage.header_bytes);
  if (header.size() < storage.header_bytes)
    throw VtkArrayError{"expected the size of the values, found too few bytes"};
  const std::uint64_t size = header_number(header, 0, storage);
  if (size > stored.left())
    throw VtkArrayError{fmt::format("expected {} bytes of values, found {}", size, stored.left())};
  if (stored.ends_after(storage.header_bytes)) {
    stored.take(storage.header_bytes);
    return stored.take(size);
  }
  return stored.take(storage.header_bytes + size).substr(storage.header_bytes);
}

void unpack_block(VtkCompression compression, std::string_view packed, std::uint64_t size,
                  std::string& bytes) {
  const bool lz4 = compression == VtkCompression::lz4;
  if (size / (lz4 ? lz4_largest_ratio : vtk_largest_ratio) > packed.size())
    throw VtkArrayError{
        fmt::format("a block of {} compressed bytes cannot hold {} bytes of values", packed.size(), size)};
  if (!(lz4 ? lz4_unpack : zlib_unpack)(packed, size, bytes))
    throw VtkArrayError{"a compressed block is damaged"};
}

/// Decodes the header (number of blocks, their size, size of the last one if it is smaller, compressed
/// sizes), then the blocks.
std::string decode_compressed(Stored& stored, const VtkStorage& storage) {
  const std::string first = stored.peek(storage.header_bytes);
  if (first.size() < storage.header_bytes)
    throw VtkArrayError{"expected the number of blocks, found too few bytes"};
  const std::uint64_t blocks = header_number(first, 0, storage);
  if (blocks == 0) return {};
  if (blocks > stored.left() / storage.header_bytes)
    throw VtkArrayError{
        fmt::format("expected the sizes of {} blocks, found only {} bytes", blocks, stored.left())};
  const std::string header = stored.take((3 + blocks) * storage.header_bytes);
  const std::uint64_t block_size = header_number(header, 1, storage),
                      last_size = header_number(header, 2, storage);
  std::uint64_t packed_size = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::uint64_t size = header_number(header, 3 + b, storage);
    if (size > stored.left() - packed_size)
      throw VtkArrayError{
          fmt::format("block {} has {} bytes, but only {} follow", b, size, stored.left() - packed_size)};
    packed_size += size;
  }
  const std::string packed = stored.take(packed_size);
  std::string bytes;
  std::size_t at = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::uint64_t size = header_number(header, 3 + b, storage);
    unpack_block(storage.compression, std::string_view(packed).substr(at, size),
                 b + 1 == blocks && last_size != 0 ? last_size : block_size, bytes);
    at += size;
  }
  return bytes;
}

template <class From, class To>
std::vector<To> convert(std::string_view bytes, std::endian order) {
  std::vector<To> values;
  values.reserve(bytes.size() / sizeof(From));
  for (std::size_t at = 0; at + sizeof(From) <= bytes.size(); at += sizeof(From))
    values.push_back(static_cast<To>(value_at<From>(bytes, at, order)));
  return values;
}

/// Converts values. Real numbers that an integer of 64 bits cannot hold become -1, which is no valid index or
/// count.
template <class From>
std::vector<std::int64_t> convert_to_integers(std::string_view bytes, std::endian order) {
  std::vector<std::int64_t> values;
  for (const From value : convert<From, From>(bytes, order))
    values.push_back(value > From{-9e18} && value < From{9e18} ? static_cast<std::int64_t>(value) : -1);
  return values;
}

}  // namespace

NumberType vtk_type(std::string_view name) {
  for (const XmlType& known : xml_types)
    if (known.name == name) return known.type;
  return NumberType::unknown;
}

std::string decode_vtk_array(std::string_view text, bool base64, const VtkStorage& storage) {
  Stored stored(text, base64);
  return storage.compression == VtkCompression::none ? decode_plain(stored, storage)
                                                     : decode_compressed(stored, storage);
}

template <class To>
std::vector<To> convert_vtk_values(std::string_view bytes, NumberType type, std::endian order) {
  constexpr bool to_integers = std::is_integral_v<To>;
  switch (type) {
    case NumberType::i8: return convert<std::int8_t, To>(bytes, order);
    case NumberType::u8: return convert<std::uint8_t, To>(bytes, order);
    case NumberType::i16: return convert<std::int16_t, To>(bytes, order);
    case NumberType::u16: return convert<std::uint16_t, To>(bytes, order);
    case NumberType::i32: return convert<std::int32_t, To>(bytes, order);
    case NumberType::u32: return convert<std::uint32_t, To>(bytes, order);
    case NumberType::i64: return convert<std::int64_t, To>(bytes, order);
    case NumberType::u64: return convert<std::uint64_t, To>(bytes, order);
    case NumberType::f32:
      if constexpr (to_integers)
        return convert_to_integers<float>(bytes, order);
      else
        return convert<float, To>(bytes, order);
    case NumberType::f64:
      if constexpr (to_integers)
        return convert_to_integers<double>(bytes, order);
      else
        return convert<double, To>(bytes, order);
    case NumberType::unknown: break;
  }
  return {};
}

template std::vector<double> convert_vtk_values(std::string_view, NumberType, std::endian);
template std::vector<std::int64_t> convert_vtk_values(std::string_view, NumberType, std::endian);

}  // namespace collarmesh::io
