#pragma once

#include <bit>
#include <string>
#include <string_view>
#include <vector>

#include "collarmesh/geometry.h"
#include "io/byte_reader.h"
#include "io/text_scanner.h"

namespace collarmesh::io {

/// The part of a .msh file between $NAME and $EndNAME.
struct MshSection {
  std::string_view name, body;
  std::size_t first_line = 1;  ///< number of the first line of `body`
  std::size_t first_byte = 0;
};

/// Splits a file into sections. Cost: linear. Throws ReadError if a section has no end.
std::vector<MshSection> split_msh(const std::string& path, std::string_view text);

/// A reader of the values of a section of a text file.
class MshText {
 public:
  MshText(const std::string& path, const MshSection& section)
      : scan_(path, section.body, 0, section.first_line) {}

  int integer(std::string_view what) {
    const std::int64_t value = scan_.integer(what);
    if (value < -0x80000000LL || value > 0x7fffffffLL)
      scan_.fail(fmt::format("{}, {}, is too large", what, value));
    return static_cast<int>(value);
  }
  std::uint64_t number(std::string_view what) {
    const std::int64_t value = scan_.integer(what);
    if (value < 0) scan_.fail(fmt::format("{}, {}, is negative", what, value));
    return static_cast<std::uint64_t>(value);
  }
  /// Reads a count of items that take at least this many numbers each; it is an error if the rest of the
  /// section cannot hold so many items.
  Index count(std::string_view what, std::size_t numbers) { return scan_.count(what, 2 * numbers); }
  double real(std::string_view what) { return scan_.number(what); }
  Point point(std::string_view what) { return scan_.point(what); }
  [[noreturn]] void fail(const std::string& message) const { scan_.fail(message); }
  TextScanner& text() { return scan_; }

 private:
  TextScanner scan_;
};

/// A reader of the values that have one binary form in all versions.
class MshBytes {
 public:
  int integer(std::string_view what) { return bytes_.get<std::int32_t>(what); }
  double real(std::string_view what) { return bytes_.get<double>(what); }
  Point point(std::string_view what);
  [[noreturn]] void fail(const std::string& message) const { bytes_.fail(message); }

 protected:
  explicit MshBytes(const ByteReader& bytes) : bytes_(bytes) {}

  ByteReader bytes_;
};

/// A reader of the values of a section of a binary file.
class MshBinary : public MshBytes {
 public:
  MshBinary(const std::string& path, const MshSection& section, std::endian order)
      : MshBytes({path, section.body, order, section.first_byte}) {}

  std::uint64_t number(std::string_view what) { return bytes_.get<std::uint64_t>(what); }
  Index count(std::string_view what, std::size_t numbers) {
    const std::uint64_t value = number(what);
    if (value > bytes_.left() / (4 * numbers) || value >= none)
      fail(fmt::format("{} is {}, but only {} bytes follow; the file is cut off or wrong", what, value,
                       bytes_.left()));
    return static_cast<Index>(value);
  }
};

/// A reader of the values of a section of a binary file of version 2: a count as text on the first line, then
/// integers of 32 bits and doubles.
class MshBinary2 : public MshBytes {
 public:
  MshBinary2(const std::string& path, const MshSection& section, std::endian order);

  std::uint64_t number(std::string_view what) {
    const int value = integer(what);
    if (value < 0) fail(fmt::format("{}, {}, is negative", what, value));
    return static_cast<std::uint64_t>(value);
  }
  /// Returns the count on the first line. `numbers`: as in MshText.
  Index count(std::string_view what, std::size_t numbers);

 private:
  std::int64_t count_;
};

}  // namespace collarmesh::io
