#include "io/base64.h"

#include <array>
#include <cstdint>

namespace collarmesh::io {

namespace {

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t invalid = 0xff;

constexpr std::array<std::uint8_t, 256> make_values() {
  std::array<std::uint8_t, 256> value_of_letter{};
  value_of_letter.fill(invalid);
  for (std::size_t i = 0; i < alphabet.size(); ++i)
    value_of_letter[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
  return value_of_letter;
}
constexpr std::array<std::uint8_t, 256> value_of_letter = make_values();

std::uint32_t byte(char c) { return static_cast<unsigned char>(c); }

}  // namespace

std::string base64_encode(std::string_view bytes) {
  std::string text(base64_size(bytes.size()), '=');
  base64_encode(bytes, text.data());
  return text;
}

void base64_encode(std::string_view bytes, char* text) {
  std::size_t i = 0;
  for (; i + 2 < bytes.size(); i += 3) {
    const std::uint32_t group = byte(bytes[i]) << 16 | byte(bytes[i + 1]) << 8 | byte(bytes[i + 2]);
    *text++ = alphabet[group >> 18];
    *text++ = alphabet[group >> 12 & 63];
    *text++ = alphabet[group >> 6 & 63];
    *text++ = alphabet[group & 63];
  }
  if (i == bytes.size()) return;
  const bool two = i + 1 < bytes.size();
  const std::uint32_t group = byte(bytes[i]) << 16 | (two ? byte(bytes[i + 1]) << 8 : 0);
  *text++ = alphabet[group >> 18];
  *text++ = alphabet[group >> 12 & 63];
  *text++ = two ? alphabet[group >> 6 & 63] : '=';
  *text = '=';
}

std::optional<std::string> base64_decode(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  const std::size_t used = text.size() - padding;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t group = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint8_t value = i < used ? value_of_letter[static_cast<unsigned char>(text[i])] : 0;
    if (value == invalid) return std::nullopt;
    group = group << 6 | value;
    if (i % 4 != 3) continue;
    bytes += static_cast<char>(group >> 16 & 255);
    bytes += static_cast<char>(group >> 8 & 255);
    bytes += static_cast<char>(group & 255);
  }
  bytes.resize(bytes.size() - padding);
  return bytes;
}

}  // namespace collarmesh::io
