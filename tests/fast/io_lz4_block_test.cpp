// Blocks of LZ4 written by hand. tests/io/vtk_lz4_test.py tests blocks that VTK packs.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "io/lz4_block.h"

namespace collarmesh::io_lz4_block_test {
namespace {

std::string text_of(std::initializer_list<int> bytes) {
  std::string text;
  for (const int byte : bytes) text += static_cast<char>(byte);
  return text;
}

std::string unpacked(std::string_view packed, std::size_t size) {
  std::string bytes = "<";
  return io::lz4_unpack(packed, size, bytes) ? bytes : "damaged";
}

// A match of seven bytes that begins three bytes before: it repeats what it has just written.
const std::string overlapping = text_of({0x33, 'a', 'b', 'c', 3, 0, 0x60}) + "012345";

TEST(IoLz4Block, LiteralsAlone) {
  EXPECT_EQ(unpacked(text_of({0x30}) + "abc", 3), "<abc");
  EXPECT_EQ(unpacked(text_of({0xf0, 255, 3}) + std::string(273, 'x'), 273), "<" + std::string(273, 'x'));
}

TEST(IoLz4Block, MatchesThatOverlap) {
  EXPECT_EQ(unpacked(overlapping, 16), "<abcabcabca012345");
  const std::string lengthy = text_of({0x1f, 'z', 1, 0, 255, 1, 0x60}) + "012345";
  EXPECT_EQ(unpacked(lengthy, 282), "<" + std::string(276, 'z') + "012345");
}

TEST(IoLz4Block, RefusesDamage) {
  for (const std::size_t size : {0, 3, 10, 15, 17}) EXPECT_EQ(unpacked(overlapping, size), "damaged") << size;
  for (std::size_t length = 0; length < overlapping.size(); ++length)
    EXPECT_EQ(unpacked(overlapping.substr(0, length), 16), "damaged") << length;
  std::string before_begin = overlapping;
  before_begin[4] = 4;
  EXPECT_EQ(unpacked(before_begin, 16), "damaged");
}

TEST(IoLz4Block, SurvivesNoise) {
  std::mt19937 random(7);
  for (int round = 0; round < 2000; ++round) {
    std::string packed(1 + random() % 40, ' '), bytes;
    for (char& byte : packed) byte = static_cast<char>(random() % 4 == 0 ? 255 : random() % 64);
    const std::size_t size = random() % 300;
    if (io::lz4_unpack(packed, size, bytes)) {
      EXPECT_EQ(bytes.size(), size);
    }
  }
}

}  // namespace
}  // namespace collarmesh::io_lz4_block_test
