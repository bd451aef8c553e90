// LZ4's block format: sequences of bytes to take as they are, followed by a match, which repeats bytes from
// up to 65535 bytes before. A sequence begins with a token: the number of bytes in its high half, the length
// of the match in its low half; 15 in either says that more bytes, all but the last of them 255, are to be
// added. The last sequence has no match.
#include "io/lz4_block.h"

#include <cstdint>

namespace collarmesh::io {

namespace {

constexpr std::size_t shortest_match = 4;
constexpr unsigned half_is_full = 15, byte_is_full = 255;

class Block {
 public:
  Block(std::string_view packed, std::size_t size) : packed_(packed), size_(size) { bytes_.reserve(size); }

  std::optional<std::string> unpack() {
    while (sequence())
      if (at_ == packed_.size())
        return bytes_.size() == size_ ? std::optional(std::move(bytes_)) : std::nullopt;
    return std::nullopt;
  }

 private:
  /// Returns whether it is complete and has no more bytes than expected.
  bool sequence() {
    std::uint8_t token = 0;
    std::size_t literals = 0, match = 0;
    if (!byte(token) || !length(token >> 4U, literals) || !take(literals)) return false;
    if (at_ == packed_.size()) return true;  // the last one
    std::uint8_t low = 0, high = 0;
    if (!byte(low) || !byte(high) || !length(token & half_is_full, match)) return false;
    return repeat(low + std::size_t{256} * high, match + shortest_match) && at_ < packed_.size();
  }

  bool byte(std::uint8_t& value) {
    if (at_ == packed_.size()) return false;
    value = static_cast<std::uint8_t>(packed_[at_++]);
    return true;
  }

  bool length(unsigned half, std::size_t& value) {
    value = half;
    std::uint8_t more = half == half_is_full ? byte_is_full : 0;
    while (more == byte_is_full) {
      if (!byte(more)) return false;
      value += more;
    }
    return true;
  }

  bool take(std::size_t count) {
    if (count > packed_.size() - at_ || count > size_ - bytes_.size()) return false;
    bytes_.append(packed_.substr(at_, count));
    at_ += count;
    return true;
  }

  /// The bytes may overlap those that they are copied to: one is copied after the other.
  bool repeat(std::size_t distance, std::size_t count) {
    if (distance == 0 || distance > bytes_.size() || count > size_ - bytes_.size()) return false;
    for (std::size_t k = 0; k < count; ++k) bytes_.push_back(bytes_[bytes_.size() - distance]);
    return true;
  }

  std::string_view packed_;
  std::size_t size_;
  std::size_t at_ = 0;
  std::string bytes_;
};

}  // namespace

std::optional<std::string> lz4_unpack(std::string_view packed, std::size_t size) {
  return Block(packed, size).unpack();
}

}  // namespace collarmesh::io
