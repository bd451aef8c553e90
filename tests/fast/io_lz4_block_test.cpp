// Blocks of LZ4 written by hand; what VTK packs is read in tests/io/vtk_lz4_test.py.
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <string>

#include "io/lz4_block.h"

namespace collarmesh {
namespace {

using Bytes = std::optional<std::string>;

std::string text_of(std::initializer_list<int> bytes) {
  std::string text;
  for (const int byte : bytes) text += static_cast<char>(byte);
  return text;
}

TEST(IoLz4Block, LiteralsAlone) {
  EXPECT_EQ(io::lz4_unpack("\x30"
                           "abc",
                           3),
            Bytes("abc"));
  EXPECT_EQ(io::lz4_unpack(text_of({0xf0, 255, 3}) + std::string(273, 'x'), 273),
            Bytes(std::string(273, 'x')));
}

/// A match of seven bytes from three before repeats what it has just written.
TEST(IoLz4Block, MatchesThatOverlap) {
  const std::string packed = text_of({0x33, 'a', 'b', 'c', 3, 0, 0x10, '!'});
  EXPECT_EQ(io::lz4_unpack(packed, 11), Bytes("abcabcabca!"));
  const std::string lengthy = text_of({0x1f, 'z', 1, 0, 255, 1, 0x10, '!'});
  std::string expected(277, 'z');
  expected.back() = '!';
  EXPECT_EQ(io::lz4_unpack(lengthy, 277), Bytes(expected));
}

TEST(IoLz4Block, RefusesDamage) {
  const std::string packed = text_of({0x33, 'a', 'b', 'c', 3, 0, 0x10, '!'});
  for (const std::size_t size : {0, 3, 10, 12}) EXPECT_EQ(io::lz4_unpack(packed, size), std::nullopt) << size;
  for (std::size_t length = 0; length < packed.size(); ++length)
    EXPECT_EQ(io::lz4_unpack(packed.substr(0, length), 11), std::nullopt) << length;
  EXPECT_EQ(io::lz4_unpack(text_of({0x33, 'a', 'b', 'c', 4, 0, 0x10, '!'}), 11), std::nullopt);
  EXPECT_EQ(io::lz4_unpack(text_of({0x33, 'a', 'b', 'c', 0, 0, 0x10, '!'}), 11), std::nullopt);
}

TEST(IoLz4Block, SurvivesNoise) {
  std::mt19937 random(7);
  for (int round = 0; round < 2000; ++round) {
    std::string packed(1 + random() % 40, ' ');
    for (char& byte : packed) byte = static_cast<char>(random() % 4 == 0 ? 255 : random() % 64);
    const std::size_t size = random() % 300;
    const Bytes bytes = io::lz4_unpack(packed, size);
    if (bytes) {
      EXPECT_EQ(bytes->size(), size);
    }
  }
}

}  // namespace
}  // namespace collarmesh
